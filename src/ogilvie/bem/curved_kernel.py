"""Potentials of one curved panel at one point, for each polynomial of its density (numba kernels: arrays and floats only).

The panel is sum_kl c_kl T_k(u) T_l(v). Moments of the single and of the double layer,

    s_kl = int P_k(u) P_l(v) |x_u x x_v| / r du dv,    d_kl = int P_k(u) P_l(v) (x - y).(x_u x x_v) / r^3 du dv,

are taken over boxes of the parameter square: a product Gauss rule where the point is far enough from the box for it, halves
of the box otherwise; from a point of the panel itself, over the four triangles that it makes with the sides.
"""

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]

DEEPEST = 40  # halvings of a box, after which it is taken as it is


@njit(cache=True, nogil=True, inline="always")
def _chebyshev(u: float, T: Array, dT: Array) -> None:
    """Put T_k(u) and its derivative into T, dT."""
    T[0], dT[0] = 1.0, 0.0
    T[1], dT[1] = u, 1.0
    for k in range(2, T.size):
        T[k] = 2.0 * u * T[k - 1] - T[k - 2]
        dT[k] = 2.0 * T[k - 1] + 2.0 * u * dT[k - 1] - dT[k - 2]


@njit(cache=True, nogil=True, inline="always")
def _legendre(u: float, P: Array) -> None:
    """Put P_k(u) into P."""
    P[0] = 1.0
    if P.size > 1:
        P[1] = u
    for k in range(2, P.size):
        P[k] = ((2 * k - 1) * u * P[k - 1] - (k - 1) * P[k - 2]) / k


@njit(cache=True, nogil=True)
def frame(c: Array, u: float, v: float, T: Array, out: Array) -> None:
    """Put position, x_u and x_v at one point into out (3, 3); T (4, q) is room to work."""
    _chebyshev(u, T[0], T[1])
    _chebyshev(v, T[2], T[3])
    out[:] = 0.0
    for k in range(c.shape[0]):
        for d in range(3):
            a = 0.0
            b = 0.0
            for l in range(c.shape[0]):
                a += c[k, l, d] * T[2, l]
                b += c[k, l, d] * T[3, l]
            out[0, d] += T[0, k] * a
            out[1, d] += T[1, k] * a
            out[2, d] += T[0, k] * b


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc", "nsz"})
def add_rule(y: Array, x: Array, weight: Array, Pu: Array, Pv: Array, S: Array, D: Array) -> None:
    """Add a product rule: y (n, n, 6) positions and x_u x x_v, weight (n,), P (n, p) to the moments S, D (p, p)."""
    n, p = Pu.shape
    row_s = np.empty(p)
    row_d = np.empty(p)
    for i in range(n):
        row_s[:] = 0.0
        row_d[:] = 0.0
        for j in range(n):
            r0, r1, r2 = x[0] - y[i, j, 0], x[1] - y[i, j, 1], x[2] - y[i, j, 2]
            n0, n1, n2 = y[i, j, 3], y[i, j, 4], y[i, j, 5]
            inverse = 1.0 / math.sqrt(r0 * r0 + r1 * r1 + r2 * r2)
            s = weight[j] * math.sqrt(n0 * n0 + n1 * n1 + n2 * n2) * inverse
            d = weight[j] * (r0 * n0 + r1 * n1 + r2 * n2) * inverse * inverse * inverse
            for l in range(p):
                row_s[l] += s * Pv[j, l]
                row_d[l] += d * Pv[j, l]
        for k in range(p):
            f = weight[i] * Pu[i, k]
            for l in range(p):
                S[k, l] += f * row_s[l]
                D[k, l] += f * row_d[l]


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc", "nsz"})
def box_points(c: Array, u: Array, v: Array, y: Array, Tu: Array, Tv: Array, half: Array) -> None:
    """Put positions and x_u x x_v at the products of u and v (n,) into y (n, n, 6); Tu, Tv (2, n, q), half (2, q, 3): room."""
    n, q = u.size, c.shape[0]
    for i in range(n):
        _chebyshev(u[i], Tu[0, i], Tu[1, i])
        _chebyshev(v[i], Tv[0, i], Tv[1, i])
    for j in range(n):
        for k in range(q):
            for d in range(3):
                a = 0.0
                b = 0.0
                for l in range(q):
                    a += c[k, l, d] * Tv[0, j, l]
                    b += c[k, l, d] * Tv[1, j, l]
                half[0, k, d] = a
                half[1, k, d] = b
        for i in range(n):
            x0 = x1 = x2 = a0 = a1 = a2 = b0 = b1 = b2 = 0.0
            for k in range(q):
                t, dt = Tu[0, i, k], Tu[1, i, k]
                x0 += t * half[0, k, 0]
                x1 += t * half[0, k, 1]
                x2 += t * half[0, k, 2]
                a0 += dt * half[0, k, 0]
                a1 += dt * half[0, k, 1]
                a2 += dt * half[0, k, 2]
                b0 += t * half[1, k, 0]
                b1 += t * half[1, k, 1]
                b2 += t * half[1, k, 2]
            y[i, j, 0], y[i, j, 1], y[i, j, 2] = x0, x1, x2
            y[i, j, 3] = a1 * b2 - a2 * b1
            y[i, j, 4] = a2 * b0 - a0 * b2
            y[i, j, 5] = a0 * b1 - a1 * b0


