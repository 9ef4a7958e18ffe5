"""Dynamic mooring lines by MoorDyn: the only importer of moordyn."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import rotation_matrix
from ogilvie.loads.base import MOORING, Surroundings, Terms, vector6
from ogilvie.loads.kernel import Callback

Array = NDArray[Any]

_PIECES = 10


class MoorDyn:
    """Lines with inertia and drag, computed by MoorDyn beside the ship and coupled to it once per period.

    Parameters
    ----------
    path : str or Path
        MoorDyn v2 input file. Its coupled points are the fairleads, in the axes of the body with the ship at the origin;
        coupled bodies and rods are refused. Water, bottom and integrator are those of the file (axes x, y, z up as here).
    period : float
        Time between two calls, s: the ship's motion is handed over and the force renewed once per period.
    dt : float, optional
        MoorDyn's own time step, s, below the period; that of the file (``dtM``) by default.
    lead : float
        The force is held for one period, so it would act half a period late and feed energy into the motion. It is extrapolated
        along a straight line by ``lead`` periods: 0.5, to the middle of the period that it is held for; 0 turns this off.

    Raises
    ------
    InputError
        No such file, moordyn not installed, a period or step that is no positive number.

    Notes
    -----
    As a load of a vessel it needs nothing more; by hand: ``start`` with the first pose, ``call`` at t, t + period, ...,
    ``close`` at the end. Between two calls each fairlead
    moves along the cubic of its places and velocities at both, in ten straight pieces (fewer where they were shorter than dt):
    it does not drift from the ship, and its velocity hardly jumps, for a jump is a blow to the lines. MoorDyn writes its log
    and output files beside the input file; what it says on the terminal is not shown.

    References
    ----------
    M. Hall and A. Goupee, Validation of a lumped-mass mooring line model with DeepCwind semisubmersible model test data,
    Ocean Engineering 104 (2015).

    Examples
    --------
    >>> MoorDyn("nowhere.txt", period=0.1)
    Traceback (most recent call last):
    ...
    ogilvie.errors.InputError: MoorDyn: an input file expected, nowhere.txt not found.
    """

    def __init__(self, path: str | Path, *, period: float, dt: float | None = None, lead: float = 0.5) -> None:
        self.path = Path(path)
        if not self.path.is_file():
            raise InputError(f"MoorDyn: an input file expected, {path} not found.")
        self.period = _seconds(period, "period")
        self.dt = None if dt is None else _seconds(dt, "dt")
        if self.dt is not None and self.dt > self.period:
            raise InputError(f"MoorDyn: a step dt up to the period {self.period:g} s expected, {self.dt:g} s found.")
        if not (np.isfinite(lead) and 0.0 <= lead <= 1.0):
            raise InputError(f"MoorDyn: lead: a number from 0 to 1 expected, {lead!r} found.")
        self.lead = float(lead)
        self.name = "mooring"
        self.fairleads: Array = np.zeros((0, 3))
        self._library: Any = None
        self._system: Any = None
        self._time = 0.0
        self._ends: Array = np.zeros((2, 0, 3))  # places and velocities in the world
        self._pulls: Array = np.zeros((0, 3))

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({MOORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return what the time loop calls."""
        return Terms(callback=Callback(self.call, self.period, begin=self.start, alone=True))

    def start(self, t: float, eta: ArrayLike, nu: ArrayLike) -> Array:
        """Read the file, let the lines find their shape with the ship at rest in the pose eta, return the force (6,) there.

        Parameters
        ----------
        t : float
            s.
        eta, nu : (6,) array
            Pose in the world; velocity in body axes. The lines themselves start from rest.

        Raises
        ------
        InputError
            moordyn not installed, file refused, no coupled points, coupled bodies or rods.
        ConvergenceError
            No static shape found.
        """
        self.close()
        self._library = _import()
        self._open()
        pose = vector6(eta, "MoorDyn: pose eta")
        self._time, self._ends = float(t), self._points(pose, vector6(nu, "MoorDyn: velocity nu"))
        places = self._ends[0].ravel().tolist()
        with _quiet():
            code = self._library.Init(self._system, places, [0.0] * len(places))
        self._pulls = (
            np.array([self._library.GetPointForce(p) for p in self._coupled()]) if code == 0 else np.full((1, 3), np.nan)
        )
        if not np.all(np.isfinite(self._pulls)):
            raise ConvergenceError(
                f"MoorDyn: no static shape of the lines found for the first pose; see the log beside {self.path}."
            )
        return self._force(self._pulls, pose)

    def call(self, t: float, eta: ArrayLike, nu: ArrayLike) -> Array:
        """Advance the lines to the time t with the ship now at eta and return the force (6,) on it about O in body axes.

        Parameters
        ----------
        t : float
            s, later than the last call; the same time returns the same force.
        eta, nu : (6,) array
            Pose in the world; velocity in body axes.

        Raises
        ------
        InputError
            Not started, or a time before the last one.
        ConvergenceError
            MoorDyn failed, or forces that are not finite: a smaller dt helps.
        """
        if self._system is None:
            raise InputError("MoorDyn: start(t, eta, nu) expected before the first call.")
        pose, span = vector6(eta, "MoorDyn: pose eta"), float(t) - self._time
        if span < 0.0:
            raise InputError(f"MoorDyn: a time from {self._time:g} s on expected, {t:g} s found.")
        if span <= 1e-9 * self.period:
            return self._force(self._pulls, pose)
        before, self._ends = self._ends, self._points(pose, vector6(nu, "MoorDyn: velocity nu"))
        pulls = self._advance(before, span)
        self._time = float(t)
        if not np.all(np.isfinite(pulls)):
            raise ConvergenceError(f"MoorDyn: finite forces expected, NaN found at {t:g} s. Take a smaller dt or more damping.")
        ahead = pulls + self.lead * self.period / span * (pulls - self._pulls)
        self._pulls = pulls
        return self._force(ahead, pose)

    def close(self) -> None:
        """Free what MoorDyn holds; nothing happens where nothing is held."""
        if self._system is not None:
            self._library.Close(self._system)
            self._system = None

    def _open(self) -> None:
        try:
            with _quiet():
                self._system = self._library.Create(str(self.path))
        except RuntimeError:
            raise InputError(f"MoorDyn: {self.path} was refused; see the log beside it.") from None
        self._library.SetVerbosity(self._system, self._library.LEVEL_ERR)
        if self.dt is not None:
            self._library.SetDt(self._system, self.dt)
        points = self._coupled()
        if not points or self._library.NCoupledDOF(self._system) != 3 * len(points):
            count = self._library.NCoupledDOF(self._system)
            self.close()
            raise InputError(
                f"MoorDyn: coupled points alone expected in {self.path}, {len(points)} of them and {count} coupled degrees of "
                "freedom found. Give each fairlead as a point of type Coupled; bodies and rods cannot be coupled here."
            )
        self.fairleads = np.array([self._library.GetPointPos(p) for p in points])

    def _advance(self, before: Array, span: float) -> Array:
        """Pull (n, 3) on the fairleads after they went along their cubics for the time span."""
        pieces = _PIECES if self.dt is None else max(1, min(_PIECES, int(span / self.dt)))
        u = np.linspace(0.0, 1.0, pieces + 1)[:, None, None]
        (x0, v0), (x1, v1) = before, self._ends
        path = x0 + u * (span * v0 + u * (3.0 * (x1 - x0) - span * (2.0 * v0 + v1) + u * (2.0 * (x0 - x1) + span * (v0 + v1))))
        step = span / pieces
        found: Any = None
        for i in range(pieces):
            speed = (path[i + 1] - path[i]) / step
            try:
                with _quiet():
                    found = self._library.Step(
                        self._system, path[i].ravel().tolist(), speed.ravel().tolist(), self._time + i * step, step
                    )
            except RuntimeError as error:
                end = self._time + span
                raise ConvergenceError(
                    f"MoorDyn: step to {end:g} s failed ({error}); see the log beside {self.path}."
                ) from None
        return np.array(found, dtype=float).reshape(-1, 3)

    def _coupled(self) -> list[Any]:
        m = self._library
        points = [m.GetPoint(self._system, i + 1) for i in range(m.GetNumberPoints(self._system))]
        return [p for p in points if m.GetPointType(p) == m.POINT_TYPE_COUPLED]

    def _points(self, pose: Array, nu: Array) -> Array:
        """World places and velocities (2, n, 3) of the fairleads."""
        R = rotation_matrix(*pose[3:])
        return np.stack([pose[:3] + self.fairleads @ R.T, (nu[:3] + np.cross(nu[3:], self.fairleads)) @ R.T])

    def _force(self, pulls: Array, pose: Array) -> Array:
        body = pulls @ rotation_matrix(*pose[3:])
        return np.concatenate([body.sum(axis=0), np.cross(self.fairleads, body).sum(axis=0)])


def _import() -> Any:
    try:
        import moordyn
    except ImportError:
        raise InputError(
            "MoorDyn: the package moordyn is not installed. Install it: pip install 'ogilvie[moordyn]', or pip install moordyn."
        ) from None
    return moordyn


def _seconds(value: float, what: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not (np.isfinite(number) and number > 0.0):
        raise InputError(f"MoorDyn: {what}: a positive number of s expected, {value!r} found.")
    return number


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep what the library prints at every step off the terminal; its errors come as return codes and in its log."""
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
