"""Least-squares fit of a simulated free decay to a whole series, with exact sensitivities and honest intervals."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import stdtrit

from ogilvie.errors import ConvergenceError

Array = NDArray[Any]

TERMS = ("linear", "quadratic", "cubic")
_STEP = 0.06  # rad of the oscillation per Runge-Kutta step at most: 1e-9 of the amplitude lost per cycle
_LAGS = 2.0  # cycles over which the correlation of the residuals is looked at


@dataclass(frozen=True, eq=False)
class Fit:
    """Outcome of :func:`fit_decay`.

    Attributes
    ----------
    values, errors : dict of str to float
        Parameters and the half widths of their 95 % confidence intervals.
    series : (n,) array
        The fitted decay at the times of the data, offset included.
    covariance : (p, p) array
        Of the parameters, in the order of `values`.
    independent : float
        Number of independent samples that the residuals amount to.
    """

    values: dict[str, float]
    errors: dict[str, float]
    series: Array
    covariance: Array
    independent: float


def fit_decay(
    t: Array, x: Array, *, terms: tuple[str, ...], stiffening: bool, drift: bool, fixed: float | None, start: dict[str, float]
) -> Fit:
    """Return the parameters of x'' + b1 x' + b2 |x'| x' + b3 x'^3 + omega^2 (x + e x^3) = 0 about offset + drift t.

    Parameters
    ----------
    t, x : (n,) array
    terms : tuple of str
        Damping terms to be found, of ``linear``, ``quadratic``, ``cubic``; the others are zero.
    stiffening : bool
        Whether e is to be found.
    drift : bool
        Whether the offset moves linearly in time.
    fixed : float, optional
        The offset where it is known.
    start : dict of str to float
        First guess: x0, v0, stiffness (omega^2), offset, drift, linear.

    Raises
    ------
    ConvergenceError
        The fit ends without a finite decay.

    Notes
    -----
    The equation is integrated by the classical Runge-Kutta method together with its derivatives with respect to all
    parameters, which are the Jacobian. Intervals: Student's t times the square root of the diagonal of f s^2 (J^T J)^-1 with
    s^2 the residual variance and f from :func:`residual_inflation`: a misfit that swings with the motion does not average
    out like white noise.
    """
    names = ["x0", "v0", "stiffness", "stiffening", *TERMS, "offset", "drift"]
    free = [True, True, True, stiffening, *(k in terms for k in TERMS), fixed is None, drift]
    chosen = np.flatnonzero(free)
    p0 = np.array([start.get(k, 0.0) if yes else 0.0 for k, yes in zip(names, free, strict=True)])
    if fixed is not None:
        p0[7] = fixed
    omega, height = np.sqrt(p0[2]), np.hypot(p0[0], p0[1] / np.sqrt(p0[2]))
    v = omega * height
    size = np.array([height, v, 0.1 * p0[2], 0.1 / height**2, 0.1 * omega, 0.1 * omega / v, 0.1 * omega / v**2, height, height])
    size[8] /= max(t[-1] - t[0], 1.0 / omega)
    tau = t - t[0]

    def model(q: Array) -> tuple[Array, Array]:
        p = p0.copy()
        p[chosen] += q * size[chosen]
        y, J = trajectory(tau, p[:7], _STEP / np.sqrt(max(p[2], 1e-6 * p0[2])))
        J = np.concatenate([J, np.ones((len(tau), 1)), tau[:, None]], axis=1)
        return y + p[7] + p[8] * tau, J[:, chosen] * size[chosen]

    found = least_squares(
        lambda q: _finite(model(q)[0]) - x, np.zeros(len(chosen)), jac=lambda q: _finite(model(q)[1]), method="lm"
    )
    series, J = model(found.x)
    if not (found.success and np.all(np.isfinite(series)) and np.all(np.isfinite(J))):
        raise ConvergenceError("decay: the fit of the simulated decay did not converge. Give a shorter series or fewer terms.")
    r = x - series
    f, freedom = residual_inflation(r, omega * float(np.median(np.diff(t))), parameters=len(chosen))
    covariance = f * (r @ r) / max(len(x) - len(chosen), 1) * np.linalg.pinv(J.T @ J) * np.outer(size[chosen], size[chosen])
    width = float(stdtrit(freedom, 0.975))
    p = p0.copy()
    p[chosen] += found.x * size[chosen]
    errors = dict.fromkeys(names, 0.0)
    for k, i in enumerate(chosen):
        errors[names[i]] = float(width * np.sqrt(covariance[k, k]))
    return Fit(dict(zip(names, map(float, p), strict=True)), errors, series, covariance, len(x) / f)


def residual_inflation(r: Array, angle: float, *, parameters: int = 0) -> tuple[float, float]:
    """Return the spectral density of a residual at one frequency over its mean, at least 1, and its degrees of freedom.

    Parameters
    ----------
    r : (n,) array
        Uniform samples.
    angle : float
        Frequency times sampling step, rad.
    parameters : int
        Number of parameters whose fit has taken out of the residual what swings with the motion.

    Notes
    -----
    Bartlett's estimate from the autocorrelation over two cycles has 3 n / lags degrees of freedom, less the parameters.

    Examples
    --------
    >>> white = np.random.default_rng(0).standard_normal(4000)
    >>> slow = np.convolve(white, np.ones(20))
    >>> bool(residual_inflation(white, 0.1)[0] < 1.5), bool(residual_inflation(slow, 0.1)[0] > 5.0)
    (True, True)
    """
    n = len(r)
    lags = int(min(_LAGS * 2 * np.pi / angle, n // 3))
    if lags < 1 or not np.any(r):
        return 1.0, float(max(n - parameters, 1))
    rho = np.fft.irfft(np.abs(np.fft.rfft(r, 2 * n)) ** 2)[: lags + 1]
    k = np.arange(1, lags + 1)
    density = 1.0 + 2.0 * np.sum((1 - k / (lags + 1)) * rho[1:] / rho[0] * np.cos(angle * k))
    total = 3 * n / lags
    left = max(total - parameters, 2.0)
    return float(max(1.0, density * total / left)), left


def _finite(y: Array) -> Array:
    """A decay that ran away is a bad trial, not an error."""
    return np.nan_to_num(y, nan=1e6, posinf=1e6, neginf=-1e6)


@njit(cache=True)
def _rates(z, p, out):
    """Time derivatives of z (16,): x and its derivatives with respect to the seven parameters, then the same of v = x'."""
    x, v, k, e = z[0], z[8], p[2], p[3]
    cube = x * x * x
    force = -k * (x + e * cube) - p[4] * v - p[5] * abs(v) * v - p[6] * v * v * v
    fx = -k * (1.0 + 3.0 * e * x * x)
    fv = -p[4] - 2.0 * p[5] * abs(v) - 3.0 * p[6] * v * v
    for i in range(8):
        out[i] = z[8 + i]
        out[8 + i] = fx * z[i] + fv * z[8 + i]
    out[8] = force
    out[11] -= x + e * cube
    out[12] -= k * cube
    out[13] -= v
    out[14] -= abs(v) * v
    out[15] -= v * v * v