@njit(cache=True, nogil=True)
def ellipse(offset: float, apart: float) -> float:
    """Return the size |z + sqrt(z^2 - 1)| of the Bernstein ellipse through z = offset + i apart (box = [-1, 1])."""
    a, b = math.hypot(offset + 1.0, apart), math.hypot(offset - 1.0, apart)
    h = max(0.5 * (a + b), 1.0)
    return h + math.sqrt(h * h - 1.0)


@njit(cache=True, nogil=True)
def reach(x: Array, y: Array, hu: float, hv: float, bend: Array) -> tuple[float, float, float]:
    """Return ellipse sizes in u and v of a box of half sides hu, hv with the frame y (3, 3) in its middle; its slenderness.

    The box is taken as plane, and larger by what it is off its tangent plane: bend holds the largest |x_uu|, |x_uv|, |x_vv|.
    """
    off_u, off_v = 0.5 * hu * (bend[0] * hu + bend[1] * hv), 0.5 * hv * (bend[1] * hu + bend[2] * hv)
    lu = math.sqrt(y[1, 0] ** 2 + y[1, 1] ** 2 + y[1, 2] ** 2)
    lv = math.sqrt(y[2, 0] ** 2 + y[2, 1] ** 2 + y[2, 2] ** 2)
    a = b = skew = square = 0.0
    for d in range(3):
        r = x[d] - y[0, d]
        a += r * y[1, d] / lu
        b += r * y[2, d] / lv
        skew += y[1, d] * y[2, d] / (lu * lv)
        square += r * r
    side_u, side_v, skew = 1.1 * lu * hu, 1.1 * lv * hv, abs(skew)
    slender = (lu * hu + off_u) / (lv * hv + off_v)
    side_u, side_v = max(side_u, lu * hu + off_u + off_v), max(side_v, lv * hv + off_u + off_v)
    in_u, in_v = max(abs(a) - skew * side_v, 0.0), max(abs(b) - skew * side_u, 0.0)
    across_u = max(math.sqrt(max(square - a * a, 0.0)) - side_v, 0.0)
    across_v = max(math.sqrt(max(square - b * b, 0.0)) - side_u, 0.0)
    return ellipse(in_u / side_u, across_u / side_u), ellipse(in_v / side_v, across_v / side_v), slender


@njit(cache=True, nogil=True)
def near_moments(c: Array, x: Array, bend: Array, gauss: Array, weight: Array, least: float, S: Array, D: Array) -> None:
    """Add the moments at x by halving boxes until both ellipse sizes are `least`; gauss, weight (n,) is the rule of a box."""
    n, q, p = gauss.size, c.shape[0], S.shape[0]
    stack = np.empty((2 * DEEPEST, 4))
    T, y = np.empty((4, q)), np.empty((3, 3))
    u, v, w = np.empty(n), np.empty(n), np.empty(n)
    points, Tu, Tv, half = np.empty((n, n, 6)), np.empty((2, n, q)), np.empty((2, n, q)), np.empty((2, q, 3))
    Pu, Pv = np.empty((n, p)), np.empty((n, p))
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0.0, 1.0, 0.0, 1.0
    count = 1
    while count > 0:
        count -= 1
        uc, hu, vc, hv = stack[count, 0], stack[count, 1], stack[count, 2], stack[count, 3]
        frame(c, uc, vc, T, y)
        in_u, in_v, slender = reach(x, y, hu, hv, bend)
        if min(in_u, in_v) < least and hu * hv > 2.0**-DEEPEST and count < 2 * DEEPEST - 2:
            for side in (-1.0, 1.0):
                stack[count, 0], stack[count, 1], stack[count, 2], stack[count, 3] = uc, hu, vc, hv
                if slender > 2.0 or (slender > 0.5 and in_u < in_v):
                    stack[count, 0], stack[count, 1] = uc + 0.5 * side * hu, 0.5 * hu
                else:
                    stack[count, 2], stack[count, 3] = vc + 0.5 * side * hv, 0.5 * hv
                count += 1
            continue
        for i in range(n):
            u[i], v[i], w[i] = uc + hu * gauss[i], vc + hv * gauss[i], math.sqrt(hu * hv) * weight[i]
            _legendre(u[i], Pu[i])
            _legendre(v[i], Pv[i])
        box_points(c, u, v, points, Tu, Tv, half)
        add_rule(points, x, w, Pu, Pv, S, D)


