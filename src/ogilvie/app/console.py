"""What the command line says: tables and lines on stdout, progress and warnings on stderr, errors without a traceback."""

import functools
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, ParamSpec

P = ParamSpec("P")

#: What `--debug` switches on: a traceback for every error.
DEBUG_VARIABLE = "OGILVIE_DEBUG"
#: s; a stage that takes longer is told of where the output is no terminal too.
LONG = 3.0
#: Width of tables where the output is no terminal.
FILE_WIDTH = 160


def stdout() -> Any:
    """Return a console on standard output: colour only on a terminal and without NO_COLOR."""
    return _console(sys.stdout)


def stderr() -> Any:
    """Return a console on standard error."""
    return _console(sys.stderr)


def _console(stream: Any) -> Any:
    from rich.console import Console

    terminal = stream.isatty()
    return Console(file=stream, highlight=False, soft_wrap=not terminal, width=None if terminal else FILE_WIDTH, emoji=False)


def say(text: str = "") -> None:
    """Print a line on standard output."""
    stdout().print(text, markup=False, soft_wrap=True)


def warn(text: str) -> None:
    """Print a warning on standard error."""
    stderr().print(f"[yellow]warning:[/yellow] {_plain(text)}", soft_wrap=True)


def _plain(text: str) -> str:
    from rich.markup import escape

    return escape(text)


def table(
    rows: Sequence[Sequence[str]], *, head: Sequence[str] = (), title: str = "", left: frozenset[int] = frozenset({0})
) -> None:
    """Print a table on standard output."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    grid = Table(
        box=SIMPLE_HEAD, title=Text(title) if title else None, title_justify="left", show_header=bool(head), pad_edge=False
    )
    for i in range(max(len(head), max((len(r) for r in rows), default=0))):
        wide = i in left
        grid.add_column(
            head[i] if i < len(head) else "", justify="left" if wide else "right", no_wrap=not wide, overflow="fold"
        )
    for row in rows:
        grid.add_row(*(Text(cell) for cell in row))
    stdout().print(grid)


@contextmanager
def step(name: str) -> Iterator[Callable[[str], None]]:
    """Time one stage of the work; a line tells what came out of it, in a log only where it took its time."""
    began = time.perf_counter()
    outcome: list[str] = []
    yield outcome.append
    seconds = time.perf_counter() - began
    if not sys.stderr.isatty():
        if seconds > LONG:
            print(f"{name}: {' '.join(outcome) or 'done'} ({seconds:.0f} s)", file=sys.stderr, flush=True)
    else:
        stderr().print(f"[green]\u2713[/green] {name:<14} {_plain(' '.join(outcome))} [dim]{seconds:.1f} s[/dim]")


def guarded(command: Callable[P, Any]) -> Callable[P, Any]:
    """Turn what a command raises into one message on standard error and an exit code.

    2: the input cannot be used (a mistake in it, a missing file); 130: interrupted; 1: anything else, a defect of the program.
    """

    @functools.wraps(command)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> Any:
        import typer

        from ogilvie.errors import OgilvieError

        try:
            return command(*args, **kwargs)
        except typer.Exit:
            raise
        except KeyboardInterrupt as stop:
            _report("interrupted", "\n".join(getattr(stop, "__notes__", [])) or "Nothing was written.")
            code, cause = 130, stop  # type: int, BaseException
        except OgilvieError as error:
            _report("error", "\n".join([str(error), *getattr(error, "__notes__", [])]))
            code, cause = 2, error
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None
        except OSError as error:
            _report("error", _system_sentence(error))
            code, cause = 2, error
        except MemoryError as error:
            advice = "Take a shorter duration, a larger step or output_step, fewer panels, frequencies or realisations."
            _report("error", f"more memory than this machine has is needed ({str(error) or 'no more is left'}). {advice}")
            code, cause = 2, error
        except Exception as error:
            _report("unexpected error", f"{type(error).__name__}: {error}")
            _report("hint", "this is a defect of the program; `ogilvie --debug ...` shows where it arose.")
            code, cause = 1, error
        if os.environ.get(DEBUG_VARIABLE):
            raise cause
        raise typer.Exit(code)

    return wrapper


def _report(kind: str, text: str) -> None:
    colour = "cyan" if kind == "hint" else "bold red"
    stderr().print(f"[{colour}]{kind}:[/{colour}] {_plain(text)}", soft_wrap=True)


def _system_sentence(error: OSError) -> str:
    """What the operating system refused, and what to do."""
    name = error.filename or error.filename2
    where = f"{name}: " if name else ""
    if isinstance(error, FileNotFoundError):
        return f"{where}an existing file expected, none found. Check the path."
    if isinstance(error, IsADirectoryError):
        return f"{where}a file expected, a folder found. Name a file in it."
    if isinstance(error, NotADirectoryError):
        return f"{where}a folder expected, a file found. Choose another place."
    if isinstance(error, FileExistsError):
        return f"{where}a new place expected, something is there already. Choose another."
    if isinstance(error, PermissionError):
        return f"{where}no permission. Check the rights of the file and of its folder, or choose another place."
    return f"{where}{error.strerror or error}."
