"""Force of waves from the elevation at O in time: the impulse response of the excitation, which begins before its crest."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.memory.fourier import fourier_integral, legendre_pieces

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[Any]

_TAPER = 0.85  # of the last frequency, from where the force is brought to zero by half a cosine
_LEFT = 2e-3  # of the largest value: a kernel is long enough where it stays below


@dataclass(frozen=True, eq=False)
class ExcitationKernel:
    """Kernels k(t) of the wave force F(t) = int k(tau) zeta(t - tau) d tau, zeta the elevation at O of long-crested waves.

    Parameters
    ----------
    t : (n_t,) array
        Uniform from -T to T, s. The kernel is not causal: waves press on the hull before their crest reaches O.
    kernel : (n_t, n_b, m) array
        Force per metre and second, SI.
    direction : (n_b,) array
        Directions that the waves travel to, rad.
    dofs : tuple of str
    truncation_error : (m,) array
        Largest value beyond 0.9 T, of the largest value.
    """

    t: Array
    kernel: Array
    direction: Array
    dofs: tuple[str, ...]
    truncation_error: Array

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float((self.t[-1] - self.t[0]) / (len(self.t) - 1))

    def force(self, elevation: ArrayLike, *, direction: float | None = None) -> Array:
        """Return the force (..., n, m) of a record of the elevation at O (..., n) with the kernel's time step.

        Parameters
        ----------
        elevation : (..., n) array
            m; zero before and after. The first and last T of the force lack what the record does not hold.
        direction : float, optional
            One of the kernel's directions, rad; may be left out where there is one only.

        Raises
        ------
        InputError
            A direction that is not there, NaN.

        Examples
        --------
        >>> t = np.array([-0.1, 0.0, 0.1])
        >>> k = ExcitationKernel(t, np.array([0.0, 10.0, 0.0])[:, None, None], np.zeros(1), ("heave",), np.zeros(1))
        >>> k.force([0.0, 2.0, 0.0])[:, 0].round(12).tolist()
        [0.0, 2.0, 0.0]
        """
        zeta = np.asarray(elevation, dtype=float)
        if zeta.ndim == 0 or not np.all(np.isfinite(zeta)):
            raise InputError("elevation: finite values (..., n) expected, NaN or a single number found.")
        k = self.kernel[:, self._index(direction)] * self.dt
        n, half = zeta.shape[-1], len(self.t) // 2
        size = int(2 ** np.ceil(np.log2(n + len(self.t))))
        spectrum = np.fft.rfft(zeta, size)[..., :, None] * np.fft.rfft(k, size, axis=0)
        return np.fft.irfft(spectrum, size, axis=-2)[..., half : half + n, :]

    def _index(self, direction: float | None) -> int:
        if direction is None and len(self.direction) == 1:
            return 0
        if direction is not None:
            away = np.abs((self.direction - direction + np.pi) % (2.0 * np.pi) - np.pi)
            if away.min() < 1e-6:
                return int(away.argmin())
        held = ", ".join(f"{d:.4g}" for d in np.degrees(self.direction))
        asked = "none" if direction is None else f"{np.degrees(direction):.4g} deg"
        raise InputError(f"direction: one of those of the kernel ({held} deg) expected, {asked} found.")


def excitation_kernel(hydro: "xr.Dataset", *, dt: float, duration: float | None = None) -> ExcitationKernel:
    """Return the impulse responses of the wave excitation of a data set.

    Parameters
    ----------
    hydro : xarray.Dataset
        With excitation_force at zero speed; see :mod:`ogilvie.hydro.schema`.
    dt : float
        Step of the kernel and of the records it is used with, s.
    duration : float, optional
        T: the kernel reaches from -T to T, s. By default the shortest that leaves out values below 0.2 % of the largest, at
        most what the spacing of the frequencies allows, pi/d_omega.

    Raises
    ------
    InputError
        No excitation force, forward speed, a step too long for the frequencies (the message gives the longest).

    Notes
    -----
    k(t) = (1/pi) Re int_0^inf X(omega) exp(i omega t) d omega with X through the data by a cubic spline, integrated exactly.
    X(0) is the hydrostatic force C_j3 of a unit elevation where the data have the stiffness, otherwise the real part of the
    first value. Over the last 15 % of the frequencies X is brought to zero by half a cosine: waves shorter than those of the
    data exert no force here. With dt < pi/omega_max the sum over a record is the integral.

    References
    ----------
    W. E. Cummins, Schiffstechnik 9 (1962) 101; J. Falnes, Applied Ocean Research 17 (1995) 157 (the kernel is not causal).

    Examples
    --------
    >>> import ogilvie as og
    >>> w = np.linspace(0.05, 4.0, 80)
    >>> X = np.exp(-w**2)[:, None, None] * (1 + 0j)  # of k = exp(-t^2/4)/(2 sqrt(pi))
    >>> zero = np.zeros((80, 1, 1))
    >>> h = og.hydro_from_arrays(omega=w, added_mass=zero, radiation_damping=zero, wave_direction=[0.0],
    ...                          excitation_force=X, dofs=("heave",))
    >>> k = excitation_kernel(h, dt=0.1, duration=8.0)
    >>> round(float(k.kernel[80, 0, 0]), 3), round(0.5 / float(np.sqrt(np.pi)), 3)
    (0.282, 0.282)
    """
    omega, X = _data(hydro)
    longest = np.pi / omega[-1]
    if not 0.0 < dt <= longest:
        raise InputError(f"dt: a step above 0 and up to pi/omega_max = {longest:.4g} s expected, {dt!r} found.")
    horizon = np.pi / float(np.diff(omega).max())
    if duration is not None and not dt <= duration <= horizon:
        raise InputError(
            f"duration: {dt:.4g} s to {horizon:.4g} s (pi over the widest gap of the frequencies) expected, {duration!r} found."
        )
    half = dt * np.arange(int((duration or horizon) / dt + 1e-9) + 1)
    t = np.concatenate([-half[:0:-1], half])
    k = fourier_integral(omega, legendre_pieces(omega, X, "spline"), t).real / np.pi
    size = np.abs(k).max(axis=(0, 1))
    if duration is None:
        t, k = _shortened(t, k, size)
    late = np.abs(k[np.abs(t) > 0.9 * t[-1]]).max(axis=(0, 1)) / np.where(size > 0.0, size, 1.0)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    return ExcitationKernel(t, k, hydro.wave_direction.values.astype(float), dofs, late)


def _data(hydro: "xr.Dataset") -> tuple[Array, Array]:
    """Return frequencies from 0 on and the force (n_w, n_b, m) there, tapered."""
    if "excitation_force" not in hydro:
        raise InputError("excitation_kernel: data with excitation_force expected, none found; solve them with wave directions.")
    if float(hydro.attrs.get("speed", 0.0)) != 0.0:
        raise InputError(
            f"excitation_kernel: data at zero speed expected, speed {hydro.attrs['speed']:.4g} m/s found: at speed the "
            "elevation at O does not tell which waves meet the ship."
        )
    omega = hydro.omega.values.astype(float)
    X = hydro.excitation_force.transpose("omega", "wave_direction", "influenced_dof").values
    if len(omega) < 4:
        raise InputError(f"excitation_kernel: four frequencies or more expected, {len(omega)} found.")
    first = X[:1].real.astype(complex)
    dofs = [str(d) for d in hydro.influenced_dof.values]
    if "hydrostatic_stiffness" in hydro and "heave" in dofs:
        first = np.broadcast_to(hydro.hydrostatic_stiffness.values[:, dofs.index("heave")].astype(complex), first.shape)
    start = _TAPER * omega[-1]
    ramp = np.clip((omega - start) / (omega[-1] - start), 0.0, 1.0)
    X = X * (0.5 + 0.5 * np.cos(np.pi * ramp))[:, None, None]
    return np.concatenate([[0.0], omega]), np.concatenate([first, X])


def _shortened(t: Array, k: Array, size: Array) -> tuple[Array, Array]:
    """Return the shortest middle part beyond which every kernel is negligible."""
    alive = np.any(np.abs(k) > _LEFT * size, axis=(1, 2)) & (t != 0.0)
    reach = np.abs(t[alive]).max() if alive.any() else t[-1]
    keep = np.abs(t) <= reach * (1.0 + 1e-9)
    return t[keep], k[keep]
