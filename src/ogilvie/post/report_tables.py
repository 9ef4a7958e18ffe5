"""Tables of the report: numbers as text, with units."""

from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.post.page import Table

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace
    from ogilvie.mesh.hydrostatics import Hydrostatics


_STILL = 1e-9  # m or rad; what moves less is rounding


def number(value: float, digits: int = 4) -> str:
    """Return a number with some significant digits, without needless zeros or exponents.

    Examples
    --------
    >>> number(24015.3, 5), number(0.01234), number(float("nan")), number(112316.2, 5)
    ('24015', '0.01234', '-', '112316')
    """
    if not np.isfinite(value):
        return "-" if np.isnan(value) else "\u221e"
    if value != 0 and (abs(value) >= 1e6 or abs(value) < 1e-4):
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def natural_periods(hydro: "xr.Dataset", body: "RigidBody") -> dict[str, float]:
    """Return undamped, uncoupled natural periods (s) of the degrees of freedom that the water restores.

    Notes
    -----
    T = 2 pi sqrt((M + A(w)) / C) at w = 2 pi / T, by the lowest frequency at which stiffness and inertia balance.
    """
    if "hydrostatic_stiffness" not in hydro:
        return {}
    omega, found = hydro.omega.values, {}
    for i, dof in enumerate(str(d) for d in hydro.influenced_dof.values):
        C = float(hydro.hydrostatic_stiffness.values[i, i])
        if C <= 0 or dof in ("surge", "sway", "yaw"):
            continue
        row = ("surge", "sway", "heave", "roll", "pitch", "yaw").index(dof)
        change = C - omega**2 * (body.matrix[row, row] + hydro.added_mass.values[:, i, i])
        cross = np.flatnonzero((change[:-1] > 0) & (change[1:] <= 0))
        if len(cross):
            k = int(cross[0])
            part = change[k] / (change[k] - change[k + 1])
            found[dof] = float(2 * np.pi / (omega[k] + part * (omega[k + 1] - omega[k])))
    return found


def hydrostatics_table(h: "Hydrostatics") -> Table:
    """Return displacement, centres and stability."""
    B, F = h.center_of_buoyancy, h.center_of_flotation
    rows = [
        ("length, beam of waterline", f"{number(h.length)}, {number(h.beam)} m"),
        ("draught", f"{number(h.draught)} m"),
        ("displaced volume", f"{number(h.volume, 5)} m\u00b3"),
        ("displacement", f"{number(h.displacement / 1000, 5)} t"),
        ("wetted area", f"{number(h.wetted_area)} m\u00b2"),
        ("waterplane area", f"{number(h.waterplane_area)} m\u00b2"),
        ("centre of buoyancy x, z", f"{number(_zero(B[0]))}, {number(B[2])} m"),
        ("centre of flotation x", f"{number(_zero(F[0]))} m"),
        ("KB, BM transverse", f"{number(h.KB)}, {number(h.BM_T)} m"),
        ("KM transverse, longitudinal", f"{number(h.KM_T)}, {number(h.KM_L)} m"),
    ]
    if h.cog is not None:
        rows += [("KG", f"{number(h.KG)} m"), ("GM transverse, longitudinal", f"{number(h.GM_T)}, {number(h.GM_L)} m")]
    return Table(rows, caption="Hydrostatics, from integrals over the panels.")


def body_table(f: Any) -> Table:
    """Return mass, centre of gravity, radii of gyration and natural periods."""
    x, y, z = (number(_zero(v)) for v in f.body.cog)
    rows = [
        ("mass", f"{number(f.body.mass / 1000, 5)} t"),
        ("centre of gravity x, y, z", f"{x}, {y}, {z} m"),
        ("radii of gyration", ", ".join(number(k) for k in f.body.gyradii) + " m"),
    ]
    rows += [(f"natural period of {dof}", f"{number(T, 3)} s") for dof, T in natural_periods(f.hydro, f.body).items()]
    return Table(rows, caption="Body; natural periods undamped and uncoupled.")


def memory_table(K: "Retardation", ssm: "StateSpace | None") -> Table:
    """Return errors of the retardation functions, both A_inf and R2 of the fit, diagonal terms."""
    head = [
        "",
        "K(0)",
        "A\u221e",
        "A\u221e Ogilvie",
        "tail B ~ \u03c9\u207b\u1d56",
        "tail error",
        "truncation",
        "interpolation",
    ]
    given = {} if ssm is None else {"R\u00b2 of A": ssm.r2_added_mass, "R\u00b2 of B": ssm.r2_damping, "R\u00b2 of K": ssm.r2}
    fits = {name: values for name, values in given.items() if values is not None}
    head += list(fits)
    rows = []
    for i, dof in enumerate(K.dofs):
        row = [dof, number(K.K[0, i, i]), number(K.A_inf[i, i]), _at(K.A_inf_ogilvie, i), _at(K.tail_exponent, i, digits=2)]
        row += [_percent(e, i) for e in (K.tail_error, K.truncation_error, K.discretisation_error)]
        row += [f"{values[i, i]:.4f}" if np.isfinite(values[i, i]) else "-" for values in fits.values()]
        rows.append(row)
    return Table(rows, head, "SI; errors as parts of the largest |K| of the entry.")


