"""Steps per second of the time domain beside a plain numpy Runge-Kutta loop of the same equations, 69 memory states.

Every figure of the package is for the whole call: set-up, wave forces of 200 components, time loop, the force of each load and
the output at every step. The numpy loop is timed alone, with its wave forces ready.
"""

import time
from collections.abc import Callable

import numpy as np

import ogilvie as og
from benchmarks import Measurement

DT = 0.1
NUMPY_STEPS = 6000
SINGLE = 10 * 3600.0  # s
ENSEMBLE, ENSEMBLE_DURATION = 256, 600.0
REPEAT = 3


def vessel(*, convolution: bool = False) -> og.Vessel:
    """Return a barge with a passive memory of 69 states: 36 in surge-heave-pitch and 33 in sway-roll-yaw."""
    A_inf = np.diag([3e5, 4e6, 6e6, 1.5e8, 2.5e9, 2e9])
    C = np.diag([0.0, 0.0, 8e6, 1.6e8, 4e9, 0.0])
    springs = np.diag([3.2e4, 4e4, 0.0, 0.0, 0.0, 1.6e7])
    damping = np.diag([3e4, 4e4, 0.0, 3e7, 0.0, 3e7])
    w, b = np.linspace(0.05, 3.0, 60), np.radians(np.arange(0, 181, 15))
    X = wave_force(w, b)
    zero = np.zeros((60, 6, 6))
    hydro = og.hydro_from_arrays(
        omega=w, added_mass=zero, radiation_damping=zero, wave_direction=b, excitation_force=X, hydrostatic_stiffness=C
    )
    model = memory_model(A_inf)
    t = np.arange(0.0, 60.0, 0.05)
    table = og.Retardation(t, model.impulse(t), A_inf)
    radiation = og.Convolution(table, truncation=table.duration) if convolution else og.StateSpaceRadiation(model)
    body = og.RigidBody(mass=1e7, cog=[0.5, 0.0, 1.0], inertia=np.diag([4e8, 7e9, 7e9]))
    loads = (
        og.LinearRestoring(hydro),
        og.LinearMooring(springs),
        og.LinearDamping(damping),
        og.WaveExcitation(hydro),
        radiation,
    )
    return og.Vessel(body, loads=loads)


def memory_model(A_inf: np.ndarray) -> og.StateSpace:
    """Return oscillators (two states each) and one first-order lag, passive by construction, in two blocks."""
    scale = np.sqrt([4e5, 3e6, 5e6, 4e7, 2.5e9, 1.2e9]) / 2.0
    A, B, C = np.zeros((69, 69)), np.zeros((69, 6)), np.zeros((6, 69))
    for first, count, dofs in ((0, 18, [0, 2, 4]), (36, 16, [1, 3, 5])):
        for i, w in enumerate(np.linspace(0.4, 2.2, count)):
            q, p = first + 2 * i, first + 2 * i + 1
            A[q, p], A[p, q], A[p, p] = 1.0, -(w**2), -0.6
            B[p, dofs] = C[dofs, p] = scale[dofs] * np.cos(i * np.array([1.0, 1.7, 2.3]))
    A[68, 68] = -0.7
    B[68, 1] = C[1, 68] = 0.1 * scale[1]
    return og.StateSpace(A, B, C, A_inf=A_inf)


