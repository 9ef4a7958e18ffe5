"""Paper C: the naval combatant DTMB 5415 at 18 knots in head seas, in the frequency domain."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.hydro.at_speed import at_speed
from ogilvie.hydro.rao import rao
from ogilvie.hydro.response import response_spectrum
from ogilvie.units import knot

TITLE = "DTMB 5415 at 18 knots in head seas: coefficients, wave forces and motions (Vu et al.)"
ABOUT = """Vu et al. simulate the naval combatant DTMB 5415 with the Marine Systems Simulator: 18 knots, head sea, JONSWAP with
Hs 4.25 m, Tp 9.8 s (peakedness 3.3 taken here). This page holds what such a simulation starts from: the hull against the
particulars of their Table 2, then coefficients, wave forces and motions at 18 knots, made in two ways: zero-speed coefficients
carried to 18 knots by `at_speed`, and `solve_bem(speed=...)`, which meets the waves panel by panel and stands in the column of
references. Both neglect that speed changes the flow at the free surface. The rule of `at_speed` for diffraction knows the six
motions of the hull alone: it is good in waves longer than the ship, poor in much shorter ones, which hardly move it. The paper
gives no radii of gyration; the usual 0.37 B and 0.25 Lpp are taken. Significant values are double amplitudes (4 standard
deviations) of the motion in waves up to 1.4 rad/s; shorter ones (less than 0.22 of the length) do not move the ship. The panel
method runs on every second line of the surface grid (at 0.7 rad/s, heave and pitch, within 1.5 % of the whole); the shortest
waves of encounter are not resolved everywhere. The paper's GM_L, 2.66 m, is a misprint: it is about 296 m."""
NEEDS: list[str] = []
HEIGHT = 6.2

MESH = "data/dtmb5415_hull/dtmb5415_maorg.gdf"
GRID = (90, 16)  # panels along and around half the hull in that file
LPP, BEAM, DRAUGHT, KG = 142.0, 19.06, 6.15, 7.55  # m; KG above the baseline
PUBLISHED = {"volume": 8447.0, "wetted area": 2979.0, "GM_T": 1.95, "LCB": -0.55, "C_WP": 0.774}
SPEED = 18 * knot
GYRADII = (0.37 * BEAM, 0.25 * LPP, 0.25 * LPP)
OMEGA = np.r_[0.1, 0.2, np.arange(0.3, 1.401, 0.05), np.arange(1.5, 3.31, 0.1)]  # rad/s; of oscillation, and of waves
WAVES = OMEGA[OMEGA < 1.41]  # rad/s; met within OMEGA at 18 knots
HEAD = np.pi
SEA = {"hs": 4.25, "tp": 9.8, "gamma": 3.3}
BOW = 0.5 * LPP  # m forward of midship
SOURCE = "Vu et al., Table 2"


@dataclass(frozen=True, eq=False)
class Ship:
    """The vessel at rest: what its motions at any speed start from.

    Parameters
    ----------
    hull : PanelMesh
        Fine; `coarse` is the one that was solved.
    body : RigidBody
    hydro0 : xarray.Dataset
        At zero speed, head seas by default.
    speed : float
        m/s.
    from_lines : bool
        Whether the hull is the real one.
    """

    hull: Any
    coarse: Any
    body: Any
    hydro0: Any
    speed: float
    from_lines: bool


def prepared(shared: Path | None, directions: Sequence[float] = (HEAD,)) -> Ship:
    """Return the ship, with lines from its particulars where its mesh is not at hand; wave directions in rad."""
    path = None if shared is None else Path(shared) / MESH
    from_lines = path is not None and path.exists()
    if from_lines:
        hull = og.load_mesh(path)
        coarse = every_second_line(hull)
    else:
        options = {"length": LPP, "beam": BEAM, "draught": DRAUGHT, "cb": PUBLISHED["volume"] / (LPP * BEAM * DRAUGHT)}
        form = {"cm": 0.819, "cwp": PUBLISHED["C_WP"], "lcb": PUBLISHED["LCB"] / 100.0}
        hull = og.shapes.from_particulars(**options, **form, panels=2400, name="DTMB 5415-like hull")
        coarse = og.shapes.from_particulars(**options, **form, panels=800, name="DTMB 5415-like hull")
    body = og.RigidBody.from_hull(coarse, zg=KG - DRAUGHT, gyradii=GYRADII)
    hydro0 = _quiet(og.solve_bem, coarse, body, omega=OMEGA, wave_direction=list(directions), progress=False)
    return Ship(hull, coarse, body, hydro0, SPEED, from_lines)


