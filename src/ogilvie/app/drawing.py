"""Draws figures as PNG in a second process while the first goes on computing; it starts its slow imports at once.

The other process, ``python -m ogilvie.app.drawing``, reads pickled jobs from its standard input and answers on its standard
output. When it fails, the first process draws what is missing, and an error that is no accident comes up there.
"""

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping
from copy import copy
from dataclasses import replace

from ogilvie.post.report_figures import Job

_MODULE = "ogilvie.app.drawing"


class Painter:
    """The other process; use it as a context. Jobs that it has not begun by the end are done by the first process."""

    def __init__(self, *, wanted: bool = True) -> None:
        self.jobs: dict[str, Job] = {}
        self.drawn: dict[str, bytes] = {}
        self.waiting: list[str] = []
        self.lock = threading.Condition()
        self.closing = False
        self.process: subprocess.Popen[bytes] | None = None
        if wanted and _cores() > 1:
            with contextlib.suppress(OSError):
                self._start()

    def _start(self) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", _MODULE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )
        self.thread = threading.Thread(target=self._attend, daemon=True)
        self.thread.start()

    def __enter__(self) -> "Painter":
        return self

    def __exit__(self, *_: object) -> None:
        if self.process is not None and self.process.poll() is None:
            self.process.kill()

    def draw(self, jobs: Mapping[str, Job]) -> None:
        """Have figures drawn, by the other process from now on or in :meth:`finish`.

        Shallow copies are handed over, since objects note what they computed while they are being packed.
        """
        with self.lock:
            self.jobs |= {name: _apart(job) for name, job in jobs.items()}
            self.waiting += jobs
            self.lock.notify()

    def finish(self) -> dict[str, tuple[bytes, str]]:
        """Return PNG and caption of every figure by name, in the order in which they were asked for."""
        while (name := self._next(last=True)) is not None:
            self.drawn[name] = self.jobs[name].png()
        with self.lock:
            self.closing = True
            self.lock.notify()
        if self.process is not None:
            self.thread.join()
            self.process.wait()
        return {name: (self.drawn.get(name) or job.png(), job.caption) for name, job in self.jobs.items()}

    def _next(self, *, last: bool) -> str | None:
        """Take a job that nobody has begun: the first process from the end, the other from the beginning."""
        with self.lock:
            return self.waiting.pop(-1 if last else 0) if self.waiting else None

    def _attend(self) -> None:
        """Hand the other process one job after the other until the end, or until it fails."""
        assert self.process is not None
        jobs, answers = self.process.stdin, self.process.stdout
        assert jobs is not None
        assert answers is not None
        with contextlib.suppress(EOFError, OSError, RuntimeError, pickle.PickleError), jobs, answers:
            while True:
                with self.lock:
                    self.lock.wait_for(lambda: self.waiting or self.closing)
                name = self._next(last=False)
                if name is None:
                    if self.closing:
                        return
                    continue
                pickle.dump(self.jobs[name], jobs, protocol=pickle.HIGHEST_PROTOCOL)
                jobs.flush()
                self.drawn[name] = pickle.load(answers)


def _apart(job: Job) -> Job:
    """The job with shallow copies of what it is drawn from."""
    options = {key: copy(value) for key, value in job.options.items()}
    return replace(job, args=tuple(copy(x) for x in job.args), options=options)


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _serve() -> None:
    """Draw what comes in until the input ends."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever prints must not end up among the answers
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process decides what an interrupt means
    import xarray  # noqa: F401  slow, and needed for what comes in

    from ogilvie.post import plot

    plot.to_png(plot.custom(_nothing, None))  # loads the drawing library and its fonts
    with contextlib.suppress(EOFError, BrokenPipeError, KeyboardInterrupt):
        while True:
            pickle.dump(pickle.load(sys.stdin.buffer).png(), answers)
            answers.flush()


def _nothing(data: object, fig: object) -> None:
    """Draw an empty figure."""


if __name__ == "__main__":
    # under this name pickle would look for the classes in __main__
    from ogilvie.app import drawing

    drawing._serve()
