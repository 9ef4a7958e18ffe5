"""Wave part of roll damping: about the axis through the centre of gravity, and how it changes with the speed."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import embed
from ogilvie.loads.given import column
from ogilvie.units import GRAVITY

Array = NDArray[Any]


def wave_speed_factor(omega: ArrayLike, *, speed: ArrayLike, draught: float, g: float = GRAVITY) -> Array:
    """Return the wave damping of roll at speed over that at zero speed.

    Notes
    -----
    ((A2 + 1) + (A2 - 1) tanh(20 (tau - 0.3)) + (2 A1 - A2 - 1) exp(-150 (tau - 0.25)^2)) / 2 with tau = omega U / g, A1 = 1 +
    k^-1.2 exp(-2 k), A2 = 0.5 + k^-1 exp(-2 k), k = omega^2 d / g. It is 1 at rest. A1 and A2 grow
    without limit as k falls: long waves are outside its range.

    References
    ----------
    Ikeda, Himeno, Tanaka (1978), Components of roll damping of ship at forward speed; ITTC 7.5-02-07-04.5, section 2.2.1.

    Examples
    --------
    >>> round(float(wave_speed_factor(0.6, speed=0.0, draught=9.5)), 3)
    1.0
    """
    w, U = np.asarray(omega, dtype=float), np.abs(np.asarray(speed, dtype=float))
    k, tau = w**2 * draught / g, w * U / g
    A1, A2 = 1.0 + k**-1.2 * np.exp(-2.0 * k), 0.5 + np.exp(-2.0 * k) / k
    hump = (2.0 * A1 - A2 - 1.0) * np.exp(-150.0 * (tau - 0.25) ** 2)
    return 0.5 * (A2 + 1.0 + (A2 - 1.0) * np.tanh(20.0 * (tau - 0.3)) + hump)


def wave_roll_damping(hydro: xr.Dataset, omega: ArrayLike, *, cog: ArrayLike) -> Array:
    """Return the radiation damping of roll about the axis through the centre of gravity, N m s.

    Parameters
    ----------
    hydro : xarray.Dataset
        Hydrodynamic data with sway and roll, about O, at zero speed.
    omega : (...) array
        rad/s, within the data; linear in between.
    cog : (3,) array
        m.

    Raises
    ------
    InputError
        Roll or sway missing, frequencies outside the data.

    Notes
    -----
    Roll about an axis at the height z_G moves O sideways by z_G p: B44_G = B44 + z_G (B24 + B42) + z_G^2 B22.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> B = np.broadcast_to([[2.0, 3.0], [3.0, 9.0]], (3, 2, 2))
    >>> data = hydro_from_arrays(omega=[0.5, 1.0, 1.5], added_mass=0 * B, radiation_damping=B, dofs=("sway", "roll"))
    >>> float(wave_roll_damping(data, 0.7, cog=[0.0, 0.0, -1.0]))  # 9 - 2 3 + 2
    5.0
    """
    center, w = column(cog, "wave_roll_damping: cog (m)", n=3), np.asarray(omega, dtype=float)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)  # the radiating ones are the same, maybe in another order
    missing = {"sway", "roll"} - (set(dofs) & {str(d) for d in hydro.radiating_dof.values})
    if missing:
        raise InputError(f"wave_roll_damping: sway and roll in the data expected, {', '.join(sorted(missing))} not found.")
    known = hydro.omega.values.astype(float)
    if not np.all((w >= known.min()) & (w <= known.max())):
        raise InputError(f"wave_roll_damping: frequencies from {known.min():.4g} to {known.max():.4g} rad/s expected.")
    damping = hydro.radiation_damping.sel(radiating_dof=list(dofs)).transpose("omega", "influenced_dof", "radiating_dof")
    B = embed(damping.values, dofs, (1, 2))
    z = center[2]
    return np.asarray(np.interp(w, known, B[:, 3, 3] + z * (B[:, 1, 3] + B[:, 3, 1]) + z**2 * B[:, 1, 1]))
