"""Hull form by coefficients: curves of sectional area and waterline breadth, and a family of sections between them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.fairing import Basis, Constraints, smoothest, span

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

Array = NDArray[np.float64]

_INTERVALS = 24  #: of the splines, over the length
_HOLLOW = 0.5  #: least section coefficient of the fore body over the midship one
_FULL_BOW = 0.8  #: section coefficient over the midship one that bows are drawn towards
_BOW_WEIGHT, _RUN_WEIGHT = 1e6, 300.0  #: of that wish, and of a run that ends hollow, against fairness
_CONVEX = 0.5  #: half-lengths from midship within which both curves have no inflection
_WAVE = 0.05  #: most by which S / w may grow outward, over half a length
_KEEL_RISES = 0.75  #: part of the midship coefficient that a section at full draught would have where the keel starts to rise


@dataclass(frozen=True)
class Form:
    """Form coefficients of a hull.

    Parameters
    ----------
    cb, cm, cwp : float
        Block, midship and waterplane coefficient.
    lcb : float
        Centre of buoyancy forward of midship over length.
    transom : float
        Immersed area of the transom over the midship area.
    ends : {"ship", "barge"}
        Sharp bow, or ends that may be blunt.
    """

    cb: float
    cm: float
    cwp: float
    lcb: float
    transom: float
    ends: Literal["ship", "barge"]

    @property
    def cp(self) -> float:
        """Prismatic coefficient."""
        return self.cb / self.cm


@dataclass(frozen=True, eq=False)
class FormCurves:
    """Sectional area over that amidships and waterline breadth over beam, of xi = 2 x / length in [-1, 1] (bow at 1)."""

    form: Form
    area: "BSpline"
    breadth: "BSpline"

    def section(self, xi: float) -> tuple[float, float, float]:
        """Return breadth over beam, local draught over draught and coefficient of the section at xi.

        Notes
        -----
        With c = cm S / w the coefficient at full draught and r = c / (0.75 cm): aft (for barges at both ends) the keel rises
        where r < 1, to the draught r / (1 - r + r^2), and the section coefficient there is 0.75 cm (1 - r + r^2).
        """
        w, cm = max(float(self.breadth(xi)), 0.0), self.form.cm
        inside = xi * (1.0 - 1e-6)  # at a sharp end area and breadth vanish together: take the limit of their ratio
        c = min(cm * max(float(self.area(inside)), 0.0) / max(float(self.breadth(inside)), 1e-300), cm)
        full = _KEEL_RISES * cm
        if c >= full or (xi > 0.0 and self.form.ends == "ship"):
            return w, 1.0, c
        r = 0.0 if self.area(xi) < 1e-9 and w > 1e-6 else c / full
        return w, r / (1.0 - r + r * r), full * (1.0 - r + r * r)


def form_curves(form: Form) -> FormCurves:
    """Return the fairest curves with the coefficients of a form.

    Raises
    ------
    InputError
        There are none.

    Notes
    -----
    Unknowns are the spline coefficients of S and w. Conditions: int S = 2 cp, int xi S = 4 cp lcb, int w = 2 cwp; S = w = 1
    amidships, both rising before and falling after, S <= w <= 1; for ships both vanish at the bow and S >= w / 2 forward; S
    = transom at the stern. Of these the pair with least int S'''^2 + w'''^2, with small weight on bows fuller or finer than
    0.8 cm and on a steep end of the run. A stretch aft or forward of midship may be held parallel, where that makes the pair
    fairer still.
    """
    basis = Basis(_INTERVALS)
    if form.cp > 1.0 - 1e-6:  # a box
        ones = basis.curve(np.ones(basis.size))
        return FormCurves(form, ones, ones)
    R = _wishes(basis, form)
    found = []
    for parallel in range(-4, 5):
        conditions = _conditions(basis, form, parallel)
        x = smoothest(R, conditions)
        if x is not None:
            found.append((float(np.linalg.norm(R @ x)), abs(parallel), x, conditions))
    if not found:
        raise InputError(_no_hull(basis, form))
    for _, _, x, conditions in sorted(found, key=lambda f: (round(f[0], 6), f[1])):
        x = _unwaved(basis, R, x, conditions)
        if _waves(basis, x).max() < _WAVE:
            return FormCurves(form, basis.curve(x[: basis.size]), basis.curve(x[basis.size :]))
    raise InputError(
        f"from_particulars: no fair hull found for cb = {form.cb:.4g}, cm = {form.cm:.4g}, cwp = {form.cwp:.4g}, "
        f"lcb = {form.lcb:.4g}: sections would get finer and then fuller again towards an end. "
        "Bring lcb nearer to midship, or change cwp."
    )


def _waves(basis: Basis, x: Array) -> Array:
    """Return by how much (n,) S / w grows outward from midship, as a slope: (S' w - S w') / w^2 or its negative aft."""
    at = basis.points[np.abs(basis.points) < 0.97]
    V, D = basis.rows(at), basis.rows(at, 1)
    S, w = x[: basis.size], x[basis.size :]
    return np.asarray(np.sign(at) * ((D @ S) * (V @ w) - (V @ S) * (D @ w)) / np.maximum(V @ w, 0.05) ** 2)


def _unwaved(basis: Basis, R: Array, x: Array, conditions: Constraints) -> Array:
    """Return curves whose sections nowhere get fuller outward, that condition linearised about one solution after the other."""
    at = basis.points[np.abs(basis.points) < 0.97]
    V, D, sign = basis.rows(at), basis.rows(at, 1), np.sign(at)[:, None]
    for _ in range(12):
        if _waves(basis, x).max() < _WAVE:
            break
        S, w = x[: basis.size], x[basis.size :]
        row = sign * np.hstack([(V @ w)[:, None] * D - (D @ w)[:, None] * V, (D @ S)[:, None] * V - (V @ S)[:, None] * D])
        value = sign[:, 0] * ((D @ S) * (V @ w) - (V @ S) * (D @ w))
        more = Constraints(conditions.A, conditions.b, np.vstack([conditions.G, -row]), np.r_[conditions.h, -value])
        better = smoothest(R, more)
        if better is None:
            break
        x = better
    return x


def section_points(coefficient: float) -> Array:
    """Return points (n, 2) of half-breadth over half the breadth, and height above the keel over draught, of a section.

    Notes
    -----
    y = (1 - (1 - s)^n)^e with n = 1.2825 (1 - c)^-1/2 and e from the area, c = Beta(1/n, e + 1) / n.

    Examples
    --------
    >>> y, s = section_points(0.9).T
    >>> round(float(np.trapezoid(y, s)), 2), float(y[-1])
    (0.9, 1.0)
    """
    from scipy.optimize import brentq
    from scipy.special import beta

    c = coefficient
    if c > 0.9995:
        return np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    n = 1.2825 / np.sqrt(1.0 - c)
    e = float(np.exp(brentq(lambda log_e: beta(1.0 / n, np.exp(log_e) + 1.0) / n - c, -12.0, 5.0)))
    phi, even = np.linspace(0.0, 0.5 * np.pi, 31), np.linspace(0.0, 1.0, 13)
    s = np.concatenate([1.0 - np.cos(phi) ** (2.0 / n), even, 1.0 - (1.0 - even ** (1.0 / e)) ** (1.0 / n)])
    s = np.unique(np.r_[0.0, s, 1.0])
    points = np.stack([(1.0 - (1.0 - s) ** n) ** e, s], axis=-1)
    inner = points[(np.hypot(*(points - points[0]).T) > 2e-3) & (np.hypot(*(points - points[-1]).T) > 2e-3)]
    apart = np.r_[True, np.hypot(*np.diff(inner, axis=0).T) > 2e-3]
    return np.vstack([points[0], inner[apart], points[-1]])


def _wishes(basis: Basis, form: Form) -> Array:
    """Return R: |R x|^2 is what the curves should have least of."""
    rough, none = basis.roughness(), np.zeros((basis.n, basis.size))
    rows = [np.block([[rough, none], [none, rough]])]
    if form.ends == "ship":
        bow = basis.rows(np.linspace(0.55, 1.0, 19)) * np.sqrt(_BOW_WEIGHT / 19.0) * form.cm
        run = basis.rows(-1.0, 1) * np.sqrt(_RUN_WEIGHT)
        rows += [np.hstack([bow, -_FULL_BOW * bow]), np.hstack([run, 0.0 * run])]
    return np.vstack(rows)


def _conditions(basis: Basis, form: Form, parallel: int, *, without: str = "") -> Constraints:
    """Return the conditions on S and w, both held at 1 over `parallel` intervals from midship (> 0: forward)."""
    size, none = basis.size, np.zeros(basis.size)
    area, breadth = (lambda r: np.r_[r, none]), (lambda r: np.r_[none, r])
    equal = [
        ("cb", area(basis.integral()), 2.0 * form.cp),
        ("lcb", area(basis.integral(1)) - 2.0 * form.lcb * area(basis.integral()), 0.0),
        ("cwp", breadth(basis.integral()), 2.0 * form.cwp),
    ]
    for curve in (area, breadth):
        equal += [("", curve(r), v) for r, v in _top(basis, parallel)]
    if form.ends == "ship":
        bow, stern = basis.rows(1.0)[0], basis.rows(-1.0)[0]
        equal += [("", area(bow), 0.0), ("", breadth(bow), 0.0), ("", area(stern), form.transom)]
    elif form.transom > 0.0:
        equal.append(("", area(basis.rows(-1.0)[0]), form.transom))
    kept = [(r, v) for key, r, v in equal if not key or key != without]
    G, h = _inequalities(basis, form, parallel / basis.n * 2.0)
    return Constraints(np.array([r for r, _ in kept]).reshape(-1, 2 * size), np.array([v for _, v in kept]), G, h)


def _top(basis: Basis, parallel: int) -> list[tuple[Array, float]]:
    """Return rows and values that make a curve 1 amidships, with no slope, or 1 all over a parallel stretch."""
    if parallel == 0:
        return [(basis.rows(0.0)[0], 1.0), (basis.rows(0.0, 1)[0], 0.0)]
    middle = basis.n // 2
    first, last = sorted((middle, middle + parallel))
    return [(np.eye(basis.size)[i], 1.0) for i in range(first, last + 3)]


def _inequalities(basis: Basis, form: Form, end: float) -> tuple[Array, Array]:
    x = basis.points
    value, slope, none = basis.rows(x), basis.rows(x, 1), np.zeros((len(x), basis.size))
    up = np.where(x < min(end, 0.0), 1.0, np.where(x > max(end, 0.0), -1.0, 0.0))[:, None] * slope
    rows = [
        (np.hstack(r), v)
        for r, v in (((value, none), 0.0), ((-value, none), -1.0), ((none, -value), -1.0), ((-value, value), 0.0))
    ]
    rows += [(np.hstack([up, none]), 0.0), (np.hstack([none, up]), 0.0)]
    bent, flat = -basis.rows(x[np.abs(x) <= _CONVEX], 2), none[np.abs(x) <= _CONVEX]
    rows += [(np.hstack([bent, flat]), 0.0), (np.hstack([flat, bent]), 0.0)]
    if form.ends == "ship":
        fore, end_slope = value[x > 0.1], basis.rows(1.0, 1)
        rows += [(np.hstack([fore, -_HOLLOW * fore]), 0.0), (np.hstack([-end_slope, _HOLLOW * end_slope]), 0.0)]
        rows += [(np.hstack([end_slope, -end_slope]), 0.0)]
    return np.vstack([r for r, _ in rows]), np.concatenate([np.full(len(r), v) for r, v in rows])


def _no_hull(basis: Basis, form: Form) -> str:
    """Return what to say when no curves have the coefficients: the ranges within which one of them would have to lie."""
    integral, none = basis.integral(), np.zeros(basis.size)
    rows = {
        "cb": (np.r_[integral, none], 0.5 * form.cm),
        "cwp": (np.r_[none, integral], 0.5),
        "lcb": (np.r_[basis.integral(1), none], 0.25 / form.cp),
    }
    ranges = []
    for key, (row, unit) in rows.items():
        spans = [span(row, _conditions(basis, form, p, without=key)) for p in range(-4, 5)]
        if known := [s for s in spans if s]:
            ranges.append(f"{key} {unit * min(s[0] for s in known):.4f} to {unit * max(s[1] for s in known):.4f}")
    given = f"cb = {form.cb:.4g}, cm = {form.cm:.4g}, cwp = {form.cwp:.4g}, lcb = {form.lcb:.4g}, transom = {form.transom:.4g}"
    advice = (
        f"Change one of them to within: {'; '.join(ranges)} (the others kept)." if ranges else "Change more than one of them."
    )
    other = "" if form.ends == "barge" else " Blunt ends (ends='barge') allow fuller hulls."
    return f"from_particulars: no fair {form.ends} has {given} (cb / cm = {form.cp:.4g} and lcb included). {advice}{other}"
