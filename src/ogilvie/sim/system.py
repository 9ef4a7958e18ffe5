"""The linear equations of motion of a vessel, gathered from its loads."""

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import MemoryKernel, MemoryModel, Surroundings, Terms
from ogilvie.sim.lag import kernel_transform
from ogilvie.sim.modes import modal_memory, resolvent
from ogilvie.sim.vessel import Vessel

Array = NDArray[Any]
ComplexArray = NDArray[Any]
#: L: velocity in body axes nu = xi' - U L xi of a displacement xi from a frame that advances at U along x.
TURNING = np.zeros((6, 6))
TURNING[1, 5], TURNING[2, 4] = 1.0, -1.0
TURNING.setflags(write=False)
_GROWTH = 1e-5  # 1/s, above the rounding of the double zero poles of a free vessel


@dataclass(frozen=True, eq=False)
class LinearSystem:
    """Equations of small motions about the steady frame that advances at the vessel's speed U and heading.

    Notes
    -----
    With L (:data:`TURNING`) and the momentum p_m of the fluid memory, p_m' = mu,

        eta' = nu + U L eta
        (M + A) nu' + (D + U (M L + L^T A)) nu + C eta + mu + U L^T p_m = F_const + F_wave(t)

    which for harmonic motions is the standard speed dependence of added mass and damping (docs/theory/speed.md).

    Parameters
    ----------
    body_mass : (6, 6) array
        M of the rigid body.
    added_mass, damping, stiffness : (6, 6) array
        Sums over the loads.
    constant : (6,) array
        N, N m.
    memory : MemoryModel or MemoryKernel
        Of mu alone, without U L^T p_m; a model without states where no load has a memory.
    names : tuple of str
        Of the loads.
    terms : tuple of Terms
        Of the loads, with damping ratios turned into damping.
    speed, heading : float
        m/s, rad.
    """

    body_mass: Array
    added_mass: Array
    damping: Array
    stiffness: Array
    constant: Array
    memory: MemoryModel | MemoryKernel
    names: tuple[str, ...]
    terms: tuple[Terms, ...]
    speed: float
    heading: float

    @property
    def mass(self) -> Array:
        """M + A (6, 6)."""
        return self.body_mass + self.added_mass

    @cached_property
    def inverse_mass(self) -> Array:
        """(M + A)^-1 (6, 6)."""
        return np.linalg.inv(self.mass)

    @property
    def damping_at_speed(self) -> Array:
        """D + U (M L + L^T A) (6, 6), what multiplies nu."""
        return self.damping + self.speed * (self.body_mass @ TURNING + TURNING.T @ self.added_mass)

    @cached_property
    def memory_at_speed(self) -> MemoryModel | MemoryKernel:
        """Memory whose force is mu + U L^T p_m; p_m = C A^-1 x, or the convolution with the integral of K."""
        memory, carry = self.memory, self.speed * TURNING.T
        if self.speed == 0.0:
            return memory
        if isinstance(memory, MemoryModel):
            return replace(memory, C=memory.C + carry @ momentum_output(memory))
        return MemoryKernel(memory.t, memory.K + carry @ memory.spline.antiderivative()(memory.t))

    def memory_transfer(self, omega: ArrayLike) -> ComplexArray:
        """Return K_hat(i omega) (n, 6, 6) of the fluid memory as the time loop uses it."""
        w = np.atleast_1d(np.asarray(omega, dtype=float))
        memory = self.memory_at_speed
        if isinstance(memory, MemoryKernel):
            return kernel_transform(memory, w)
        return memory.C @ resolvent(memory.A, w, memory.B)

    def impedance(self, omega: ArrayLike) -> ComplexArray:
        """Return Z(omega) (n, 6, 6) with Z eta = F for harmonic motions at the signed encounter frequency omega.

        Notes
        -----
        Z = (i omega (M + A) + D + U (M L + L^T A) + K_hat_U)(i omega - U L) + C; -omega^2 (M + A) + i omega (D + K_hat) + C at
        zero speed.
        """
        s = 1j * np.atleast_1d(np.asarray(omega, dtype=float))[:, None, None]
        inner = s * self.mass + self.damping_at_speed + self.memory_transfer(s[:, 0, 0].imag)
        return inner @ (s * np.eye(6) - self.speed * TURNING) + self.stiffness

    @property
    def state_space(self) -> MemoryModel:
        """The fluid memory as a state space, in real modal form; of order 0 where there is none."""
        memory = self.memory_at_speed
        if isinstance(memory, MemoryKernel):
            raise InputError("fluid memory: a state-space model expected, a Convolution found.")
        return memory

    @cached_property
    def poles(self) -> Array:
        """Eigenvalues of :meth:`closed_loop`, 1/s."""
        return np.linalg.eigvals(self.closed_loop())

    def closed_loop(self) -> Array:
        """Return the matrix (12 + n, 12 + n) of z' = A z + ... for z = (eta, nu, x) with a state-space memory or none."""
        A, B, C = self.state_space.A, self.state_space.B, self.state_space.C
        W, n = self.inverse_mass, len(A)
        return np.block(
            [
                [self.speed * TURNING, np.eye(6), np.zeros((6, n))],
                [-W @ self.stiffness, -W @ self.damping_at_speed, -W @ C],
                [np.zeros((n, 6)), B, A],
            ]
        )


def bind_loads(vessel: Vessel) -> tuple[Terms, ...]:
    """Return what each load of a vessel adds to the equations of motion."""
    surroundings = Surroundings(vessel.body, vessel.speed, vessel.heading)
    return tuple(load.bind(surroundings) for load in vessel.loads)


