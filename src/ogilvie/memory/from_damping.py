"""K(t) from the damping: the cosine form, integrated exactly piece by piece."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.curves import RadiationCurves, cosine_integrals
from ogilvie.memory.fourier import fourier_integral, legendre_pieces

Array = NDArray[Any]


def kernel_from_damping(curves: RadiationCurves, A_inf: Array | None, t: Array, interpolation: str) -> Array:
    """Return K(t) = (2/pi) int_0^inf B(omega) cos(omega t) d omega, shape (n_t, m, m).

    Parameters
    ----------
    curves : RadiationCurves
    A_inf : (m, m) array or None
        Not used; every way to K(t) has this signature.
    t : (n_t,) array
        Any times >= 0, s.
    interpolation : {"spline", "linear"}
        Of B between the frequencies, from B(0) = 0 on.

    References
    ----------
    Ogilvie (1964); paper A (Yuan 2017), Eq. (4).

    Examples
    --------
    >>> w = np.linspace(0.02, 30.0, 1500)
    >>> B = (2 * w**2 / (1 + w**2) ** 2)[:, None, None]  # of K = (1 - t) exp(-t)
    >>> from ogilvie.memory.curves import continued
    >>> curves, _ = continued(w, B, B, ("heave",), "fit")
    >>> kernel_from_damping(curves, None, np.array([0.0, 1.0, 2.0]), "spline")[:, 0, 0].round(4) + 0.0
    array([ 1. ,  0. , -0.1353])
    """
    w = curves.omega_from_zero
    data = fourier_integral(w, legendre_pieces(w, curves.from_zero(curves.B), interpolation), t).real
    return 2 / np.pi * (data + cosine_integrals(curves.tails, curves.omega[-1], t))
