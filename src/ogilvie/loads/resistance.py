"""Calm-water resistance of a ship under way, ahead and astern."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.given import ascending, column, number
from ogilvie.loads.kernel import NU, NU_R, Kernel, load_kernel
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[Any]

CALM_WATER = "calm-water resistance"
WIND = "wind"

VISCOSITY = 1.1892e-6  #: m2/s, kinematic, of sea water at 15 deg C (ITTC 7.5-02-01-03)
AIR = 1.225  #: kg/m3, density of air at 15 deg C and sea level
SLOW = 1e5  #: Reynolds number below which the friction line is held


def friction_coefficient(reynolds: ArrayLike) -> Array:
    """Return the coefficient of the ITTC-57 model-ship correlation line, held below a Reynolds number of 1e5.

    Parameters
    ----------
    reynolds : (...) array
        Speed times length over viscosity; its sign does not matter.

    Notes
    -----
    C_F = 0.075 / (log10 Rn* - 2)^2 with Rn* = (Rn^2 + 1e10)^1/2: smooth at rest, where the line itself has no value, and
    within 1e-5 of it from Rn = 1e7 on.

    References
    ----------
    ITTC Recommended Procedure 7.5-02-02-01, Resistance tests.

    Examples
    --------
    >>> round(float(friction_coefficient(1e9)), 6), round(float(friction_coefficient(0.0)), 6)
    (0.001531, 0.008333)
    """
    Rn = np.asarray(reynolds, dtype=float)
    return 0.075 / (0.5 * np.log10(Rn**2 + SLOW**2) - 2.0) ** 2


@load_kernel
def resistance_force(x: Array, data: Array, own: Array, force: Array) -> None:
    """Resistance by formula with a table of further coefficients, plus air and thrust.

    Data: 1/2 rho S, length / viscosity, form factor, constant coefficient, Froude number per m/s, factor astern, air,
    thrust, number of pieces n; n + 1 ends and 4 n coefficients of cubics, highest power first. 1/2 rho S of zero: a table R(u),
    signed where it begins below zero.
    """
    u, n = x[NU_R], int(data[8])
    signed = data[0] == 0.0 and data[9] < 0.0
    speed = u if signed else abs(u) * data[4]
    C = 0.0
    if n > 0:
        C = np.nan
        if data[9] <= speed <= data[9 + n]:
            k = 0
            while k < n - 1 and speed > data[10 + k]:
                k += 1
            s, a = speed - data[9 + k], 10 + n + 4 * k
            C = ((data[a] * s + data[a + 1]) * s + data[a + 2]) * s + data[a + 3]
        elif speed < data[9] and not signed:
            C = data[10 + n + 3]
    if data[0] > 0.0:
        Rn = u * data[1]
        line = 0.5 * np.log10(Rn * Rn + 1e10) - 2.0
        R = data[0] * ((1.0 + data[2]) * 0.075 / (line * line) + data[3] + C) * u * u
    else:
        R = C
    R = -R if u > 0.0 or signed else R * data[5]
    force[0] += R + data[7] - data[6] * abs(x[NU]) * x[NU]


@dataclass(frozen=True, eq=False, init=False)
class SurgeResistance:
    """Resistance of a hull in calm water, by friction line and further coefficients or as a table over speed.

    Parameters
    ----------
    area : float
        Wetted surface at rest, m2.
    length : float
        Of the waterline, m.
    form_factor : float
        k of (1 + k) C_F.
    allowance : float
        Constant coefficient on the wetted surface: roughness and correlation, appendages.
    residuary : pair of (n,) arrays, optional
        Froude numbers U / (g length)^1/2, ascending, n >= 4, and coefficients C_R on the wetted surface. Held below the first.
    air_area, air_cd : float
        Frontal area above the water, m2, and its drag coefficient, in still air.
    astern : float
        Resistance going astern over that ahead at the same speed.
    balanced_at : float, optional
        Speed (m/s) that a constant thrust holds in still water. By default there is no thrust, and a ship slows down.
    rho, g, viscosity : float
        kg/m3, m/s2, m2/s.

    Raises
    ------
    InputError
        A number out of its range, a table that does not ascend or has fewer than 4 points, `balanced_at` outside the table.

    Notes
    -----
    ``F_x = -1/2 rho S [(1 + k) C_F(Rn) + C_A + C_R(Fn)] |u_r| u_r - 1/2 rho_air A C_D |u| u + T``, in body axes at O; u_r is
    the speed through the water, u that over ground. C_F is :func:`friction_coefficient`; C_R a cubic spline. Above the last
    Froude number of the table the force is NaN and a run stops: a wave resistance is not to be guessed. With a propulsion load
    leave `balanced_at` out.

    References
    ----------
    ITTC Recommended Procedures 7.5-02-02-01, Resistance tests, and 7.5-02-03-01.4, Performance prediction method.

    Examples
    --------
    >>> ship = SurgeResistance(area=5000.0, length=175.0, form_factor=0.2, balanced_at=10.0)
    >>> float(ship.bind(None).kernel.force(nu=[10.0, 0, 0, 0, 0, 0])[0])
    0.0
    >>> round(float(ship.resistance(10.0)) / 1e3, 1)  # kN
    448.9
    """

    data: Array
    covers: frozenset[str]
    name: str = "resistance"

    def __init__(
        self,
        *,
        area: float,
        length: float,
        form_factor: float = 0.0,
        allowance: float = 0.0,
        residuary: tuple[ArrayLike, ArrayLike] | None = None,
        air_area: float = 0.0,
        air_cd: float = 0.8,
        astern: float = 1.0,
        balanced_at: float | None = None,
        rho: float = SEA_WATER,
        g: float = GRAVITY,
        viscosity: float = VISCOSITY,
    ) -> None:
        def given(value: Any, what: str, **bounds: float) -> float:
            return number(value, f"SurgeResistance: {what}", **bounds)

        L = given(length, "length (m)", above=0.0)
        table = () if residuary is None else _pieces(*residuary, "residuary")
        head = [
            0.5 * given(rho, "rho (kg/m3)", above=0.0) * given(area, "area (m2)", above=0.0),
            L / given(viscosity, "viscosity (m2/s)", above=0.0),
            given(form_factor, "form_factor", above=-1.0),
            given(allowance, "allowance"),
            1.0 / np.sqrt(given(g, "g (m/s2)", above=0.0) * L),
        ]
        air = 0.5 * AIR * given(air_area, "air_area (m2)", least=0.0) * given(air_cd, "air_cd", least=0.0)
        self._set(head, given(astern, "astern", least=0.0), air, table, balanced_at)

    @classmethod
    def from_table(
        cls, speed: ArrayLike, resistance: ArrayLike, *, astern: float = 1.0, balanced_at: float | None = None
    ) -> "SurgeResistance":
        """Return the resistance as a table.

        Parameters
        ----------
        speed : (n,) array
            Through the water, ascending, n >= 4, from 0 upward or from below to above it, m/s.
        resistance : (n,) array
            N, positive ahead, negative astern; zero at rest where the table begins there.
        astern, balanced_at : float
            As above; `astern` for tables from 0 upward.

        Notes
        -----
        Cubic spline; from 0 upward it is continued by R(-u) = -astern R(u). Beyond the table the force is NaN and a run stops.

        Examples
        --------
        >>> u = [0.0, 4.0, 8.0, 12.0]
        >>> ship = SurgeResistance.from_table(u, [0.0, 40e3, 160e3, 360e3])
        >>> round(float(ship.resistance(6.0))), round(float(ship.resistance(-6.0)))
        (90000, -90000)
        """
        table = _pieces(speed, resistance, "table", signed=True)
        first, last = table[0][[0, -1]]
        if first > 0.0 or last <= 0.0 or (first == 0.0 and table[1][3, 0] != 0.0):
            raise InputError("SurgeResistance: a table from zero speed and zero resistance on, or of both signs, expected.")
        if first < 0.0 and astern != 1.0:
            raise InputError("SurgeResistance: a table of both signs holds the resistance astern; leave out astern.")
        load = object.__new__(cls)
        factor = number(astern, "SurgeResistance: astern", least=0.0)
        load._set([0.0, 0.0, 0.0, 0.0, 1.0], factor, 0.0, table, balanced_at)
        return load

    def _set(self, head: list[float], astern: float, air: float, table: Any, balanced_at: float | None) -> None:
        n = len(table[0]) - 1 if table else 0
        pieces = [table[0], table[1].T.ravel()] if table else []
        data = np.concatenate([head, [astern, air, 0.0, n], *pieces])
        object.__setattr__(self, "data", data)
        object.__setattr__(self, "covers", frozenset({CALM_WATER, WIND} if air > 0.0 else {CALM_WATER}))
        object.__setattr__(self, "name", "resistance")
        if balanced_at is not None:
            U = number(balanced_at, "SurgeResistance: balanced_at (m/s)")
            thrust = float(self.resistance(U))
            if not np.isfinite(thrust):
                raise InputError(f"SurgeResistance: balanced_at within the table of speeds expected, {U:g} m/s found.")
            data[7] = thrust
        data.setflags(write=False)

    @property
    def thrust(self) -> float:
        """Constant thrust, N: the resistance at `balanced_at`."""
        return float(self.data[7])

    def resistance(self, speed: ArrayLike) -> Array:
        """Return the resistance (...) in still water at speeds (m/s), N, thrust left out; NaN outside the table."""
        kernel, u = Kernel(resistance_force, self.data), np.asarray(speed, dtype=float)
        forces = [kernel.force(nu=[v, 0, 0, 0, 0, 0])[0] for v in u.ravel()]
        return self.thrust - np.array(forces).reshape(u.shape)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=Kernel(resistance_force, self.data))


def _pieces(x: ArrayLike, y: ArrayLike, what: str, *, signed: bool = False) -> tuple[Array, Array]:
    """Return the ends (n + 1,) and coefficients (4, n) of the cubics of a spline through a table."""
    from scipy.interpolate import CubicSpline

    at = ascending(x, f"SurgeResistance: {what}, first column", fewest=4)
    value = column(y, f"SurgeResistance: {what}, second column", n=len(at))
    if at[0] < 0.0 and not signed:
        raise InputError(f"SurgeResistance: {what} at speeds >= 0 expected, {at[0]:g} found.")
    spline = CubicSpline(at, value)
    return spline.x, spline.c
