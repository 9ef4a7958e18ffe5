"""What the commands do."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ogilvie.app.console import say, step, warn
from ogilvie.app.files import collected_warnings, kind_of, read_memory, read_result, read_set, write_memory, write_result
from ogilvie.atomic import check_place
from ogilvie.errors import InputError
from ogilvie.units import deg, knot


def _tell(notes: list[str]) -> None:
    for note in notes:
        warn(note)


def run_command(path: Path, output: Path | None) -> None:
    """Run a case and say what came out."""
    from ogilvie.app.case import read_case
    from ogilvie.app.run import run_case
    from ogilvie.app.summary import print_findings

    case = read_case(path)
    folder = output or case.path(case.output.folder or f"{case.name}-results")
    found = run_case(case, folder)
    print_findings(found, folder)
    _stop_if_incomplete(found.run, f"The simulation up to then and the rest are in {folder}.")


def _stop_if_incomplete(run: Any, kept: str) -> None:
    if not run.attrs.get("complete", 1):
        stop = KeyboardInterrupt()
        stop.add_note(kept)
        raise stop


@dataclass(frozen=True)
class MeshFile:
    """How a mesh file is to be read: draught (m) that it is cut at, length of its unit (m), planes of symmetry."""

    draught: float | None = None
    unit: float | None = None
    symmetry: str | None = None

    def load(self, source: Path) -> Any:
        """The mesh as the file has it, without a cut."""
        from ogilvie.mesh.files import load_mesh

        known = ("none", "xz", "xz+yz")
        if self.symmetry not in (None, *known):
            raise InputError(f"--symmetry: one of {', '.join(known)} expected, {self.symmetry!r} found.")
        return load_mesh(source, unit=self.unit, symmetry=self.symmetry)  # type: ignore[arg-type]


@dataclass(frozen=True)
class MeshOptions:
    """How a mesh file is to be solved, as the command line has it (deg, knots)."""

    file: MeshFile
    omega: str | None
    directions: str
    depth: float
    speed_knots: float

    @property
    def frequencies(self) -> Any:
        """MIN:MAX:N as an array, rad/s."""
        try:
            low, high, count = (self.omega or "").split(":")
            return np.linspace(float(low), float(high), int(count))
        except ValueError:
            raise InputError(
                f"--omega: MIN:MAX:N in rad/s expected with a mesh (0.2:2.0:40, say), {self.omega!r} found."
            ) from None

    @property
    def wave_directions(self) -> Any:
        """D,D,... as an array, rad, ascending."""
        try:
            return np.unique([float(d) for d in self.directions.split(",")]) * deg
        except ValueError:
            raise InputError(
                f"--directions: degrees with commas expected (90,135,180, say), {self.directions!r} found."
            ) from None


def hydro_command(source: Path, *, output: Path, wamit: Path | None, scale: float | None, mesh: MeshOptions) -> None:
    """Solve or convert, and write."""
    from ogilvie.hydro.netcdf import write_netcdf
    from ogilvie.hydro.wamit_write import write_wamit

    kind, notes = kind_of(source), list[str]()
    check_place(output)
    with collected_warnings(notes):
        if kind == "case":
            hydro = _solve_case(source)
        elif kind == "mesh":
            hydro = _solve_mesh(source, mesh)
        else:
            hydro = read_coefficients(source, scale=scale)
        files = [write_netcdf(hydro, output), *(write_wamit(hydro, wamit) if wamit is not None else ())]
    _tell(notes)
    say(f"{hydro.sizes['omega']} frequencies, {hydro.sizes.get('wave_direction', 0)} directions written to")
    for file in files:
        say(f"  {file}")


def _solve_case(source: Path) -> Any:
    from ogilvie.app import build
    from ogilvie.app.case import read_case

    case = read_case(source)
    hull = build.make_hull(case)
    return build.make_hydro(case, hull, build.make_body(case, hull) if case.body else None)


def _solve_mesh(source: Path, options: MeshOptions) -> Any:
    from ogilvie.hydro.capytaine import solve_bem

    return solve_bem(
        options.file.load(source).immersed(options.file.draught),
        omega=options.frequencies,
        wave_direction=options.wave_directions,
        water_depth=options.depth,
        speed=options.speed_knots * knot,
    )


def read_coefficients(path: Path, *, scale: float | None = None) -> Any:
    """Read a file of coefficients; other kinds of files are an error."""
    from ogilvie.hydro.files import read_hydro

    kind = kind_of(path)
    if kind != "coefficients":
        raise InputError(f"{path.name}: coefficients (netCDF, WAMIT, HAMS) expected, a {kind} found.")
    return read_hydro(path, ulen=scale)


def check_command(source: Path, *, mesh: MeshFile) -> bool:
    """Print what is found; return whether it can be used."""
    kind, notes = kind_of(source), list[str]()
    with collected_warnings(notes):
        if kind == "mesh":
            good = _check_mesh(source, mesh)
        elif kind == "case":
            _check_case(source)
            good = True
        elif kind == "coefficients":
            from ogilvie.hydro.checks import check

            checks = check(read_coefficients(source))
            say(str(checks))
            good = bool(checks.ok)
        else:
            raise InputError(f"{source.name}: a mesh, coefficients or a case expected, a {kind} found.")
    _tell(notes)
    if kind == "case":
        say(f"{source.name}: no mistakes{f', {len(notes)} to look at' if notes else ''}.")
    return good


def _check_case(source: Path) -> None:
    from ogilvie.app import build
    from ogilvie.app.case import read_case
    from ogilvie.app.foresight import foresee, foresee_data

    case = read_case(source)
    hull = build.make_hull(case)
    foresee(case, hull)
    if case.coefficients.file is not None:
        foresee_data(case, build.make_hydro(case, hull, build.make_body(case, hull) if case.body else None))


def _check_mesh(source: Path, options: MeshFile) -> bool:
    from ogilvie.mesh.hydrostatics import hydrostatics
    from ogilvie.mesh.inspect import check_mesh

    mesh = options.load(source)
    mesh = mesh.immersed(options.draught) if options.draught is not None else mesh
    report = check_mesh(mesh)
    say(str(report))
    if report.ok:
        say(str(hydrostatics(mesh)))
    return report.ok


def identify_command(source: Path, *, output: Path, r2: float, duration: float | None, tail: str, figures: Path | None) -> None:
    """Identify the fluid memory, print its quality, save and draw it."""
    from ogilvie.app.summary import print_memory
    from ogilvie.memory.identify import identify
    from ogilvie.memory.retardation import retardation

    notes: list[str] = []
    check_place(output)
    with collected_warnings(notes):
        hydro = read_coefficients(source)
        K = retardation(hydro, duration=duration, tail=tail)
        ssm = identify(K, r2=r2)
        write_memory(output, K, ssm)
    _tell(notes)
    print_memory(K, ssm)
    say(f"written to {output}")
    if figures is not None:
        from ogilvie.post import plot

        figures.mkdir(parents=True, exist_ok=True)
        plot.coefficients(hydro, ssm=ssm, save=figures / "coefficients.png")
        plot.retardation(K, ssm, save=figures / "retardation.png")
        say(f"figures in {figures}")


def simulate_command(path: Path, *, coefficients: Path | None, memory: Path | None, output: Path) -> None:
    """Simulate a case, from saved coefficients and fluid memory where they are given."""
    from ogilvie.app import build, build_run
    from ogilvie.app.build_memory import make_memory, refuse_memory_of_another
    from ogilvie.app.case import read_case
    from ogilvie.app.foresight import foresee, foresee_data
    from ogilvie.app.summary import print_motions

    case, notes = read_case(path), list[str]()
    check_place(output)
    with collected_warnings(notes):
        hull = build.make_hull(case)
        foresee(case, hull)
        body = build.make_body(case, hull) if case.body is not None else None
        with step("coefficients"):
            if coefficients is None:
                hydro = build.make_hydro(case, hull, body)
            else:
                hydro = build.fitted_to_speed(case, read_coefficients(coefficients), hull)
        foresee_data(case, hydro)
        body = body or build.make_body(case, hull, hydro)
        with step("fluid memory"):
            K, ssm = make_memory(case, hydro, body) if memory is None else read_memory(memory)
            if memory is not None:
                refuse_memory_of_another(K, hydro)
        with step("simulation"):
            sea = build_run.make_sea(case, build_run.make_spectrum(case), hydro)
            vessel = build_run.finished_vessel(case, body, hydro, K, ssm, hull=hull, sea=sea)
            run = build_run.simulate_case(case, vessel, sea)
        write_result(run, output)
        statistics = build_run.statistics(case, run)
    _tell(notes)
    print_motions(statistics, run=run, skip=build_run.skipped(case))
    say(f"written to {output}")
    _stop_if_incomplete(run, f"What had been simulated is in {output}.")


def plot_command(source: Path, *, output: Path, format: str, window: tuple[float, float] | None) -> None:
    """Draw what a file holds."""
    from ogilvie.post import plot
    from ogilvie.post.course import about_course

    if format not in ("png", "svg", "pdf"):
        raise InputError(f"--format: one of png, svg, pdf expected, {format!r} found.")
    kind, made, notes = kind_of(source), dict[str, Any](), list[str]()
    with collected_warnings(notes):
        if kind == "mesh":
            from ogilvie.mesh.files import load_mesh

            made["hull"] = plot.hull(load_mesh(source))
        elif kind == "coefficients":
            hydro = read_coefficients(source)
            made["coefficients"] = plot.coefficients(hydro)
            if "excitation_force" in hydro:
                made["excitation"] = plot.excitation(hydro)
            if "mean_drift" in hydro:
                made["drift"] = plot.drift(hydro)
        elif kind == "drift":
            made["drift"] = plot.drift(read_set(source))
        elif kind == "memory":
            made["retardation"] = plot.retardation(*read_memory(source))
        elif kind == "result":
            run = read_result(source)
            if run.attrs.get("motions") == "large":
                made["track"], made["controls"] = plot.track(run), plot.controls(run)
                run = about_course(run)
            made["motions"] = plot.motions(run, window=window)
            if run.sizes["time"] >= 600:
                made["response_spectra"] = plot.response_spectra(run)
        else:
            raise InputError(
                f"{source.name}: a mesh, coefficients, memory.npz, drift.nc or result.nc expected, a {kind} found."
            )
    _tell(notes)
    output.mkdir(parents=True, exist_ok=True)
    for name, fig in made.items():
        say(f"  {plot.write(fig, output / f'{name}.{format}')}")
