"""Nonlinear Froude-Krylov force of a hull of 2000 wetted panels in 100 components, beside a plain numpy evaluation.

One evaluation is all that a stage of a time step needs: waves at the hull, still water and waves cut at it, weight. The runs
are of a ship with a fluid memory of 69 states, diffraction where the vessel is, and damping, at dt = 0.05 s (four evaluations a
step).
"""

import time
from collections.abc import Callable

import numpy as np

import ogilvie as og
from benchmarks import Measurement
from benchmarks.simulation import memory_model, vessel
from ogilvie.frames import rotation_matrix
from ogilvie.loads.base import Surroundings
from ogilvie.loads.froude_krylov import NonlinearFroudeKrylov
from ogilvie.loads.froude_krylov_kernel import HULL
from ogilvie.loads.kernel import Kernel, situation
from ogilvie.mesh.raise_sides import with_raised_sides

PANELS, COMPONENTS, DT = 2000, 100, 0.05
POSE = np.array([30.0, -20.0, 0.4, 0.3, 0.03, 0.4])
TIME = 3.0
Array = np.ndarray


def ship(*, panels: int = PANELS, **options: str | float) -> tuple[og.RigidBody, NonlinearFroudeKrylov]:
    """Return the S175 with its sides up to 5.9 m above the water, and its load."""
    hull = with_raised_sides(og.shapes.s175(panels=panels, above_water=True), 5.9)
    body = og.RigidBody.from_hull(hull.immersed(), kg=9.52, gyradii=(8.33, 42.0, 42.0))
    return body, NonlinearFroudeKrylov(hull, body, data(), **options)  # type: ignore[arg-type]


def data() -> object:
    """Return the coefficients of the barge of the other benchmarks with a Froude-Krylov part."""
    hydro = next(load.hydro for load in vessel().loads if isinstance(load, og.WaveExcitation))
    return hydro.assign(Froude_Krylov_force=0.5 * hydro.excitation_force)


def numpy_force(load: NonlinearFroudeKrylov, sea: og.Sea, t: float, eta: Array) -> Array:
    """Return the same force (6,), written plainly."""
    numbers = load._hull
    n, m, rho_g, weight, cog = int(numbers[0]), int(numbers[1]), numbers[2], numbers[3], numbers[4:7]
    r = numbers[HULL : HULL + 3 * n].reshape(3, n).T
    tri = numbers[HULL + 3 * n : HULL + 3 * n + 3 * m].reshape(3, m).T.astype(int)
    R = rotation_matrix(*eta[3:])
    x = r @ R.T + eta[:3]
    kx, ky = sea.wavenumber * np.cos(sea.direction), sea.wavenumber * np.sin(sea.direction)
    a = sea.amplitude * np.cos(sea.omega * t - np.outer(x[:, 0], kx) - np.outer(x[:, 1], ky) + sea.phase)
    zeta = a.sum(axis=1)
    stretched = np.minimum(x[:, 2] - zeta, 0.0)
    head = (a * np.exp(np.outer(stretched, sea.wavenumber))).sum(axis=1) - x[:, 2]
    q = np.concatenate([r, np.where(zeta > x[:, 2], head, 0.0)[:, None]], axis=1)[tri]
    level = (zeta - x[:, 2])[tri]
    wet = (level > 0.0).sum(axis=1)
    pieces = [q[wet == 3]]
    for few in (1, 2):
        at = np.flatnonzero(wet == few)
        alone = np.argmax(level[at] > 0.0 if few == 1 else level[at] <= 0.0, axis=1)
        turned = (alone[:, None] + np.arange(3)) % 3
        c, h = np.take_along_axis(q[at], turned[..., None], axis=1), np.take_along_axis(level[at], turned, axis=1)
        one, two = (c[:, 0] + (h[:, 0] / (h[:, 0] - h[:, k]))[:, None] * (c[:, k] - c[:, 0]) for k in (1, 2))
        one[:, 3] = two[:, 3] = 0.0
        if few == 1:
            pieces.append(np.stack([c[:, 0], one, two], axis=1))
        else:
            pieces += [np.stack([one, c[:, 1], c[:, 2]], axis=1), np.stack([one, c[:, 2], two], axis=1)]
    p = np.concatenate(pieces)
    S = 0.5 * np.cross(p[:, 1, :3] - p[:, 0, :3], p[:, 2, :3] - p[:, 0, :3])
    P = p[..., 3]
    arm = np.einsum("tik,ti->tk", p[..., :3], (P + P.sum(axis=1, keepdims=True)) / 12.0)
    pull = -weight * R[2]
    force = -rho_g * (S * P.sum(axis=1, keepdims=True) / 3.0).sum(axis=0) + pull
    return np.concatenate([force, -rho_g * np.cross(arm, S).sum(axis=0) + np.cross(cog, pull)])


