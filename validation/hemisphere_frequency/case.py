"""The floating hemisphere in the frequency domain: panel method against the exact solution."""

from typing import Any

import numpy as np

import ogilvie as og

TITLE = "Added mass, damping and wave force of a floating hemisphere"
ABOUT = """The exact solution is the multipole expansion of A. Hulme, The wave forces acting on a floating hemisphere undergoing
forced periodic oscillations, Journal of Fluid Mechanics 121 (1982) 443-463, evaluated to 1e-8. `solve_bem` with
`shapes.hemisphere` and the lid that it makes by itself must be within 0.4 % (wave force: 0.3 %) of each curve's largest value
for Ka from 0.05 to 4, the irregular frequency of heave at Ka = 2.56 included."""
NEEDS = ["reference/hemisphere_exact.csv"]

G, PANELS = 9.81, 1000
CURVES = ("A33", "B33", "A11", "B11")
TOLERANCE = 0.4  # %
SWEEP = np.arange(2.30, 2.801, 0.01)
LIMITS = {"A33 at zero": 0.830951, "A11 at zero": 0.5, "A33 at infinity": 0.5, "A11 at infinity": 4.0 / np.pi - 1.0}


def run(shared: Any) -> tuple[list[dict], dict]:
    """Return the checks and what the figure needs."""
    table = np.genfromtxt(shared / NEEDS[0], delimiter=",", comments="#", skip_header=3)
    band = table[(table[:, 0] >= 0.05) & (table[:, 0] <= 4.0), 0]
    Ka = np.unique(np.round(np.concatenate([band[::2], band[-9:], SWEEP]), 6))
    hull = og.shapes.hemisphere(1.0, panels=PANELS)
    hydro = og.solve_bem(hull, omega=np.sqrt(G * Ka), wave_direction=[np.pi], g=G, rho=1.0, cache=False, progress=False)
    exact, scale = _exact(table, Ka), _exact(table, band).max(axis=0)
    volume = 2.0 / 3.0 * np.pi
    A, B = hydro.added_mass.values, hydro.radiation_damping.values
    found = np.stack([A[:, 2, 2], B[:, 2, 2] / np.sqrt(G), A[:, 0, 0], B[:, 0, 0] / np.sqrt(G)], axis=1) / volume
    error = 100.0 * (found - exact) / scale
    panels = f"{hydro.attrs['panels']} panels of the hull and {hydro.attrs['lid_panels']} of the lid"
    swept = (Ka >= SWEEP[0] - 1e-9) & (Ka <= SWEEP[-1] + 1e-9)
    checks = [
        _error(f"{name}, Ka 0.05 to 4", error[:, i], TOLERANCE, f"{len(Ka)} frequencies; {panels}")
        for i, name in enumerate(CURVES)
    ]
    checks += [_error(f"{name}, Ka 2.3 to 2.8 by 0.01", error[swept, i], TOLERANCE, "") for i, name in enumerate(CURVES)]
    checks += _limits(hydro, volume) + _forces(hydro, table, Ka)
    return checks, {"Ka": Ka, "found": found, "exact": exact, "error": error}


def draw(data: dict, fig: Any) -> None:
    """Curves above, errors below."""
    above, below = fig.subplots(2, 1, sharex=True)
    for i, name in enumerate(CURVES):
        above.plot(data["Ka"], data["exact"][:, i], color=f"C{i}", lw=1)
        above.plot(data["Ka"], data["found"][:, i], ".", color=f"C{i}", ms=4, label=name)
        below.plot(data["Ka"], data["error"][:, i], color=f"C{i}", lw=1)
    below.axhspan(-TOLERANCE, TOLERANCE, color="0.9", zorder=0)
    above.set_ylabel("A/(rho V), B/(rho V sqrt(g/a))")
    above.legend(ncols=4, frameon=False)
    below.set_xlabel("Ka")
    below.set_ylabel("error, % of largest value")


def _exact(table: np.ndarray, Ka: np.ndarray) -> np.ndarray:
    """Return mu33, lam33 sqrt(Ka), mu11, lam11 sqrt(Ka) (n, 4), by cubic splines through the tabulated points."""
    from scipy.interpolate import CubicSpline

    mu33, lam33, mu11, lam11 = (CubicSpline(table[:, 0], table[:, i])(Ka) for i in (1, 2, 3, 4))
    return np.stack([mu33, lam33 * np.sqrt(Ka), mu11, lam11 * np.sqrt(Ka)], axis=1)


def _error(name: str, error: np.ndarray, tolerance: float, note: str) -> dict:
    worst = float(error[np.abs(error).argmax()])
    return {
        "name": name,
        "value": worst,
        "reference": 0.0,
        "tolerance": tolerance,
        "unit": "% of the largest value",
        "source": "Hulme 1982",
        "note": note,
    }


def _limits(hydro: Any, volume: float) -> list[dict]:
    zero, infinite = np.diag(hydro.added_mass_zero.values) / volume, np.diag(hydro.added_mass_inf.values) / volume
    values = (zero[2], zero[0], infinite[2], infinite[0])
    return [
        {
            "name": f"{name}, over rho V",
            "value": float(value),
            "reference": reference,
            "tolerance": 0.005 * reference,
            "source": "Hulme 1982",
        }
        for value, (name, reference) in zip(values, LIMITS.items(), strict=True)
    ]


def _forces(hydro: Any, table: np.ndarray, Ka: np.ndarray) -> list[dict]:
    """Compare |X3| and |X1| with those that follow from the exact damping by Haskind's relation."""
    exact = _exact(table, Ka) / np.stack([np.ones_like(Ka), np.sqrt(Ka)] * 2, axis=1)
    X = np.abs(hydro.excitation_force.values[:, 0]) / (G * np.pi)
    wanted = {"X3": np.sqrt(4.0 * exact[:, 1] / (3.0 * np.pi * Ka)), "X1": np.sqrt(8.0 * exact[:, 3] / (3.0 * np.pi * Ka))}
    return [
        _error(f"{name}, Ka 0.05 to 4", 100.0 * (X[:, i] - w) / w.max(), 0.3, "exact by Haskind's relation")
        for (name, w), i in zip(wanted.items(), (2, 0), strict=True)
    ]
