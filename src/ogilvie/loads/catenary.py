"""Statics of one elastic mooring line between two points, compiled.

The line has the unstretched length L (m), the weight w in water (N/m) and the axial stiffness EA (N). l >= 0 is the
horizontal distance of its ends, h the height of the fairlead above the anchor, H and V the horizontal and vertical components
of the tension at the fairlead, V positive where the line pulls the fairlead down. Derivation: docs/theory/mooring.md.
"""

import numpy as np
from numba import njit

#: How a line lies: not solved, all weight on the ground, part of the line on the ground, clear of the ground.
FAILED, SLACK, GROUNDED, SUSPENDED = -1, 0, 1, 2

_TOLERANCE = 1e-12  # of the position of the fairlead, as a fraction of L
_LAST = 1e-6  # a Newton step that is this small a fraction leaves the square of it as error: no need to look again
_ITERATIONS = 80

compiled = njit(cache=True, nogil=True, error_model="numpy")


@compiled
def solve_line(l, h, L, w, EA, friction, ground):
    """Return (H, V, kind) of a line, NaN and :data:`FAILED` where there is no solution.

    Parameters
    ----------
    l, h : float
        Horizontal distance of the ends and height of the fairlead above the anchor, m.
    L, w, EA : float
        Unstretched length, m; weight in water, N/m; axial stiffness, N; all > 0.
    friction : float
        Coefficient of friction of the ground.
    ground : float
        Not 0: a flat bottom at the level of the anchor carries the line; 0: the line hangs free and may sag below its anchor.

    Returns
    -------
    H, V : float
        N.
    kind : int

    Notes
    -----
    The kind is decided in closed form before anything is iterated. With q = h - w L^2 / (2 EA) the line leaves the ground
    altogether (V = w L) at H* = w (L^2 - q^2) / (2 q), l* = (H* / w) asinh(w L / H*) + H* L / EA; the horizontal force grows
    with l at constant h, so the line is grounded where l < l*. The place of the fairlead is met to 1e-10 L (at worst
    1e-9 L, else the line counts as not solved).

    References
    ----------
    J. M. Jonkman, Dynamics Modeling and Loads Analysis of an Offshore Floating Wind Turbine, NREL/TP-500-41958, 2007,
    chapter 2, quasi-static mooring model.

    Examples
    --------
    >>> H, V, kind = solve_line(796.732, 186.0, 835.35, 108.63 * 9.81, 753.6e6, 0.0, 1.0)
    >>> round(H / 1e3), round(V / 1e3), kind == GROUNDED
    (908, 631, True)
    """
    if not (l >= 0.0 and np.isfinite(l) and np.isfinite(h)) or (ground != 0.0 and h < 0.0):
        return np.nan, np.nan, FAILED
    if ground == 0.0:
        return _suspended(l, h, L, w, EA)
    s = 2.0 * h / (1.0 + np.sqrt(1.0 + 2.0 * w * h / EA))  # unstretched length that hangs upright
    if s <= L and l <= L - s:
        return 0.0, w * s, SLACK
    q = h - 0.5 * w * L * L / EA
    if q >= L:
        return _suspended(l, h, L, w, EA)
    if q > 0.0:
        limit = 0.5 * w * (L * L - q * q) / q
        if l >= limit / w * np.arcsinh(w * L / limit) + limit * L / EA:
            return _suspended(l, h, L, w, EA)
    return _grounded(l, h, L, w, EA, friction)


@compiled
def _asinh(x):
    """Inverse hyperbolic sine of x >= 0, to rounding where the sum under the logarithm would lose digits."""
    if x < 0.02:
        y = x * x
        return x * (1.0 - y * (1.0 / 6.0 - y * (3.0 / 40.0 - y * (15.0 / 336.0))))
    return np.log(x + np.sqrt(1.0 + x * x))


@compiled
def suspended_line(H, V, L, w, EA):
    """Return (l, h, dl/dH, dl/dV = dh/dH, dh/dV) of a line clear of the ground.

    Notes
    -----
    V_a = V - w L, T = sqrt(H^2 + V^2), T_a likewise:
    l = (H / w) (asinh(V / H) - asinh(V_a / H)) + H L / EA,
    h = (T - T_a) / w + (V + V_a) L / (2 EA),
    both written so that nothing cancels when the weight is small against the tension.
    """
    Va = V - w * L
    T, Ta = np.sqrt(H * H + V * V), np.sqrt(H * H + Va * Va)
    if V * Va > 0.0:
        y = w * L * (V + Va) / (V * Ta + Va * T)
        A = _asinh(y)
        B = H * H * y / (T * Ta)  # V / T - V_a / T_a
    else:
        A = np.arcsinh(V / H) - np.arcsinh(Va / H)
        B = V / T - Va / Ta
    l = H / w * A + H * L / EA
    h = L * (V + Va) * (1.0 / (T + Ta) + 0.5 / EA)
    return l, h, (A - B) / w + L / EA, -H * L * (V + Va) / ((T + Ta) * T * Ta), B / w + L / EA


