"""A case from its file to results: each stage writes its file when it is done, so that an interrupt keeps what there was."""

import platform
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ogilvie.app import build, build_run
from ogilvie.app.build_memory import make_memory
from ogilvie.app.case import Case
from ogilvie.app.compare import frequency_domain
from ogilvie.app.console import step, warn
from ogilvie.app.drawing import Painter
from ogilvie.app.files import collected_warnings, write_bytes, write_memory, write_result, write_text
from ogilvie.app.foresight import foresee, foresee_data
from ogilvie.app.weather import weather
from ogilvie.atomic import check_place
from ogilvie.errors import ConvergenceError, OgilvieWarning
from ogilvie.post.report import Findings, report
from ogilvie.post.report_figures import (
    Job,
    drift_figure,
    hull_figures,
    memory_figures,
    mooring_figure,
    overview_figure,
    run_figures,
    wave_figures,
)

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.loads.mooring_lines import CatenaryMooring
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.sim.vessel import Vessel
    from ogilvie.waves.field import Sea


@dataclass(eq=False)
class Workspace:
    """The output folder and what has been written to it."""

    folder: Path
    written: list[Path] = field(default_factory=list)
    solving: bool = False
    new: bool = False

    def open(self) -> "Workspace":
        """Make the folder if need be."""
        if self.folder.exists() and not self.folder.is_dir():
            raise NotADirectoryError(20, "Not a directory", str(self.folder))
        self.new = not self.folder.exists()
        self.folder.mkdir(parents=True, exist_ok=True)
        check_place(self.folder / "report.html")
        return self

    def keep(self, path: Path) -> Path:
        """Note a file that was written whole."""
        self.written.append(path)
        return path

    @contextmanager
    def naming_what_is_kept(self) -> Iterator[None]:
        """Add to whatever ends the work early what is there by then."""
        try:
            yield
        except (KeyboardInterrupt, ConvergenceError) as stop:
            names = ", ".join(p.name for p in self.written)
            stop.add_note(f"Kept in {self.folder}: {names}." if names else "Nothing was written.")
            if self.solving:
                stop.add_note("What was solved is in the cache: the same case goes on from there.")
            raise
        finally:
            if self.new and not self.written:
                with suppress(OSError):
                    self.folder.rmdir()  # no empty folder is left of work that came to nothing


def run_case(case: Case, folder: str | Path, *, progress: bool | None = None) -> Findings:
    """Run a case from hull or coefficients to result, figures and report.

    Parameters
    ----------
    case : Case
    folder : str or Path
        Gets coefficients.nc, memory.npz, result.nc, figures/*.png and report.html, each written whole when its stage is done.
    progress : bool, optional
        Progress bars; by default on a terminal.

    Returns
    -------
    Findings
        With `run.attrs["complete"] == 0` where an interrupt ended the simulation early.

    Raises
    ------
    OgilvieError
        The input cannot be used.
    KeyboardInterrupt
        Interrupted before the simulation had results; a note says what was kept.
    """
    began = time.perf_counter()
    place = Workspace(Path(folder)).open()
    notes: list[str] = []
    drawing = case.output.figures or case.output.report
    with place.naming_what_is_kept(), Painter(wanted=drawing) as painter:
        with collected_warnings(notes):
            found = _prepared(case, place, painter, progress)
            found = _simulated(case, found, place, painter, progress)
        found = replace(found, notes=tuple(notes))
        return _shown(case, found, place, painter, began) if drawing else found


def _prepared(case: Case, place: Workspace, painter: Painter, progress: bool | None) -> Findings:
    """Hull, coefficients and fluid memory."""
    from ogilvie.hydro.checks import check
    from ogilvie.hydro.netcdf import write_netcdf

    with step("hull") as tell:
        hull = build.make_hull(case)
        _told_at_once(case, hull)
        if hull is not None:
            painter.draw(hull_figures(hull))
            tell(f"{hull.full().n_faces} panels, {hull.volume:.6g} m3")
    with step("coefficients") as tell:
        body = None if case.body is None else build.make_body(case, hull)
        place.solving = case.coefficients.file is None and case.coefficients.cache
        hydro = build.make_hydro(case, hull, body, progress=progress)
        place.solving = False
        foresee_data(case, hydro)
        body = body or build.make_body(case, hull, hydro)
        place.keep(write_netcdf(hydro, place.folder / "coefficients.nc"))
        tell(f"{hydro.sizes['omega']} frequencies, {hydro.sizes.get('wave_direction', 0)} directions")
    with step("checks") as tell:
        checks = check(hydro)
        tell(f"{len(checks.findings)} findings" if checks.findings else "no findings")
    if not checks.ok:
        failed = sum(f.severity == "error" for f in checks.findings)
        where = "Checks and warnings in the report"
        warn(f"the coefficients fail {failed} of their checks ({where}): look before you trust the motions.")
    with step("fluid memory") as tell:
        K, ssm = make_memory(case, hydro, body)
        place.keep(write_memory(place.folder / "memory.npz", K, ssm))
        painter.draw(memory_figures(hydro, K, ssm))
        tell(f"convolution over {K.duration:.4g} s" if ssm is None else f"{ssm.order} states, {ssm.method}")
    return Findings(
        title=case.title,
        body=body,
        hydro=hydro,
        K=K,
        ssm=ssm,
        hull=hull,
        hydrostatics=build.statics(case, hull, body),
        checks=checks,
        case_text=case.text,
    )