@njit(cache=True)
def trajectory(t, p, longest):
    """Return x (n,) at the times t and its derivatives (n, 7) with respect to p = (x0, v0, omega^2, e, b1, b2, b3).

    `longest` is the largest Runge-Kutta step, s; a step ends at every sample.
    """
    n = len(t)
    x, J = np.empty(n), np.empty((n, 7))
    z, y, a, total = np.zeros(16), np.empty(16), np.empty(16), np.empty(16)
    z[0], z[8], z[1], z[10] = p[0], p[1], 1.0, 1.0
    now = t[0]
    for i in range(n):
        steps = int(np.ceil((t[i] - now) / longest - 1e-9))
        h = (t[i] - now) / max(steps, 1)
        for _ in range(steps):
            for q in range(16):
                y[q], total[q] = z[q], 0.0
            for stage in range(4):
                _rates(y, p, a)
                weight = 1.0 if stage == 0 or stage == 3 else 2.0
                ahead = h if stage == 2 else 0.5 * h
                for q in range(16):
                    total[q] += weight * a[q]
                    y[q] = z[q] + ahead * a[q]
            for q in range(16):
                z[q] += h / 6.0 * total[q]
        now = t[i]
        x[i] = z[0]
        for q in range(7):
            J[i, q] = z[1 + q]
    return x, J
