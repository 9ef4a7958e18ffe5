"""One picture of a whole case: the ship in the sea at one moment, the sea's spectrum, responses and motions."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.post.plot._motions import _first
from ogilvie.post.plot._scene import Camera, Surface, draw, hull_surface, moved, waterline
from ogilvie.post.plot._style import BLUE, CYAN, GREEN, INK, RED, degrees, is_rotation, new_figure, styled
from ogilvie.post.plot._waves import _ceiling, spectrum_axes

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.waves.field import Sea
    from ogilvie.waves.spectrum import Spectrum

Array = NDArray[np.float64]

_SHOWN = {"heave": BLUE, "roll": GREEN, "pitch": RED}


@styled
def overview(
    hull: "PanelMesh",
    run: "xr.Dataset",
    *,
    sea: "Sea",
    spectrum: "Spectrum | None" = None,
    response: "xr.DataArray | None" = None,
    time: float | None = None,
    title: str | None = None,
    save: str | Path | None = None,
) -> Any:
    """Draw the ship in the sea at one moment of a run, with spectrum, response amplitude operators and motions below.

    Parameters
    ----------
    hull : PanelMesh
        Wetted hull. Sides above the water are drawn wall-sided and are no part of the calculation.
    run : xarray.Dataset
        From :func:`ogilvie.simulate`; the first realisation is shown.
    sea : Sea
        That of the run.
    spectrum : Spectrum, optional
    response : xarray.DataArray, optional
        From :func:`ogilvie.rao`; the direction nearest to the sea's is shown.
    time : float, optional
        The moment, s; by default that of the largest heave and pitch together.
    title : str, optional
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    sea = sea.isel(0) if sea.amplitude.ndim > 1 else sea
    eta = _first(run.eta.values, 2)
    moment = _moment(run, eta) if time is None else int(np.abs(run.time.values - time).argmin())
    fig = new_figure(5.9, 9.0)
    grid = fig.add_gridspec(2, 3, height_ratios=(1.12, 1.0), width_ratios=(1.0, 1.0, 1.4))
    fig.get_layout_engine().set(wspace=0.08)
    scene = fig.add_subplot(grid[0, :])
    t = float(run.time[moment])
    _scene(scene, hull, sea, _in_the_world(eta[moment], run, t), t)
    if title:
        scene.set_title(title, fontsize=10)
    spectrum_axes(fig.add_subplot(grid[1, 0]), spectrum, None if spectrum is not None else sea)
    end = 3.2 * 2 * np.pi / spectrum.tp if spectrum is not None else float(1.5 * sea.omega.max())
    _responses(fig.add_subplot(grid[1, 1]), response, _towards(sea) - float(run.attrs.get("heading", 0.0)), end)
    _history(fig, grid[1, 2].subgridspec(4, 1), run, eta, moment)
    return fig


def _moment(run: "xr.Dataset", eta: Array) -> int:
    """The step of the largest heave and pitch together, each against its own standard deviation, in the second half."""
    names = [str(d) for d in run.dof.values]
    half = len(eta) // 2
    x = eta[half:, [names.index(d) for d in ("heave", "pitch") if d in names]]
    return half + int(np.abs(x / np.maximum(x.std(axis=0), 1e-12)).sum(axis=1).argmax())


def _in_the_world(eta: Array, run: "xr.Dataset", t: float) -> Array:
    """Pose in the world of a motion in the steady frame, which sails at the speed and heading of the vessel."""
    if run.attrs.get("motions") == "large":
        return eta
    heading = float(run.attrs.get("heading", 0.0))
    c, s = np.cos(heading), np.sin(heading)
    ahead = float(run.attrs.get("speed", 0.0)) * t + eta[0]
    return np.array([c * ahead - s * eta[1], s * ahead + c * eta[1], eta[2], eta[3], eta[4], eta[5] + heading])


