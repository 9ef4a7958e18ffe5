"""KVLCC2 of paper D: hull, mass, coefficients, mean drift, mooring; what second-order roll is by transfer functions."""

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.loads.excitation import WaveExcitation
from ogilvie.sim.system import assemble

NEEDS = ["data/kvlcc2_hull/kvlcc2_coarse.gdf"]
RHO, G = 1025.0, 9.80665
GM, PERIOD, KG, DISPLACEMENT = 5.703, 21.02, 18.205, 320438.0  # m, s, m, t: table 1 of the paper
GYRADII = (23.0, 80.0, 80.0)  # m: the first is replaced, the others are a quarter of the length
OMEGA = np.arange(0.05, 1.41, 0.05)  # rad/s
WAVES = (0.4, 1.3)  # rad/s, of the seas and the mean drift; the panels resolve 1.2
BEAM = np.pi / 2
ROLL, LATERAL = 3, [1, 5]
MOORING = {"period": 250.0, "damping": 0.05}  # s, of critical: surge, sway, yaw
FORMS = ("newman-1974", "newman-arithmetic", "newman-geometric")


@dataclass(frozen=True)
class Ship:
    """The ship with its coefficients."""

    hull: Any
    body: Any
    hydro: Any
    drift: Any  # near field, moments about the moving O
    gyradius: float
    rest: Any

    @property
    def slow(self) -> Any:
        """The mean drift, with the coefficients that tell that the ship is symmetric."""
        return self.hydro.interp(omega=self.drift.omega).assign(mean_drift=self.drift.mean_drift)


def prepared(shared: Path) -> Ship:
    """Return the ship with KG and the roll radius of gyration chosen so that GM and the roll period are the paper's."""
    hull = og.load_mesh(shared / NEEDS[0])
    rest = og.hydrostatics(hull)
    zg = rest.KM_T - hull.draught - GM
    body = og.RigidBody.from_hull(hull, zg=zg, gyradii=GYRADII, rho=RHO)
    common = {"wave_direction": [BEAM], "rho": RHO, "g": G, "progress": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)  # short waves on these panels, energy of single points: see ABOUT
        hydro = og.solve_bem(hull, body, omega=OMEGA, **common)
        kxx = _gyradius(body, hydro)
        body = og.RigidBody.from_hull(hull, zg=zg, gyradii=(kxx, *GYRADII[1:]), rho=RHO)
        waves = np.r_[
            np.arange(WAVES[0], 0.66, 0.025), np.arange(0.7, WAVES[1] + 0.01, 0.05)
        ]  # the drift rises steeply at first
        drift = og.mean_drift(hull, body, omega=waves, method="near", moments="body", **common)
    return Ship(hull, body, hydro, drift, kxx, rest)


def _gyradius(body: Any, hydro: Any) -> float:
    """Return kxx for which roll, with sway and yaw free to follow, has its natural period."""
    w = 2 * np.pi / PERIOD
    A = hydro.added_mass.interp(omega=w, method="cubic").values
    C44 = hydro.hydrostatic_stiffness.values[ROLL, ROLL]
    M = body.matrix + A
    shape = np.zeros(6)
    shape[ROLL] = 1.0
    shape[LATERAL] = -np.linalg.solve(M[np.ix_(LATERAL, LATERAL)], M[LATERAL, ROLL])
    return float(np.sqrt(GYRADII[0] ** 2 + (C44 / w**2 - shape @ M @ shape) / body.mass))


def moored(ship: Ship, radiation: Any, *, drift: str | None = None, roll: float = 0.0) -> Any:
    """Return the vessel: linear restoring and waves, soft mooring, slow drift by one of FORMS, linear roll damping (N m s)."""
    M = ship.body.matrix + ship.hydro.added_mass_zero.values
    inertia = np.diag([M[0, 0], M[1, 1], 0, 0, 0, M[5, 5]])
    w = 2 * np.pi / MOORING["period"]
    damping = 2 * MOORING["damping"] * w * inertia
    damping[ROLL, ROLL] = roll
    loads = [
        og.LinearRestoring(ship.hydro),
        radiation,
        og.WaveExcitation(ship.hydro),
        og.LinearMooring(w**2 * inertia),
        og.LinearDamping(damping),
    ]
    if drift is not None:
        loads.append(og.SlowDrift(ship.slow, drift))
    return og.Vessel(ship.body, loads=loads)


