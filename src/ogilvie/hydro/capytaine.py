"""Radiation and diffraction by a panel method (the only importer of capytaine).

Capytaine supplies the influence of the panels on each other through the Green function of the free surface; boundary
conditions, equations, symmetry, forces, forward speed and the cache are those of this package.
"""

import logging
import shutil
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.body import RigidBody
from ogilvie.errors import ConvergenceError, InputError, OgilvieError, OgilvieWarning
from ogilvie.hydro.bem_case import Case, Irregular, make_case, warn_if_coarse
from ogilvie.hydro.bem_depth import exponentials
from ogilvie.hydro.bem_kernel import force_vectors
from ogilvie.hydro.bem_panels import Facets, HullPanels
from ogilvie.hydro.bem_result import assemble
from ogilvie.hydro.bem_store import SolutionStore
from ogilvie.hydro.bem_table import near_surface
from ogilvie.hydro.cache import cache_folder, fill_folder
from ogilvie.hydro.drift_centre import Dipoles
from ogilvie.hydro.drift_solve import Sources
from ogilvie.hydro.progress import tracked
from ogilvie.hydro.threads import available_cores, library_threads
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: Raised whenever the same problem would give other numbers than before: cached results of other revisions are not used.
REVISION = 4

#: Linear algebra with up to so many unknowns is faster on one thread.
SMALL = 800

#: Points of the integral that Capytaine tabulates; 1001 (its default) take four times as long and move A and B by 5e-5.
_TABLE = {"tabulation_nb_integration_points": 251}


def solve_bem(
    hull: PanelMesh,
    body: RigidBody | None = None,
    *,
    omega: ArrayLike,
    wave_direction: ArrayLike = (np.pi,),
    rho: float = SEA_WATER,
    g: float = GRAVITY,
    water_depth: float = np.inf,
    speed: float = 0.0,
    irregular_frequencies: Irregular = "remove",
    progress: bool | None = None,
    cache: bool = True,
    workers: int | None = None,
) -> xr.Dataset:
    """Return added mass, damping and wave forces of a hull by the boundary element method.

    Parameters
    ----------
    hull : PanelMesh
        Wetted hull (z <= 0, normals into the fluid); its symmetry is used. Its own `lid` is used if it has one.
    body : RigidBody, optional
        Adds `inertia_matrix` and `hydrostatic_stiffness` (gravity included) to the result.
    omega : (n_w,) array
        Frequencies, rad/s. At forward speed: of oscillation for added mass and damping, of the incident waves for the forces.
    wave_direction : (n_b,) array
        Directions that the waves travel to, rad; pi is head seas.
    rho, g : float
        kg/m3, m/s2.
    water_depth : float
        m; inf for deep water.
    speed : float
        Forward speed, m/s.
    irregular_frequencies : {"remove", "keep"}
        Remove them by panels on the waterplane inside the hull (made here if the hull brings none), or leave them.
    progress : bool, optional
        Show a progress bar; by default for long work on a terminal.
    cache : bool
        Keep results on disk, wavenumber by wavenumber, and use those kept (see :mod:`ogilvie.hydro.cache`). An interrupted
        run goes on where it stopped; other directions, speeds or densities of a solved hull cost next to nothing.
    workers : int, optional
        Threads; by default all cores, or OMP_NUM_THREADS.

    Returns
    -------
    xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`: added_mass, radiation_damping, added_mass_inf, added_mass_zero (deep water at zero
        speed only: infinite otherwise), excitation_force and its parts Froude_Krylov_force and diffraction_force; everything
        about O. Attributes name the numbers of panels and the frequency that they resolve, `omega_resolved`.

    Raises
    ------
    InputError
        The hull cannot be solved (above water, normals inward), or an argument is out of range.
    ConvergenceError
        The Green function cannot be evaluated.

    Warns
    -----
    OgilvieWarning
        Frequencies above those that the panels resolve; damaged entries of the cache.

    Notes
    -----
    Direct method: the potential on flat panels with one unknown each, second order in the panel size. Panels on z = 0 inside
    the hull, with equations of their own (:mod:`ogilvie.hydro.bem_kernel`), remove the irregular frequencies: heave damping of
    a box 4 x 1 x 0.5 m of 1000 panels is within 0.2 % of its largest value of the energy in the waves up to K = 10 rad/m.

    Forward speed: the Green function of zero speed at the frequency of encounter, uniform flow past the hull and Tuck's theorem
    (:mod:`ogilvie.hydro.bem_forces`), as in the strip theory of Salvesen, Tuck and Faltinsen but in three dimensions. Good for
    slender hulls at moderate speed and tau = U omega_e/g well above 1/4. The force of overtaken waves oscillates with the
    negative omega_e = omega - k U cos(direction). Damping tends to `radiation_damping_inf` at high frequency then.

    References
    ----------
    M. Ancellin and F. Dias, Capytaine, Journal of Open Source Software 4 (2019) 1341; C.-H. Lee and J. N. Newman, Computation
    of wave effects using the panel method (2005); N. Salvesen, E. O. Tuck and O. Faltinsen, SNAME 78 (1970) 250.

    Examples
    --------
    >>> hull = PanelMesh([[2.0, 0, -1], [2, 1, -1], [0, 1, -1], [0, 0, -1], [2, 0, 0], [2, 1, 0], [0, 1, 0]],
    ...                  [[0, 3, 2, 1], [1, 2, 6, 5], [0, 1, 5, 4]], symmetry="xz+yz")
    >>> hydro = solve_bem(hull, omega=[1.0], rho=1000.0, cache=False, workers=1)
    >>> hydro.added_mass.shape, bool(hydro.radiation_damping.sel(influenced_dof="heave", radiating_dof="heave") > 0)
    ((1, 6, 6), True)
    """
    case = make_case(
        hull,
        omega=omega,
        wave_direction=wave_direction,
        rho=rho,
        g=g,
        water_depth=water_depth,
        speed=speed,
        irregular_frequencies=irregular_frequencies,
    )
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InputError(f"solve_bem: workers: a number of threads >= 1 or None expected, {workers!r} found.")
    resolved = warn_if_coarse(case)
    vectors = _solutions(
        case, store=SolutionStore(case, settings=green_settings()) if cache else None, progress=progress, workers=workers
    )
    attrs = {"source": f"ogilvie solve_bem, Capytaine {_capytaine_version()}", "omega_resolved": resolved}
    return assemble(case, vectors, body=body, attrs=attrs)