def _scene(ax: Any, hull: "PanelMesh", sea: "Sea", pose: Array, t: float) -> None:
    """A block of sea, cut open beside the ship so that the hull below the water is seen."""
    L, B, T = hull.length, hull.beam, hull.draught
    level = np.array([pose[0], pose[1], 0.0, 0.0, 0.0, pose[5]])
    far = max(0.40 * L, 2.0 * B)
    u = np.linspace(-0.72 * L, 0.72 * L, 230)
    v = np.concatenate([np.linspace(-0.64 * B, 0.6 * B, 60), np.linspace(0.6 * B, far, 36)[1:]])
    points = _surface(sea, t, u, v, level)
    camera = Camera(np.radians(-64) + pose[5], np.radians(15), (pose[0], pose[1], 0.0))
    outside = ~_within(hull, 0.25 * (points[:-1, :-1] + points[1:, 1:] + points[:-1, 1:] + points[1:, :-1]), level)
    near = (v[None, :-1] < 0.0) & (np.abs(u[:-1, None]) < 0.54 * L)
    cells = _water(points, sea, level)
    walls = _walls(points, level, -1.5 * T)
    draw(ax, _pick(cells, outside & ~near, 1.0), camera, linewidth=0.3)
    draw(ax, hull_surface(hull, pose=pose, freeboard=0.8 * T), camera)
    draw(ax, _pick(cells, outside & near, 0.5), camera, linewidth=0.0)
    draw(ax, walls, camera, linewidth=0.0)
    seen = camera.project(np.concatenate([points.reshape(-1, 3), walls.polygons.reshape(-1, 3)]))[0]
    ax.set_xlim(seen[:, 0].min(), seen[:, 0].max())
    ax.set_ylim(seen[:, 1].min(), seen[:, 1].max())
    _arrow(ax, sea, camera, level, L, 0.6 * far)


def _surface(sea: "Sea", t: float, u: Array, v: Array, level: Array) -> Array:
    """World points (n_u, n_v, 3) of the water surface."""
    grid = np.stack([*np.meshgrid(u, v, indexing="ij"), np.zeros((len(u), len(v)))], axis=-1)
    points = moved(grid, level)
    points[..., 2] = sea.elevation(t, points[..., 0], points[..., 1])
    return points


def _within(hull: "PanelMesh", centres: Array, level: Array) -> NDArray[np.bool_]:
    """Which centres of cells lie inside the waterline."""
    full = hull.full()
    E = waterline(full.vertices[full.faces]).reshape(-1, 3)
    x = np.unique(E[:, 0].round(6))
    half = np.array([np.abs(E[np.abs(E[:, 0] - a) < 1e-5, 1]).max() for a in x])
    c, s = np.cos(level[5]), np.sin(level[5])
    dx, dy = centres[..., 0] - level[0], centres[..., 1] - level[1]
    a, b = c * dx + s * dy, -s * dx + c * dy
    return np.abs(b) < np.interp(a, x, half, left=-1.0, right=-1.0)


def _water(points: Array, sea: "Sea", level: Array) -> Surface:
    """Cells coloured by slope towards the sun and by height."""
    P = np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], axis=2).reshape(-1, 4, 3)
    normal = np.cross(P[:, 2] - P[:, 0], P[:, 3] - P[:, 1])
    slope = (normal[:, 0] * np.cos(level[5] + 0.9) + normal[:, 1] * np.sin(level[5] + 0.9)) / normal[:, 2]
    height = P[..., 2].mean(axis=1) / max(float(np.max(sea.hs)), 1e-9)
    tone = np.clip(0.5 + 2.6 * slope + 0.22 * height, 0.0, 1.0)[:, None]
    dark, light = np.array([0.13, 0.33, 0.50]), np.array([0.66, 0.82, 0.90])
    rgb = dark + (light - dark) * tone
    colours = np.column_stack([rgb, np.ones(len(rgb))])
    return Surface(P, colours, colours)


def _pick(surface: Surface, chosen: NDArray[np.bool_], alpha: float) -> Surface:
    colours = surface.colours[chosen.ravel()].copy()
    colours[:, 3] = alpha
    return Surface(surface.polygons[chosen.ravel()], colours, colours)


