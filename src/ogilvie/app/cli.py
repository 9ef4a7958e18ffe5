"""The command line: each command reads files, calls public functions and writes files; heavy imports wait inside them."""

import os
from pathlib import Path
from typing import Annotated

import typer

from ogilvie.app.console import DEBUG_VARIABLE, guarded

app = typer.Typer(
    name="ogilvie",
    help="From a hull to a ship moving in a seaway: coefficients, fluid memory, motions in the time domain.",
    epilog="Start with `ogilvie demo`; `ogilvie cases` lists case files to begin from. Exit codes: 0 done, 1 a check "
    "failed or a defect of the program, 2 the input cannot be used, 130 interrupted.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)

CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case.")]
Folder = Annotated[Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Where the results go.")]
Draught = Annotated[float | None, typer.Option("--draught", metavar="M", help="Mesh: clip at this draught, m.")]
Unit = Annotated[float | None, typer.Option("--unit", metavar="M", help="Mesh: length of its unit, m; 0.001 for mm.")]
Planes = Annotated[
    str | None, typer.Option("--symmetry", help="Mesh: planes whose other side it leaves out; none, xz or xz+yz.")
]


def _version(wanted: bool) -> None:
    if wanted:
        from ogilvie import __version__

        typer.echo(f"ogilvie {__version__}")
        raise typer.Exit()


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")] = False,
) -> None:
    if debug:
        os.environ[DEBUG_VARIABLE] = "1"
    else:
        os.environ.pop(DEBUG_VARIABLE, None)


@app.command()
@guarded
def demo(
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the results go.")] = Path(
        "ogilvie-demo"
    ),
    case: Annotated[
        bool, typer.Option("--case", help="Print the TOML text of the demo, to start one's own case from.")
    ] = False,
    cache: Annotated[bool, typer.Option("--cache/--no-cache", help="Use solved coefficients that are kept on disk.")] = True,
) -> None:
    """Run the S175 container ship from its lines to a report."""
    from ogilvie.app.demo import demo_text, run_demo

    if case:
        typer.echo(demo_text(), nl=False)
        return
    run_demo(output, cache=cache)


@app.command()
@guarded
def cases(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="The case to copy; without it all are listed.")] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE.toml", help="Where to; NAME.toml here by default.")
    ] = None,
) -> None:
    """List the cases that come with the package, or copy one.

    Ready to run and to be changed: a ship under autopilot, a vessel on dynamic positioning, a moored one.
    """
    from ogilvie.app.demo import copy_case, list_cases

    if name is None:
        list_cases()
    else:
        copy_case(name, output)


@app.command()
@guarded
def run(case: CaseFile, output: Folder = None) -> None:
    """Run a case from hull or coefficients to a report.

    Writes coefficients.nc, memory.npz, result.nc, figures/*.png and report.html.
    """
    from ogilvie.app.commands import run_command

    run_command(case, output)


@app.command()
@guarded
def hydro(
    source: Annotated[Path, typer.Argument(metavar="SOURCE", help="CASE.toml or mesh to solve, or coefficients to convert.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.nc", help="netCDF file to write.")] = Path(
        "coefficients.nc"
    ),
    wamit: Annotated[
        Path | None, typer.Option("--wamit", metavar="STEM", help="Also write WAMIT files with this stem.")
    ] = None,
    scale: Annotated[float | None, typer.Option("--scale", metavar="M", help="WAMIT files: unit length ULEN, m.")] = None,
    omega: Annotated[str | None, typer.Option("--omega", metavar="MIN:MAX:N", help="Mesh: frequencies, rad/s.")] = None,
    directions: Annotated[
        str, typer.Option("--directions", metavar="D,D,...", help="Mesh: where waves travel to, deg; 180 is head sea.")
    ] = "180",
    draught: Draught = None,
    depth: Annotated[float, typer.Option("--depth", metavar="M", help="Mesh: water depth, m.")] = float("inf"),
    speed_knots: Annotated[float, typer.Option("--speed-knots", metavar="KN", help="Mesh: forward speed.")] = 0.0,
    unit: Unit = None,
    symmetry: Planes = None,
) -> None:
    """Solve a hull for its coefficients, or convert a file.

    The hull is that of a case, or a mesh file with the options below.
    """
    from ogilvie.app.commands import MeshFile, MeshOptions, hydro_command

    file = MeshFile(draught=draught, unit=unit, symmetry=symmetry)
    mesh = MeshOptions(file, omega=omega, directions=directions, depth=depth, speed_knots=speed_knots)
    hydro_command(source, output=output, wamit=wamit, scale=scale, mesh=mesh)