def _solutions(case: Case, *, store: SolutionStore | None, progress: bool | None, workers: int | None) -> dict[float, Complex]:
    """Return the force vectors at every wavenumber of the case, from the store as far as they are there."""
    kept = {k: store.load(k) if store else None for k in case.wavenumbers}
    found = {k: g for k, g in kept.items() if g is not None}
    missing = [k for k in case.wavenumbers if k not in found]
    if missing:
        green = _green_function()
        with frequency_threads(case, workers or available_cores()):
            for k in tracked(missing, show=progress, title=f"solving {case.panels.hull.name}"):
                panels = case.panels_at(k)
                influence = partial(_influence, green, panels, k, case.depth)
                found[k] = force_vectors(panels, influence, K=case.deep_wavenumber(k)).conj()
                if store:
                    store.save(k, found[k])
    if store:
        store.finish()
    return found


def frequency_threads(case: Case, workers: int) -> AbstractContextManager[None]:
    """Return a context in which influence matrices and equations of a case use so many threads."""
    small = case.panels.n_hull + case.panels.n_lid <= SMALL
    return library_threads(
        openmp="capytaine.green_functions.Delhommeau_float64", integrals=workers, algebra=1 if small else workers
    )


def _influence(green: Any, panels: HullPanels, k: float, depth: float, mirror: Array) -> tuple[Complex, Complex]:
    """Return S and D at the mirrored points due to the stored panels, in Capytaine's convention exp(-i omega t).

    Capytaine 3.0 gives the imaginary part of the influence of a panel on z = 0 on its own middle the wrong sign; the points of
    the lid lie below.
    """
    from capytaine.green_functions.abstract_green_function import GreenFunctionEvaluationError

    receivers = SimpleNamespace(faces_centers=panels.points * mirror, nb_faces=len(panels.facets.faces))
    try:
        return green.evaluate(
            receivers,
            _sources(panels.facets),
            wavenumber=k,
            water_depth=depth,
            adjoint_double_layer=False,
            diagonal_term_in_double_layer=bool(np.all(mirror > 0.0)),
        )
    except (GreenFunctionEvaluationError, NotImplementedError) as e:
        raise ConvergenceError(
            f"solve_bem: the Green function cannot be evaluated at k = {k:.6g} rad/m in {depth:.6g} m of water ({e}). "
            "Leave this frequency out."
        ) from e


