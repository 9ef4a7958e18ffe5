"""Motions of a vessel that goes anywhere, seen from its mean track: what statistics and spectra can be made of."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]

#: A straight track is sailed where it is so many times longer than the deviations from it.
_UNDER_WAY = 6.0
#: m/s; a vessel that moves more slowly keeps its place.
_SLOWEST = 0.1
#: rad; a vessel whose heading changes more than this has no mean course.
_TURNED = np.radians(45.0)
_HORIZONTAL = ("surge", "sway", "yaw")


@dataclass(frozen=True)
class Course:
    """Mean course of one realisation.

    Parameters
    ----------
    start : (2,) array
        Place of the mean track at the first time, m.
    velocity : (2,) array
        m/s; zero for a vessel that keeps its place.
    heading : float
        Mean heading, rad.
    turned : float
        Largest less smallest heading, rad.
    """

    start: Array
    velocity: Array
    heading: float
    turned: float

    @property
    def speed(self) -> float:
        """Over ground, m/s."""
        return float(np.hypot(*self.velocity))

    @property
    def direction(self) -> float:
        """Of the track over ground, rad; the mean heading for a vessel that keeps its place."""
        return float(np.arctan2(self.velocity[1], self.velocity[0])) if self.speed > 0.0 else self.heading

    @property
    def drift_angle(self) -> float:
        """Direction of the track less heading, rad, in (-pi, pi]."""
        return float(np.pi - np.remainder(np.pi - (self.direction - self.heading), 2.0 * np.pi))

    @property
    def straight(self) -> bool:
        """Whether there is a mean course at all."""
        return self.turned <= _TURNED


def mean_course(time: Array, eta: Array) -> Course:
    """Return the mean course of poses in the world.

    Parameters
    ----------
    time : (n,) array
        s.
    eta : (n, 6) array
        m, rad.

    Notes
    -----
    The track is the straight line x_0 + v t of least squares, with v = 0 where it is shorter than six standard deviations of
    what is left of it or slower than 0.1 m/s: the slow motion about a mooring is no course.

    Examples
    --------
    >>> t = np.linspace(0.0, 100.0, 201)
    >>> eta = np.zeros((201, 6))
    >>> eta[:, 0], eta[:, 1] = 8.0 * t, 6.0 * t + np.cos(t)
    >>> course = mean_course(t, eta)
    >>> round(course.speed, 1), round(float(np.degrees(course.drift_angle)))
    (10.0, 37)
    """
    t, place = time - time[0], eta[:, :2]
    psi = np.unwrap(eta[:, 5])
    basis = np.stack([np.ones_like(t), t], axis=1)
    fit = np.linalg.lstsq(basis, place, rcond=None)[0]
    length = float(np.hypot(*fit[1]) * t[-1])
    left = float(np.sqrt(np.mean(np.sum((place - basis @ fit) ** 2, axis=1))))
    under_way = length > _UNDER_WAY * left and length > _SLOWEST * t[-1]
    start, velocity = fit if under_way else (place.mean(axis=0), np.zeros(2))
    return Course(start, velocity, float(psi.mean()), float(np.ptp(psi)))


def courses(run: xr.Dataset, *, skip: float = 0.0) -> list[Course]:
    """Return the mean course of each realisation of large motions, from `skip` (s) on."""
    eta, t = _poses(run)
    late = t >= t[0] + skip - 1e-9
    if late.sum() < 2:
        raise InputError(f"courses: a run that goes on after skip = {skip:g} s expected, it ends at {t[-1]:g} s.")
    return [mean_course(t[late], one[late]) for one in eta]


def about_course(run: xr.Dataset, *, skip: float = 0.0) -> xr.Dataset:
    """Return a run with motions about the mean course in place of poses in the world.

    Parameters
    ----------
    run : xarray.Dataset
        From :func:`ogilvie.simulate`; one of small motions is returned as it is.
    skip : float
        Start that has no part in the mean course, s.

    Returns
    -------
    xarray.Dataset
        In `eta` surge and sway are the deviations along and to port of the straight mean track, yaw that from the mean
        heading. Where the heading changes by more than 45 deg there is no mean course: surge, sway and yaw are left out.

    Examples
    --------
    >>> t = np.arange(0.0, 200.0)
    >>> eta = np.zeros((200, 6))
    >>> eta[:, 0], eta[:, 2] = 9.0 * t, 0.3
    >>> names = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
    >>> run = xr.Dataset({"eta": (("time", "dof"), eta)}, {"time": t, "dof": names}, {"motions": "large"})
    >>> about_course(run).eta.values[-1].round(9) + 0.0
    array([0. , 0. , 0.3, 0. , 0. , 0. ])
    """
    if run.attrs.get("motions") != "large":
        return run
    found = courses(run, skip=skip)
    eta, t = _poses(run)
    for one, course in zip(eta, found, strict=True):
        c, s = np.cos(course.direction), np.sin(course.direction)
        off = one[:, :2] - course.start - np.outer(t - (t[0] + skip), course.velocity)
        one[:, 0], one[:, 1] = off @ [c, s], off @ [-s, c]
        one[:, 5] = np.unwrap(one[:, 5]) - course.heading
    values = eta if "realisation" in run.eta.dims else eta[0]
    dims = ("realisation", "time", "dof") if "realisation" in run.eta.dims else ("time", "dof")
    about = run.assign(eta=(dims, values, run.eta.attrs | {"long_name": "motion about the mean course"}))
    if all(course.straight for course in found):
        return about
    kept = [d for d in about.dof.values if d not in _HORIZONTAL]
    return about.sel(dof=kept)


def _poses(run: xr.Dataset) -> tuple[Array, Array]:
    """Return poses (r, n, 6), a copy, and times (n,)."""
    eta = run.eta if "realisation" in run.eta.dims else run.eta.expand_dims("realisation")
    poses: Any = np.array(eta.transpose("realisation", "time", "dof").values, dtype=float)
    return poses, run.time.values
