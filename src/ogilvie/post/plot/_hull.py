"""The hull as its panels."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.post.plot._scene import PORT, STARBOARD, Camera, draw, hull_surface, waterline
from ogilvie.post.plot._style import BLUE, INK, new_figure, styled

if TYPE_CHECKING:
    from ogilvie.mesh.panels import PanelMesh


@styled
def hull(mesh: "PanelMesh", *, save: str | Path | None = None) -> Any:
    """Draw the wetted hull: a shaded view from below, profile, plan and body plan; port red, starboard green.

    Parameters
    ----------
    mesh : PanelMesh
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    P = mesh.full().vertices[mesh.full().faces]
    fig = new_figure(4.4)
    grid = fig.add_gridspec(3, 2, height_ratios=(2.2, 0.8, 1.0), width_ratios=(2.6, 1.0))
    main = fig.add_subplot(grid[0, :])
    draw(main, hull_surface(mesh), Camera(np.radians(-62), np.radians(-20)))
    _title(main, mesh, P)
    _view(fig.add_subplot(grid[1, 0]), P[P[:, :, 1].mean(axis=1) <= 0], (0, 2), "profile, from starboard")
    _view(fig.add_subplot(grid[2, 0]), P, (0, 1), "plan, from above")
    _view(fig.add_subplot(grid[1:, 1]), P[P[:, :, 0].mean(axis=1) >= np.median(P[:, :, 0])], (1, 2), "forward half, from ahead")
    return fig


def _title(ax: Any, mesh: "PanelMesh", P: Any) -> None:
    size = np.ptp(P.reshape(-1, 3), axis=0)
    note = f"{len(P)} panels,  length {size[0]:.4g} m,  beam {size[1]:.4g} m,  draught {-P[..., 2].min():.4g} m"
    ax.set_title(mesh.name)
    ax.set_title(note, loc="right", fontsize=7.5, weight="normal")
    ax.text(0.0, 0.90, "port", transform=ax.transAxes, fontsize=7.5, color=PORT, weight="bold")
    ax.text(0.0, 0.81, "starboard", transform=ax.transAxes, fontsize=7.5, color=STARBOARD, weight="bold")


def _view(ax: Any, P: Any, axes: tuple[int, int], title: str) -> None:
    """Panels seen along one axis, with the waterline."""
    from matplotlib.collections import LineCollection, PolyCollection

    side = [PORT if y > 0 else STARBOARD for y in P[:, :, 1].mean(axis=1)]
    ax.add_collection(PolyCollection(list(P[:, :, axes]), facecolors=side, alpha=0.16, linewidths=0))
    ax.add_collection(PolyCollection(list(P[:, :, axes]), facecolors="none", edgecolors=side, linewidths=0.35))
    ax.add_collection(LineCollection(list(waterline(P)[:, :, axes]), colors=INK, linewidths=0.9))
    if axes[1] == 2:
        ax.axhline(0.0, color=BLUE, lw=0.8)
    ax.autoscale_view()
    ax.set_aspect("equal", adjustable="datalim" if axes[0] == 0 else "box")
    ax.grid(False)
    ax.set_title(title, fontsize=7.5, weight="normal")
    ax.set_xlabel(f"{'xyz'[axes[0]]} [m]")
    ax.set_ylabel(f"{'xyz'[axes[1]]} [m]")
