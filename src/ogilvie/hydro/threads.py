"""How many threads the libraries below use, and what memory there is.

Capytaine's integrals and the linear algebra of numpy and scipy each start as many threads as there are cores. The integrals
gain by it; on small matrices the threads of the linear algebra only wait for each other (four times the work, measured).
"""

import ctypes
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager, ExitStack, contextmanager
from importlib import import_module
from typing import TypeVar

from ogilvie.hydro.progress import tracked

Item = TypeVar("Item")
Found = TypeVar("Found")

#: Extension modules and the names under which their linear algebra sets and tells its number of threads.
BLAS = (
    ("scipy.linalg._flapack", "scipy_openblas_set_num_threads", "scipy_openblas_get_num_threads"),
    ("numpy.linalg._umath_linalg", "scipy_openblas_set_num_threads64_", "scipy_openblas_get_num_threads64_"),
)


def available_cores() -> int:
    """Return the number of threads to use: OMP_NUM_THREADS if set, else the cores that this process may run on.

    Examples
    --------
    >>> available_cores() >= 1
    True
    """
    given = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()
    if given.isdigit() and int(given) > 0:
        return int(given)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def machine_memory() -> float:
    """Return the memory of this machine, bytes; inf where the system does not tell it.

    Examples
    --------
    >>> machine_memory() > 0
    True
    """
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")


@contextmanager
def library_threads(*, openmp: str, integrals: int, algebra: int) -> Iterator[None]:
    """Let the OpenMP library of an extension module and the linear algebra use so many threads, and put both back.

    Libraries that cannot be reached from here (on Windows, or builds other than the wheels) keep their own numbers.

    Examples
    --------
    >>> with library_threads(openmp="math", integrals=1, algebra=1):
    ...     pass
    """
    with ExitStack() as stack:
        stack.enter_context(_limited(openmp, "omp_set_num_threads", "omp_get_max_threads", integrals))
        for library in BLAS:
            stack.enter_context(_limited(*library, algebra))
        yield


def algebra_threads(threads: int) -> AbstractContextManager[None]:
    """Return a context in which the linear algebra uses so many threads.

    Examples
    --------
    >>> with algebra_threads(1):
    ...     pass
    """
    return library_threads(openmp="math", integrals=1, algebra=threads)


def in_parallel(
    function: Callable[[Item], Found], items: Iterable[Item], *, progress: bool | None = False, title: str = "working"
) -> list[Found]:
    """Return function(item) of all items, as many at a time as there are cores, each with one thread of linear algebra.

    For work whose time is spent where the interpreter is not needed (linear algebra, compiled loops that let it go). Progress
    as for :func:`ogilvie.hydro.progress.tracked`.

    Examples
    --------
    >>> in_parallel(abs, [-1, 2])
    [1, 2]
    """
    with algebra_threads(1), ThreadPoolExecutor(available_cores()) as pool:
        running = [pool.submit(function, item) for item in items]
        try:
            return [one.result() for one in tracked(running, show=progress, title=title)]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


@contextmanager
def _limited(module: str, setter: str, getter: str, threads: int) -> Iterator[None]:
    tell, ask = _function(module, setter), _function(module, getter)
    if tell is None or ask is None:
        yield
        return
    before = ask()
    tell(threads)
    try:
        yield
    finally:
        tell(before)


def _function(module: str, name: str) -> Callable[..., int] | None:
    try:
        path = import_module(module).__file__
        return None if path is None else getattr(ctypes.CDLL(path), name)
    except (ImportError, OSError, AttributeError):
        return None
