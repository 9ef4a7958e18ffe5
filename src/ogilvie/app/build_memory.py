"""From a case to its fluid memory, at rest and under way."""

import contextlib
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.case import Case
from ogilvie.app.files import read_memory, write_memory
from ogilvie.app.sections import Memory
from ogilvie.body import RigidBody
from ogilvie.errors import FormatError, InputError, OgilvieWarning
from ogilvie.hydro.at_speed import radiation_at_rest
from ogilvie.hydro.schema import DOFS

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace

Array = NDArray[np.float64]


def slow_added_mass(hydro: "xr.Dataset") -> Array:
    """Return the added mass (6, 6) of slow motions about O: that at zero frequency, or at the lowest of the data."""
    from ogilvie.loads.base import embed

    rest = radiation_at_rest(hydro)
    A = rest.added_mass_zero.values if "added_mass_zero" in rest else rest.added_mass.values[0]
    return np.asarray(embed(A, tuple(str(d) for d in rest.influenced_dof.values), (0, 1)))


def make_memory(case: Case, hydro: "xr.Dataset", body: RigidBody) -> "tuple[Retardation, StateSpace | None]":
    """Return retardation functions and, unless the case asks for the convolution, the identified model.

    The fit knows body and restoring, so that it serves the motions. Results are kept on disk by the content of the problem.
    """
    m, hydro = case.memory, radiation_at_rest(hydro)
    stiffness = mooring_stiffness(case, body, hydro)
    if "hydrostatic_stiffness" in hydro:
        stiffness = stiffness + hydro.hydrostatic_stiffness.values
    if not m.cache:
        return _identified(m, hydro, body, stiffness)
    kept = _memory_file(m, hydro, body, stiffness)
    if kept.exists():
        try:
            K, ssm = read_memory(kept)
        except FormatError:
            kept.unlink(missing_ok=True)
        else:
            for note in ssm.notes if ssm is not None else ():
                warnings.warn(f"identify: {note}", OgilvieWarning)
            return K, ssm
    K, ssm = _identified(m, hydro, body, stiffness)
    with contextlib.suppress(OSError):  # a cache that cannot be written costs time, no more
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_memory(kept, K, ssm)
    return K, ssm


#: Difference of A_inf, as a part, beyond which a fluid memory is that of another hull; for one hull it is a few percent.
_ANOTHER = 0.25


def refuse_memory_of_another(K: "Retardation", hydro: "xr.Dataset") -> None:
    """Raise InputError where a saved fluid memory and the coefficients are those of different vessels, by their A_inf."""
    rest = radiation_at_rest(hydro)
    A = rest.added_mass_inf.values if "added_mass_inf" in rest else rest.added_mass.values[-1]
    dofs = tuple(str(d) for d in rest.influenced_dof.values)
    for i, dof in enumerate(dofs):
        j = K.dofs.index(dof) if dof in K.dofs else -1
        if j < 0 or abs(K.A_inf[j, j] - A[i, i]) > _ANOTHER * abs(A[i, i]):
            found = "none" if j < 0 else f"{K.A_inf[j, j]:.4g}"
            raise InputError(
                f"--memory: infinite-frequency added mass of {dof} near that of the coefficients, {A[i, i]:.4g}, expected, "
                f"{found} found: the fluid memory of another vessel. Identify it from these coefficients."
            )


def _identified(m: Memory, hydro: "xr.Dataset", body: RigidBody, stiffness: Array) -> "tuple[Retardation, StateSpace | None]":
    from ogilvie.memory.identify import identify
    from ogilvie.memory.retardation import retardation

    K = retardation(hydro, duration=m.duration, dt=m.dt, tail=m.tail, frequencies=m.frequencies)
    if m.model == "convolution":
        return K, None
    return K, identify(K, method=m.method, r2=m.r2, max_order=m.max_order, mass=body.matrix, stiffness=stiffness)


def _memory_file(m: Memory, hydro: "xr.Dataset", body: RigidBody, stiffness: Array) -> Path:
    """Where the fluid memory of this problem is kept; another version of the code is another problem."""
    import ogilvie.memory
    from ogilvie.hydro.cache import cache_folder, content_key

    names = ("omega", "added_mass", "radiation_damping", "added_mass_inf")
    arrays = [hydro[name].values for name in names if name in hydro]
    code = [file.read_text(encoding="utf-8") for file in sorted(Path(ogilvie.memory.__path__[0]).glob("*.py"))]
    key = content_key(*arrays, body.matrix, stiffness, m.model_dump_json(), str(hydro.attrs.get("name")), *code)
    return cache_folder() / "memory" / f"{key}.npz"


def mooring_stiffness(case: Case, body: RigidBody, hydro: "xr.Dataset") -> Array:
    """Return the (6, 6) stiffness of the springs: as given, or such that a degree of freedom has the natural period given."""
    k, hydro = np.zeros(6), radiation_at_rest(hydro)
    for dof, value in case.loads.mooring_stiffness.given.items():
        k[DOFS.index(dof)] = value
    for dof, period in case.loads.mooring_period.given.items():
        i, w = DOFS.index(dof), 2 * np.pi / period
        A = hydro.added_mass.sel(influenced_dof=dof, radiating_dof=dof)
        inertia = body.matrix[i, i] + float(np.interp(w, A.omega.values, A.values))
        own = float(hydro.hydrostatic_stiffness.values[i, i]) if "hydrostatic_stiffness" in hydro else 0.0
        k[i] = w**2 * inertia - own
        if k[i] <= 0.0:
            raise InputError(
                f"loads.mooring_period.{dof}: {period:g}: a period shorter than the unmoored one, "
                f"{2 * np.pi * np.sqrt(inertia / own):.4g} s, expected. Springs can only shorten it."
            )
    return np.diag(k)
