"""Wave-drift damping: how the mean drift force changes with a slow velocity of the vessel."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.coverage import covered
from ogilvie.loads.interpolation import heading_weights, interpolated, vessel_headings
from ogilvie.loads.kernel import ETA, NU_R, ROTATION, Kernel, load_kernel
from ogilvie.loads.newman import DriftTable, drift_table
from ogilvie.loads.speed_table import HeadingTable
from ogilvie.waves.dispersion import group_velocity, wavenumber
from ogilvie.waves.field import Sea

Array = NDArray[Any]
#: The effect that :class:`WaveDriftDamping` accounts for.
WAVE_DRIFT_DAMPING = "wave-drift damping"
_STEP = np.radians(3.0)  # of the table over the vessel's heading, rad
_HEAD = 4  # headings, first heading, step, periodic
_RELATIVE = 1e-4  # step of the derivative of the group velocity


@dataclass(frozen=True, eq=False, init=False)
class WaveDriftDamping:
    """Damping of slow surge and sway by the waves.

    Parameters
    ----------
    hydro : xarray.Dataset
        With ``mean_drift`` (or ``qtf_diff``) at several frequencies and headings, at zero speed.
    sea : Sea
        The sea of the run; the damping is that of the mean over its realisations and acts from the beginning (no ramp).
    variable : str
        Which mean drift.

    Raises
    ------
    InputError
        Data that are missing, at speed, or for one heading only; a sea that they do not cover.

    Notes
    -----
    F_i = -sum_j B_ij v_j for surge and sway, v the velocity through the water in the horizontal axes that turn with the vessel,
    B_ij = sum a^2 b_ij over the components of the sea with, for a velocity in the direction alpha (0 surge, 90 deg sway),

        b = cos(beta - alpha) (k dD/domega + q D) - sin(beta - alpha)/c_g dD/dbeta,   q = k/omega + 1/c_g - k c_g'/c_g,

    D the drift force in surge or sway per amplitude squared, c_g the group velocity; in deep water Aranha's formula
    b = (omega/g)[(omega dD/domega + 4 D) cos(beta - alpha) - 2 dD/dbeta sin(beta - alpha)]. It follows from the
    conservation of wave action for a body that absorbs no energy (docs/theory/slow_drift.md). The yaw moment obeys no such
    formula in D alone, so yaw is left out. With :class:`SlowDrift` at zero speed it gives the drift at low speed.

    References
    ----------
    Aranha (1994), A formula for 'wave damping' in the drift of a floating body, J. Fluid Mechanics 275.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> from ogilvie.waves.sea import regular
    >>> w, b, Z = np.linspace(0.2, 2.0, 10), np.linspace(0, np.pi, 5), np.zeros((10, 6, 6))
    >>> D = 1e4 * np.cos(b)[None, :, None] * np.eye(6)[0] * np.ones((10, 1, 1))
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=b, mean_drift=D)
    >>> damping = WaveDriftDamping(hydro, regular(amplitude=2.0, omega=0.8, direction=np.pi))
    >>> damping.matrix(0.0)[0, 0].round()  # 4 a^2 |D| omega/g
    np.float64(13052.0)
    """

    hydro: xr.Dataset
    sea: Sea = field(repr=False)
    _table: HeadingTable = field(repr=False)
    name: str = "wave_drift_damping"

    def __init__(self, hydro: xr.Dataset, sea: Sea, *, variable: str = "mean_drift") -> None:
        if not isinstance(hydro, xr.Dataset) or not isinstance(sea, Sea):
            kinds = f"{type(hydro).__name__} and {type(sea).__name__}"
            raise InputError(f"WaveDriftDamping: a hydrodynamic data set (xarray.Dataset) and a Sea expected, {kinds} found.")
        speed = float(hydro.attrs.get("speed", 0.0))
        if speed != 0.0:
            raise InputError(f"WaveDriftDamping: drift at zero speed expected, {speed:.4g} m/s found.")
        drift = drift_table(hydro, "mean", variable)
        assert isinstance(drift, DriftTable)
        table = drift.table
        if len(table.omega) < 2 or hydro.sizes["wave_direction"] < 2:
            raise InputError(
                "WaveDriftDamping: drift at two or more frequencies and headings expected (it takes their slopes), "
                f"{len(table.omega)} and {hydro.sizes['wave_direction']} found."
            )
        covered(sea, table.omega, "WaveDriftDamping")
        for key, value in (("hydro", hydro), ("sea", sea), ("_table", table), ("name", "wave_drift_damping")):
            object.__setattr__(self, key, value)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({WAVE_DRIFT_DAMPING})

    def coefficients(self, omega: ArrayLike, direction: ArrayLike) -> Array:
        """Return b (n, 2, 2) per amplitude squared, N s/m3: force in surge, sway by velocity in surge, sway.

        Parameters
        ----------
        omega, direction : (n,) array
            Of the waves, rad/s and rad relative to the bow, within the data.
        """
        given = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (omega, direction))
        w, b = np.broadcast_arrays(*given)
        lo, hi = self._table.omega[[0, -1]]
        if len(w) and not (w.min() >= lo * (1 - 1e-9) and w.max() <= hi * (1 + 1e-9)):
            raise InputError(
                f"WaveDriftDamping: frequencies within {lo:.4g}..{hi:.4g} rad/s expected, {w.min():.4g}..{w.max():.4g} found."
            )
        return self._coefficients(np.clip(w, lo, hi), b[None])[0]

    def matrix(self, heading: float) -> Array:
        """Return B (2, 2) of surge and sway, N s/m, in the sea on a vessel at a heading (rad)."""
        return self._matrices(np.array([heading]))[0]

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        B = np.zeros((6, 6))
        B[:2, :2] = self.matrix(surroundings.heading)
        small = Terms(damping=B, constant=-B[:, 0] * surroundings.speed)
        limits = vessel_headings(self._table.headings, self.sea.direction, surroundings.heading)
        if limits is None:
            grid = np.arange(0.0, 2 * np.pi - 0.5 * _STEP, _STEP)
        else:
            grid = np.linspace(*limits, max(2, int(np.ceil((limits[1] - limits[0]) / _STEP)) + 1))
        step = max(float(grid[1] - grid[0]), 1e-9)
        data = np.concatenate([[len(grid), grid[0], step, float(limits is None)], self._matrices(grid).ravel()])
        text = "" if limits is None else f"headings {np.degrees(limits[0]):.4g}..{np.degrees(limits[1]):.4g} deg in this sea"
        return Terms(kernel=Kernel(_damping, data, limits=text), small=small, suffices=True)

    def _matrices(self, headings: Array) -> Array:
        """Return B (n_h, 2, 2) at headings of the vessel (n_h,)."""
        inside = covered(self.sea, self._table.omega, "WaveDriftDamping")
        lo, hi = self._table.omega[[0, -1]]
        w = np.clip(self.sea.omega[inside], lo, hi)
        b = self._coefficients(w, self.sea.direction[inside] - headings[:, None])
        square = np.mean(np.atleast_2d(self.sea.amplitude[..., inside]) ** 2, axis=0)
        return np.einsum("n,hnij->hij", square, b)

    def _coefficients(self, w: Array, b: Array) -> Array:
        """Return b (n_h, n, 2, 2) at frequencies (n,) and directions (n_h, n)."""
        table, water = self._table, {"g": float(self.hydro.attrs["g"])}
        depth = float(self.hydro.attrs["water_depth"])
        k, c_g = wavenumber(w, depth, **water), group_velocity(w, depth, **water)
        above, below = (group_velocity(w * (1 + s * _RELATIVE), depth, **water) for s in (1, -1))
        q = k / w + 1.0 / c_g - k * (above - below) / (2 * _RELATIVE * w * c_g)
        values = table.values[..., :2].real
        D, D_w = (interpolated(table.omega, values, w, derivative=order) for order in (0, 1))  # (n, n_b, 2)
        h, h_b = (_weights(table, b, order) for order in (0, 1))  # (n_h, n, n_b)
        along = k[:, None] * np.einsum("hnb,nbi->hni", h, D_w) + q[:, None] * np.einsum("hnb,nbi->hni", h, D)
        across = np.einsum("hnb,nbi->hni", h_b, D) / c_g[:, None]
        c, s = np.cos(b)[..., None], np.sin(b)[..., None]
        return np.stack([c * along - s * across, s * along + c * across], axis=-1)


def _weights(table: HeadingTable, b: Array, derivative: int) -> Array:
    try:
        return heading_weights(table.headings, b.ravel(), derivative=derivative).reshape(*b.shape, -1)
    except InputError as error:
        raise InputError(str(error).replace("WaveExcitation", "WaveDriftDamping")) from None


@load_kernel
def _damping(x, data, own, force):
    n_h = int(data[0])
    h = (x[ETA + 5] - data[1]) / data[2]
    if data[3] > 0.5:
        h -= n_h * np.floor(h / n_h)
    elif h < -1e-9 or h > n_h - 1 + 1e-9:
        force[:] = np.nan
        return
    i = min(max(int(h), 0), n_h - 1 if data[3] > 0.5 else n_h - 2)
    j, s = (i + 1) % n_h, h - i
    cp, sp = np.cos(x[ETA + 5]), np.sin(x[ETA + 5])
    R = x[ROTATION:]
    vx = R[0] * x[NU_R] + R[1] * x[NU_R + 1] + R[2] * x[NU_R + 2]
    vy = R[3] * x[NU_R] + R[4] * x[NU_R + 1] + R[5] * x[NU_R + 2]
    u, v = cp * vx + sp * vy, -sp * vx + cp * vy
    f0 = f1 = 0.0
    for k, share in ((i, 1.0 - s), (j, s)):
        B = data[_HEAD + 4 * k :]
        f0 -= share * (B[0] * u + B[1] * v)
        f1 -= share * (B[2] * u + B[3] * v)
    w0, w1 = cp * f0 - sp * f1, sp * f0 + cp * f1
    for p in range(3):
        force[p] += R[p] * w0 + R[3 + p] * w1