@njit(cache=True, nogil=True)
def self_moments(c: Array, u0: float, v0: float, gauss: Array, weight: Array, S: Array, D: Array) -> None:
    """Add the moments at the panel's own point (u0, v0).

    In the triangle to the side at distance H: u = u0 + r H, v = v0 + r s with 0 < r < 1, du dv = r H dr ds takes 1/r away, and
    s = s* + h* sinh(tau) makes 1/|x - y| constant in tau in the tangent plane, however close the point is to the side.
    """
    n, q, p = gauss.size, c.shape[0], S.shape[0]
    T, x, y = np.empty((4, q)), np.empty((3, 3)), np.empty((3, 3))
    Pu, Pv = np.empty(p), np.empty(p)
    frame(c, u0, v0, T, x)
    guu = x[1, 0] ** 2 + x[1, 1] ** 2 + x[1, 2] ** 2
    gvv = x[2, 0] ** 2 + x[2, 1] ** 2 + x[2, 2] ** 2
    guv = x[1, 0] * x[2, 0] + x[1, 1] * x[2, 1] + x[1, 2] * x[2, 2]
    for side in range(4):
        along_v = side < 2
        sign = 1.0 if side % 2 == 0 else -1.0
        centre, other = (u0, v0) if along_v else (v0, u0)
        gaa, gbb = (guu, gvv) if along_v else (gvv, guu)
        H = sign - centre
        middle = -H * guv / gbb
        least = abs(H) * math.sqrt(max(gaa - guv * guv / gbb, 1e-12 * gaa) / gbb)
        lower, upper = math.asinh((-1.0 - other - middle) / least), math.asinh((1.0 - other - middle) / least)
        for i in range(n):
            tau = 0.5 * (upper + lower) + 0.5 * (upper - lower) * gauss[i]
            s = middle + least * math.sinh(tau)
            wi = 0.5 * (upper - lower) * weight[i] * least * math.cosh(tau) * abs(H)
            for j in range(n):
                r = 0.5 + 0.5 * gauss[j]
                w = 0.5 * weight[j] * wi * r
                u, v = (u0 + r * H, v0 + r * s) if along_v else (u0 + r * s, v0 + r * H)
                frame(c, u, v, T, y)
                _add_point(x[0], y, w, u, v, Pu, Pv, S, D)


@njit(cache=True, nogil=True)
def _add_point(x: Array, y: Array, w: float, u: float, v: float, Pu: Array, Pv: Array, S: Array, D: Array) -> None:
    """Add one point with the frame y to the moments."""
    n0 = y[1, 1] * y[2, 2] - y[1, 2] * y[2, 1]
    n1 = y[1, 2] * y[2, 0] - y[1, 0] * y[2, 2]
    n2 = y[1, 0] * y[2, 1] - y[1, 1] * y[2, 0]
    r0, r1, r2 = x[0] - y[0, 0], x[1] - y[0, 1], x[2] - y[0, 2]
    inverse = 1.0 / math.sqrt(r0 * r0 + r1 * r1 + r2 * r2)
    s = w * math.sqrt(n0 * n0 + n1 * n1 + n2 * n2) * inverse
    d = w * (r0 * n0 + r1 * n1 + r2 * n2) * inverse**3
    _legendre(u, Pu)
    _legendre(v, Pv)
    for k in range(Pu.size):
        for l in range(Pv.size):
            S[k, l] += s * Pu[k] * Pv[l]
            D[k, l] += d * Pu[k] * Pv[l]
