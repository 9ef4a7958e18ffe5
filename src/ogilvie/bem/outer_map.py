"""The open sea seen from the control hemisphere: potential on it from its normal velocity, per azimuthal mode and frequency.

phi_C = -N(omega) q in the depth functions of `outer_functions`, N complex symmetric; time factor exp(+i omega t). Lengths
in the control radius Rc, time in sqrt(Rc / g).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.bem.outer_functions import depth_functions, gauss, legendre, legendre_at_surface
from ogilvie.bem.outer_waves import WaveSource, wave_source
from ogilvie.errors import InputError

Array = NDArray[Any]

MULTIPOLES = 500
_SHARES = (1.0, 0.75, 0.5)  # of the multipoles, from which the sums are extrapolated
_POWERS = (4.0, 5.0)


@dataclass(frozen=True, eq=False)
class OuterMap:
    """What the Neumann-to-Dirichlet map of one azimuthal mode needs at any frequency.

    Attributes
    ----------
    m : int
    degree : (n,) array
        l = m + 2, m + 4, ...: the wave-free multipoles are psi_l = P_l / r^(l+1) + k0 ratio_l P_(l-1) / r^l with the
        normalised functions P of `legendre`.
    ratio : (n,) array
    cross : (n, n) array
        Integrals of P_l P_(l'-1) over x = 0..1.
    even, odd : (n, J) array
        Integrals of P_l and of P_(l-1) times the depth functions.
    first : (J,) array
        The same of P_m, the remaining function at zero frequency.
    P_even, P_odd : (n, n_x) array
        P_l and P_(l-1) at the Gauss points, times the weights.
    y : (J, n_x) array
        Depth functions, times the weights.
    weight : (n_x,) array
    source : WaveSource
    """

    m: int
    degree: Array
    ratio: Array
    cross: Array
    even: Array
    odd: Array
    first: Array
    P_even: Array
    P_odd: Array
    y: Array
    weight: Array
    source: WaveSource

    def at(self, omega: float) -> Array:
        """Return N (J, J) complex at omega > 0: Re N is the added mass, -omega Im N the damping of unit density.

        Notes
        -----
        phi = sum_n c_n phi_n with phi_n the wave-free multipoles and the source S_m. Tested with the multipoles themselves,

            N = -Phi^T M^-1 Phi,   M_kn = int phi_k d(phi_n)/dr,   Phi_nj = int phi_n y_j,

        and M is symmetric by Green's identity. The wave-free part is real and -M positive definite: with its Cholesky factor
        the products above are sums over n of positive terms, of order n^-5, which are extrapolated to all n from three partial
        sums. The source is eliminated last and gives the damping, of rank one.
        """
        if not omega > 0.0:
            raise InputError(f"OuterMap.at: omega > 0 expected, {omega!r} found; zero and infinity have their own functions.")
        S, dS = self.source.at(omega**2)
        size = np.sqrt(self.weight @ np.abs(S) ** 2)
        S, dS = S / size, dS / size
        G = self._wave_free(omega**2, dS)
        J = len(self.first)
        G_source = G[:, J] + 1j * G[:, J + 1]
        left = self.y @ S - G_source[:J]  # of the source's Phi and -M, once the wave-free multipoles are eliminated
        pivot = -(self.weight @ (S * dS)) - (G_source[J] + 1j * G_source[J + 1])
        return np.conj(G[:J, :J] + np.outer(left, left) / pivot)

    def _wave_free(self, k0: float, dS: Array) -> Array:
        """Products X^T (-M)^-1 X (J + 2, J + 2) of the wave-free multipoles, X = [Phi | Re, Im of -int psi dS/dr]."""
        l, k = self.degree, k0 * self.ratio
        linear = self.cross * (k * l)  # int psi_k d psi_n / dr, terms of P_l in psi_k
        M = linear + k[:, None] * self.cross.T * (l + 1)
        M[np.diag_indices_from(M)] += l + 1 + k * k * l
        scale = 1 / np.sqrt(np.diag(M))
        drain = -(self.P_even @ dS + k * (self.P_odd @ dS))
        X = np.column_stack([self.even + k[:, None] * self.odd, drain.real, drain.imag]) * scale[:, None]
        L = scipy.linalg.cholesky(M * scale * scale[:, None], lower=True, overwrite_a=True, check_finite=False)
        V = scipy.linalg.solve_triangular(L, X, lower=True, check_finite=False)
        stops = [int(share * len(l)) for share in _SHARES]
        sums = np.array([V[:n].T @ V[:n] for n in stops])
        return extrapolated(sums, 1.0 / (self.degree[[n - 1 for n in stops]] + 1.0), _POWERS)

    @property
    def at_zero(self) -> Array:
        """N_0 (J, J): phi_y = 0 on the surface, P_l / r^(l+1) with l - m even, N = sum_l E_l E_l^T / (l + 1)."""
        E = np.vstack([self.first, self.even])
        return _static(E, np.append(self.m, self.degree), (4.0, 5.0, 6.0, 7.0))

    @property
    def at_infinity(self) -> Array:
        """N_inf (J, J): phi = 0 on the surface, P_l / r^(l+1) with l - m odd."""
        return _static(self.odd, self.degree - 1, (2.0, 3.0, 4.0, 5.0, 6.0, 7.0))


def outer_map(m: int, count: int, *, multipoles: int = MULTIPOLES) -> OuterMap:
    """Prepare the map of azimuthal mode m in the first `count` depth functions.

    Examples
    --------
    >>> sea = outer_map(0, 2, multipoles=100)
    >>> c = np.array([1 / 2, 1 / 12**0.5])  # x = cos(theta): heave of the hemisphere
    >>> round(float(3 * c @ sea.at_infinity @ c), 6)  # added mass over 2/3 pi rho a^3
    0.5
    """
    x, w = gauss(2 * multipoles + 100)
    top = m + 2 * multipoles
    P = legendre(m, x, top)
    y = depth_functions(m, x, count) * w
    integrals = P @ y.T
    value, slope = legendre_at_surface(m, top)
    l = np.arange(m + 2.0, top + 1.0, 2.0)
    # by Legendre's equation: (l'(l'+1) - l(l+1)) int P_l P_l' = P_l(0) P_l'(0)', l - m even and l' - m odd
    cross = value[2::2, None] * slope[None, 1::2] / ((l - 1) * l - (l * (l + 1))[:, None])
    ratio = np.sqrt((2 * l + 1) / (2 * l - 1) * (l - m) / (l + m)) / (l - m)
    return OuterMap(
        m=m,
        degree=l,
        ratio=ratio,
        cross=cross,
        even=integrals[2::2],
        odd=integrals[1::2],
        first=integrals[0],
        P_even=P[2::2] * w,
        P_odd=P[1::2] * w,
        y=y,
        weight=w,
        source=wave_source(m, x),
    )


def extrapolated(sums: Array, h: Array, powers: tuple[float, ...]) -> Array:
    """Return the limit h -> 0 of sums (n, ...) that behave as limit + sum_p c_p h^p, as many powers as sums less one or fewer.

    Examples
    --------
    >>> h = np.array([0.1, 0.2, 0.3])
    >>> float(extrapolated(1.0 + h**2 - h**3, h, (2.0, 3.0)).round(12))
    1.0
    """
    scaled = h / h[0]
    basis = np.column_stack([np.ones(len(h))] + [scaled**p for p in powers])
    return np.tensordot(np.linalg.pinv(basis, rcond=1e-15)[0], sums, axes=1)


def _static(E: Array, degree: Array, powers: tuple[float, ...]) -> Array:
    stops = [int(len(E) * share) for share in np.linspace(1.0, 0.4, len(powers) + 1)]
    F = E / np.sqrt(degree + 1.0)[:, None]
    sums = np.array([F[:n].T @ F[:n] for n in stops])
    return extrapolated(sums, 1.0 / (degree[[n - 1 for n in stops]] + 1.5), powers)