def every_second_line(hull: Any) -> Any:
    """Return the hull on every second line of its structured grid, along and around."""
    n, m = GRID
    corner = hull.vertices[hull.faces].reshape(n, m, 4, 3)
    points = np.empty((n + 1, m + 1, 3))
    points[:n, :m], points[:n, m] = corner[:, :, 3], corner[:, m - 1, 0]
    points[n, :m], points[n, m] = corner[n - 1, :, 2], corner[n - 1, m - 1, 1]
    points = points[::2, ::2]
    i = np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2])
    faces = np.stack([i[:-1, 1:], i[1:, 1:], i[1:, :-1], i[:-1, :-1]], axis=-1).reshape(-1, 4)
    mesh = og.PanelMesh(points.reshape(-1, 3), faces, symmetry="xz", name="DTMB 5415")
    return og.heal(mesh)[0]


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    ship = prepared(shared)
    sailing = _quiet(at_speed, ship.hydro0, ship.speed)
    solved = _quiet(og.solve_bem, ship.coarse, ship.body, omega=WAVES, wave_direction=[HEAD], speed=ship.speed, progress=False)
    met = sailing.sel(omega=WAVES)
    # one set of coefficients up to the highest frequency of encounter (at_speed's are the panel method's), two sets of forces
    motions = {
        "18 kn, at_speed": _motion(sailing),
        "18 kn, solve_bem": _motion(_with_forces(sailing, solved)),
        "0 kn": _motion(ship.hydro0),
    }
    sea = og.jonswap(**SEA)
    responses = {name: _response(m, sea) for name, m in motions.items()}
    data = {
        "ship": ship,
        "sailing": sailing,
        "met": met,
        "solved": solved,
        "motions": motions,
        "responses": responses,
        "sea": sea,
    }
    return [*_particulars(ship), *_coefficients(data), *_motions(data)], data


def _motion(hydro: Any) -> Any:
    """Return RAOs of heave, pitch and the vertical motion at the bow in waves up to the last of WAVES."""
    import xarray as xr

    pair = ["heave", "pitch"]
    keep = {"influenced_dof": pair, "radiating_dof": pair}
    full = _quiet(rao, hydro.sel(keep)).sel(omega=slice(None, WAVES[-1] + 1e-9))
    bow = full.sel(dof="heave", drop=True) - BOW * full.sel(dof="pitch", drop=True)
    found = xr.concat([full, bow.assign_coords(dof="bow")], dim="dof").transpose("omega", "wave_direction", "dof")
    return found.assign_attrs(full.attrs)


def _with_forces(sailing: Any, solved: Any) -> Any:
    """Return the coefficients of `sailing` with the wave forces of `solved` up to its last frequency."""
    chosen = sailing.copy(deep=True)
    chosen.excitation_force.loc[{"omega": WAVES}] = solved.excitation_force
    return chosen


def _response(motion: Any, sea: Any) -> dict[str, Any]:
    """Return spectra and significant double amplitudes; of acceleration too, m/s2."""
    w = np.linspace(motion.omega.values[0], WAVES[-1], 1201)
    S = response_spectrum(motion, sea, direction=HEAD, omega=w)
    U, g = motion.attrs["speed"], motion.attrs["g"]
    w_e = w + w**2 / g * U
    found = {"omega": w, "omega_e": w_e, "spectrum": S.values, "dof": list(S.dof.values)}
    m0 = np.trapezoid(S.values, w, axis=0)
    m4 = np.trapezoid(S.values * w_e[:, None] ** 4, w, axis=0)
    found["significant"] = dict(zip(found["dof"], 4.0 * np.sqrt(m0), strict=True))
    found["acceleration"] = dict(zip(found["dof"], 4.0 * np.sqrt(m4), strict=True))
    return found


