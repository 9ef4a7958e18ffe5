"""The hybrid time-domain method as published: flat constant panels inside, the transient Green function outside."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.plain_boundary import FlatBoundary
from ogilvie.bem.plain_checks import DOFS, PARITY, check_arguments, check_bounded, time_step
from ogilvie.bem.plain_matrices import Response, histories, leapfrog_limit, responses
from ogilvie.errors import InputError
from ogilvie.memory.table import Retardation

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class PlainHybrid:
    """Retardation functions by the plain hybrid method.

    Parameters
    ----------
    t : (n_t,) array
        s.
    K : (n_t, m, m) array
        Retardation functions of the dofs, SI; first index the force.
    A_inf : (m, m) array
        Added mass at infinite frequency, SI.
    dofs : tuple of str
    step_limit : float
        Largest stable time step, s.
    storage : dict
        Bytes of the matrices ("responses") and of the Green function's history ("history").
    seconds : dict
        Wall time of the Rankine matrices and their solution ("rankine"), the Green function ("green"), the time steps ("run").
    """

    t: Array
    K: Array
    A_inf: Array
    dofs: tuple[str, ...]
    step_limit: float
    storage: dict[str, int]
    seconds: dict[str, float]

    def retardation(self) -> Retardation:
        """Return the table that the rest of the package works with."""
        return Retardation(
            self.t, self.K, self.A_inf, dofs=self.dofs, source="hybrid time-domain method, transient Green function outside"
        )


def plain_hybrid(
    boundary: FlatBoundary,
    *,
    duration: float,
    dt: float | None = None,
    dofs: tuple[str, ...] = DOFS,
    rho: float = 1025.0,
    g: float = 9.81,
    points: int = 3,
    accuracy: float = 1e-6,
    memory_limit: float = 4e9,
) -> PlainHybrid:
    """Return retardation functions and infinite added mass of a hull by the method of Guo et al.

    Parameters
    ----------
    boundary : FlatBoundary
        Hull, free surface and control surface.
    duration : float
        Last time of K, s.
    dt : float, optional
        Time step, s; by default half the largest stable one. `duration` is rounded up to a multiple of it.
    dofs : tuple of str
        Motions and forces wanted.
    rho, g : float
        kg/m3, m/s2.
    points : int
        Gauss points along each side of the control surface's panels for the transient Green function, 1..8; 1: the centroid.
    accuracy : float
        Of the Rankine coefficients, see `rankine`.
    memory_limit : float
        Largest storage of the Green function's history, bytes.

    Returns
    -------
    PlainHybrid

    Raises
    ------
    InputError
        A time step that the leapfrog does not bear, storage beyond the limit, panels that do not enclose the fluid, unknown
        dofs, numbers out of range.
    ConvergenceError
        The size of some K_jj exceeds 2 K_jj(0): no fluid does that, the solution grows.

    Notes
    -----
    The potential of a unit impulse of velocity is psi delta(t) + chi(t); A_inf = rho int psi n dS, K = rho int chi_t n dS. With
    the responses of `plain_matrices` psi follows from phi_F = 0; then in each step

        chi_F(M+1) = 2 chi_F(M) - chi_F(M-1) - g dt^2 chi_n,F(M),   chi_F(0) = 0, chi_F(1) = -g dt psi_n,F,

    which is Eqs. (18), (19) with the normal derivative that (19) lacks, the history r_C over all earlier steps (trapezoidal
    rule, whose ends are zero), and one product with a matrix for all modes of a parity; chi_t by central differences. See
    docs/theory/transient_green.md.

    References
    ----------
    Y. Guo, W. Wang, T. Chen, X. Tong, Application of symmetry properties on the hybrid method in time domain, Eqs. (1)-(33).

    Examples
    --------
    >>> from ogilvie.bem.plain_boundary import hemisphere_boundary
    >>> coarse = hemisphere_boundary(1.0, 3.0, around=8, rings=(4, 5, 4))
    >>> result = plain_hybrid(coarse, duration=1.0, dofs=("heave",), rho=1.0, g=1.0)
    >>> bool(abs(result.A_inf[0, 0] / (np.pi / 3) - 1) < 0.1)
    True
    """
    check_arguments(duration=duration, dt=dt, dofs=dofs, rho=rho, g=g, points=points)
    parities = _parities(boundary, dofs)
    clock = [time.perf_counter()]
    found = responses(boundary, np.array(list(parities)), accuracy=accuracy)
    limit = min(leapfrog_limit(r, boundary.counts, g=g) for r in found)
    step = time_step(dt, limit)
    steps = int(np.ceil(duration / step - 1e-9)) + 1
    n_c = boundary.counts[0]
    needed = 16 * n_c * n_c * (steps + 1) * (len(parities) + (len(parities) > 1))
    if needed > memory_limit:
        raise InputError(
            f"plain_hybrid: at most {memory_limit:.3g} bytes for the history expected, {needed:.3g} needed "
            f"({steps} steps, {n_c} panels of the control surface). Use symmetry, fewer panels, a larger dt or memory_limit."
        )
    clock.append(time.perf_counter())
    kernels = histories(boundary, np.array(list(parities)), g=g, step=step, steps=steps, points=points)
    clock.append(time.perf_counter())
    K, A_inf = np.zeros((steps, len(dofs), len(dofs))), np.zeros((len(dofs), len(dofs)))
    for members, response, W in zip(parities.values(), found, kernels, strict=True):
        modes = boundary.modes[:, [DOFS.index(dofs[i]) for i in members]]
        psi, chi = impulse_response(response, W, modes, boundary.counts, g=g, step=step)
        force = rho * len(boundary.hull.images) * (modes * boundary.hull.areas[:, None]).T
        A_inf[np.ix_(members, members)] = force @ psi
        K[:, np.array(members)[:, None], members] = rate(np.einsum("jh,thk->tjk", force, chi), step)
    clock.append(time.perf_counter())
    check_bounded(K, step, dofs, float(np.linalg.norm(boundary.hull.corners, axis=-1).max()))
    return PlainHybrid(
        t=step * np.arange(steps),
        K=K,
        A_inf=A_inf,
        dofs=tuple(dofs),
        step_limit=limit,
        storage={"responses": sum(r.storage for r in found), "history": sum(W.nbytes for W in kernels)},
        seconds=dict(zip(("rankine", "green", "run"), np.diff(clock).tolist(), strict=True)),
    )


def impulse_response(
    response: Response, W: Array, modes: Array, counts: tuple[int, int, int], *, g: float, step: float
) -> tuple[Array, Array]:
    """Return psi (n_h, m) and chi (n_t + 1, n_h, m) on the hull after impulses of normal velocity (n_h, m), n_t lags of W."""
    n_c, n_f, n_h = counts
    n_t, m = W.shape[1], modes.shape[1]
    instant = response.V @ modes
    psi_n, rise, psi = instant[:n_c], instant[n_c : n_c + n_f], instant[n_c + n_f :]
    kernel = W.reshape(n_c, -1)
    past = np.zeros((n_t + 1, 2 * n_c, m))  # (chi, chi_n) dt on C, latest first: row n_t - M holds step M
    past[n_t] = np.concatenate([response.Z @ psi_n, psi_n])
    chi = np.zeros((n_t + 1, n_h, m))
    before, now = np.zeros((n_f, m)), -g * step * rise
    for M in range(1, n_t + 1):
        r_C = kernel[:, : M * 2 * n_c] @ past[n_t + 1 - M :].reshape(-1, m)
        x = response.X @ np.concatenate([r_C, now])
        chi[M] = x[n_c + n_f :]
        past[n_t - M, :n_c] = step * (response.Z @ x[:n_c] - response.Y @ r_C)
        past[n_t - M, n_c:] = step * x[:n_c]
        before, now = now, 2.0 * now - before - g * step**2 * x[n_c : n_c + n_f]
    return psi, chi


def rate(values: Array, step: float) -> Array:
    """Return the time derivative (n_t, ...) of values (n_t + 1, ...) that start from zero as an odd function of time."""
    extended = np.concatenate([-values[1:2], values])
    return np.asarray((extended[2:] - extended[:-2]) / (2.0 * step))


def _parities(boundary: FlatBoundary, dofs: tuple[str, ...]) -> dict[tuple[int, int], list[int]]:
    """Return positions in `dofs` for each parity that the symmetry of the boundary keeps apart."""
    groups: dict[tuple[int, int], list[int]] = {}
    for i, dof in enumerate(dofs):
        x, y = PARITY[dof]
        parity = (x if boundary.symmetry == "xz+yz" else 1, y if boundary.symmetry != "none" else 1)
        groups.setdefault(parity, []).append(i)
    return groups
