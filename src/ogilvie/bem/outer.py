"""The open sea outside the control hemisphere as passive oscillators, one set per azimuthal mode; stored with the package."""

from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.outer_functions import depth_functions
from ogilvie.bem.outer_oscillators import solved
from ogilvie.errors import InputError

__all__ = ["OuterMode", "depth_functions", "outer_mode"]

Array = NDArray[Any]

DATA = "outer.npz"


@dataclass(frozen=True, eq=False)
class OuterMode:
    """Potential on the control surface from its normal velocity, for cos(m alpha) or sin(m alpha) in the azimuth.

    Coefficients are those of the depth functions y_mj of :func:`depth_functions`; unit length is the control radius Rc, unit
    time sqrt(Rc / g), density 1. The normal points out of the inner domain, away from O. With n oscillators w,

        phi_C = -N_inf q - b^T w,     w'' + D D^T w' + W^2 w = b q,     N_inf, W^2 > 0.

    Whatever q does, the sea never gives back more energy than it got.

    Attributes
    ----------
    m : int
    instantaneous : (J, J) array
        N_inf, symmetric.
    inputs : (n, J) array
        b; b^T b = K(0+).
    dampers : (n, r) array
        D; r = 1, as each mode radiates one wave.
    frequencies : (n,) array
        W, ascending.
    """

    m: int
    instantaneous: Array
    inputs: Array
    dampers: Array
    frequencies: Array

    def at(self, omega: Array) -> Array:
        """Return N_inf + b^T (s^2 + s D D^T + W^2)^-1 b at s = i omega, shape (f, J, J)."""
        Y = solved(self.frequencies, self.inputs, self.dampers, np.asarray(omega, dtype=float))
        return np.asarray(self.instantaneous + self.inputs.T @ Y)

    def memory(self, t: Array) -> Array:
        """Return K(t) = b^T w'(t) (n_t, J, J), w' that of oscillators hit by b: the transform of i omega (N - N_inf)."""
        n = len(self.frequencies)
        W = np.diag(self.frequencies)
        values, modes = np.linalg.eig(np.block([[-self.dampers @ self.dampers.T, -W], [W, np.zeros((n, n))]]))
        right = np.linalg.solve(modes, np.vstack([self.inputs, 0 * self.inputs]).astype(complex))
        left = self.inputs.T @ modes[:n]
        decay = np.exp(np.multiply.outer(np.asarray(t, dtype=float), values))
        return np.asarray(np.einsum("ik,tk,kj->tij", left, decay, right, optimize=True).real)


def outer_mode(m: int, count: int) -> OuterMode:
    """Return the outer domain of azimuthal mode m in the first `count` depth functions.

    Parameters
    ----------
    m : int
    count : int
        J.

    Raises
    ------
    InputError
        Beyond the stored data.

    Examples
    --------
    >>> sea = outer_mode(1, 1)  # y_10 is sin(theta): surge of the hemisphere
    >>> round(float(sea.instantaneous[0, 0]), 6)  # 4/pi - 1
    0.27324
    >>> round(float(sea.inputs[:, 0] @ sea.inputs[:, 0]), 6)  # K(0+)
    0.547681
    """
    stored = _stored()
    modes, most = stored["instantaneous"].shape[:2]
    if not 0 <= m < modes:
        raise InputError(f"outer_mode: azimuthal mode 0 to {modes - 1} expected, {m} found; leave higher modes out.")
    if not 1 <= count <= most:
        raise InputError(f"outer_mode: 1 to {most} depth functions expected, {count} found; use {most} at most.")
    inputs = stored["inputs"][m][:, :count]
    return OuterMode(
        m, stored["instantaneous"][m][:count, :count], inputs, stored["dampers"][m][:, None], stored["frequencies"][m]
    )


@cache
def _stored() -> dict[str, Array]:
    with resources.files("ogilvie.bem").joinpath(DATA).open("rb") as file, np.load(file) as arrays:
        stored = {name: arrays[name] for name in arrays.files}
    for array in stored.values():
        array.setflags(write=False)
    return stored