def surface_green_function() -> Any:
    """Return the Green function with a table that is exact near the free surface, for points on it and sources on lids."""
    green = _green_function()
    z = np.asarray(green.tabulated_z_range)
    near = np.flatnonzero(z >= -1.0)
    table = np.array(green.tabulated_integrals, order="F")
    table[:, near, 0] = near_surface(np.asarray(green.tabulated_r_range), z[near])
    green.tabulated_integrals = table
    return green


def source_influence(green: Any, facets: Facets, k: float, depth: float) -> Sources:
    """Return the influence of sources on all panels, and its gradient, in the convention exp(+i omega t)."""

    def influence(points: Array, mirror: Array) -> tuple[Complex, Complex]:
        from capytaine.green_functions.abstract_green_function import GreenFunctionEvaluationError

        try:
            S, G = green.evaluate(
                points * mirror,
                _sources(facets),
                wavenumber=k,
                water_depth=depth,
                adjoint_double_layer=True,
                early_dot_product=False,
                diagonal_term_in_double_layer=False,
            )
        except (GreenFunctionEvaluationError, NotImplementedError) as e:
            raise ConvergenceError(
                f"mean_drift: the Green function cannot be evaluated at k = {k:.6g} rad/m in {depth:.6g} m of water ({e}). "
                "Leave this frequency out."
            ) from e
        return np.conjugate(S, out=S), np.conjugate(G, out=G)

    return influence


def dipole_influence(green: Any, panels: HullPanels, k: float, depth: float) -> Dipoles:
    """Return the influence of sources and dipoles on all panels, in the convention exp(+i omega t)."""

    def influence(mirror: Array) -> tuple[Complex, Complex]:
        S, D = _influence(green, panels, k, depth, mirror)
        return np.conjugate(S, out=S), np.conjugate(D, out=D)

    return influence


def _sources(facets: Facets) -> Any:
    """Return the panels under the names that Capytaine's Green functions read from a mesh."""
    return SimpleNamespace(
        vertices=facets.vertices,
        faces=facets.faces,
        nb_faces=len(facets.faces),
        faces_centers=facets.centers,
        faces_normals=facets.normals,
        faces_areas=facets.areas,
        faces_radiuses=facets.radii,
        quadrature_points=(facets.centers[:, None, :], facets.areas[:, None]),
    )


def green_settings() -> str:
    """Return what solutions depend on besides the problem: revision, version, table of the Green function."""
    return f"revision {REVISION}; capytaine {_capytaine_version()}; {sorted(_TABLE.items())}"


def _capytaine_version() -> str:
    """Return the installed version without importing it (3 s)."""
    try:
        return version("capytaine")
    except PackageNotFoundError:
        raise OgilvieError(
            "solve_bem: Capytaine expected, not installed (there is no ready-made package for Linux on ARM). Install it with "
            "'pip install capytaine', or read coefficients of another code with read_hydro."
        ) from None


def _green_function() -> Any:
    """Return Capytaine's Green function with its table (made once, 5 s, and kept) and our own fit for finite depth."""
    with _root_logger_untouched():
        from capytaine import Delhommeau
    folder = cache_folder() / "green" / f"capytaine-{_capytaine_version()}-{_TABLE['tabulation_nb_integration_points']}"
    log = logging.getLogger("capytaine")
    level = log.level
    log.setLevel(logging.ERROR)  # it announces the table as a warning
    try:
        if not folder.is_dir():
            fill_folder(folder, lambda new: Delhommeau(**_TABLE, tabulation_cache_dir=str(new)))
        green = _load_table(folder, Delhommeau)
    finally:
        log.setLevel(level)
    green.find_best_exponential_decomposition = exponentials
    return green


def _load_table(folder: Path, green_function: Callable[..., Any]) -> Any:
    if not folder.is_dir():
        return green_function(**_TABLE, tabulation_cache_dir=None)
    try:
        return green_function(**_TABLE, tabulation_cache_dir=str(folder))
    except (OSError, zipfile.BadZipFile, zlib.error) as e:
        warnings.warn(f"solve_bem: the table in {folder} cannot be read ({e}); it is computed again.", OgilvieWarning)
        shutil.rmtree(folder, ignore_errors=True)
        return green_function(**_TABLE, tabulation_cache_dir=None)


@contextmanager
def _root_logger_untouched() -> Iterator[None]:
    """Keep the import of capytaine from installing a handler on the root logger."""
    guard = logging.NullHandler()
    logging.root.addHandler(guard)
    try:
        yield
    finally:
        logging.root.removeHandler(guard)