@compiled
def _suspended(l, h, L, w, EA):
    """Newton's method on the complementary energy, which is convex, with a step that is halved until its slope is checked."""
    H, V = _suspended_start(l, h, L, w, EA)
    a, b, aH, aV, bV = suspended_line(H, V, L, w, EA)
    for _ in range(_ITERATIONS):
        ra, rb = a - l, b - h
        if abs(ra) + abs(rb) <= _TOLERANCE * L:
            return H, V, SUSPENDED
        det = aH * bV - aV * aV
        dH, dV = (-ra * bV + rb * aV) / det, (-rb * aH + ra * aV) / det
        if abs(dH) <= _LAST * H and abs(dV) <= _LAST * H:
            return H + dH, V + dV, SUSPENDED
        t = 1.0
        if H + dH < 0.05 * H:
            t = -0.95 * H / dH
        slope = ra * dH + rb * dV
        for _ in range(40):
            a, b, aH, aV, bV = suspended_line(H + t * dH, V + t * dV, L, w, EA)
            if (a - l) * dH + (b - h) * dV <= -0.7 * slope:
                break
            t *= 0.5
        H, V = H + t * dH, V + t * dV
    if abs(a - l) + abs(b - h) <= 1e-9 * L:
        return H, V, SUSPENDED
    return np.nan, np.nan, FAILED


@compiled
def _suspended_start(l, h, L, w, EA):
    """Estimate for a line between taut and deep sag.

    With p = w l / (2 H), arc^2 = h^2 + (l sinh(p) / p)^2 of the inextensible catenary gives p^2 = p0^2 for small p,
    p0^2 = 3 ((L^2 - h^2) / l^2 - 1); the stretch w d / (2 p EA) of a line of chord d adds b / p, b = 3 L^2 w d / (EA l^2).
    """
    x = max(l, 1e-6 * L)
    d = np.sqrt(x * x + h * h)
    p0 = 3.0 * ((L * L - h * h) / (x * x) - 1.0)
    b = 3.0 * L * L * w * d / (EA * x * x)
    p = np.sqrt(max(p0, 0.0)) + np.cbrt(b)
    for _ in range(3):
        p -= (p * (p * p - p0) - b) / (3.0 * p * p - p0)
    p = min(max(p, 1e-9), 300.0)
    return max(0.5 * w * x / p, 1e-12 * w * L), 0.5 * w * (h / np.tanh(p) + L)


@compiled
def grounded_line(H, h, L, w, EA, friction):
    """Return (l, V, dl/dH, dV/dH at constant h) of a line that rests on the ground with the length L_B = L - V / w.

    Notes
    -----
    h = (T - H) / w + V^2 / (2 EA w) is a quadratic equation for V^2;
    l = L_B + (H / w) asinh(V / H) + H L / EA - loss, where friction c takes from the stretch of the part on the ground
    loss = (c w / 2 EA) (L_B^2 - (L_B - x) max(L_B - x, 0)), x = H / (c w).
    """
    k = 1.0 + (H + w * h) / EA
    c = w * h * (2.0 * H + w * h)
    V = np.sqrt(2.0 * c / (k + np.sqrt(k * k - c / (EA * EA))))
    T = np.sqrt(H * H + V * V)
    A = _asinh(V / H)
    ground = L - V / w
    slope = 0.0  # dV/dH
    if V > 0.0:
        slope = (1.0 - H / T) / (V / T + V / EA)
    l = ground + H / w * A + H * L / EA
    dl = (A - V / T) / w + L / EA + slope * (H / T - 1.0) / w
    if friction > 0.0:
        pull = min(H, friction * w * max(ground, 0.0))  # H less the tension at the anchor
        l -= (ground * pull - 0.5 * pull * pull / (friction * w)) / EA
        if friction * w * ground > H:
            dl -= (ground - H / (friction * w) - slope * H / w) / EA
        else:
            dl += friction * ground * slope / EA
    return l, V, dl, slope


@compiled
def _grounded(l, h, L, w, EA, friction):
    """Newton's method for H alone between bounds that close in; l grows with H."""
    low, high = 0.0, np.inf
    H = _grounded_start(l, h, L, w, EA)
    for _ in range(_ITERATIONS):
        a, V, slope, rise = grounded_line(H, h, L, w, EA, friction)
        if abs(a - l) <= _TOLERANCE * L:
            return H, V, GROUNDED
        dH = (l - a) / slope
        if abs(dH) <= _LAST * H:
            return H + dH, V + rise * dH, GROUNDED
        if dH > 0.0:
            low = H
        else:
            high = H
        new = H + dH
        if not (low < new < high):
            new = 10.0 * H if high == np.inf else (0.5 * (low + high) if low > 0.01 * high else 0.03 * high)
        H = new
    return np.nan, np.nan, FAILED


@compiled
def _grounded_start(l, h, L, w, EA):
    """Estimate from D = (length - l) / h.

    A line that does not stretch has D = sqrt(1 + 2 u) - u acosh(1 + 1 / u), u = H / (w h);
    u = (2 / 9) (1 / D^2 - 1) is right for small D; the polynomial corrects it to 5 % for D < 0.97. The stretch H L / EA
    lengthens the line: D^3 - D0 D^2 = (2 / 9) w L / EA.
    """
    height = max(h, 1e-9 * L)
    D0, c = (L - l) / height, 2.0 / 9.0 * w * L / EA
    D = max(D0, 0.0) + np.cbrt(c)
    for _ in range(2):
        D -= (D * D * (D - D0) - c) / (D * (3.0 * D - 2.0 * D0))
    D = min(D, 0.999)
    near = max(1.00683 + D * (-0.22171 + D * (0.54631 - D * 0.91244)), 0.2)
    return 2.0 / 9.0 * w * height * (1.0 / (D * D) - 1.0) * near


@compiled
def anchor_tension(H, V, L, w, friction, kind):
    """Return the tension at the anchor, N."""
    if kind == SUSPENDED:
        return np.hypot(H, V - w * L)
    return max(H - friction * w * (L - V / w), 0.0)
