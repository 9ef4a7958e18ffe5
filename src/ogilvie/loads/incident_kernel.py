"""Compiled: elevation and dynamic head of the undisturbed sea at the vertices of a hull.

The tables are those of :class:`ogilvie.loads.incident_field.IncidentField`.
"""

import numpy as np
from numba import njit

from ogilvie.loads.incident_field import GROUP, HEAD
from ogilvie.loads.kernel import ETA, TIME
from ogilvie.waves.sincos import sine_and_cosine, sines_and_cosines

_FAST = {"reassoc", "contract", "nsz", "arcp"}
_F = np.float32
_HALF, _PER, _HIGH, _LOW = _F(0.5), _F(2.0 / np.pi), _F(1.5703125), _F(np.pi / 2.0 - 1.5703125)  # pi/2 = high + low
_S3, _S5, _S7 = _F(-1.6666654611e-1), _F(8.3321608736e-3), _F(-1.9515295891e-4)
_C4, _C6, _C8 = _F(4.166664568298827e-2), _F(-1.388731625493765e-3), _F(2.443315711809948e-5)
_ONE, _TWO = _F(1.0), _F(2.0)


@njit(cache=True, nogil=True, fastmath=_FAST)
def cubic_weights(s):
    """Return the weights of values at -1, 0, 1, 2 for cubic interpolation at s in [0, 1].

    Examples
    --------
    >>> cubic_weights(0.5)
    (-0.0625, 0.5625, 0.5625, -0.0625)
    """
    a, b, c = s + 1.0, s - 1.0, s - 2.0
    return -s * b * c / 6.0, a * b * c / 2.0, -a * s * c / 2.0, a * s * b / 6.0


@njit(cache=True, nogil=True, fastmath=_FAST)
def phasors(x, data, own, cosine, sine):
    """Fill a cos and a sin (n,) of the phase of each component at O, with the amplitudes of the moment."""
    n = int(data[0])
    first = HEAD + GROUP * int(data[1])
    angle = np.empty(n)
    for j in range(n):
        angle[j] = data[first + j] * x[TIME] + own[n + j]
        angle[j] -= data[first + n + j] * x[ETA] + data[first + 2 * n + j] * x[ETA + 1]
    sines_and_cosines(angle, sine, cosine)
    grown = 1.0
    if data[6] > 0.0 and x[TIME] < data[6]:
        grown = np.sin(0.5 * np.pi * max(x[TIME], 0.0) / data[6]) ** 2
    for j in range(n):
        cosine[j] *= grown * own[j]
        sine[j] *= grown * own[j]


@njit(cache=True, nogil=True, fastmath=_FAST)
def line(data, g, cosine, sine, begin, count):
    """Return the dynamic heads (count, rows + 1) of group g at the points begin, begin + 1 ... of its line."""
    n, rows, at = int(data[0]), int(data[3]), HEAD + GROUP * g
    first = HEAD + GROUP * int(data[1])
    j0, m, step = int(data[at]), int(data[at + 1]), data[at + 4]
    k = data[first + 3 * n + j0 : first + 3 * n + j0 + m]
    tc = data[first + 4 * n + j0 : first + 4 * n + j0 + m]
    ts = data[first + 5 * n + j0 : first + 5 * n + j0 + m]
    table = first + 6 * n + j0
    c, s = np.empty(m), np.empty(m)
    for j in range(m):
        sb, cb = sine_and_cosine(k[j] * step * begin)
        c[j] = cosine[j0 + j] * cb + sine[j0 + j] * sb  # cos(phase - k step begin)
        s[j] = sine[j0 + j] * cb - cosine[j0 + j] * sb
    out = np.empty((count, rows + 1))
    for i in range(count):
        for r in range(rows + 1):
            row = data[table + r * n : table + r * n + m]
            total = 0.0
            for j in range(m):
                total += row[j] * c[j]
            out[i, r] = total
        for j in range(m):
            cj = c[j]
            c[j] = cj * tc[j] + s[j] * ts[j]
            s[j] = s[j] * tc[j] - cj * ts[j]
    return out


@njit(cache=True, nogil=True, fastmath=_FAST)
def place(z, zeta, data):
    """Return the place u = sqrt(-z'/c) in the table of heights of a point at the height z, and its height above z = 0.

    Notes
    -----
    Wheeler: z' = (z - zeta) h/(h + zeta); the others z' = z. Points above z' = 0 have u = 0.
    """
    if data[7] == 0.0:
        s = z - zeta
        if data[5] > 0.0:
            s *= data[5] / (data[5] + zeta)
        above = 0.0
    else:
        s, above = z, max(z, 0.0) if data[7] == 2.0 else 0.0
    return np.sqrt(max(-s, 0.0) / data[4]), above


