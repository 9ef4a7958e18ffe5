"""A Wigley hull with forward speed: panel method against model tests."""

from typing import Any

import numpy as np

import ogilvie as og

TITLE = "Wigley hull III at forward speed against model tests"
ABOUT = """Measured by J. M. J. Journee, Experiments and calculations on 4 Wigley hull forms in head waves, TU Delft Ship
Hydromechanics Laboratory report 0909 (1992): added mass and damping of heave at Fn 0.3, wave forces on the restrained model,
and heave in waves. The method neglects what speed does to the free surface, so the tolerances are those of engineering: 25 %
for added mass and damping, 15 % for heave, 10 % for wave forces."""
NEEDS = ["data/wigley_journee/journee1992_selected.csv"]

L, G, RHO, KYY = 3.0, 9.81, 1000.0, 0.75
SETTINGS = {"rho": RHO, "g": G, "progress": False}
TOLERANCE = {"A33": 0.25, "B33": 0.25, "X3": 0.10, "X5": 0.10, "heave": 0.15}


def run(shared: Any) -> tuple[list[dict], dict]:
    """Return the checks and what the figure needs."""
    measured = _measured(shared / NEEDS[0])
    hull = og.shapes.wigley(L, kind="III", panels=700)
    body = og.RigidBody.from_gyradii(RHO * hull.volume, cog=[0.0, 0.0, 0.0], gyradii=[0.1, KYY, KYY])
    checks, points = [], []
    for Fn in sorted({row["Fn"] for row in measured}):
        rows = [row for row in measured if row["Fn"] == Fn]
        found = _computed(hull, body, Fn * np.sqrt(G * L), rows)
        for row, value in zip(rows, found, strict=True):
            checks.append(
                {
                    "name": f"{row['quantity']} at Fn {Fn:g}, {row['abscissa']}",
                    "value": float(value),
                    "reference": row["value"],
                    "tolerance": TOLERANCE[row["quantity"]] * row["value"],
                    "source": "Journee 1992",
                    "note": f"{100.0 * (value / row['value'] - 1.0):+.0f} %",
                }
            )
            points.append((row["quantity"], Fn, row["x"], row["value"], float(value)))
    return checks, {"points": points}


def draw(data: dict, fig: Any) -> None:
    """One panel for each quantity."""
    axes = fig.subplots(2, 3).ravel()
    for axis, quantity in zip(axes, TOLERANCE, strict=False):
        for i, Fn in enumerate((0.2, 0.3)):
            rows = sorted(p[2:] for p in data["points"] if p[0] == quantity and p[1] == Fn)
            if rows:
                x, wanted, found = np.transpose(rows)
                axis.plot(x, wanted, "o", mfc="none", color=f"C{i}", label=f"measured, Fn {Fn:g}")
                axis.plot(x, found, color=f"C{i}", label=f"solve_bem, Fn {Fn:g}")
        axis.set_title(quantity)
        axis.set_xlabel("omega_e sqrt(L/g)" if quantity in ("A33", "B33") else "wave length/L")
        axis.set_ylim(bottom=0.0)
    handles, labels = axes[4].get_legend_handles_labels()
    axes[5].axis("off")
    axes[5].legend(handles, labels, loc="center", frameon=False)


def _measured(path: Any) -> list[dict]:
    rows = []
    for line in path.read_text().splitlines():
        if line.startswith(("#", "table")):
            continue
        _, model, Fn, abscissa, quantity, value = line.split(",")
        if model == "III" and float(Fn) > 0.0 and quantity in TOLERANCE:
            x = float(abscissa.split("=")[1])
            rows.append({"Fn": float(Fn), "abscissa": abscissa, "x": x, "quantity": quantity, "value": float(value)})
    return rows


def _computed(hull: Any, body: Any, speed: float, rows: list[dict]) -> list[float]:
    """Return the quantities in the report's dimensionless form."""
    forced = ("A33", "B33")
    return [(_forced if row["quantity"] in forced else _in_waves)(hull, body, speed, row) for row in rows]


def _forced(hull: Any, body: Any, speed: float, row: dict) -> float:
    hydro = og.solve_bem(hull, omega=[row["x"] * np.sqrt(G / L)], wave_direction=[0.5 * np.pi], speed=speed, **SETTINGS)
    if row["quantity"] == "A33":
        return hydro.added_mass.values[0, 2, 2] / body.mass
    return hydro.radiation_damping.values[0, 2, 2] / body.mass * np.sqrt(L / G)


def _in_waves(hull: Any, body: Any, speed: float, row: dict) -> float:
    w = np.sqrt(2.0 * np.pi * G / (row["x"] * L))
    k = w**2 / G
    we = w + k * speed
    waves = og.solve_bem(hull, body, omega=[w], wave_direction=[np.pi], speed=speed, **SETTINGS)
    X, C = waves.excitation_force.values[0, 0], waves.hydrostatic_stiffness.values
    if row["quantity"] == "X3":
        return abs(X[2]) / C[2, 2]
    if row["quantity"] == "X5":
        return abs(X[4]) / (k * C[4, 4])
    met = og.solve_bem(hull, omega=[we], wave_direction=[0.5 * np.pi], speed=speed, **SETTINGS)
    A, B = met.added_mass.values[0], met.radiation_damping.values[0]
    free = [2, 4]
    Z = (-(we**2) * (body.matrix + A) + 1j * we * B + C)[np.ix_(free, free)]
    return abs(np.linalg.solve(Z, X[free])[0])
