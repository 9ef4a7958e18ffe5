"""Mean drift of a tanker and an FPSO: three methods against each other."""

import warnings
from typing import Any

import numpy as np

import ogilvie as og

TITLE = "Mean drift of a tanker and an FPSO by far field, control surface and pressure integration"
ABOUT = """The tanker of the Marine Systems Simulator (WAMIT's panels and mass; github.com/cybergalactic/MSS, MIT licence),
2375 panels on the port half, afloat. Ten periods from 6.5 to 15.5 s, directions from the bow to 45 degrees off the stern. The
three methods share the sources on the hull and little else. Roll has 2 % of critical damping beside its waves, as any ship has
at least: without, at its resonance (12.5 s) terms of the pressure integration twenty times as large as the drift cancel, and
the numbers of the notes come out. The FPSO of the same source, 1775 panels on the port half, has sharp edges, where
velocities on panels are poor: its near field is noted, not judged; four periods from 8.6 to 15.3 s, five directions.
Differences are ratios of root mean squares over periods and directions. The first run takes some minutes; the fields are
kept."""
NEEDS = [
    "data/mss_wamit_tanker/tanker.1",
    "data/mss_wamit_tanker/tanker.gdf",
    "data/mss_wamit_fpso/fpso.1",
    "data/mss_wamit_fpso/fpso_low.gdf",
]
HEIGHT = 9.0

PERIODS = np.linspace(6.5, 15.5, 10)  # s
FPSO_PERIODS = np.array([8.6, 10.4, 12.6, 15.3])  # s
DIRECTIONS = np.radians([180.0, 150.0, 120.0, 90.0, 45.0])
ROLL = 0.02  # of critical damping
METHODS = {"momentum": "far field", "control_surface": "control surface", "pressure": "near field"}
DOFS = {"surge": (0, 5.0, 2.0), "sway": (1, 5.0, 2.0), "yaw": (5, 8.0, 3.0)}  # allowed, %: near field, control surface
SHARP = {"surge": 5.0, "sway": 5.0, "yaw": 12.0}  # allowed of the control surface at sharp edges, %


def run(shared: Any) -> tuple[list[dict], dict]:
    """Return the checks and what the figure needs."""
    damped, bare = (_drift(shared, *NEEDS[:2], PERIODS, damping) for damping in (ROLL, 0.0))
    fpso = _drift(shared, *NEEDS[2:], FPSO_PERIODS, ROLL)
    checks = []
    for name, (i, near, control) in DOFS.items():
        for method, tolerance in (("control_surface", control), ("pressure", near)):
            checks.append(
                {
                    "name": f"tanker, {name}, {METHODS[method]} against far field",
                    "value": _apart(damped, method, i),
                    "reference": 0.0,
                    "tolerance": tolerance,
                    "unit": "% (rms)",
                    "source": "each other",
                    "note": f"{_apart(bare, method, i):.2g} % without damping of roll",
                }
            )
    for name, tolerance in SHARP.items():
        i = DOFS[name][0]
        checks.append(
            {
                "name": f"FPSO, {name}, control surface against far field",
                "value": _apart(fpso, "control_surface", i),
                "reference": 0.0,
                "tolerance": tolerance,
                "unit": "% (rms)",
                "source": "each other",
                "note": f"near field {_apart(fpso, 'pressure', i):.2g} %",
            }
        )
    for words, drift, tolerance in (
        ("tanker", damped, 2.0),
        ("tanker, no damping of roll", bare, 2.0),
        ("FPSO", fpso, 6.0),  # in long head seas, where next to nothing is scattered
    ):
        worst = 100.0 * float(np.abs(drift.energy_imbalance).max())
        checks.append(
            {"name": f"energy, {words}", "value": worst, "reference": 0.0, "tolerance": tolerance, "unit": "% out of balance"}
        )
    return checks, {"drift": damped}


def draw(data: dict, fig: Any) -> None:
    """Surge, sway and yaw of the tanker over period, one colour for each direction."""
    drift = data["drift"]
    unit = drift.attrs["rho"] * drift.attrs["g"]
    period = 2.0 * np.pi / drift.omega.values
    for axis, (name, (i, _, _)) in zip(fig.subplots(3, 1, sharex=True), DOFS.items(), strict=True):
        for b, degrees in enumerate(np.degrees(drift.wave_direction.values)):
            far = drift.mean_drift_momentum[:, b, i] / unit
            (line,) = axis.plot(period, far, label=f"{degrees:.0f} deg")
            for method, mark in (("control_surface", "s"), ("pressure", "x")):
                axis.plot(
                    period, drift[f"mean_drift_{method}"][:, b, i] / unit, mark, ms=4, fillstyle="none", color=line.get_color()
                )
        axis.set_ylabel(f"{name}/(rho g a^2), {'m2' if i > 2 else 'm'}")
    fig.axes[0].plot([], [], "k-", label="far field")
    fig.axes[0].plot([], [], "ks", ms=4, fillstyle="none", label="control surface")
    fig.axes[0].plot([], [], "kx", ms=4, label="near field")
    fig.axes[0].legend(frameon=False, ncols=2, title="waves travel to")
    fig.axes[-1].set_xlabel("wave period, s")


def _drift(shared: Any, data: str, mesh: str, periods: np.ndarray, damping: float) -> Any:
    wamit = og.read_hydro(shared / data)
    M, C = wamit.inertia_matrix.values, wamit.hydrostatic_stiffness.values
    m = M[0, 0]
    x, y, z = cog = np.array([-M[2, 4], M[2, 3], M[0, 4]]) / m
    S = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    natural = np.sqrt(C[3, 3] / (M[3, 3] + wamit.added_mass.values[:, 3, 3]))
    roll = float(np.interp(0.5, wamit.omega.values, natural))  # rad/s; hardly depends on the frequency it is taken at
    B = np.zeros((6, 6))
    B[3, 3] = 2.0 * damping * C[3, 3] / roll
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)  # the file's radii of gyration; undamped resonance
        return og.mean_drift(
            og.load_mesh(shared / mesh),
            og.RigidBody(m, cog, M[3:, 3:] - m * S.T @ S),
            omega=2.0 * np.pi / periods,
            wave_direction=DIRECTIONS,
            rho=wamit.attrs["rho"],
            g=wamit.attrs["g"],
            damping=B,
        )


def _apart(drift: Any, method: str, i: int) -> float:
    far = drift.mean_drift_momentum.values[..., i]
    difference = drift[f"mean_drift_{method}"].values[..., i] - far
    return float(100.0 * np.sqrt(np.mean(difference**2) / np.mean(far**2)))
