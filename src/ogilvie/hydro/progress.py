"""A progress bar over long work."""

import sys
import time
from collections.abc import Iterator, Sequence
from typing import TypeVar

T = TypeVar("T")

#: Work that is done sooner than this shows no bar unless it is asked for, s.
PATIENCE = 1.0


def tracked(items: Sequence[T], *, show: bool | None = None, title: str = "working") -> Iterator[T]:
    """Yield the items while a bar on the terminal shows how many are done and how long the rest will take.

    Parameters
    ----------
    items : sequence
    show : bool, optional
        None: only where standard error is a terminal, and after the first second.
    title : str

    Examples
    --------
    >>> list(tracked([1, 2, 3], show=False))
    [1, 2, 3]
    """
    if show is None:
        show, wait = sys.stderr.isatty(), PATIENCE
    else:
        wait = 0.0
    if show:
        yield from _with_bar(items, title, wait)
    else:
        yield from items


def _with_bar(items: Sequence[T], title: str, wait: float) -> Iterator[T]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = Console(stderr=True)
    bar = Progress(*columns, console=console, transient=console.is_terminal)
    task = bar.add_task(title, total=len(items))
    start, running = time.monotonic(), wait == 0.0
    if running:
        bar.start()
    try:
        for item in items:
            if not running and time.monotonic() - start >= wait:
                bar.start()
                running = True
            yield item
            bar.advance(task)
    finally:
        if running:
            bar.stop()
