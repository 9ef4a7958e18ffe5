"""The linear equations of motion of a vessel, gathered from its loads."""

import warnings
from dataclasses import dataclass
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
_GROWTH = 1e-5  # 1/s, above the rounding of the double zero poles of a free vessel


@dataclass(frozen=True, eq=False)
class LinearSystem:
    """(M + A) nu' + D nu + C eta + mu = F_const + F_wave(t), eta' = nu, in the steady frame of the vessel.

    Parameters
    ----------
    body_mass : (6, 6) array
        M of the rigid body.
    added_mass, damping, stiffness : (6, 6) array
        Sums over the loads.
    constant : (6,) array
        N, N m.
    memory : MemoryModel or MemoryKernel
        A model without states where no load has a memory.
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

    def memory_transfer(self, omega: ArrayLike) -> ComplexArray:
        """Return K_hat(i omega) (n, 6, 6) of the fluid memory as the time loop uses it."""
        w = np.atleast_1d(np.asarray(omega, dtype=float))
        if isinstance(self.memory, MemoryKernel):
            return kernel_transform(self.memory, w)
        return self.memory.C @ resolvent(self.memory.A, w, self.memory.B)

    def impedance(self, omega: ArrayLike) -> ComplexArray:
        """Return Z(omega) (n, 6, 6) = -omega^2 (M + A) + i omega (D + K_hat(i omega)) + C."""
        w = np.atleast_1d(np.asarray(omega, dtype=float))[:, None, None]
        return -(w**2) * self.mass + 1j * w * (self.damping + self.memory_transfer(w[:, 0, 0])) + self.stiffness

    @property
    def state_space(self) -> MemoryModel:
        """The fluid memory as a state space, in real modal form; of order 0 where there is none."""
        if isinstance(self.memory, MemoryKernel):
            raise InputError("fluid memory: a state-space model expected, a Convolution found.")
        return self.memory

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
                [np.zeros((6, 6)), np.eye(6), np.zeros((6, n))],
                [-W @ self.stiffness, -W @ self.damping, -W @ C],
                [np.zeros((n, 6)), B, A],
            ]
        )


def assemble(vessel: Vessel) -> LinearSystem:
    """Return the equations of motion of a vessel.

    Raises
    ------
    InputError
        Mass plus added mass not positive definite; damping ratio of a degree of freedom without stiffness.
    """
    surroundings = Surroundings(vessel.body, vessel.speed, vessel.heading)
    terms = tuple(load.bind(surroundings) for load in vessel.loads)
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
    return _with_damping_ratios(system)


def critical_damping(system: LinearSystem, dof: int) -> float:
    """Return 2 sqrt(C (M + A(w_n))) of an uncoupled degree of freedom at its natural frequency w_n = sqrt(C / (M + A(w_n)))."""
    C, M = system.stiffness[dof, dof], system.mass[dof, dof]
    if C <= 0.0:
        raise InputError(
            f"damping ratio of {DOFS[dof]}: a positive stiffness expected, {C:g} found, so there is no critical damping. "
            "Give LinearDamping a matrix instead, or add restoring or mooring."
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
        warnings.warn(
            f"Vessel: a motion {how} by itself, e-fold in {1.0 / rate:.3g} s. Check restoring (GM) and damping; if it comes "
            "with the memory model, that model is not passive.",
            OgilvieWarning,
            stacklevel=5,
        )


def _with_damping_ratios(system: LinearSystem) -> LinearSystem:
    """Turn fractions of critical damping into damping matrices."""
    terms = []
    for term in system.terms:
        D = np.zeros(6)
        for i in np.flatnonzero(term.damping_ratio):
            D[i] = term.damping_ratio[i] * critical_damping(system, int(i))
        terms.append(_replace_damping(term, np.diag(D)) if D.any() else term)
    damping = _total([t.damping for t in terms], (6, 6))
    return LinearSystem(**{**vars(system), "damping": damping, "terms": tuple(terms)})


def _replace_damping(term: Terms, extra: Array) -> Terms:
    return Terms(**{**vars(term), "damping": term.damping + extra, "damping_ratio": np.zeros(6)})


def _memory(found: list[MemoryModel | MemoryKernel]) -> MemoryModel | MemoryKernel:
    if not found:
        return MemoryModel(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)))
    return modal_memory(found[0]) if isinstance(found[0], MemoryModel) else found[0]


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
