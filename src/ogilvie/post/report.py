"""The report of a case: what was found, drawn and tabulated on one self-contained page."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.post.page import Picture, Section, Table, render_page
from ogilvie.post.report_course import course_table
from ogilvie.post.report_mooring import tension_table
from ogilvie.post.report_tables import (
    body_table,
    check_table,
    hydrostatics_table,
    memory_table,
    natural_periods,
    number,
    statistics_table,
    wave_table,
)
from ogilvie.units import knot

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.loads.mooring_lines import CatenaryMooring
    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace
    from ogilvie.mesh.hydrostatics import Hydrostatics
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.waves.field import Sea
    from ogilvie.waves.spectrum import Spectrum


@dataclass(frozen=True, eq=False)
class Findings:
    """What a case produced; None for what it did not.

    Parameters
    ----------
    title : str
    body : RigidBody
    hydro : xarray.Dataset
        Coefficients.
    K, ssm : Retardation, StateSpace or None
        Fluid memory.
    hull, hydrostatics : PanelMesh, Hydrostatics
    response : xarray.DataArray
        From :func:`ogilvie.rao`, with the damping and springs of the vessel.
    spectrum, sea : Spectrum, Sea
    run : xarray.Dataset
        From :func:`ogilvie.simulate`.
    statistics : xarray.Dataset
        From :func:`ogilvie.post.stats.summary`.
    expected, expected_spectra : xarray.Dataset, xarray.DataArray
        Statistics and spectra of the motions in the frequency domain.
    checks : check report of the coefficients
    skip : float
        Start of the statistics, s.
    lines : CatenaryMooring
        Mooring lines of a run of large motions.
    weather : tuple of (str, str)
        What wind and current are.
    loads : tuple of str
        What acts on the vessel.
    notes : tuple of str
        Warnings and remarks.
    provenance : tuple of (str, str)
    case_text : str
        The TOML text.
    """

    title: str
    body: "RigidBody"
    hydro: "xr.Dataset"
    K: "Retardation"
    ssm: "StateSpace | None" = None
    hull: "PanelMesh | None" = None
    hydrostatics: "Hydrostatics | None" = None
    response: "xr.DataArray | None" = None
    spectrum: "Spectrum | None" = None
    sea: "Sea | None" = None
    run: "xr.Dataset | None" = None
    statistics: "xr.Dataset | None" = None
    expected: "xr.Dataset | None" = None
    expected_spectra: "xr.DataArray | None" = None
    checks: Any = None
    skip: float = 0.0
    lines: "CatenaryMooring | None" = None
    weather: tuple[tuple[str, str], ...] = ()
    loads: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    provenance: tuple[tuple[str, str], ...] = ()
    case_text: str = ""


def report(f: Findings, *, pictures: Mapping[str, tuple[bytes, str]]) -> str:
    """Return the report as one HTML page without links to the outside.

    Parameters
    ----------
    f : Findings
    pictures : mapping of str to (bytes, str)
        PNG and caption of the figures by name.
    """
    drawn = {name: Picture(png, caption) for name, (png, caption) in pictures.items()}
    sections = [s for s in _sections(f, drawn) if s.pictures or s.tables or s.notes or s.verbatim or s.paragraphs]
    lead = "From hull to motions in the time domain. SI units; x forward, y port, z up; positive pitch is bow down; "
    lead += "directions are those that waves travel to, 180\u00b0 head sea."
    return render_page(f.title, sections, lead=lead, facts=_facts(f))


def _sections(f: Findings, drawn: Mapping[str, Picture]) -> Sequence[Section]:
    def shown(*names: str) -> list[Picture]:
        return [drawn[name] for name in names if name in drawn]

    statics = [hydrostatics_table(f.hydrostatics)] if f.hydrostatics is not None else []
    problems = [check_table(f.checks)] if f.checks is not None else []
    findings = [finding.sentence for finding in f.checks.findings] if f.checks is not None else []
    motion_tables = [statistics_table(f.statistics, f.expected)] if f.statistics is not None else []
    motion_tables += course_table(f.run, skip=f.skip) if f.run is not None else []
    if f.lines is not None and f.run is not None and float(f.run.time[-1] - f.run.time[0]) > f.skip:
        motion_tables.append(tension_table(f.lines, f.run, skip=f.skip))
    weather = [Table(f.weather, caption="Wind and current.", wrap=frozenset({1}))] if f.weather else []
    return [
        Section("Overview", pictures=shown("overview")),
        Section("Hull and hydrostatics", pictures=shown("hull"), tables=[*statics, body_table(f)], narrow=True),
        Section("Hydrodynamic coefficients", [_about_hydro(f)], shown("coefficients", "excitation", "drift")),
        Section(
            "Fluid memory",
            [_about_memory(f)],
            shown("retardation"),
            [memory_table(f.K, f.ssm)],
            list(dict.fromkeys([*f.K.notes, *_model_notes(f)])),
        ),
        Section("Responses", pictures=shown("rao")),
        Section(
            "Sea, wind and current" if f.weather else "Sea",
            pictures=shown("spectrum"),
            tables=[*wave_table(f.spectrum, f.sea), *weather],
        ),
        Section(
            "Motions",
            [_about_run(f)] if f.run is not None else [],
            shown("track", "controls", "motions", "response_spectra", "mooring"),
            motion_tables,
        ),
        Section("Checks and warnings", [], (), problems, [*findings, *f.notes]),
        Section("Case", verbatim=f.case_text),
        Section("Provenance", tables=[_provenance(f)] if f.provenance else []),
    ]


def _facts(f: Findings) -> list[tuple[str, str]]:
    facts = []
    if f.hydrostatics is not None:
        facts += [
            ("displacement", f"{number(f.hydrostatics.displacement / 1000, 5)} t"),
            ("transverse GM", f"{f.hydrostatics.GM_T:.2f} m"),
        ]
    facts += [
        (f"{dof} period", f"{T:.3g} s")
        for dof, T in natural_periods(f.hydro, f.body).items()
        if dof in ("heave", "roll", "pitch")
    ]
    if f.ssm is not None:
        facts.append(("memory states", str(f.ssm.order)))
    if speed := float(f.run.attrs.get("speed", 0.0)) if f.run is not None else 0.0:
        facts.append(("speed", f"{speed / knot:.3g} kn"))
    if f.spectrum is not None:
        facts.append(("sea", f"Hs {f.spectrum.hs:.3g} m, Tp {f.spectrum.tp:.3g} s"))
    return facts


def _about_hydro(f: Findings) -> str:
    h = f.hydro
    depth = "deep water" if np.isinf(h.attrs["water_depth"]) else f"depth {h.attrs['water_depth']:g} m"
    text = (
        f"{h.sizes['omega']} frequencies from {float(h.omega[0]):.3g} to {float(h.omega[-1]):.3g} rad/s, {depth}, "
        f"speed {h.attrs.get('speed', 0.0):.3g} m/s. Source: {h.attrs.get('source', 'not stated')}."
    )
    if "wave_direction" in h.coords:
        b = np.degrees(h.wave_direction.values)
        text += f" {len(b)} wave direction{'s' if len(b) > 1 else ''} relative to the bow: {_listed(b)}\u00b0."
    return text


def _listed(values: Any) -> str:
    """Numbers one by one, or where they are many the first two and the last."""
    words = [f"{x:.4g}" for x in values]
    return ", ".join(words) if len(words) <= 13 else f"{words[0]}, {words[1]}, ... {words[-1]}"


def _about_memory(f: Findings) -> str:
    text = f"K(t) to {f.K.duration:.4g} s in steps of {f.K.dt:.3g} s. Source: {f.K.source}."
    if f.ssm is None:
        return text + " The convolution itself is used in the time domain."
    return text + f" {describe(f.ssm)}"


def describe(ssm: "StateSpace") -> str:
    """Return order, stability, passivity and worst fit of a model in a sentence."""
    words = ["stable" if ssm.is_stable else "UNSTABLE"]
    if ssm.is_passive is not None:
        words.append("passive" if ssm.is_passive else f"not passive (margin {ssm.passivity_margin:.2g})")
    worst = {"A": ssm.r2_added_mass, "B": ssm.r2_damping, "K": ssm.r2}
    lowest = [f"{np.nanmin(r2):.4f} of {letter} ({_entry(ssm.dofs, r2)})" for letter, r2 in worst.items() if r2 is not None]
    quality = f"lowest R\u00b2 of a coupling {', '.join(lowest)}"
    return f"State space of {ssm.order} states ({ssm.method}), {', '.join(words)}; {quality}."


def _entry(dofs: Sequence[str], r2: Any) -> str:
    """The name of the entry with the lowest R2."""
    i, j = (int(k) for k in np.unravel_index(np.nanargmin(r2), np.shape(r2)))
    return dofs[i] if i == j else f"{dofs[i]}-{dofs[j]}"


def _model_notes(f: Findings) -> Sequence[str]:
    return f.ssm.notes if f.ssm is not None else ()


def _about_run(f: Findings) -> str:
    run = f.run
    assert run is not None
    n = int(run.sizes.get("realisation", 1))
    length = number(float(run.time[-1] - run.time[0]))
    text = f"{n} realisation{'s' if n > 1 else ''} of {length} s, dt {number(run.attrs['dt'])} s"
    if n > 1 and len(run.attrs.get("seeds", ())) == n:
        text += f", seeds {run.attrs['seeds'][0]} to {run.attrs['seeds'][-1]}"
    text += f", {run.attrs['method']}, {run.attrs.get('motions', 'small')} motions."
    if f.loads:
        text += f" Loads: {', '.join(f.loads)}."
    if f.skip > 0:
        text += f" Statistics from {number(f.skip)} s on."
    if f.spectrum is not None and "slow_drift" not in f.loads and {"mooring", "positioning"} & set(f.loads):
        text += " Waves of first order alone: their mean and slow drift is left out, which a vessel that is held may feel most."
    return text + (" INTERRUPTED: this is what had been computed." if not run.attrs.get("complete", 1) else "")


def _provenance(f: Findings) -> Any:
    return Table(f.provenance, left=frozenset({0, 1}), wrap=frozenset({1}))
