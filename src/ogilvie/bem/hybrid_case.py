"""What is asked of the hybrid method, checked: boundary, times, units."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import Uncoupled, uncoupled
from ogilvie.bem.curved import CurvedMesh
from ogilvie.bem.curved_split import split_at_waterline, water_angle
from ogilvie.bem.inner import InnerMap
from ogilvie.bem.inner_mesh import default_size, inner_mesh
from ogilvie.bem.outer import depth_functions, outer_mode
from ogilvie.body import RigidBody
from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[Any]

_DURATION = 40.0  # default over sqrt(control radius / g)
_DT = 0.035  # default time step over sqrt(control radius / g)
_SIZE = 1.75  # length of panels over the mesher's default
_ROWS, _DEPTH = 6, 3  # rows of panels on the free surface and on the control surface
_FINE = 1.5  # resolution from which on the panels at the waterline are divided twice
_SHARE, _SHARES = (0.15,), (0.25, 0.25)  # of a panel at the waterline that its part next to the waterline gets, once or twice
_FLARED = np.radians(100.0)  # angle of the water at the waterline from which on panels are divided twice in any case
_MODES, _FUNCTIONS = 23, 12  # azimuthal modes and depth functions of the outer domain
_START = 0.07  # part of sqrt(control radius / g) in which K(t) of a flared hull depends on the panels at the waterline
_FLOATS = 0.01  # difference of displaced and body's mass that is worth a note


@dataclass(frozen=True, eq=False)
class HybridCase:
    """A checked problem for the hybrid method.

    Parameters
    ----------
    mesh : CurvedMesh
    order : int
        Nodes per side of a panel.
    step : float
        s.
    count : int
        Number of times 0, step, ...
    rho, g : float
    """

    mesh: CurvedMesh
    order: int
    step: float
    count: int
    rho: float
    g: float

    @property
    def time(self) -> float:
        """Unit of time sqrt(Rc/g), s."""
        return float(np.sqrt(self.mesh.radius / self.g))

    @property
    def centre(self) -> Array:
        """Centre of the control hemisphere from O, in control radii (3,)."""
        return np.array(self.mesh.centre) / self.mesh.radius

    @property
    def t(self) -> Array:
        """Times, s."""
        return self.step * np.arange(self.count)

    @property
    def arm(self) -> Array:
        """Unit of length of each dof (6,): 1 for translations, the control radius for rotations."""
        return np.where(np.arange(6) < 3, 1.0, self.mesh.radius)

    @property
    def source(self) -> str:
        """The method, in words."""
        return f"hybrid time-domain panel method, {len(self.mesh.part)} curved panels, control radius {self.mesh.radius:.4g} m"

    def domains(self, inner: InnerMap) -> Uncoupled:
        """Return inner and outer domain of one class of symmetry, ready to be joined."""
        sea = [outer_mode(m, _FUNCTIONS) for m in range(_MODES)]
        return uncoupled(inner, sea, depth_functions, centre=self.centre)


def hybrid_case(
    caller: str,
    hull: PanelMesh | CurvedMesh,
    *,
    duration: float | None = None,
    dt: float | None = None,
    control_radius: float | None = None,
    resolution: float = 1.0,
    order: int = 4,
    rho: float = SEA_WATER,
    g: float = GRAVITY,
) -> HybridCase:
    """Return the problem; parameters as of :func:`ogilvie.hybrid_bem`, a duration that is not given is 40 sqrt(Rc/g).

    Errors name the `caller`.

    Raises
    ------
    InputError
        Numbers out of range, or a hull that :func:`ogilvie.bem.inner_mesh.inner_mesh` refuses.
    """
    positive = {"duration": 1.0 if duration is None else duration, "dt": 1.0 if dt is None else dt, "rho": rho, "g": g}
    for name, value in positive.items():
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{caller}: {name} > 0 expected, {value!r} found.")
    if dt is not None and duration is not None and dt > duration:
        raise InputError(f"{caller}: a time step up to the duration, {duration:g} s, expected, {dt:g} s found.")
    if not 0.3 <= resolution <= 5.0:
        raise InputError(f"{caller}: resolution 0.3 to 5 expected, {resolution!r} found.")
    if not 2 <= order <= 10:
        raise InputError(f"{caller}: order 2 to 10 expected, {order!r} found.")
    mesh = hull if isinstance(hull, CurvedMesh) else curved_boundary(hull, control_radius, resolution)
    time = float(np.sqrt(mesh.radius / g))
    step = _DT * time if dt is None else dt
    last = _DURATION * time if duration is None else duration
    return HybridCase(mesh, order, step, int(np.ceil(last / step - 1e-9)) + 1, rho, g)


def curved_boundary(hull: PanelMesh, control_radius: float | None, resolution: float) -> CurvedMesh:
    """Return curved panels, smallest at the waterline."""
    mesh = inner_mesh(
        hull,
        control_radius=control_radius,
        size=_SIZE / resolution * default_size(hull),
        rows=max(3, round(_ROWS * resolution)),
        depth=max(2, round(_DEPTH * resolution)),
    )
    fine = resolution >= _FINE
    for share in _SHARES if fine else 2 * _SHARE if water_angle(mesh) > _FLARED else _SHARE:
        mesh = split_at_waterline(mesh, share=share)
    return mesh


def flared(mesh: CurvedMesh, time: float) -> list[str]:
    """Return a note on the start of K where the hull flares at the waterline (docs/theory/hybrid.md, section 7)."""
    angle = water_angle(mesh)
    if angle <= _FLARED:
        return []
    return [
        f"the water meets the hull at up to {np.degrees(angle):.0f} deg at the waterline: K in the first {_START * time:.2g} s "
        "converges slowly there and may be too small, which the estimate of errors does not see."
    ]


def floating(hull: PanelMesh | CurvedMesh, body: RigidBody | None, rho: float) -> list[str]:
    """Return a note where the body does not float at this draught."""
    if body is None or isinstance(hull, CurvedMesh):
        return []
    displaced = rho * hull.immersed().volume
    if abs(displaced / body.mass - 1.0) < _FLOATS:
        return []
    return [f"the hull displaces {displaced:.4g} kg at z = 0, the mass of the body is {body.mass:.4g} kg."]
