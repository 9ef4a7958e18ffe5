"""Pressure of the undisturbed waves on the instantaneous wetted hull: nonlinear Froude-Krylov force and restoring."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.loads.base import FROUDE_KRYLOV, RESTORING, SLOW_DRIFT, Surroundings, Terms
from ogilvie.loads.excitation import WaveExcitation
from ogilvie.loads.froude_krylov_kernel import HULL, incident_force, still_force
from ogilvie.loads.given import number
from ogilvie.loads.incident_field import STRETCHING, IncidentField
from ogilvie.loads.kernel import Kernel
from ogilvie.loads.wet_panels import vertex_weights
from ogilvie.mesh.deck_across import decked_across
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.integrals import triangles
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.split import split_long_edges
from ogilvie.waves.field import Sea

Array = NDArray[Any]

_BALANCE = 0.005  # of the weight: imbalance at eta = 0 from which on a warning is due

_LONGEST = 0.1  # of the hull's extent: longest edge of a triangle


@dataclass(frozen=True, eq=False, init=False)
class NonlinearFroudeKrylov:
    """Weight, buoyancy and pressure of the incident waves on a hull cut by their surface at the pose of the moment.

    Parameters
    ----------
    hull : PanelMesh
        Up to the deck, in the body's axes, normals into the fluid; a watertight deck is put across where it is open at the top.
    body : RigidBody
        Mass and centre of gravity.
    hydro : xarray.Dataset or sequence of them
        As for :class:`ogilvie.WaveExcitation`, with ``Froude_Krylov_force`` or ``diffraction_force``: the linear force that
        stands for the load in small motions; its ``rho`` and ``g``.
    stretching : {"wheeler", "vertical", "extrapolated"}
        Pressure near the surface: the linear profile stretched to the instantaneous depth (zero pressure at the surface);
        that of z = 0 above it; the linear profile continued above z = 0 by its slope. Without effect for surface="mean".
    surface : {"incident", "mean"}
        What cuts the hull: the incident waves, or still water (body-exact, linear waves).
    evaluation : {"interpolated", "direct"}
        Waves summed on a line for each direction and interpolated to the hull, or at every vertex.
    accuracy : float
        Standard deviation of the error of interpolated elevation and head over that of the elevation, > 0.

    Raises
    ------
    InputError
        Hull without freeboard, normals into the body, data without the parts of the excitation, unknown words.

    Notes
    -----
    With zeta and p_D = rho g sum_j a_j f_j(z') cos(theta_j) of the undisturbed sea at the place of each vertex,
    f = cosh k(z' + h)/cosh kh, and Wheeler's z' = (z - zeta) h/(h + zeta),

        F = - int_wet (p_D - rho g z) n dS + m g,      N = - int_wet (p_D - rho g z) r x n dS + r_G x m g

    in body axes about O. Pressure and height of the surface over the hull are linear on each triangle (a panel is two); the
    zero of the latter cuts it. Triangles with edges above a tenth of the hull's extent are split.
    Still water is exact for the panels; in waves the error falls with the square of their size.
    Two compiled forces add up: still water, which acts always, and what the sea adds to it.

    Covers restoring, Froude-Krylov force and slow drift (its second-order parts would be counted twice by a drift force).
    Diffraction is a load of its own: ``WaveExcitation(hydro, part="diffraction")``. In small motions the load is its linear
    limit. In a run where a part of the hull comes deeper under the waves than twice the hull's size, or below the bottom, the
    force is not known and the run stops.

    References
    ----------
    Wheeler (1970), Journal of Petroleum Technology 22, 359-367, for the stretching; paper D (Somayajula and Falzarano) for
    double counting with second-order forces.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> from ogilvie.mesh.shapes import box
    >>> barge = box(60.0, 10.0, 8.0, panels=100).translated((0, 0, 5.0))  # draught 3 m
    >>> body = RigidBody.from_hull(barge.immersed(), zg=0.5, gyradii=(3.5, 15.0, 15.0))
    >>> w, Z, X = np.linspace(0.2, 2.0, 4), np.zeros((4, 6, 6)), np.zeros((4, 1, 6))
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[0.0], excitation_force=X)
    >>> load = NonlinearFroudeKrylov(barge, body, hydro.assign(Froude_Krylov_force=hydro.excitation_force))
    >>> (load.force(eta=[0, 0, 0.5, 0, 0, 0])[2] / (hydro.rho * hydro.g * 60.0 * 10.0)).round(9)  # 0.5 m out of the water
    np.float64(-0.5)
    """

    hydro: xr.Dataset | Sequence[xr.Dataset] = field(repr=False)
    stretching: str
    surface: str
    evaluation: str
    accuracy: float
    weight: Array
    stiffness: Array
    rest: Array
    _hull: Array = field(repr=False)
    _size: float = field(repr=False)
    _linear: WaveExcitation = field(repr=False)
    name: str = "froude_krylov"

    def __init__(
        self,
        hull: PanelMesh,
        body: RigidBody,
        hydro: xr.Dataset | Sequence[xr.Dataset],
        *,
        stretching: str = "wheeler",
        surface: str = "incident",
        evaluation: str = "interpolated",
        accuracy: float = 1e-4,
    ) -> None:
        for what, value, known in (
            ("stretching", stretching, tuple(STRETCHING)),
            ("surface", surface, ("incident", "mean")),
            ("evaluation", evaluation, ("interpolated", "direct")),
        ):
            if value not in known:
                raise InputError(f"NonlinearFroudeKrylov: {what}: one of {', '.join(known)} expected, {value!r} found.")
        for what, thing, kind in (("hull", hull, PanelMesh), ("body", body, RigidBody)):
            if not isinstance(thing, kind):
                raise InputError(f"NonlinearFroudeKrylov: {what}: a {kind.__name__} expected, {type(thing).__name__} found.")
        linear = WaveExcitation(hydro, part="Froude-Krylov")
        closed = decked_across(hull)
        rho, g = (float(linear.hydro.attrs[key]) for key in ("rho", "g"))
        weight = np.r_[float(body.mass), np.array(body.cog, dtype=float)]
        data = _packed(closed, weight, rho, g)
        stiffness = hydrostatics(hull.immersed(), body=body, rho=rho, g=g).stiffness
        rest = Kernel(still_force, data).force()
        for key, array in (("weight", weight), ("stiffness", stiffness), ("rest", rest), ("_hull", data)):
            array.setflags(write=False)
            object.__setattr__(self, key, array)
        for key, given in (
            ("hydro", hydro),
            ("stretching", stretching),
            ("surface", surface),
            ("evaluation", evaluation),
            ("accuracy", number(accuracy, "NonlinearFroudeKrylov: accuracy", above=0.0)),
            ("_size", float(np.linalg.norm(closed.vertices, axis=1).max())),
            ("_linear", linear),
            ("name", "froude_krylov"),
        ):
            object.__setattr__(self, key, given)
        self._tell_of_imbalance(body, g)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({RESTORING, FROUDE_KRYLOV, SLOW_DRIFT})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled forces for the time loop; the vessel's body has to be the one of the load."""
        body = surroundings.body
        if not np.allclose(np.r_[body.mass, body.cog], self.weight, rtol=1e-9, atol=1e-9):
            raise InputError(
                f"NonlinearFroudeKrylov: the vessel's body expected ({body.mass:.6g} kg at {body.cog.tolist()}), "
                f"{self.weight[0]:.6g} kg at {self.weight[1:].tolist()} found. Make the load with the vessel's body."
            )
        wave = self._linear.bind(surroundings).wave
        return Terms(
            kernel=Kernel(still_force, self._hull),
            wave=wave,
            encounter=partial(_incident, self),
            small=Terms(stiffness=self.stiffness, wave=wave),
        )

    def force(self, sea: Sea | None = None, *, t: ArrayLike = 0.0, eta: ArrayLike = (0, 0, 0, 0, 0, 0)) -> Array:
        """Return weight and pressure force on the body about O, in body axes.

        Parameters
        ----------
        sea : Sea, optional
            Still water without it; the first realisation.
        t : float or (n,) array
            s.
        eta : (6,) or (n, 6) array
            Pose in the world, m, rad.

        Returns
        -------
        (6,) or (n, 6) array
            N, N m; NaN where the sea is not known.
        """
        kernels = [Kernel(still_force, self._hull)] + ([] if sea is None else [_incident(self, sea, 0.0)])
        times, poses = np.asarray(t, dtype=float), np.asarray(eta, dtype=float)
        shape = np.broadcast_shapes(times.shape, poses.shape[:-1])
        times, poses = np.broadcast_to(times, shape).ravel(), np.broadcast_to(poses, (*shape, 6)).reshape(-1, 6)
        forces = [sum(k.force(t=a, eta=b) for k in kernels) for a, b in zip(times, poses, strict=True)]
        return np.array(forces).reshape(*shape, 6)

    def _tell_of_imbalance(self, body: RigidBody, g: float) -> None:
        share = self.rest[2] / (body.mass * g)
        if abs(share) > _BALANCE:
            warnings.warn(
                f"NonlinearFroudeKrylov: buoyancy that balances the weight at eta = 0 expected, {100 * share:+.3g} % of the "
                "weight left over; the vessel moves to another draught. Make the body for this hull (RigidBody.from_hull).",
                OgilvieWarning,
                stacklevel=3,
            )


def _incident(load: NonlinearFroudeKrylov, sea: Sea, ramp: float) -> Kernel:
    """Return the compiled difference of the force in waves and in still water."""
    stretching = "vertical" if load.surface == "mean" else load.stretching
    field_ = IncidentField.of(
        sea,
        reach=2.0 * load._size,
        accuracy=load.accuracy,
        stretching=stretching,
        ramp=ramp,
        lines=load.evaluation == "interpolated",
    )
    surface = 0.0 if load.surface == "mean" else 1.0
    free = 1.0 if load.surface == "incident" and load.stretching == "wheeler" else 0.0
    data = np.concatenate([[surface, free, len(load._hull)], load._hull, field_.data])
    limits = f"hulls at most {field_.reach:.4g} m below the waves and above the bottom"
    return Kernel(incident_force, data, field_.own, limits, steady=False)


def _packed(closed: PanelMesh, weight: Array, rho: float, g: float) -> Array:
    """Return the numbers of the hull: counts, rho g, weight and centre of gravity, vertices, triangles, weights."""
    tri = triangles(closed.faces)
    p = closed.vertices[tri]
    tri = tri[np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) > 0.0]
    length = _LONGEST * float(np.ptp(closed.bounds, axis=0).max())
    vertices, tri = split_long_edges(closed.vertices, tri, length=length)  # a deck may come as a few large triangles
    used, places = np.unique(tri, return_inverse=True)
    tri, vertices = places.reshape(tri.shape), vertices[used]
    head = [len(vertices), len(tri), rho * g, weight[0] * g, *weight[1:]]
    assert len(head) == HULL
    W = vertex_weights(vertices, tri)
    return np.concatenate([head, vertices.T.ravel(), tri.T.ravel().astype(float), W.T.ravel()])
