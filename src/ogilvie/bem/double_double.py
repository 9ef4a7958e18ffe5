"""Compiled: sums and products with twice the digits of a float, as unevaluated pairs high + low (kernel: numbers only).

Products are split and sums compensated (T. J. Dekker, A floating-point technique for extending the available precision,
Numerische Mathematik 18 (1971) 224-242). The relative error of each operation is a few times 2^-104.
"""

from numba import njit

_SPLIT = 134217729.0  # 2^27 + 1


@njit(cache=True, nogil=True)
def two_sum(a, b):
    """Return a + b and what rounding took away.

    Examples
    --------
    >>> two_sum(1.0, 1e-20)
    (1.0, 1e-20)
    """
    s = a + b
    v = s - a
    return s, (a - (s - v)) + (b - v)


@njit(cache=True, nogil=True)
def two_product(a, b):
    """Return a b and what rounding took away (both below 1e290)."""
    p = a * b
    t = _SPLIT * a
    ah = t - (t - a)
    al = a - ah
    t = _SPLIT * b
    bh = t - (t - b)
    bl = b - bh
    return p, ((ah * bh - p) + ah * bl + al * bh) + al * bl


@njit(cache=True, nogil=True)
def dd_add(ah, al, bh, bl):
    """Return the sum of two pairs."""
    s, e = two_sum(ah, bh)
    e += al + bl
    h = s + e
    return h, e - (h - s)


@njit(cache=True, nogil=True)
def dd_multiply(ah, al, bh, bl):
    """Return the product of two pairs."""
    p, e = two_product(ah, bh)
    e += ah * bl + al * bh
    h = p + e
    return h, e - (h - p)


@njit(cache=True, nogil=True)
def dd_divide(ah, al, b):
    """Return a pair divided by a float."""
    q = ah / b
    p, e = two_product(q, b)
    low = ((ah - p) - e + al) / b
    h = q + low
    return h, low - (h - q)
