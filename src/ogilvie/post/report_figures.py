"""Which figures a report has, as jobs: a drawing function, what it draws, and the caption."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.post import plot
from ogilvie.post.course import about_course
from ogilvie.units import knot

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.loads.mooring_lines import CatenaryMooring
    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.waves.field import Sea
    from ogilvie.waves.spectrum import Spectrum


@dataclass(frozen=True)
class Job:
    """A figure to be made, ``draw(*args, **options)``, and its caption."""

    draw: Callable[..., Any]
    args: tuple[Any, ...]
    caption: str
    options: Mapping[str, Any] = field(default_factory=dict)

    def png(self) -> bytes:
        """Make it, as the bytes of a PNG file."""
        return plot.to_png(self.draw(*self.args, **self.options))


def hull_figures(hull: "PanelMesh") -> dict[str, Job]:
    """Return the pictures of the hull."""
    return {"hull": Job(plot.hull, (hull,), "Wetted hull as panels.")}


def memory_figures(hydro: "xr.Dataset", K: "Retardation", ssm: "StateSpace | None") -> dict[str, Job]:
    """Return coefficients, retardation functions and their fits."""
    fit = " Dashed: the identified model's own A and B." if ssm is not None else ""
    jobs = {
        "coefficients": Job(
            plot.coefficients, (hydro,), f"Added mass and radiation damping, diagonal terms.{fit}", {"ssm": ssm}
        ),
        "retardation": Job(plot.retardation, (K, ssm), "Retardation functions K(t)."),
    }
    if "excitation_force" in hydro:
        jobs["excitation"] = Job(plot.excitation, (hydro,), "Wave excitation per metre of wave amplitude.")
    return jobs


def wave_figures(spectrum: "Spectrum | None", sea: "Sea | None", response: "xr.DataArray | None") -> dict[str, Job]:
    """Return the sea and the responses to it."""
    jobs = {}
    if response is not None:
        caption = "Motions of O per metre of wave amplitude, with the damping and springs of the case."
        jobs["rao"] = Job(plot.rao, (response,), caption)
    if spectrum is not None or sea is not None:
        caption = "Wave spectrum and the components of the sea that was simulated."
        jobs["spectrum"] = Job(plot.spectrum, (spectrum,), caption, {"sea": sea})
    return jobs


def drift_figure(drift: "xr.Dataset") -> dict[str, Job]:
    """Return the mean drift that slow drift is made from."""
    if "mean_drift" not in drift:
        return {}
    speed = float(drift.attrs.get("speed", 0.0))
    caption = "Mean drift force per square metre of wave amplitude"
    caption += f" at {speed / knot:.3g} knots: in surge, its sign changed, the added resistance." if speed else "."
    return {"drift": Job(plot.drift, (drift[["mean_drift"]],), caption)}


def run_figures(
    run: "xr.Dataset",
    *,
    spectrum: "Spectrum | None",
    expected: "xr.DataArray | None",
    skip: float,
    hull: "PanelMesh | None" = None,
) -> dict[str, Job]:
    """Return time histories and, in an irregular sea, spectra of the motions; of large motions track and control too."""
    window = busiest(run)
    large = run.attrs.get("motions") == "large" and float(run.time[-1] - run.time[0]) > skip
    caption = "Motions around the largest wave of the first realisation" if "elevation" in run else "Motions in calm water"
    jobs = voyage_figures(run, hull=hull) if large else {}
    run = about_course(run, skip=skip) if large else run
    caption += "; surge, sway and yaw about the mean course." if large and "surge" in run.dof.values else "."
    shown = run[[name for name in ("eta", "elevation") if name in run]]
    jobs["motions"] = Job(plot.motions, (shown.sel(time=slice(*window)),), caption)
    if spectrum is not None and run.sizes["time"] > 600:
        options = {"expected": expected, "skip": skip}
        jobs["response_spectra"] = Job(plot.response_spectra, (run[["eta"]],), "Spectra of the motions.", options)
    return jobs


def voyage_figures(run: "xr.Dataset", *, hull: "PanelMesh | None" = None) -> dict[str, Job]:
    """Return the track of large motions and what steered and drove the vessel."""
    size = {} if hull is None else {"length": hull.length, "beam": hull.beam}
    signals = [key for key in run.data_vars if set(run[key].dims) <= {"realisation", "time"}]
    drawn = run[[key for key in ("eta", "nu") if key in run] + signals]
    return {
        "track": Job(plot.track, (run[["eta"]],), "Where O went, and how the vessel headed.", size),
        "controls": Job(plot.controls, (drawn,), "Heading, and what steered and drove the vessel, first realisation."),
    }


def mooring_figure(lines: "CatenaryMooring", eta: Any) -> dict[str, Job]:
    """Return the mooring lines in a pose eta (6,), beside those at the origin."""
    return {"mooring": Job(plot.mooring, (lines,), "Mooring lines at the mean place and heading.", {"eta": eta})}


def overview_figure(
    hull: "PanelMesh",
    run: "xr.Dataset",
    *,
    sea: "Sea",
    spectrum: "Spectrum | None",
    response: "xr.DataArray | None",
    title: str,
) -> dict[str, Job]:
    """Return the picture of the whole case."""
    caption = "The vessel at the moment of its largest heave and pitch, to scale; sides above water schematic."
    options = {"sea": sea, "spectrum": spectrum, "response": response, "title": title}
    return {"overview": Job(plot.overview, (hull, run), caption, options)}


def busiest(run: "xr.Dataset", *, span: float = 300.0) -> tuple[float, float]:
    """Return first and last time of a window around the largest wave (or the start of a run in calm water)."""
    t = run.time.values
    if t[-1] - t[0] <= span or "elevation" not in run:
        return float(t[0]), float(min(t[0] + span, t[-1]))
    first = run.elevation.values.reshape(-1, len(t))[0]
    middle = t[int(np.abs(first).argmax())]
    start = float(np.clip(middle - 0.5 * span, t[0], t[-1] - span))
    return start, start + span