def assemble(vessel: Vessel, *, bound: tuple[Terms, ...] | None = None, large: bool = False) -> LinearSystem:
    """Return the equations of motion of a vessel; for large motions those parts that are linear all the same.

    Raises
    ------
    InputError
        Mass plus added mass not positive definite; damping ratio of a degree of freedom without stiffness.
    """
    bound = bind_loads(vessel) if bound is None else bound
    terms = tuple(term if large or term.small is None else term.small for term in bound)
    memories = [t.memory for t in terms if t.memory is not None]
    if len(memories) > 1:
        raise InputError(f"Vessel: at most one load with fluid memory expected, {len(memories)} found.")
    system = LinearSystem(
        body_mass=vessel.body.matrix,
        added_mass=_total([t.added_mass for t in terms], (6, 6)),
        damping=_total([t.damping for t in terms], (6, 6)),
        stiffness=_total([t.stiffness for t in terms], (6, 6)),
        constant=_total([t.constant for t in terms], (6,)),
        memory=_memory(memories),
        names=vessel.names,
        terms=terms,
        speed=vessel.speed,
        heading=vessel.heading,
    )
    _check_mass(system)
    stiffness = _total([(t.small or t).stiffness for t in bound], (6, 6))
    return _with_damping_ratios(system, stiffness)


def critical_damping(system: LinearSystem, dof: int, stiffness: Array | None = None) -> float:
    """Return 2 sqrt(C (M + A(w_n))) of an uncoupled degree of freedom at its natural frequency w_n = sqrt(C / (M + A(w_n)))."""
    C, M = (system.stiffness if stiffness is None else stiffness)[dof, dof], system.mass[dof, dof]
    if C <= 0.0:
        what = "Give LinearDamping a matrix instead, or add restoring or mooring."
        if C < 0.0 and DOFS[dof] in ("roll", "pitch"):
            what = "The vessel would capsize: its metacentric height is negative. Check the height of the centre of gravity."
        raise InputError(
            f"damping ratio of {DOFS[dof]}: a positive stiffness expected, {C:g} found, so there is no critical damping. {what}"
        )
    total = M
    for _ in range(100):
        w = np.sqrt(C / total)
        change = M + system.memory_transfer([w])[0, dof, dof].imag / w - total
        total += change
        if abs(change) < 1e-12 * total:
            break
    return float(2.0 * np.sqrt(C * total))


def warn_of_growth(system: LinearSystem) -> None:
    """Warn where a motion of the undisturbed vessel grows by itself."""
    rate = system.poles.real.max()
    if rate > _GROWTH:
        w = abs(system.poles[system.poles.real.argmax()].imag)
        how = f"oscillates at {w:.3g} rad/s and grows" if w > 0.0 else "grows"
        why = "Check restoring (GM) and damping; if it comes with the memory model, that model is not passive."
        if system.speed > 0.0:
            why = "At speed the fluid's own (Munk) moment turns a hull without lift off its course: add HullLift or steering."
        warnings.warn(
            f"Vessel: a motion {how} by itself, e-fold in {1.0 / rate:.3g} s. {why}",
            OgilvieWarning,
            stacklevel=5,
        )


def _with_damping_ratios(system: LinearSystem, stiffness: Array) -> LinearSystem:
    """Turn fractions of critical damping into damping matrices, with the stiffness of small motions."""
    terms = []
    for term in system.terms:
        D = np.zeros(6)
        for i in np.flatnonzero(term.damping_ratio):
            D[i] = term.damping_ratio[i] * critical_damping(system, int(i), stiffness)
        terms.append(replace(term, damping=term.damping + np.diag(D), damping_ratio=np.zeros(6)) if D.any() else term)
    damping = _total([t.damping for t in terms], (6, 6))
    return replace(system, damping=damping, terms=tuple(terms))


def _memory(found: list[MemoryModel | MemoryKernel]) -> MemoryModel | MemoryKernel:
    if not found:
        return MemoryModel(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)))
    return modal_memory(found[0]) if isinstance(found[0], MemoryModel) else found[0]


def added_mass_at_rest(system: LinearSystem) -> Array:
    """Return A(0) = A_inf - C A^-2 B (6, 6), the added mass of slow motions that A_inf and a state-space memory have."""
    memory = system.memory
    if isinstance(memory, MemoryKernel) or not len(memory.A):
        return system.added_mass
    return system.added_mass - momentum_output(memory) @ np.linalg.solve(memory.A, memory.B)


def momentum_output(model: MemoryModel) -> Array:
    """Return C A^-1 (6, n): the momentum p_m = C A^-1 x of the fluid memory, p_m' = mu since K_hat(0) = -C A^-1 B = 0."""
    return np.linalg.solve(model.A.T, model.C.T).T if len(model.A) else np.zeros((6, 0))


def _total(arrays: list[Array], shape: tuple[int, ...]) -> Array:
    return np.sum(arrays, axis=0) if arrays else np.zeros(shape)


def _check_mass(system: LinearSystem) -> None:
    scale = np.sqrt(np.diag(system.body_mass))
    smallest = np.linalg.eigvalsh((system.mass + system.mass.T) / np.outer(scale, scale) / 2)[0]
    if not smallest > 0.0:
        raise InputError(
            "mass plus added mass at infinite frequency: a positive definite matrix expected, smallest eigenvalue "
            f"{smallest:.3g} (scaled by the body's mass) found. Check the added mass, its units and reference point."
        )