def _told_at_once(case: Case, hull: "PanelMesh | None") -> None:
    """Warn of what is doubtful before the long work, and let it go into the report as well."""
    doubts: list[str] = []
    with collected_warnings(doubts):
        foresee(case, hull)
    for doubt in doubts:
        warn(doubt)
        warnings.warn(doubt, OgilvieWarning)


def _simulated(case: Case, f: Findings, place: Workspace, painter: Painter, progress: bool | None) -> Findings:
    """Sea, mean drift, vessel, motions and their statistics."""
    spectrum = build_run.make_spectrum(case)
    sea, drift = build_run.make_sea(case, spectrum, f.hydro), None
    if case.slow_drift is not None and sea is not None:
        drift = _drifting(case, f, sea, place, progress)
        painter.draw(drift_figure(drift))
        f = replace(f, hydro=drift) if _extends(drift, f.hydro) else f
    with step("simulation") as tell:
        vessel = build_run.make_vessel(case, f.body, f.hydro, f.K, f.ssm, hull=f.hull, sea=sea, drift=drift)
        compared = frequency_domain(case, vessel, f.hydro, f.body, spectrum)
        painter.draw(wave_figures(spectrum, sea, compared.get("response")))
        run = build_run.simulate_case(case, vessel, sea, progress=progress)
        place.keep(write_result(run, place.folder / "result.nc"))
        tell(f"{run.sizes.get('realisation', 1)} x {float(run.time[-1]):.4g} s")
    skip = build_run.skipped(case)
    statistics = build_run.statistics(case, run)
    if statistics is not None and "surge" not in statistics.dof.values and case.large:
        compared = {"response": compared["response"]} if "response" in compared else {}  # it turned away from that heading
    painter.draw(run_figures(run, spectrum=spectrum, expected=compared.get("expected_spectra"), skip=skip, hull=f.hull))
    lines = _lines(vessel, run)
    painter.draw(_moored(lines, run, skip))
    said: dict[str, Any] = {"weather": weather(case, f.hull), "loads": vessel.names, "lines": lines}
    return replace(f, spectrum=spectrum, sea=sea, run=run, skip=skip, statistics=statistics, **said, **compared)


def _drifting(case: Case, f: Findings, sea: "Sea", place: Workspace, progress: bool | None) -> "xr.Dataset":
    """What slow drift is made from: the coefficients with their mean drift, or a data set of its own."""
    from ogilvie.app.build_drift import drift_data, holds_drift
    from ogilvie.hydro.netcdf import write_netcdf

    with step("mean drift" if case.speed == 0.0 else "added resistance") as tell:
        if holds_drift(case, f.hydro):
            tell("that of the coefficients")
            return f.hydro
        still = build_run.make_vessel(case, f.body, f.hydro, f.K, f.ssm, hull=f.hull)
        place.solving = case.coefficients.cache
        drift = drift_data(case, still, f.hydro, f.body, f.hull, sea, progress=progress)
        place.solving = False
        if _extends(drift, f.hydro):
            write_netcdf(drift, place.folder / "coefficients.nc")
        else:
            place.keep(write_result(drift, place.folder / "drift.nc"))
        tell(f"{drift.sizes['omega']} frequencies, {drift.sizes['wave_direction']} directions")
    return drift


def _extends(drift: "xr.Dataset", hydro: "xr.Dataset") -> bool:
    """Whether drift is the coefficients with something added."""
    return drift.omega.equals(hydro.omega) and set(hydro.data_vars) <= set(drift.data_vars)


def _lines(vessel: "Vessel", run: "xr.Dataset") -> "CatenaryMooring | None":
    """The catenary lines, whose tensions a run of large motions tells."""
    from ogilvie.loads.mooring_lines import CatenaryMooring

    lines = (load for load in vessel.loads if isinstance(load, CatenaryMooring))
    return next(lines, None) if run.attrs.get("motions") == "large" else None


def _moored(lines: "CatenaryMooring | None", run: "xr.Dataset", skip: float) -> dict[str, Job]:
    """The picture of catenary lines at the mean pose."""
    if lines is None or float(run.time[-1]) <= skip:
        return {}
    eta = run.eta.sel(time=slice(skip, None)).values
    return mooring_figure(lines, eta.reshape(-1, 6).mean(axis=0))


def _shown(case: Case, f: Findings, place: Workspace, painter: Painter, began: float) -> Findings:
    """Figures and report."""
    with step("figures"), collected_warnings([]):
        if f.hull is not None and f.sea is not None and f.run is not None:
            job = overview_figure(f.hull, f.run, sea=f.sea, spectrum=f.spectrum, response=f.response, title=f.title)
            painter.draw(job)
        pictures = painter.finish()
    if case.output.figures:
        target = place.folder / "figures"
        target.mkdir(exist_ok=True)
        for name, (png, _) in pictures.items():
            place.keep(write_bytes(target / f"{name}.png", png))
    if case.output.report:
        with step("report"):
            f = replace(f, provenance=_provenance(case, f, time.perf_counter() - began))
            place.keep(write_text(place.folder / "report.html", report(f, pictures=pictures)))
    return f


def _provenance(case: Case, f: Findings, seconds: float) -> tuple[tuple[str, str], ...]:
    run: Any = f.run
    return (
        ("case", f"{case.name}.toml, SHA-256 {case.digest}..."),
        ("run", f"hash {run.attrs['case_hash']}, {run.attrs['wall_time']:.2f} s of simulation, {seconds:.1f} s in all"),
        ("made", datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")),
        ("software", f"{run.attrs['versions']}, matplotlib {version('matplotlib')}"),
        ("system", f"{platform.system()} {platform.machine()}"),
        ("coefficients", str(f.hydro.attrs.get("source", "not stated"))),
    )