def wave_force(omega: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Return smooth wave forces (n_w, n_b, 6) of a port-starboard symmetric hull."""
    w, c, s = omega[:, None], np.cos(direction)[None], np.sin(direction)[None]
    size = np.exp(-(w**2) + 0.4j * w * c)
    heave = 8e6 * size * np.exp(-(w**2) * c**2)
    forces = [1j * c * 8e5 * w**2 * size, 1j * s * 3e6 * w**2 * size, heave]
    moments = [1j * s * 2e7 * w**2 * size, 1j * c * 3e8 * w * size, s * c * 4e7 * w**2 * size]
    return np.stack(forces + moments, axis=-1)


def numpy_loop(ship: og.Vessel, sea: og.Sea) -> tuple[float, np.ndarray]:
    """Return steps per second and the motions (n, 6) of the classical Runge-Kutta method, written plainly in numpy."""
    restoring, mooring, drag, excitation, radiation = ship.loads
    M = ship.body.matrix + radiation.added_mass
    A, B, C = radiation.model.A, radiation.model.B, radiation.model.C
    K, D, W = restoring.stiffness + mooring.stiffness, drag.matrix, np.linalg.inv(M)
    X = excitation.force(sea.omega, sea.direction) * sea.complex_amplitude[:, None]
    F = (np.exp(1j * np.outer(0.5 * DT * np.arange(2 * NUMPY_STEPS + 1), sea.omega)) @ X).real
    eta, nu, x = np.zeros(6), np.zeros(6), np.zeros(len(A))
    out = np.empty((NUMPY_STEPS, 18))

    def rates(eta, nu, x, force):  # type: ignore[no-untyped-def]
        return nu, W @ (force - K @ eta - D @ nu - C @ x), A @ x + B @ nu

    begin = time.perf_counter()
    for i in range(NUMPY_STEPS):
        k1 = rates(eta, nu, x, F[2 * i])
        out[i, :6], out[i, 6:12], out[i, 12:] = eta, nu, k1[1]
        h = 0.5 * DT
        k2 = rates(eta + h * k1[0], nu + h * k1[1], x + h * k1[2], F[2 * i + 1])
        k3 = rates(eta + h * k2[0], nu + h * k2[1], x + h * k2[2], F[2 * i + 1])
        k4 = rates(eta + DT * k3[0], nu + DT * k3[1], x + DT * k3[2], F[2 * i + 2])
        h = DT / 6.0
        eta = eta + h * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        nu = nu + h * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        x = x + h * (k1[2] + 2 * k2[2] + 2 * k3[2] + k4[2])
    return NUMPY_STEPS / (time.perf_counter() - begin), out[:, :6]


def numpy_matrix_loop(ship: og.Vessel) -> float:
    """Return steps per second of the fastest plain form: one 81 x 81 matrix for the whole vessel, forces on the state ready."""
    from ogilvie.sim.system import assemble

    A = assemble(ship).closed_loop()
    z = np.zeros(len(A))
    f = np.zeros((2 * NUMPY_STEPS + 1, len(A)))
    out = np.empty((NUMPY_STEPS, len(A)))
    begin = time.perf_counter()
    for i in range(NUMPY_STEPS):
        out[i] = z
        k1 = A @ z + f[2 * i]
        k2 = A @ (z + 0.5 * DT * k1) + f[2 * i + 1]
        k3 = A @ (z + 0.5 * DT * k2) + f[2 * i + 1]
        k4 = A @ (z + DT * k3) + f[2 * i + 2]
        z = z + DT / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4)
    return NUMPY_STEPS / (time.perf_counter() - begin)


def rate(steps: float, work: Callable[[], object]) -> float:
    """Return steps per second of the best of a few calls."""
    best = np.inf
    for _ in range(REPEAT):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return steps / best


def stepper_rate(ship: og.Vessel, sea: og.Sea, steps: int = 20000) -> float:
    """Return steps per second with one Python call per step."""
    stepper = og.Stepper(ship, sea, dt=DT)
    stepper.step()

    def work() -> None:
        for _ in range(steps):
            stepper.step()

    return rate(steps, work)


def measure() -> list[Measurement]:
    """Return the measurements."""
    ship, memory_by_sum = vessel(), vessel(convolution=True)
    spectrum = og.jonswap(hs=3.0, tp=9.0, gamma=3.3)
    one = og.irregular(spectrum, direction=np.radians(130.0), n=200, omega_range=(0.3, 2.5), seed=1)
    many = og.irregular(spectrum, direction=np.radians(130.0), n=200, omega_range=(0.3, 2.5), seed=range(ENSEMBLE))
    first = time.perf_counter()
    run = og.simulate(ship, one, duration=NUMPY_STEPS * DT, dt=DT, initial="rest")
    first = time.perf_counter() - first
    loops = [numpy_loop(ship, one) for _ in range(REPEAT)]
    motions = loops[0][1]
    worst = float(np.abs(run.eta.values[:-1] - motions).max() / np.abs(motions).max())
    assert worst < 1e-4, f"the two loops solve different equations: {worst:.2g}"
    matrix = max(numpy_matrix_loop(ship) for _ in range(REPEAT))
    rates = {
        "simulate, one run of 10 h": rate(SINGLE / DT, lambda: og.simulate(ship, one, duration=SINGLE, dt=DT)),
        f"simulate, ensemble of {ENSEMBLE} runs of 10 min": rate(
            ENSEMBLE * ENSEMBLE_DURATION / DT, lambda: og.simulate(ship, many, duration=ENSEMBLE_DURATION, dt=DT)
        ),
        "simulate, method exact, one run of 1 h": rate(
            3600.0 / DT, lambda: og.simulate(ship, one, duration=3600.0, dt=DT, method="exact")
        ),
        "simulate, convolution over 60 s, one run of 20 min": rate(
            1200.0 / DT, lambda: og.simulate(memory_by_sum, one, duration=1200.0, dt=DT)
        ),
        "Stepper, one call per step": stepper_rate(ship, one),
    }
    plain = max(r for r, _ in loops + [numpy_loop(ship, one) for _ in range(REPEAT)])  # before and after the others
    rows = [Measurement(name, value, "steps/s", value / plain, "numpy RK4") for name, value in rates.items()]
    return [
        Measurement("numpy RK4, plain", plain, "steps/s", 1.0, "numpy RK4"),
        Measurement("numpy RK4, one matrix for everything", matrix, "steps/s", matrix / plain, "numpy RK4"),
        *rows,
        Measurement("first call, compilation or its cache included", first, "s"),
        Measurement("largest difference of the two motions", worst, "of max"),
    ]