@app.command()
@guarded
def check(
    source: Annotated[Path, typer.Argument(metavar="FILE", help="A mesh, coefficients, or a CASE.toml.")],
    draught: Draught = None,
    unit: Unit = None,
    symmetry: Planes = None,
) -> None:
    """Look critically at a mesh, at coefficients or a case.

    Exit code 1 when an error is found, 0 with warnings or none.
    """
    from ogilvie.app.commands import MeshFile, check_command

    mesh = MeshFile(draught=draught, unit=unit, symmetry=symmetry)
    raise typer.Exit(0 if check_command(source, mesh=mesh) else 1)


@app.command()
@guarded
def identify(
    source: Annotated[Path, typer.Argument(metavar="COEFFICIENTS", help="netCDF or WAMIT files.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.npz", help="K(t) and the state space.")] = Path(
        "memory.npz"
    ),
    r2: Annotated[
        float,
        typer.Option("--r2", help="Coefficient of determination that added mass and damping of every coupling have to reach."),
    ] = 0.99,
    duration: Annotated[float | None, typer.Option("--duration", metavar="S", help="Last time of K, s.")] = None,
    tail: Annotated[
        str, typer.Option("--tail", help="fit, omega-2, omega-3 or none: damping beyond the last frequency.")
    ] = "fit",
    figures: Annotated[
        Path | None, typer.Option("--figures", metavar="FOLDER", help="Draw A, B and K with their fits.")
    ] = None,
) -> None:
    """Identify the fluid memory: K(t) and a state space."""
    from ogilvie.app.commands import identify_command

    identify_command(source, output=output, r2=r2, duration=duration, tail=tail, figures=figures)


@app.command()
@guarded
def simulate(
    case: CaseFile,
    coefficients: Annotated[
        Path | None, typer.Option("--coefficients", metavar="FILE", help="Use these instead of the case's.")
    ] = None,
    memory: Annotated[
        Path | None, typer.Option("--memory", metavar="FILE.npz", help="Use this, of `ogilvie identify`.")
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.nc", help="netCDF file to write.")] = Path(
        "result.nc"
    ),
) -> None:
    """Simulate a case, from saved pieces if wished.

    Writes the result alone, without figures and report.
    """
    from ogilvie.app.commands import simulate_command

    simulate_command(case, coefficients=coefficients, memory=memory, output=output)


@app.command()
@guarded
def live(
    case: CaseFile,
    host: Annotated[str, typer.Option("--host", help="Name or address that hears the datagrams.")] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", help="UDP port.")] = 10110,
    format: Annotated[str, typer.Option("--format", help="json or nmea.")] = "json",
    factor: Annotated[float, typer.Option("--factor", help="Simulated seconds per second: 1 is real time.")] = 1.0,
    duration: Annotated[
        float | None, typer.Option("--duration", metavar="S", help="Simulated time, s; that of the case by default, or inf.")
    ] = None,
    rate: Annotated[
        float | None, typer.Option("--rate", metavar="HZ", help="Datagrams per simulated second; every step by default.")
    ] = None,
    origin: Annotated[
        str, typer.Option("--origin", metavar="LAT,LON", help="nmea: where the vessel's origin lies at the start, deg.")
    ] = "0,0",
    x_axis: Annotated[str, typer.Option("--x-axis", help="nmea: where the x axis points, east or north.")] = "east",
    fix: Annotated[str, typer.Option("--fix", help="nmea: mark positions as simulated or ordinary.")] = "simulated",
) -> None:
    """Run a case in real time and send its states over UDP.

    One datagram per step to whoever listens, until the duration is over or ctrl-C is pressed; then how well time was kept.
    """
    from ogilvie.app.live import LiveOptions, live_command

    live_command(case, LiveOptions(host, port, format, factor, duration, rate, origin, x_axis, fix))


@app.command()
@guarded
def plot(
    source: Annotated[Path, typer.Argument(metavar="FILE", help="result.nc, coefficients, memory.npz or a mesh.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the figures go.")] = Path("figures"),
    format: Annotated[str, typer.Option("--format", help="png, svg or pdf.")] = "png",
    window: Annotated[
        tuple[float, float] | None, typer.Option("--window", metavar="S S", help="First and last time drawn, s.")
    ] = None,
) -> None:
    """Draw what a file holds."""
    from ogilvie.app.commands import plot_command

    plot_command(source, output=output, format=format, window=window)


@app.command()
@guarded
def validate(
    names: Annotated[list[str] | None, typer.Argument(metavar="[NAMES]...", help="Cases to run; all by default.")] = None,
    folder: Annotated[Path, typer.Option("--folder", metavar="FOLDER", help="Where the cases are.")] = Path("validation"),
    data: Annotated[
        Path | None, typer.Option("--data", metavar="FOLDER", help="Published data; `shared` beside the project by default.")
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where pages and figures go.")] = Path(
        "out/validation"
    ),
) -> None:
    """Run the comparisons with published results.

    Exit code 1 when one fails.
    """
    from ogilvie.app.validate import validate_all

    raise typer.Exit(0 if validate_all(names or [], folder=folder, data=data, output=output) else 1)


def main() -> None:
    """Entry point of the command `ogilvie`."""
    app()