def seconds(work: Callable[[], object], *, repeat: int = 5, times: int = 50) -> float:
    """Return the best time of one call, s."""
    best = np.inf
    for _ in range(repeat):
        begin = time.perf_counter()
        for _ in range(times):
            work()
        best = min(best, (time.perf_counter() - begin) / times)
    return best


def evaluation(load: NonlinearFroudeKrylov, body: og.RigidBody, sea: og.Sea) -> Callable[[], Array]:
    """Return what evaluates both compiled forces."""
    terms = load.bind(Surroundings(body))
    assert terms.kernel is not None
    assert terms.encounter is not None
    kernels: list[Kernel] = [terms.kernel, terms.encounter(sea, 0.0)]
    x, owns = situation(TIME, POSE), [k.own[0].copy() for k in kernels]

    def work() -> Array:
        force = np.zeros(6)
        for kernel, own in zip(kernels, owns, strict=True):
            kernel.function(x, kernel.data, own, force)
        return force

    return work


def real_time_factor(sea: og.Sea, duration: float, **options: str | float) -> float:
    """Return simulated over elapsed time of a whole run."""
    body, load = ship(**options)  # type: ignore[arg-type]
    radiation = og.StateSpaceRadiation(memory_model(np.diag([1e6, 1.2e7, 2.4e7, 5e8, 3e10, 2e10])))
    springs = og.LinearMooring(np.diag([6e4, 6e4, 0, 0, 0, 5e7]))
    damping = og.LinearDamping(0.02 * body.matrix)
    diffraction = og.WaveExcitation(load.hydro, part="diffraction")
    boat = og.Vessel(body, loads=(load, diffraction, radiation, springs, damping))
    best = 0.0
    for _ in range(2):
        begin = time.perf_counter()
        og.simulate(boat, sea, duration=duration, dt=DT, initial="rest", ramp=20.0, motions="large", variables=("eta", "nu"))
        best = max(best, sea.n_realisations * duration / (time.perf_counter() - begin))
    return best


def measure() -> list[Measurement]:
    """Return the measurements."""
    spectrum, options = og.jonswap(hs=5.0, tp=10.0, gamma=3.3), {"n": COMPONENTS, "omega_range": (0.3, 2.5)}
    long = og.irregular(spectrum, seed=1, direction=2.0, **options)
    pair = og.irregular(spectrum, seed=range(2), direction=2.0, **options)
    scattered = og.Sea(
        omega=long.omega, direction=2.0 + np.linspace(-0.6, 0.6, len(long.omega)), amplitude=long.amplitude, phase=long.phase
    )
    rows, base = [], 0.0
    for name, sea, how in (
        ("waves of one direction", long, {}),
        ("the same, accuracy 1e-3", long, {"accuracy": 1e-3}),
        ("the same, every component at every vertex", long, {"evaluation": "direct"}),
        ("100 directions", scattered, {}),
    ):
        body, load = ship(**how)  # type: ignore[arg-type]
        work = evaluation(load, body, sea)
        want = numpy_force(load, sea, TIME, POSE)
        off = np.abs((work() - want) / np.abs(want).max()).max()
        assert off < 1e-3, f"the two evaluate different forces: {off:.2g}"
        if not base:
            base = seconds(lambda load=load, sea=sea: numpy_force(load, sea, TIME, POSE), repeat=3, times=10)  # type: ignore[misc]
        took = seconds(work)
        rows.append(Measurement(name, 1e3 * took, "ms", base / took, "numpy", f"difference {off:.1e} of the largest"))
    vertices = int(load._hull[0])
    return [
        Measurement("plain numpy evaluation", 1e3 * base, "ms", 1.0, "numpy", f"{vertices} vertices"),
        *rows,
        Measurement("simulated over real time, one run of 10 min", real_time_factor(long, 600.0), "x"),
        Measurement("the same, two runs side by side", real_time_factor(pair, 600.0), "x"),
        Measurement("one run, 1000 panels", real_time_factor(long, 600.0, panels=1000), "x"),
        Measurement("one run, 100 directions", real_time_factor(scattered, 300.0), "x"),
    ]