def wave_table(spectrum: Any, sea: Any) -> list[Table]:
    """Return what describes the sea."""
    rows = []
    if spectrum is not None:
        rows += [
            ("spectrum", spectrum.name),
            ("Hs", f"{number(spectrum.hs)} m"),
            ("Tp, Tz", f"{number(spectrum.tp)}, {number(spectrum.tz)} s"),
        ]
    if sea is not None:
        hs = np.atleast_1d(sea.hs)
        spread = (
            f"{number(hs.mean())} m"
            if np.ptp(hs) < 1e-9
            else f"{number(hs.mean())} m ({number(hs.min())} to {number(hs.max())})"
        )
        main = np.degrees(
            np.angle(np.average(np.exp(1j * sea.direction), weights=np.mean(np.atleast_2d(sea.amplitude) ** 2, axis=0)))
        )
        rows += [
            ("components", str(len(sea.omega))),
            ("realisations", str(sea.n_realisations)),
            ("Hs of the realisations", spread),
            ("mean direction, towards", f"{number(main)}\u00b0"),
        ]
    return [Table(rows)] if rows else []


def check_table(checks: Any) -> Table:
    """Return the outcome of the checks of the coefficients."""
    head = ("check", "worst", "allowed", "where", "verdict")
    return Table(checks.rows, head, "Checks of the coefficients.", left=frozenset({0, 3, 4}), wrap=frozenset({3}))


def _expected(expected: "xr.Dataset | None", dof: str, factor: float) -> str:
    if expected is None or dof not in expected.dof.values:
        return "-"
    return number(float(expected["std"].sel(dof=dof)) * factor, 3)


def _at(values: Any, i: int, digits: int = 4) -> str:
    return "-" if values is None else number(float(values[i, i]), digits)


def _percent(values: Any, i: int) -> str:
    if values is None or not np.isfinite(values[i, i]):
        return "-"
    return f"{100 * values[i, i]:.2g} %"


def _zero(value: float) -> float:
    return 0.0 if abs(value) < 5e-7 else float(value)


def motion_rows(statistics: "xr.Dataset", expected: "xr.Dataset | None") -> tuple[list[str], list[list[str]]]:
    """Return head and rows of a small table of motions: standard deviation with its interval, largest, period."""
    percent = f"{100 * statistics.attrs['confidence']:.0f} % interval"
    head = ["", "unit", "std", percent, "freq. domain", "largest", "Tz, s"]
    if expected is None:
        head.remove("freq. domain")
    rows = []
    for dof in map(str, statistics.dof.values):
        s = statistics.sel(dof=dof)
        factor, unit = (180 / np.pi, "deg") if dof in ("roll", "pitch", "yaw") else (1.0, "m")
        if float(s["std"]) < _STILL:
            rows.append([dof, unit, *("0" if name in ("std", "largest") else "-" for name in head[2:])])
            continue
        low, high = (number(float(v) * factor, 3) for v in s.std_interval.values)
        row = [dof, unit, number(float(s["std"]) * factor, 3), f"{low} to {high}"]
        if expected is not None:
            row.append(_expected(expected, dof, factor))
        largest = max(abs(float(s["maximum"])), abs(float(s["minimum"]))) * factor
        rows.append([*row, number(largest, 3), number(float(s["tz"]), 3)])
    return head, rows


def statistics_table(statistics: "xr.Dataset", expected: "xr.Dataset | None") -> Table:
    """Return the statistics of the motions with confidence intervals, beside those of the frequency domain."""
    percent = f"{100 * statistics.attrs['confidence']:.0f} % interval"
    head = ["", "unit", "mean", "std", percent, "std, freq. domain", "signif. 4 std", "highest third", "min", "max"]
    head += ["expected max", "Tz [s]"]
    rows = []
    for dof in map(str, statistics.dof.values):
        s = statistics.sel(dof=dof)
        factor, unit = (180 / np.pi, "deg") if dof in ("roll", "pitch", "yaw") else (1.0, "m")
        if float(s["std"]) < _STILL:
            mean = number(_zero(float(s["mean"]) * factor), 3)
            rows.append([dof, unit, mean, *("0" if name in ("std", "min", "max") else "-" for name in head[3:])])
            continue

        def cell(key: str, s: Any = s, factor: float = factor) -> str:
            return number(_zero(float(s[key]) * factor), 3)

        low, high = (number(float(v) * factor, 3) for v in s.std_interval.values)
        other = _expected(expected, dof, factor)
        mean = "0" if abs(float(s["mean"])) < 1e-3 * float(s["std"]) else cell("mean")
        row = [dof, unit, mean, cell("std"), f"{low}\u2013{high}", other]
        row += [cell(key) for key in ("significant", "significant_third", "minimum", "maximum", "expected_maximum")]
        rows.append([*row, number(float(s["tz"]), 3)])
    about = str(statistics.attrs.get("about", ""))
    where = f" about {about}" if about else ""
    caption = (
        f"Motions of O{where}: {statistics.attrs['realisations']} x {number(statistics.attrs['duration'])} s. Significant and "
        "highest third are double amplitudes; the expected maximum is that of one realisation, above the mean."
    )
    if expected is not None:
        caption += " The frequency domain holds waves of first order alone."
    return Table(rows, head, caption, left=frozenset({0, 1}))
