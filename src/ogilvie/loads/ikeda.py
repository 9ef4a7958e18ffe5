"""Roll damping of a ship by its components: friction, eddies, lift, bilge keels, waves (Ikeda's method)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.given import ascending, column, number
from ogilvie.loads.ikeda_eddy import bilge_radius, eddy_coefficient
from ogilvie.loads.ikeda_keels import keel_damping
from ogilvie.loads.ikeda_wave import wave_speed_factor
from ogilvie.loads.resistance import VISCOSITY
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.stations import stations
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[Any]

_LEAST = 1e-6  # rad: amplitude below which the formula of the keels has no value
_KEEL_POINTS = 21


@dataclass(frozen=True, eq=False)
class IkedaComponents:
    """Equivalent linear roll damping about the roll axis, N m s, by its causes; arrays of one shape.

    Parameters
    ----------
    friction, eddy, lift, keel_force, keel_pressure, wave : (...) array
        Of the skin, of the naked sections, of the hull as a foil, of the normal force of the bilge keels and of the pressure
        that they cause on the hull, of the radiated waves (zero unless given).
    """

    friction: Array
    eddy: Array
    lift: Array
    keel_force: Array
    keel_pressure: Array
    wave: Array

    @property
    def viscous(self) -> Array:
        """All but the waves."""
        return self.friction + self.eddy + self.lift + self.keel_force + self.keel_pressure

    @property
    def total(self) -> Array:
        """Sum of all components."""
        return self.viscous + self.wave


@dataclass(frozen=True, eq=False, init=False)
class IkedaHull:
    """What Ikeda's method has to know of a ship.

    Parameters
    ----------
    length, beam, draught : float
        Between perpendiculars, on the waterline amidships, amidships, m.
    cb, cm : float
        Block and midship coefficient.
    og : float
        Depth of the roll axis, taken through the centre of gravity, below the still water, m (negative above): -cog[2].
    x, breadth, section_draught, area : (n,) arrays
        Sections from O, ascending, m and m2.
    radius : (n,) array, optional
        Bilge radius of the sections, m; by default from their area.
    keels : (start, end, breadth), optional
        Places x of the ends of the bilge keels and their breadth, m.
    rho, viscosity, g : float
        kg/m3, m2/s, m/s2.

    Raises
    ------
    InputError
        A number out of its range, keels that go beyond the sections or where there is no section.

    Examples
    --------
    >>> from ogilvie.mesh.s175 import s175
    >>> ship = IkedaHull.from_hull(s175(panels=600), cog=[-2.5, 0.0, 0.05], keels=(-26.0, 26.0, 0.35))
    >>> found = ship.components(amplitude=0.1, omega=0.4, speed=10.0)
    >>> bool(found.keel_pressure > found.keel_force > found.friction > 0.0), bool(found.lift > found.eddy)
    (True, True)
    """

    length: float
    beam: float
    draught: float
    cb: float
    cm: float
    og: float
    sections: Array
    keels: tuple[float, float, float] | None
    rho: float
    viscosity: float
    g: float

    def __init__(
        self,
        *,
        length: float,
        beam: float,
        draught: float,
        cb: float,
        cm: float,
        og: float,
        x: ArrayLike,
        breadth: ArrayLike,
        section_draught: ArrayLike,
        area: ArrayLike,
        radius: ArrayLike | None = None,
        keels: tuple[float, float, float] | None = None,
        rho: float = SEA_WATER,
        viscosity: float = VISCOSITY,
        g: float = GRAVITY,
    ) -> None:
        positive = {"length": length, "beam": beam, "draught": draught, "cb": cb, "cm": cm}
        positive |= {"rho": rho, "viscosity": viscosity, "g": g}
        for key, value in positive.items():
            object.__setattr__(self, key, number(value, f"IkedaHull: {key}", above=0.0))
        if max(self.cb, self.cm) > 1.0:
            raise InputError(f"IkedaHull: cb and cm of at most 1 expected, {self.cb:g} and {self.cm:g} found.")
        depth = number(og, "IkedaHull: og (m)")
        if depth >= self.draught:
            raise InputError(
                f"IkedaHull: roll axis above the keel expected, og {depth:g} m with draught {self.draught:g} m found."
            )
        object.__setattr__(self, "og", depth)
        at = ascending(x, "IkedaHull: x (m)")
        given = {"breadth (m)": breadth, "section_draught (m)": section_draught, "area (m2)": area}
        B, d, S = (column(v, f"IkedaHull: {k}", n=len(at), least=0.0) for k, v in given.items())
        R = bilge_radius(B, d, S) if radius is None else column(radius, "IkedaHull: radius (m)", n=len(at), least=0.0)
        sections = np.stack([at, B, d, S, R])
        sections.setflags(write=False)
        object.__setattr__(self, "sections", sections)
        object.__setattr__(self, "keels", None if keels is None else _keels(keels, sections))

    @classmethod
    def from_hull(
        cls,
        hull: PanelMesh,
        *,
        cog: ArrayLike,
        keels: tuple[float, float, float] | None = None,
        length: float | None = None,
        strips: int = 40,
        rho: float = SEA_WATER,
        viscosity: float = VISCOSITY,
    ) -> "IkedaHull":
        """Return the particulars and sections of a panelled hull below z = 0.

        Parameters
        ----------
        hull : PanelMesh
        cog : (3,) array
            Centre of gravity from O, m.
        keels : (start, end, breadth), optional
        length : float, optional
            m; by default that of the wetted hull.
        strips : int
            Number of sections.
        rho, viscosity : float

        Notes
        -----
        The midship section is that of the largest area.
        """
        wet = hull.immersed()
        s = stations(hull, strips)
        low, high = wet.bounds[:, 0]
        center = column(cog, "from_hull: cog (m)", n=3)
        middle = int(np.argmax(s.area))
        B, T = float(s.breadth[middle]), float(s.draught[middle])
        L = float(high - low) if length is None else length
        ends = [np.pad(v, 1, mode="edge") for v in (s.breadth, s.draught, s.area)]
        return cls(
            length=L,
            beam=B,
            draught=T,
            cb=min(wet.volume / (number(L, "from_hull: length (m)", above=0.0) * B * T), 1.0),
            cm=min(float(s.area[middle]) / (B * T), 1.0),
            og=-float(center[2]),
            x=np.r_[low, s.x, high],
            breadth=ends[0],
            section_draught=ends[1],
            area=ends[2],
            keels=keels,
            rho=rho,
            viscosity=viscosity,
        )

    def components(
        self, *, amplitude: ArrayLike, omega: ArrayLike, speed: ArrayLike = 0.0, wave: ArrayLike = 0.0
    ) -> IkedaComponents:
        """Return the equivalent linear damping by its components.

        Parameters
        ----------
        amplitude : (...) array
            Of roll, rad, > 0.
        omega : (...) array
            Frequency of roll (of encounter), rad/s, > 0.
        speed : (...) array
            m/s.
        wave : (...) array
            Wave damping about the roll axis at zero speed and these frequencies, N m s, e.g. by :func:`wave_roll_damping`; it
            is changed for the speed by :func:`wave_speed_factor`.

        Raises
        ------
        InputError
            Amplitude or frequency not positive, NaN.

        Notes
        -----
        Friction, with S = L (1.7 d + cb B), r = ((0.887 + 0.145 cb) S / L - 2 OG) / pi, Rn = 0.512 (r phi_a)^2 omega / nu:
        B_F = (4 / 3 pi) rho S r^3 phi_a omega (1.328 Rn^-1/2 + 0.014 Rn^-0.114) (1 + 4.1 U / (omega L)).

        Eddies, with C_R of :func:`eddy_coefficient` and k = 0.04 omega L / U:
        B_E = (4 / 3 pi) rho omega phi_a int d^4 C_R dx k^2 / (1 + k^2).

        Lift, with l0 = 0.3 d, lR = 0.5 d, kN = 2 pi d / L + K (4.1 B / L - 0.045), K = 106 (cm - 0.91)^2 - 700 (cm - 0.91)^3 (0
        for cm < 0.91): B_L = 1/2 rho U L d kN l0 lR (1 - 1.4 OG / lR + 0.7 OG^2 / (l0 lR)).

        Bilge keels: :func:`keel_damping` over their length, the same at all speeds.

        References
        ----------
        Himeno (1981), Prediction of ship roll damping - state of the art, University of Michigan report 239; ITTC Recommended
        Procedure 7.5-02-07-04.5, section 2.2; Kato (1958) for friction, Ikeda et al. (1978) for the others.
        """
        a, w, U, Bw = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (amplitude, omega, speed, wave)))
        if not (np.all(np.isfinite(a + w + U + Bw)) and np.all(a > _LEAST) and np.all(w > 0.0)):
            raise InputError("IkedaHull: finite amplitudes (rad) and frequencies (rad/s) > 0 expected; check their ranges.")
        U = np.abs(U)
        N, H = self._keel_damping(a)
        factor = self.rho * w * a
        return IkedaComponents(
            friction=self._friction(a, w, U),
            eddy=4.0 / (3.0 * np.pi) * factor * self._eddy_integral() * self._eddy_speed(w, U),
            lift=self._lift() * U,
            keel_force=factor * N,
            keel_pressure=factor * H,
            wave=Bw * wave_speed_factor(w, speed=U, draught=self.draught, g=self.g),
        )

    def _friction(self, a: Array, w: Array, U: Array) -> Array:
        girth = 1.7 * self.draught + self.cb * self.beam
        r = ((0.887 + 0.145 * self.cb) * girth - 2.0 * self.og) / np.pi
        Rn = 0.512 * (r * a) ** 2 * w / self.viscosity
        C = 1.328 * Rn**-0.5 + 0.014 * Rn**-0.114
        still = 4.0 / (3.0 * np.pi) * self.rho * self.length * girth * r**3 * a * w * C
        return still * (1.0 + 4.1 * U / (w * self.length))

    def _eddy_integral(self) -> float:
        x, B, d, S, R = self.sections
        return float(np.trapezoid(d**4 * eddy_coefficient(B, d, S, og=self.og, radius=R), x))

    def _eddy_speed(self, w: Array, U: Array) -> Array:
        k = 0.04 * w * self.length
        return k**2 / (k**2 + U**2)

    def _lift(self) -> float:
        """Return B_L over the speed."""
        L, B, d, o = self.length, self.beam, self.draught, self.og
        m = max(self.cm - 0.91, 0.0)
        kN = 2.0 * np.pi * d / L + (106.0 * m**2 - 700.0 * m**3) * (4.1 * B / L - 0.045)
        l0, lR = 0.3 * d, 0.5 * d
        return 0.5 * self.rho * L * d * kN * l0 * lR * (1.0 - 1.4 * o / lR + 0.7 * o**2 / (l0 * lR))

    def _keel_damping(self, a: Array) -> tuple[Array, Array]:
        if self.keels is None:
            return np.zeros(a.shape), np.zeros(a.shape)
        start, end, b = self.keels
        at = np.linspace(start, end, _KEEL_POINTS)
        B, d, S, R = (np.interp(at, self.sections[0], v) for v in self.sections[1:])
        N, H = keel_damping(B, d, S, R, keel=np.full(at.shape, b), og=self.og, amplitude=a[..., None])
        return np.trapezoid(N, at, axis=-1), np.trapezoid(H, at, axis=-1)


def _keels(keels: tuple[float, float, float], sections: Array) -> tuple[float, float, float]:
    values = column(keels, "IkedaHull: keels (start, end, breadth, m)", n=3)
    start, end, b = (float(v) for v in values)
    x, B, d = sections[:3]
    if not (x[0] <= start < end <= x[-1] and b > 0.0):
        raise InputError(
            f"IkedaHull: keels (start, end, breadth) within x = {x[0]:.4g} to {x[-1]:.4g} m expected, {keels!r} found."
        )
    at = np.linspace(start, end, _KEEL_POINTS)
    if min(np.interp(at, x, B).min(), np.interp(at, x, d).min()) <= 0.0:
        raise InputError(
            "IkedaHull: sections with breadth and draught all along the bilge keels expected, none found at places."
        )
    return start, end, b
