"""The free-surface part of the transient Green function of deep water, with its gradient."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.bem.transient_green_kernel import fill_scattered
from ogilvie.bem.transient_green_table import chebyshev_table
from ogilvie.errors import InputError

Array = NDArray[Any]


class TransientGreen(NamedTuple):
    """Value (...) in 1/(m s) and gradient (..., 3) with respect to the field point, 1/(m2 s)."""

    value: Array
    gradient: Array


def transient_green(field: ArrayLike, source: ArrayLike, t: ArrayLike, *, g: float = 9.81) -> TransientGreen:
    """Return the waves that an impulsive source of deep water has made after the time t.

    Parameters
    ----------
    field, source : (..., 3) arrays
        Points x and xi at or below the still water z = 0, m.
    t : (...) array
        Time since the impulse, >= 0, s. Points and times broadcast.
    g : float
        m/s2.

    Returns
    -------
    TransientGreen
        Value and gradient with respect to `field`. With respect to `source` the horizontal components change their sign.

    Raises
    ------
    InputError
        Points above the water, both points at one place of the surface, t < 0, g <= 0, NaN, shapes that do not broadcast.

    Notes
    -----
    The potential of a source 1/r switched on for an instant is (1/r - 1/r') delta(t) + G_f(t),

        G_f = 2 int_0^inf (g k)^(1/2) sin((g k)^(1/2) t) exp(k Z) J_0(k R) dk = 2 g^(1/2) r'^(-3/2) F(mu, beta),

    R and Z = z + zeta the horizontal and vertical distance from the source's image in z = 0, r' = (R^2 + Z^2)^(1/2),
    mu = -Z/r', beta = t (g/r')^(1/2). The gradient is dG/dZ = -2 g^(1/2) r'^(-5/2) F'' (that is, -G_tt/g) and
    dG/dR = -2 g^(1/2) r'^(-5/2) H with H of `transient_green_kernel`. For beta < 12 a table that was summed with 32 digits
    is interpolated, beyond there are asymptotic series. Errors are below 1e-12 of each integral's largest value over mu at
    that beta, for all mu = 0..1; for beta > 64 rounding of the phase (1 - mu^2)^(1/2) beta^2/4 adds about 1e-16 of it.

    References
    ----------
    J. V. Wehausen, E. V. Laitone, Surface Waves (1960), section 13; A. H. Clement, An ordinary differential equation for the
    Green function of time-domain free-surface hydrodynamics, Journal of Engineering Mathematics 33 (1998) 201-217.

    Examples
    --------
    Above a source, late: the algebraic part -8 g^(1/2) r'^(-3/2) beta^(-3) = -8/(g t^3) alone remains.

    >>> late = transient_green([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 30.0, g=1.0)
    >>> bool(np.isclose(late.value, -8.0 / 30.0**3, rtol=0.02))
    True
    """
    x, xi, time = _checked(field, source, t, g)
    d = x - xi
    d[..., 2] = x[..., 2] + xi[..., 2]
    r = np.sqrt((d**2).sum(axis=-1))
    if not np.all(r > 0.0):
        raise InputError("transient_green: field and source at one place of the surface z = 0; move one of them below it.")
    mu, beta = np.minimum(-d[..., 2] / r, 1.0), time * np.sqrt(g / r)
    out = np.empty((r.size, 3))
    fill_scattered(mu.ravel(), beta.ravel(), chebyshev_table(), out)
    F, F2, H = out.T.reshape(3, *r.shape)
    scale = 2.0 * np.sqrt(g) * r**-2.5
    return TransientGreen(
        scale * r * F, np.stack([-scale * H * d[..., 0] / r, -scale * H * d[..., 1] / r, scale * F2], axis=-1)
    )


def _checked(field: ArrayLike, source: ArrayLike, t: ArrayLike, g: float) -> tuple[Array, Array, Array]:
    """Return the points (..., 3) and times (...) broadcast against each other."""
    try:
        x, xi, time = (np.asarray(a, dtype=float) for a in (field, source, t))
    except (TypeError, ValueError):
        raise InputError("transient_green: arrays of numbers expected for field, source and t.") from None
    for name, points in (("field", x), ("source", xi)):
        if points.ndim == 0 or points.shape[-1] != 3:
            raise InputError(f"transient_green: {name}: a (..., 3) array expected, shape {points.shape} found.")
        if not (np.all(np.isfinite(points)) and np.all(points[..., 2] <= 0.0)):
            raise InputError(f"transient_green: {name}: finite points with z <= 0 expected, NaN or z > 0 found.")
    if not (np.all(np.isfinite(time)) and np.all(time >= 0.0)):
        raise InputError("transient_green: t: finite times >= 0 expected, NaN or t < 0 found.")
    if not (np.isfinite(g) and g > 0.0):
        raise InputError(f"transient_green: g: a positive number expected, {g!r} found.")
    try:
        shape = np.broadcast_shapes(x.shape[:-1], xi.shape[:-1], time.shape)
    except ValueError:
        raise InputError(
            f"transient_green: shapes that broadcast expected, field {x.shape}, source {xi.shape}, t {time.shape} found."
        ) from None
    return np.broadcast_to(x, (*shape, 3)), np.broadcast_to(xi, (*shape, 3)), np.broadcast_to(time, shape)
