"""Steps per second of large motions beside a plain numpy Runge-Kutta loop of the same equations, 69 memory states.

The vessel has Coriolis forces of body and fluid, the fluid memory, restoring and mooring of the pose, quadratic damping, and a
table of slow-drift forces; its first-order waves are a table made before the run, or met where the vessel is (200 components).
Motions alone are kept (eta and nu at every step), in the package as in numpy.
"""

import time
from collections.abc import Callable

import numpy as np

import ogilvie as og
from benchmarks import Measurement
from benchmarks.simulation import DT, memory_model, rate, vessel
from ogilvie.frames import coriolis_matrix, euler_rate_matrix, rotation_matrix

NUMPY_STEPS = 1500
SINGLE, ENSEMBLE, ENSEMBLE_DURATION = 4 * 3600.0, 256, 600.0
WAVES, HELD = 1800.0, 1200.0  # s
KEPT = ("eta", "nu")
A_INF = np.diag([3e5, 4e6, 6e6, 1.5e8, 2.5e9, 2e9])
QUADRATIC = np.diag([4e4, 3e5, 2e5, 6e8, 3e10, 6e10])


def drift_table(duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times (s) and a slowly varying force (n, 6), N and N m, in the axes of the vessel's heading."""
    t = np.arange(0.0, duration + 20.0, 1.0)
    phase = 0.02 * t[:, None] + np.arange(6)
    return t, np.cos(phase) * [5e4, 4e4, 0.0, 0.0, 0.0, 1e6]


def sailing(*, position: str, duration: float, more: tuple = ()) -> og.Vessel:
    """Return the barge of the benchmark of small motions with quadratic damping and slow drift."""
    ship = vessel()
    kept = [load for load in ship.loads if not isinstance(load, og.WaveExcitation)]
    hydro = next(load.hydro for load in ship.loads if isinstance(load, og.WaveExcitation))
    t, force = drift_table(duration)
    loads = (
        *kept,
        og.WaveExcitation(hydro, position=position),
        og.QuadraticDamping(QUADRATIC),
        og.ForceTable(t, force),
        *more,
    )
    return og.Vessel(ship.body, loads=loads)


class NumpyLoop:
    """The same equations, written plainly."""

    def __init__(self, ship: og.Vessel, sea: og.Sea, *, instantaneous: bool) -> None:
        loads = {type(load).__name__: load for load in ship.loads}
        model = memory_model(A_INF)
        self.M, self.A = ship.body.matrix, A_INF
        self.inverse = np.linalg.inv(self.M + self.A)
        self.a, self.b, self.c = model.A, model.B, model.C
        self.momentum = np.linalg.solve(self.a.T, self.c.T).T
        self.C = loads["LinearRestoring"].stiffness + loads["LinearMooring"].stiffness
        self.D = loads["LinearDamping"].matrix
        self.sea, self.instantaneous = sea, instantaneous
        self.excitation = loads["WaveExcitation"]
        self.X = self.excitation.force(sea.omega, sea.direction) * sea.complex_amplitude[:, None]
        self.headings = np.radians(np.arange(-60.0, 60.1, 0.5))
        force = [self.excitation.force(sea.omega, sea.direction - psi) for psi in self.headings] if instantaneous else []
        self.turned = np.array(force) * sea.complex_amplitude[:, None] if instantaneous else self.X
        half = 0.5 * DT * np.arange(2 * NUMPY_STEPS + 1)
        self.table = (np.exp(1j * np.outer(half, sea.omega)) @ self.X).real
        t, force = drift_table(NUMPY_STEPS * DT)
        self.drift = np.array([np.interp(half, t, f) for f in force.T]).T

    def rates(self, k: int, eta: np.ndarray, nu: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the rates of pose, velocity and memory at half step k."""
        R, T = rotation_matrix(*eta[3:]), euler_rate_matrix(eta[3], eta[4])
        J = np.zeros((6, 6))
        J[:3, :3], J[3:, 3:] = R, T
        c, s = np.cos(eta[5]), np.sin(eta[5])
        heading = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        waves, turn = self.table[k], R.T
        if self.instantaneous:
            sea = self.sea
            place = eta[0] * np.cos(sea.direction) + eta[1] * np.sin(sea.direction)
            phase = np.exp(1j * (sea.omega * 0.5 * DT * k - sea.wavenumber * place))
            at = (eta[5] - self.headings[0]) / (self.headings[1] - self.headings[0])
            i = int(at)
            X = (1.0 - at + i) * self.turned[i] + (at - i) * self.turned[i + 1]
            waves, turn = (phase @ X).real, R.T @ heading
        drift = R.T @ heading
        P = self.A @ nu + self.momentum @ x
        v, w = nu[:3], nu[3:]
        fluid = np.concatenate([np.cross(w, P[:3]), np.cross(w, P[3:]) + np.cross(v, P[:3])])
        force = np.concatenate([turn @ waves[:3], turn @ waves[3:]]) - J.T @ (self.C @ eta)
        force += np.concatenate([drift @ self.drift[k, :3], drift @ self.drift[k, 3:]])
        force -= coriolis_matrix(self.M, nu) @ nu + fluid + self.D @ nu + QUADRATIC @ (np.abs(nu) * nu) + self.c @ x
        return J @ nu, self.inverse @ force, self.a @ x + self.b @ nu

    def run(self) -> tuple[float, np.ndarray]:
        """Return steps per second and the poses (n, 6)."""
        eta, nu, x = np.zeros(6), np.zeros(6), np.zeros(len(self.a))
        out = np.empty((NUMPY_STEPS, 12))
        begin = time.perf_counter()
        for i in range(NUMPY_STEPS):
            out[i, :6], out[i, 6:] = eta, nu
            h = 0.5 * DT
            k1 = self.rates(2 * i, eta, nu, x)
            k2 = self.rates(2 * i + 1, eta + h * k1[0], nu + h * k1[1], x + h * k1[2])
            k3 = self.rates(2 * i + 1, eta + h * k2[0], nu + h * k2[1], x + h * k2[2])
            k4 = self.rates(2 * i + 2, eta + DT * k3[0], nu + DT * k3[1], x + DT * k3[2])
            eta, nu, x = (
                z + DT / 6.0 * (a + 2 * b + 2 * c + d) for z, a, b, c, d in zip((eta, nu, x), k1, k2, k3, k4, strict=True)
            )
        return NUMPY_STEPS / (time.perf_counter() - begin), out[:, :6]


def compared(ship: og.Vessel, sea: og.Sea, *, instantaneous: bool) -> tuple[float, float]:
    """Return the best speed of numpy and the largest difference of the two motions, as a fraction of each one's largest."""
    loop = NumpyLoop(ship, sea, instantaneous=instantaneous)
    speed, poses = max((loop.run() for _ in range(2)), key=lambda r: r[0])
    run = og.simulate(ship, sea, duration=NUMPY_STEPS * DT, dt=DT, initial="rest", motions="large", variables=KEPT)
    difference = np.abs(run.eta.values[:-1] - poses).max(axis=0) / np.abs(poses).max(axis=0)
    return speed, float(difference.max())


def _rate(ship: og.Vessel, sea: og.Sea | None, duration: float, realisations: int = 1) -> float:
    work: Callable[[], object] = lambda: og.simulate(  # noqa: E731
        ship, sea, duration=duration, dt=DT, initial="rest", motions="large", variables=KEPT
    )
    return rate(realisations * duration / DT, work)


def measure() -> list[Measurement]:
    """Return the measurements."""
    spectrum = og.jonswap(hs=3.0, tp=9.0, gamma=3.3)
    options = {"direction": np.radians(130.0), "n": 200, "omega_range": (0.3, 2.5)}
    one, many = og.irregular(spectrum, seed=1, **options), og.irregular(spectrum, seed=range(ENSEMBLE), **options)
    tabled = sailing(position="mean", duration=SINGLE)
    met = sailing(position="instantaneous", duration=SINGLE)
    nothing = np.zeros(6)
    held = sailing(position="mean", duration=SINGLE, more=(og.UserForce(lambda t, eta, nu: nothing, DT),))
    plain, worst = compared(tabled, one, instantaneous=False)
    plain_met, worst_met = compared(met, one, instantaneous=True)
    assert max(worst, worst_met) < 2e-3, f"the two loops solve different equations: {worst:.2g}, {worst_met:.2g}"
    rows = [
        ("large motions, wave table, one run of 4 h", _rate(tabled, one, SINGLE), plain),
        (f"the same, ensemble of {ENSEMBLE} runs of 10 min", _rate(tabled, many, ENSEMBLE_DURATION, ENSEMBLE), plain),
        ("waves met where the vessel is, 200 components", _rate(met, one, WAVES), plain_met),
        ("an empty Python force at every step", _rate(held, one, HELD), plain),
    ]
    return [
        Measurement("numpy RK4, wave table", plain, "steps/s", 1.0, "numpy RK4"),
        Measurement("numpy RK4, waves met where the vessel is", plain_met, "steps/s", 1.0, "numpy RK4"),
        *[Measurement(name, value, "steps/s", value / base, "numpy RK4") for name, value, base in rows],
        Measurement("largest difference of the two motions, table", worst, "of max"),
    ]