def roll_of_force(vessel: Any, omega: np.ndarray) -> np.ndarray:
    """Return roll (n, 6) per harmonic force at frequencies from zero on."""
    w = np.maximum(omega, 1e-6)
    return np.linalg.inv(assemble(vessel).impedance(w))[:, ROLL]


@dataclass(frozen=True)
class Expected:
    """Mean and standard deviations of roll over all phases of a sea, rad."""

    mean: float
    first: float
    second: float

    @property
    def both(self) -> float:
        """Standard deviation of the whole."""
        return float(np.hypot(self.first, self.second))


def expected(vessel: Any, slow: Any, sea: Any, *, since: float = np.inf, pole: tuple[float, float] = (PERIOD, 0.0)) -> Expected:
    """Return roll of first and second order in a sea of given amplitudes and random phases, by transfer functions.

    With `since`, the time (s) since a start without slow motion: a force at mu leaves a free oscillation at the roll period and
    ratio of `pole`, H (1 - exp((i (w0 - mu) - ratio w0) t)) for |mu| near w0, which is where H counts.
    """
    excitation = next(load for load in vessel.loads if isinstance(load, WaveExcitation))
    a, w = np.atleast_2d(sea.amplitude)[0], sea.omega
    H = roll_of_force(vessel, w)
    first = np.einsum("nk,nk->n", H, excitation.force(w, sea.direction, 0.0)) * a
    i, j = np.nonzero(w[:, None] > w[None, :])
    Q = slow.qtf(w[i], w[j], BEAM)
    near = 2 * np.pi / pole[0] + np.arange(-0.01, 0.01, 1e-5)  # the resonance of waves alone is 2e-4 rad/s wide
    mu = np.union1d(np.arange(0.0, np.ptp(w) + 4e-4, 2e-4), near)
    H = roll_of_force(vessel, mu)
    difference = w[i] - w[j]
    second = sum(np.interp(difference, mu, H[:, k]) * Q[:, k] for k in range(6)) * 2 * a[i] * a[j]
    if np.isfinite(since):
        w0 = 2 * np.pi / pole[0]
        second = second * (1 - np.exp((1j * (w0 - difference) - pole[1] * w0) * since))
    mean = (H[0] @ (slow.qtf(w, w, BEAM).real * a[:, None] ** 2).sum(axis=0)).real
    return Expected(float(mean), *(float(np.sqrt(0.5 * np.sum(np.abs(x) ** 2))) for x in (first, second)))


NEAR = 2 * np.pi / PERIOD + np.linspace(-0.03, 0.03, 601)  # rad/s


def roll_damping(vessel: Any) -> tuple[float, float]:
    """Return natural period (s) and damping ratio of roll, sway and yaw moving with it, from 1/H_44 near the resonance."""
    return _resonance(1.0 / roll_of_force(vessel, NEAR)[:, ROLL])


def roll_damping_of_data(vessel: Any, ship: Ship) -> tuple[float, float]:
    """Return the same with added mass and damping interpolated between the data in place of the vessel's memory."""
    system = assemble(vessel)
    at = ship.hydro[["added_mass", "radiation_damping"]].interp(omega=NEAR, method="cubic")
    s = 1j * NEAR[:, None, None]
    inner = s * (ship.body.matrix + at.added_mass.values) + at.radiation_damping.values + system.damping
    return _resonance(1.0 / np.linalg.inv(inner * s + system.stiffness)[:, ROLL, ROLL])


def _resonance(Y: np.ndarray) -> tuple[float, float]:
    """Return period and damping ratio of Y = C - w^2 I + i w B at the frequencies NEAR."""
    k = int(np.argmin(np.abs(Y.real)))
    few = slice(k - 3, k + 4)
    w0 = float(np.interp(0.0, -Y.real[few], NEAR[few]))
    slope = -np.gradient(Y.real, NEAR)[k]
    return 2 * np.pi / w0, float(np.interp(w0, NEAR, Y.imag) / (slope * w0))
