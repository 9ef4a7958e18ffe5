"""A fluid-memory model as a linear state space: K(t) = C exp(A t) B."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class StateSpace:
    """Memory force mu = C x with x' = A x + B nu, hence K(t) = C exp(A t) B and no direct term.

    Parameters
    ----------
    A : (n, n) array
        1/s. Stable: all eigenvalues in the left half plane. Real block-diagonal (1x1 and 2x2 blocks) when made by
        :func:`ogilvie.identify`.
    B : (n, m) array
    C : (m, n) array
        m degrees of freedom.
    dofs : tuple of str
        Names of the m degrees of freedom.
    r2 : (m, m) array
        Coefficient of determination of each entry of K (paper A, Eq. 7); NaN where the entry is zero by symmetry.
    r2_added_mass, r2_damping : (m, m) array
        The same of A(omega) and B(omega) at the frequencies used.
    passivity_margin : float
        Smallest eigenvalue of Re K_hat(i omega) over 4001 frequencies, each dof scaled by its largest damping; 0 for a passive
        model (reached at zero frequency), negative where the model feeds energy into the vessel.
    is_passive : bool
        Certified at all frequencies by the Hamiltonian matrix, to 1e-6 of that scale.
    motion_change : (m,) array, optional
        Relative change of the motion of the free-floating body under unit forces, see
        :func:`ogilvie.memory.motion.motion_change`; where mass and restoring were given.
    A_inf : (m, m) array, optional
        Added mass at infinite frequency that goes with the model, SI.
    method : str
        How it was identified.
    notes : tuple of str
        What the user should know about the fit.
    """

    A: Array
    B: Array
    C: Array
    dofs: tuple[str, ...] = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    r2: Array | None = None
    r2_added_mass: Array | None = None
    r2_damping: Array | None = None
    passivity_margin: float | None = None
    is_passive: bool | None = None
    motion_change: Array | None = None
    A_inf: Array | None = None
    method: str = "given"
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        A, B, C = (np.array(x, dtype=float) for x in (self.A, self.B, self.C))
        n, m = A.shape[0], len(self.dofs)
        if A.shape != (n, n) or B.shape != (n, m) or C.shape != (m, n):
            raise InputError(f"state space: A (n, n), B (n, {m}), C ({m}, n) expected, {A.shape}, {B.shape}, {C.shape} found.")
        for name, value in (("A", A), ("B", B), ("C", C)):
            if not np.all(np.isfinite(value)):
                raise InputError(f"state space: {name} holds NaN or infinite numbers.")
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A)

    @property
    def poles(self) -> NDArray[np.complex128]:
        """Eigenvalues of A, 1/s."""
        return np.linalg.eigvals(self.A).astype(complex)

    @property
    def is_stable(self) -> bool:
        """Whether every pole lies in the open left half plane."""
        return bool(self.order == 0 or self.poles.real.max() < 0.0)

    def states(self, t: ArrayLike) -> Array:
        """Return exp(A t) B, shape (n_t, n, m): the states after a unit impulse of each velocity."""
        lam, V, W = self._modes()
        decay = np.exp(np.outer(np.atleast_1d(np.asarray(t, dtype=float)), lam))
        return np.einsum("ik,tk,kj->tij", V, decay, W, optimize=True).real

    def impulse(self, t: ArrayLike) -> Array:
        """Return K(t) = C exp(A t) B, shape (n_t, m, m)."""
        return self.C @ self.states(t)

    def transfer(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Return K_hat(i omega) = C (i omega - A)^-1 B = B(omega) + i omega (A(omega) - A_inf), shape (n_w, m, m)."""
        omega = np.atleast_1d(np.asarray(omega, dtype=float))
        lam, V, W = self._modes()
        return np.einsum("ik,wk,kj->wij", self.C @ V, 1.0 / (1j * omega[:, None] - lam), W, optimize=True)

    def _modes(self) -> tuple[Array, Array, Array]:
        lam, V = scipy.linalg.eig(self.A)
        return lam, V, np.linalg.solve(V, self.B.astype(complex))

    def __str__(self) -> str:
        lines = [f"State-space model of the fluid memory: {self.order} states ({self.method}), slowest pole {self._slowest()}"]
        if self.is_passive is not None:
            verdict = "passive at all frequencies" if self.is_passive else "NOT passive"
            lines.append(f"{verdict}; smallest scaled eigenvalue of Re K_hat {self.passivity_margin:.2g}")
        if self.motion_change is not None:
            worst = int(np.argmax(self.motion_change))
            lines.append(
                f"motion of the floating body under unit forces changes by at most {self.motion_change[worst]:.2%} "
                f"({self.dofs[worst]})"
            )
        for name, r2 in (("K", self.r2), ("A", self.r2_added_mass), ("B", self.r2_damping)):
            if r2 is not None:
                lines.append(f"R2 of {name} " + "".join(f"{d:>9}" for d in self.dofs))
                for d, row in zip(self.dofs, r2, strict=True):
                    lines.append(f"{d:8}" + "".join("        -" if np.isnan(v) else f"{v:9.4f}" for v in row))
        return "\n".join(lines + [f"note: {n}" for n in self.notes])

    def _slowest(self) -> str:
        return "none" if self.order == 0 else f"{self.poles.real.max():.3g} 1/s"


def modal_form(A: Array, B: Array, C: Array) -> tuple[Array, Array, Array]:
    """Return the model in real modal form: 2x2 blocks [[a, b], [-b, a]] for pairs of poles a +- ib, then real poles.

    Raises
    ------
    InputError
        Poles so close together that A has no full set of eigenvectors in double precision.

    Examples
    --------
    >>> A, B, C = modal_form(np.array([[0.0, 1.0], [-5.0, -2.0]]), np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]]))
    >>> A.round(9)
    array([[-1.,  2.],
           [-2., -1.]])
    """
    lam, V = scipy.linalg.eig(A)
    T = np.zeros(A.shape)
    blocks = np.zeros(A.shape)
    pairs = [k for k in np.lexsort((np.abs(lam), lam.imag == 0.0)) if lam[k].imag >= 0.0]
    at = 0
    for k in pairs:
        if lam[k].imag > 0.0:
            T[:, at], T[:, at + 1] = V[:, k].real, V[:, k].imag
            blocks[at : at + 2, at : at + 2] = [[lam[k].real, lam[k].imag], [-lam[k].imag, lam[k].real]]
            at += 2
        else:
            T[:, at] = V[:, k].real
            blocks[at, at] = lam[k].real
            at += 1
    if at != len(A) or np.linalg.cond(T) > 1e13:
        raise InputError("modal_form: poles that coincide in double precision; use a lower order.")
    size = np.linalg.norm(np.linalg.solve(T, B), axis=1)
    for i in np.flatnonzero(np.diag(blocks, 1)):
        size[i] = size[i + 1] = np.hypot(size[i], size[i + 1])
    size = np.where(size > 0, size, 1.0)
    T = T * size  # every mode is driven by an input of unit size
    return blocks, np.linalg.solve(T, B), C @ T


def stack_blocks(models: list[tuple[list[int], Array, Array, Array]], m: int) -> tuple[Array, Array, Array]:
    """Return one model of m degrees of freedom from models of blocks [(indices, A, B, C)] that do not interact."""
    A = scipy.linalg.block_diag(*[model[1] for model in models])
    B, C = np.zeros((len(A), m)), np.zeros((m, len(A)))
    at = 0
    for block, a, b, c in models:
        B[at : at + len(a), block] = b
        C[np.array(block)[:, None], np.arange(at, at + len(a))] = c
        at += len(a)
    return A, B, C