@njit(cache=True, nogil=True, fastmath=_FAST)
def incident(x, data, own, X, Y, Z, zeta, head):
    """Fill elevation (n,) and dynamic head (n,), m, at points X, Y from O in the axes of the world and heights Z.

    Returns False, with nothing to rely on, where a point lies deeper than the table or the bottom falls dry.
    """
    n, n_g, single, rows = int(data[0]), int(data[1]), int(data[2]), int(data[3])
    HEAD + GROUP * n_g
    cosine, sine = np.empty(n), np.empty(n)
    phasors(x, data, own, cosine, sine)
    zeta[:] = 0.0
    head[:] = 0.0
    heads = [np.empty((0, 0)) for _ in range(n_g)]
    begins = np.zeros(n_g)
    along = np.empty(X.shape[0])
    for g in range(n_g):
        at = HEAD + GROUP * g
        cx, cy = data[at + 2] / data[at + 4], data[at + 3] / data[at + 4]
        lo, hi = np.inf, -np.inf
        for v in range(X.shape[0]):
            along[v] = cx * X[v] + cy * Y[v]
            lo, hi = min(lo, along[v]), max(hi, along[v])
        begins[g] = np.floor(lo) - 1.0
        D = line(data, g, cosine, sine, begins[g], int(np.floor(hi) - begins[g]) + 3)
        heads[g] = D
        for v in range(X.shape[0]):
            u = along[v] - begins[g]
            i = int(u)
            w0, w1, w2, w3 = cubic_weights(u - i)
            zeta[v] += w0 * D[i - 1, 0] + w1 * D[i, 0] + w2 * D[i + 1, 0] + w3 * D[i + 2, 0]
    if single < n and not _singles(data, cosine, sine, single, X, Y, Z, zeta, head):
        return False
    for v in range(X.shape[0]):
        u, above = place(Z[v], zeta[v], data)
        if not (u <= rows - 3.0) or (data[5] > 0.0 and not (zeta[v] > -0.9 * data[5])):
            return False
        m = int(u)
        h0, h1, h2, h3 = cubic_weights(u - m)
        before = abs(m - 1)
        for g in range(n_g):
            at = HEAD + GROUP * g
            D = heads[g]
            b = (data[at + 2] * X[v] + data[at + 3] * Y[v]) / data[at + 4] - begins[g]
            i = int(b)
            w = cubic_weights(b - i)
            for p in range(4):
                row = D[i - 1 + p]
                value = h0 * row[before] + h1 * row[m] + h2 * row[m + 1] + h3 * row[m + 2] + above * row[rows]
                head[v] += w[p] * value
    return True


@njit(cache=True, nogil=True, fastmath=_FAST - {"reassoc"})  # the order of its subtractions matters
def single_sine_and_cosine(angle):
    """Return sine and cosine of a float32 angle within some hundred rad, in float32, with errors of 2e-7.

    Notes
    -----
    As :func:`ogilvie.waves.sincos.sine_and_cosine`, with the least-squares polynomials of the Cephes library (Moshier).

    Examples
    --------
    >>> s, c = single_sine_and_cosine(np.float32(20.5))
    >>> bool(max(abs(s - np.sin(20.5)), abs(c - np.cos(20.5))) < 2e-6)
    True
    """
    q = np.floor(angle * _PER + _HALF)
    r = (angle - q * _HIGH) - q * _LOW
    z = r * r
    s = r + r * z * (_S3 + z * (_S5 + z * _S7))
    c = _ONE - _HALF * z + z * z * (_C4 + z * (_C6 + z * _C8))
    half = _HALF * q
    odd = _TWO * (half - np.floor(half))  # q mod 2
    up = half - odd * _HALF  # whole turns by pi
    turned = _TWO * (_HALF * up - np.floor(_HALF * up))  # and whether their number is odd
    sign = _ONE - _TWO * turned
    sine = sign * (s + odd * (c - s))
    cosine = sign * (c + odd * (-s - c))
    return sine, cosine


@njit(cache=True, nogil=True, fastmath=_FAST)
def _singles(data, cosine, sine, single, X, Y, Z, zeta, head):
    """Add elevation and head of the components that are on no line, at every point, in single precision."""
    n, rows = int(data[0]), int(data[3])
    first = HEAD + GROUP * int(data[1])
    m = n - single
    kx, ky, ca, sa, a = np.empty(m, _F), np.empty(m, _F), np.empty(m, _F), np.empty(m, _F), np.empty(m, _F)
    table = np.empty((rows + 1, m), _F)
    for j in range(m):
        kx[j], ky[j] = _F(data[first + n + single + j]), _F(data[first + 2 * n + single + j])
        ca[j], sa[j] = _F(cosine[single + j]), _F(sine[single + j])
    for r in range(rows + 1):
        for j in range(m):
            table[r, j] = _F(data[first + (6 + r) * n + single + j])
    for v in range(X.shape[0]):
        xv, yv, total = _F(X[v]), _F(Y[v]), _F(0.0)
        for j in range(m):
            s, c = single_sine_and_cosine(kx[j] * xv + ky[j] * yv)
            a[j] = ca[j] * c + sa[j] * s
            total += a[j]
        zeta[v] += total
        u, above = place(Z[v], zeta[v], data)
        if not (u <= rows - 3.0):
            return False
        i = int(u)
        g0, g1, g2, g3 = cubic_weights(u - i)
        h0, h1, h2, h3, h4 = _F(g0), _F(g1), _F(g2), _F(g3), _F(above)
        t0, t1, t2, t3, t4 = table[abs(i - 1)], table[i], table[i + 1], table[i + 2], table[rows]
        total = _F(0.0)
        for j in range(m):
            total += a[j] * (h0 * t0[j] + h1 * t1[j] + h2 * t2[j] + h3 * t3[j] + h4 * t4[j])
        head[v] += total
    return True