def _particulars(ship: Ship) -> list[dict[str, Any]]:
    body = og.RigidBody.from_hull(ship.hull, zg=KG - DRAUGHT, gyradii=GYRADII)
    fine = og.hydrostatics(ship.hull, body=body)
    found = {
        "volume": (fine.volume, "m3", 0.01),
        "wetted area": (fine.wetted_area, "m2", 0.01 if ship.from_lines else 0.1),
        "GM_T": (fine.GM_T, "m", 0.02 if ship.from_lines else 0.4),
        "LCB": (100.0 * fine.center_of_buoyancy[0] / LPP, "% Lpp", 0.1),
        "C_WP": (fine.waterplane_area / (LPP * BEAM), "", 0.01),
    }
    whose = "mesh of the hull" if ship.from_lines else "lines made from the particulars"
    return [
        _check(name, value, PUBLISHED[name], abs(PUBLISHED[name]) * part, unit=unit, source=SOURCE, note=whose)
        for name, (value, unit, part) in found.items()
    ]


def _coefficients(data: dict[str, Any]) -> list[dict[str, Any]]:
    """Speed terms: at_speed against the panel method at speed."""
    checks = []
    for what, key, i, j in (("A35", "added_mass", 2, 4), ("B53", "radiation_damping", 4, 2), ("A55", "added_mass", 4, 4)):
        ours, theirs = data["met"][key].values[:, i, j], data["solved"][key].values[:, i, j]
        away = np.abs(ours - theirs).max() / np.abs(theirs).max()
        checks.append(_check(f"{what} at 18 kn: at_speed - solve_bem", 100 * away, 0.0, 1e-4, unit="%", source="identity"))
    long = np.sqrt(2 * np.pi * data["solved"].attrs["g"] / (0.9 * LPP)) > WAVES
    for what, i in (("X3", 2), ("X5", 4)):
        ours, theirs = (data[k].excitation_force.values[:, 0, i] for k in ("met", "solved"))
        away = 100 * np.abs(ours - theirs) / np.abs(theirs).max()
        for which, value, allowed in (("over 0.9 Lpp long", away[long].max(), 6.0), ("all", away.max(), 20.0)):
            note = f"of the largest {what}"
            checks.append(_check(f"{what}, waves {which}: at_speed - solve_bem", value, 0.0, allowed, unit="%", note=note))
    return checks


def _motions(data: dict[str, Any]) -> list[dict[str, Any]]:
    ahead = data["motions"]["18 kn, at_speed"]
    k = ahead.omega.values**2 / ahead.attrs["g"]
    heave, pitch = (ahead.sel(dof=d).values[:, 0] for d in ("heave", "pitch"))
    checks = [
        _check("heave in the longest wave (0.1 rad/s)", abs(heave[0]), 1.0, 0.01, source="hydrostatics"),
        _check("pitch / wave slope in the longest wave", abs(pitch[0]) / k[0], 1.0, 0.05, source="hydrostatics"),
        _check("phase of pitch there", np.degrees(np.angle(pitch[0])), -90.0, 2.0, unit="deg", source="hydrostatics"),
        _check("heave in the shortest wave", abs(heave[-1]), 0.0, 0.03, source="short waves cancel along the hull"),
    ]
    one, other, rest = (data["responses"][name] for name in data["responses"])
    for dof, unit, scale in (("heave", "m", 1.0), ("pitch", "deg", np.degrees(1.0)), ("bow", "m", 1.0)):
        note = f"at zero speed {rest['significant'][dof] * scale:.3g} {unit}"
        value, wanted = one["significant"][dof] * scale, other["significant"][dof] * scale
        checks.append(_check(f"significant {dof}", value, wanted, 0.05 * wanted, unit=unit, source="solve_bem", note=note))
    for dof, where in (("heave", "midship"), ("bow", "the bow")):
        value, wanted = one["acceleration"][dof], other["acceleration"][dof]
        note = f"at zero speed {rest['acceleration'][dof]:.3g} m/s2"
        checks.append(
            _check(
                f"significant acceleration at {where}", value, wanted, 0.05 * wanted, unit="m/s2", source="solve_bem", note=note
            )
        )
    return checks


