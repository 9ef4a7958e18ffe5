"""What the mooring lines of a run carry: a table of tensions."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ogilvie.post.page import Table
from ogilvie.post.report_tables import number

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.loads.mooring_lines import CatenaryMooring

#: s; tensions of quasi-static lines change no faster than the vessel moves.
_STEP = 0.25


def line_tensions(lines: "CatenaryMooring", run: "xr.Dataset", *, skip: float = 0.0) -> NDArray[np.float64]:
    """Return the quasi-static tensions (realisations, times, lines, 2) at fairlead and anchor, N, from `skip` on.

    Parameters
    ----------
    lines : CatenaryMooring
    run : xarray.Dataset
        In large motions: `eta` is the pose in the world.
    skip : float
        Time left out at the start, s.
    """
    eta = run.eta if "realisation" in run.eta.dims else run.eta.expand_dims("realisation")
    after = eta.transpose("realisation", "time", "dof").isel(time=run.time.values >= float(run.time[0]) + skip)
    step = float(run.time[1] - run.time[0])
    return np.asarray(lines.tensions(after.values[:, :: max(1, int(_STEP / step + 1e-9))]))


def tension_table(lines: "CatenaryMooring", run: "xr.Dataset", *, skip: float = 0.0) -> Table:
    """Return mean, deviation and extremes of the tension at the fairlead of each line, and the largest at its anchor."""
    T = line_tensions(lines, run, skip=skip) / 1e3
    head = ["line", "its fairlead x, y, z [m]", "mean [kN]", "std [kN]", "least [kN]", "largest [kN]", "largest at anchor [kN]"]
    rows = []
    for i, line in enumerate(lines.lines):
        place = ", ".join(number(float(v)) for v in line.fairlead)
        top, anchor = T[..., i, 0], T[..., i, 1]
        values = (top.mean(), top.std(), top.min(), top.max(), anchor.max())
        rows.append([str(i), place, *(number(float(v)) for v in values)])
    caption = "Tension of the lines at the fairlead over all realisations, quasi-static: without inertia and drag of the lines."
    caption += " Lines are counted from 0, as in the figure."
    return Table(rows, head, caption, left=frozenset({0, 1}))
