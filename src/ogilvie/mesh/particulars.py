"""A fair hull from main dimensions and form coefficients, for the designer who has no lines yet."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.mesh.form import Form, FormCurves, form_curves, section_points
from ogilvie.mesh.loft import panelled
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.sections import Lines, lofted
from ogilvie.mesh.wetted import area_of, wet

Array = NDArray[np.float64]
Ends = Literal["auto", "ship", "barge"]

_BARGE = 0.88  #: prismatic coefficient above which ends are blunt unless asked otherwise
_STATIONS = 61


def from_particulars(
    *,
    length: float,
    beam: float,
    draught: float,
    cb: float,
    cm: float | None = None,
    cwp: float | None = None,
    lcb: float | None = None,
    depth: float | None = None,
    transom: float = 0.0,
    ends: Ends = "auto",
    panels: int = 1000,
    above_water: bool = False,
    name: str = "hull",
) -> PanelMesh:
    """Return a fair hull with the given main dimensions and form coefficients.

    Parameters
    ----------
    length, beam, draught : float
        Between perpendiculars (here also on the waterline), greatest, and design, m.
    cb : float
        Block coefficient, volume / (length beam draught).
    cm : float, optional
        Midship coefficient, midship area / (beam draught); by default 1.006 - 0.0056 cb^-3.56, at least cb, at most 1.
    cwp : float, optional
        Waterplane coefficient, waterplane area / (length beam); by default (1 + 2 cb) / 3.
    lcb : float, optional
        Centre of buoyancy forward of midship, as a fraction of the length (-0.0055 is 0.55 % aft); by default
        -0.135 + 0.194 cb / cm for ships and 0 for barges.
    depth : float, optional
        From baseline to deck, m; the sides are upright above the water. By default 1.3 times the draught.
    transom : float
        Immersed area of a transom stern over the midship area.
    ends : {"auto", "ship", "barge"}
        "ship": sharp bow, keel rising to the stern; "barge": ends may be blunt, with the keel rising at both. "auto": a barge
        where cb / cm > 0.88.
    panels : int
        Largest number of panels of the whole hull below the water.
    above_water : bool
        Add the sides from the water to the deck; these panels count extra.
    name : str

    Returns
    -------
    PanelMesh
        Symmetry "xz"; x = 0 at midship, z = 0 at the water. Volume, waterplane area and midship area within 0.5 % of those
        given by the coefficients, centre of buoyancy within 0.1 % of the length.

    Raises
    ------
    InputError
        No fair hull has these coefficients; the message says which ranges are possible.

    Notes
    -----
    Curves of sectional area and of waterline breadth are splines. Of all pairs with the given areas and centroid that rise
    to the midship value and fall from it, with sections nowhere fuller than amidships and forward never hollower than half
    of that, it takes the pair with the least integral of squared third derivatives: a convex programme with one solution.
    Sections with breadth b, draught d and coefficient c are y = b/2 (1 - (1 - s)^n)^e, s the height above the keel over d, n
    = 1.2825 (1 - c)^-1/2 and e such that the area is c b d: boxes with rounded bilges for c near 1, vees for c near 0.5.
    Aft, where the area is less than 0.75 cm of breadth times full draught, the keel rises.

    References
    ----------
    Default cm: Kerlen (1970); default cwp and lcb: Schneekluth and Bertram (1998), Ship design for efficiency and economy,
    chapters 1, 2.

    Examples
    --------
    >>> hull = from_particulars(length=175.0, beam=25.4, draught=9.5, cb=0.572, cm=0.970, cwp=0.711, lcb=-0.0142, panels=600)
    >>> round(hull.volume / (175.0 * 25.4 * 9.5), 3), round(float(hull.center_of_buoyancy[0]) / 175.0, 3)
    (0.572, -0.014)
    """
    L, B, T = _positive("length", length), _positive("beam", beam), _positive("draught", draught)
    D = 1.3 * T if depth is None else _positive("depth", depth)
    if D < T:
        raise InputError(f"depth: at least the draught ({T:.6g} m) expected, {D:.6g} m found.")
    form = completed(cb=cb, cm=cm, cwp=cwp, lcb=lcb, transom=transom, ends=ends)
    lines = lofted(stations(form_curves(form), length=L, beam=B, draught=T, depth=D))
    volume = form.cb * L * B * T
    mesh = panelled(lines, panels=panels, bow="flat", stern="flat", above_water=above_water, volume=volume, name=name)
    _check(mesh.immersed() if above_water else mesh, lines, form, (L, B, T))
    return mesh


def completed(
    *,
    cb: float,
    cm: float | None = None,
    cwp: float | None = None,
    lcb: float | None = None,
    transom: float = 0.0,
    ends: Ends = "auto",
) -> Form:
    """Return the form with what was not given from statistics; see :func:`from_particulars`.

    Examples
    --------
    >>> form = completed(cb=0.8)
    >>> round(form.cm, 3), round(form.cwp, 3), round(form.lcb, 3), form.ends
    (0.994, 0.867, 0.021, 'ship')
    """
    _between("cb", cb, 0.2, 1.0)
    cm = min(max(1.006 - 0.0056 * cb**-3.56, cb, 0.5), 1.0) if cm is None else cm
    _between("cm", cm, cb, 1.0)
    if ends not in ("auto", "ship", "barge"):
        raise InputError(f"ends: 'auto', 'ship' or 'barge' expected, {ends!r} found.")
    kind: Literal["ship", "barge"] = "barge" if ends == "barge" or (ends == "auto" and cb / cm > _BARGE) else "ship"
    cwp = (1.0 + 2.0 * cb) / 3.0 if cwp is None else cwp
    _between("cwp", cwp, cb / cm, 1.0)
    lcb = (0.0 if kind == "barge" else -0.135 + 0.194 * cb / cm) if lcb is None else lcb
    _between("lcb", lcb, -0.2, 0.2)
    _between("transom", transom, 0.0, 1.0)
    return Form(cb=float(cb), cm=float(cm), cwp=float(cwp), lcb=float(lcb), transom=float(transom), ends=kind)


def stations(curves: FormCurves, *, length: float, beam: float, draught: float, depth: float) -> list[tuple[float, Array]]:
    """Return the stations (x, points of half-breadth and height above the water), m, of a hull with these form curves."""
    xi = np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, _STATIONS))
    return [(float(0.5 * length * x), _station(curves.section(x), 0.5 * beam, draught, depth - draught)) for x in xi]


def _station(section: tuple[float, float, float], half_beam: float, draught: float, freeboard: float) -> Array:
    w, d, c = section
    top = [[w * half_beam, freeboard]] if freeboard > 0.0 else []
    if w < 1e-6:
        return np.array([[0.0, -d * draught], [0.0, 0.0], *([0.0, z] for _, z in top)])
    if d < 1e-6:
        return np.array([[0.0, 0.0], [w * half_beam, 0.0], *top])
    y, s = section_points(c).T
    return np.array([*zip(w * half_beam * y, d * draught * (s - 1.0), strict=True), *top])


def _check(mesh: PanelMesh, lines: Lines, form: Form, size: tuple[float, float, float]) -> None:
    """Raise if the panels do not have the coefficients asked for."""
    L, B, T = size
    middle = wet(lines.main.sections([0.0])[0])
    found = {
        "cb": (mesh.volume / (L * B * T), form.cb, 0.005 * form.cb),
        "cm": (0.0 if middle is None else 2.0 * area_of(middle) / (B * T), form.cm, 0.005 * form.cm),
        "cwp": (-2.0 * float(mesh.area_vectors[:, 2].sum()) / (L * B), form.cwp, 0.005 * form.cwp),
        "lcb": (float(mesh.center_of_buoyancy[0]) / L, form.lcb, 0.001),
    }
    for key, (is_now, asked, allowed) in found.items():
        if abs(is_now - asked) > allowed:
            raise ConvergenceError(
                f"from_particulars: {key} {asked:.4f} expected, {is_now:.4f} reached with {2 * mesh.n_faces} panels. "
                "Give more panels."
            )


def _between(key: str, value: float, low: float, high: float) -> None:
    if not (np.isfinite(value) and low <= value <= high):
        raise InputError(f"{key}: a number from {low:.4g} to {high:.4g} expected, {value!r} found.")


def _positive(key: str, value: float) -> float:
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{key}: a positive length in m expected, {value!r} found.")
    return float(value)