def _check(
    name: str, value: float, reference: float, tolerance: float, *, unit: str = "", source: str = "solve_bem", note: str = ""
) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": float(tolerance), "unit": unit,
        "source": source, "note": note,
    }  # fmt: skip


def _quiet(function: Any, *arguments: Any, **options: Any) -> Any:
    """Call without the package's warnings (unresolved short waves, encounters beyond the data), which ABOUT speaks of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)
        return function(*arguments, **options)


COLOR = {"18 kn, at_speed": "#2f6db0", "18 kn, solve_bem": "#d1495b", "0 kn": "#8a8f98"}
STYLE = {"18 kn, at_speed": "-", "18 kn, solve_bem": "o", "0 kn": "--"}


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw motions over wave length, spectra of the responses, the speed's share of a coefficient, wave forces."""
    axes = fig.subplots(2, 3)
    titles = (("heave", "heave / wave amplitude"), ("pitch", "pitch / wave slope"), ("bow", "bow, up / wave amplitude"))
    for ax, (dof, title) in zip(axes[0], titles, strict=True):
        for name, motion in data["motions"].items():
            w = motion.omega.values
            k = w**2 / motion.attrs["g"]
            scale = 1.0 / k if dof == "pitch" else 1.0
            size = np.abs(motion.sel(dof=dof).values[:, 0]) * scale
            ax.plot(2 * np.pi / k / LPP, size, STYLE[name], color=COLOR[name], ms=3, mfc="none", label=name)
        ax.set(title=title, xlabel="wave length / Lpp", xlim=(0, 4), ylim=(0, None))
    _spectra(axes[1, 0], data)
    _coupling(axes[1, 1], data)
    _forces(axes[1, 2], data)
    fig.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=3)


def _spectra(ax: Any, data: dict[str, Any]) -> None:
    for name, r in data["responses"].items():
        if name != "18 kn, solve_bem":
            jacobian = np.gradient(r["omega_e"], r["omega"])
            ax.plot(r["omega_e"], r["spectrum"][:, 0] / jacobian, STYLE[name], color=COLOR[name])
    w = data["responses"]["0 kn"]["omega"]
    ax.fill_between(w, data["sea"](w), color="#cfd8dc", label="waves, fixed point", zorder=0)
    ax.set(
        title="spectrum of heave", xlabel="frequency of encounter [rad/s]", ylabel="m2 s/rad", xlim=(0.2, 1.8), ylim=(0, None)
    )
    ax.legend(frameon=False, fontsize=7)


def _coupling(ax: Any, data: dict[str, Any]) -> None:
    for hydro, name in (
        (data["sailing"], "18 kn, at_speed"),
        (data["solved"], "18 kn, solve_bem"),
        (data["ship"].hydro0, "0 kn"),
    ):
        w, B = hydro.omega.values, hydro.radiation_damping.values[:, 4, 2]
        ax.plot(w, B / 1e6, STYLE[name], color=COLOR[name], ms=3, mfc="none")
    ax.axhline(0.0, color="#22262b", lw=0.6)
    ax.set(title="damping B53", xlabel="frequency of oscillation [rad/s]", ylabel="1e6 N s", xlim=(0, 2.5))


def _forces(ax: Any, data: dict[str, Any]) -> None:
    for hydro, name in (
        (data["sailing"], "18 kn, at_speed"),
        (data["solved"], "18 kn, solve_bem"),
        (data["ship"].hydro0, "0 kn"),
    ):
        ax.plot(
            hydro.omega.values,
            np.abs(hydro.excitation_force.values[:, 0, 4]) / 1e6,
            STYLE[name],
            color=COLOR[name],
            ms=3,
            mfc="none",
        )
    ax.set(title="pitch moment of waves", xlabel="wave frequency [rad/s]", ylabel="1e6 N m/m", xlim=(0, 1.6), ylim=(0, None))