def _walls(points: Array, level: Array, bottom: float) -> Surface:
    """The cut faces of the block, towards starboard and ahead."""
    quads = []
    for edge in (points[:, 0], points[-1, :]):
        low = edge.copy()
        low[:, 2] = bottom
        quads.append(np.stack([edge[:-1], edge[1:], low[1:], low[:-1]], axis=1))
    P = np.concatenate(quads)
    alpha = np.r_[np.full(len(quads[0]), 0.22), np.full(len(quads[1]), 0.45)]
    colours = np.column_stack([np.tile([0.20, 0.45, 0.62], (len(P), 1)), alpha])
    return Surface(P, colours, colours * [1, 1, 1, 0])


def _arrow(ax: Any, sea: "Sea", camera: Camera, level: Array, L: float, side: float) -> None:
    """Where the waves travel to, lying on the water."""
    b = _towards(sea)
    middle = moved([[0.5 * L, side, 0.0]], level)[0]
    half = 0.09 * L * np.array([np.cos(b), np.sin(b), 0.0])
    start, stop = middle - half, middle + half
    a, e = camera.project([start, stop])[0]
    ax.annotate("", xy=e, xytext=a, arrowprops={"arrowstyle": "-|>", "color": "white", "lw": 1.8, "mutation_scale": 14})
    ax.text(*(0.5 * (a + e) - [0, 0.05 * L]), "waves", color="white", fontsize=8, ha="center", weight="bold")


def _towards(sea: "Sea") -> float:
    """Mean direction of the waves' energy, rad."""
    return float(np.angle(np.sum(sea.amplitude**2 * np.exp(1j * sea.direction))))


def _responses(ax: Any, response: "xr.DataArray | None", direction: float, end: float) -> None:
    if response is None:
        ax.set_axis_off()
        return
    b = response.wave_direction.values
    nearest = int(np.abs(np.angle(np.exp(1j * (b - direction)))).argmin())
    other = ax.twinx()
    other.grid(False)
    other.spines["right"].set_visible(True)
    for dof, colour in _SHOWN.items():
        if dof in response.dof.values:
            size = np.abs(response.sel(dof=dof).isel(wave_direction=nearest).values)
            axis, factor = (other, 180 / np.pi) if is_rotation(dof) else (ax, 1.0)
            axis.plot(response.omega, size * factor, color=colour, label=dof)
            axis.set_ylim(0, max(axis.get_ylim()[1], 1.06 * _ceiling(response.omega.values, size * factor)))
    ax.set_xlabel("\u03c9 [rad/s]")
    ax.set_ylabel("heave [m/m]")
    other.set_ylabel("roll, pitch [deg/m]")
    ax.set_xlim(0, min(end, float(response.omega[-1])))
    ax.set_title(f"responses, waves towards {np.degrees(b[nearest]):.0f}\u00b0", fontsize=7.5, weight="normal")
    ax.legend(handles=[*ax.get_lines(), *other.get_lines()], loc="upper right")


def _history(fig: Any, grid: Any, run: "xr.Dataset", eta: Array, moment: int) -> None:
    t = run.time.values
    names = [str(d) for d in run.dof.values]
    span = min(180.0, t[-1] - t[0])
    start = float(np.clip(t[moment] - 0.5 * span, t[0], t[-1] - span))
    cut = (t >= start) & (t <= start + span)
    curves = [("wave elevation [m]", CYAN, _first(run.elevation.values, 1)[cut])]
    for dof, colour in _SHOWN.items():
        if dof in names:
            values, unit = degrees(dof, eta[cut, names.index(dof)])
            curves.append((f"{dof} [{unit}]", colour, values))
    first = None
    for k, (label, colour, values) in enumerate(curves):
        ax = first = fig.add_subplot(grid[k], sharex=first)
        ax.plot(t[cut], values, color=colour, lw=0.9)
        ax.axvline(t[moment], color=INK, lw=0.6, ls=":")
        ax.set_title(label, fontsize=7, weight="normal", pad=2)
        ax.margins(y=0.1)
        ax.locator_params(axis="y", nbins=3)
        ax.tick_params(labelbottom=k == len(curves) - 1)
    ax.set_xlabel("t [s]")
    ax.set_xlim(start, start + span)
