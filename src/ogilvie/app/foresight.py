"""What the long work would come to grief on, or would do without a word though nobody can mean it: told before it begins."""

import warnings
from math import ceil, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.app import build, build_run
from ogilvie.app.angles import in_radians
from ogilvie.app.build_control import try_parts
from ogilvie.app.build_drift import refuse_without_drift
from ogilvie.app.case import Case
from ogilvie.app.plausible import (
    compare_centres,
    compare_heights,
    compare_inertia,
    compare_mass,
    doubts,
    refuse_capsizing,
    refuse_gyration,
    refuse_size,
)
from ogilvie.errors import InputError, OgilvieWarning

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.mesh.panels import PanelMesh


def foresee(case: Case, hull: "PanelMesh | None") -> None:
    """Try what needs no coefficients: parts of the vessel, its weight and stability, the sea, the directions it comes from.

    Raises
    ------
    InputError
        What cannot be: a table, a mass in tonnes, a hull in millimetres, a negative GM, a sea from where there are no data.

    Warns
    -----
    OgilvieWarning
        What can be but is hardly meant.
    """
    if hull is not None:
        refuse_size(case, hull)
    try_parts(case, hull)
    if hull is not None and case.body is not None:
        body = build.make_body(case, hull)
        statics = build.statics(case, hull, body)
        compare_mass(body.mass, case.water.rho * hull.volume, "displaced by the hull")
        compare_centres(body, hull)
        refuse_gyration(body, hull)
        if statics is not None:
            refuse_capsizing(case, statics)
    _result(case)
    for sentence in (*in_radians(case), *doubts(case, hull)):
        warnings.warn(sentence, OgilvieWarning)
    if hull is not None and case.coefficients.file is None:
        foresee_sea(case, build.frequencies(case, hull), _headings(case, hull))


def foresee_data(case: Case, hydro: "xr.Dataset") -> None:
    """Try what needs the coefficients: the mass against theirs, the sea and the directions that it comes from."""
    from ogilvie.loads.speed_table import HeadingTable

    has_inertia = "inertia_matrix" in hydro and hydro.inertia_matrix.shape == (6, 6)
    if case.body is not None and case.hull is None and case.body.mass is not None and has_inertia:
        M = hydro.inertia_matrix.values
        compare_mass(case.body.mass, float(M[0, 0]), "of the coefficients")
        mine = build.make_body(case, None).matrix
        compare_inertia(mine, M)
        compare_heights(mine, M, hydro)
    refuse_without_drift(case, hydro)
    if "excitation_force" in hydro:
        foresee_sea(case, hydro.omega.values, HeadingTable.of(hydro).headings)


def foresee_sea(case: Case, omega: Any, headings: Any) -> None:
    """Make the sea, and look whether the coefficients hold the directions that it comes from.

    Parameters
    ----------
    omega : (n,) array
        Frequencies of the coefficients, rad/s.
    headings : Headings
        Their wave directions relative to the bow.
    """
    import xarray as xr

    from ogilvie.loads.interpolation import heading_weights

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)  # it is told when the sea is made for good
        sea = build_run.make_sea(case, build_run.make_spectrum(case), xr.Dataset(coords={"omega": omega}))
    if sea is None:
        return
    try:
        heading_weights(headings, np.unique(sea.direction) - radians(case.vessel.heading_deg))
    except InputError:
        met = 180 - (180 + case.vessel.heading_deg - case.sea.direction_deg) % 360
        spread = ", spread," if case.sea.spreading is not None else ""
        key = "directions_deg" if case.coefficients.file is None else "file"
        raise InputError(
            f"sea.direction_deg: {case.sea.direction_deg:g}: waves{spread} that meet the vessel at {met:g} "
            f"deg from its bow: among or between the directions of the coefficients, {headings.text}, no two of them more than "
            f"60 deg apart, expected. Change the direction, or add to coefficients.{key}."
            + "".join(f"\n{sentence}" for sentence in in_radians(case))
        ) from None


def _headings(case: Case, hull: "PanelMesh") -> Any:
    """The directions that will be solved, on both sides of a hull that is its own mirror image."""
    from ogilvie.loads.interpolation import unwrapped

    b = build.directions(case, hull)
    if "xz" in hull.planes:
        b = np.unique(np.concatenate([b, -b[np.abs(b) < np.pi - 1e-9]]).round(9))
    return unwrapped(b, np.zeros((1, len(b), 1), dtype=complex))[0]


def _result(case: Case) -> None:
    """Refuse a result that does not fit in the machine's memory: pose, velocity, acceleration and three loads at least."""
    from ogilvie.sim.run import check_memory

    s = case.simulation
    check_memory(ceil(s.duration / (s.output_step or s.dt)) * s.realisations, 36)
