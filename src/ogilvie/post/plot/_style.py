"""One look for all figures: size, fonts, colours that colour-blind readers can tell apart, units on every axis."""

import io
import sys
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.atomic import write_whole
from ogilvie.errors import InputError

P = ParamSpec("P")
Array = NDArray[np.float64]

WIDTH = 7.6  # in: the text width of an A4 page
BLUE, RED, GREEN, AMBER, CYAN, PURPLE, GREY = "#2f6db0", "#d1495b", "#2e8b57", "#c9971c", "#4fb3d9", "#8e4585", "#8a8f98"
CYCLE = (BLUE, RED, GREEN, AMBER, PURPLE, CYAN, GREY)
INK, FAINT = "#22262b", "#d9dce1"

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8.0,
    "axes.labelcolor": INK,
    "axes.edgecolor": "#5b616b",
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.limits": (-4, 5),
    "grid.color": "#e6e8ec",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "legend.handlelength": 1.8,
    "text.color": INK,
    "xtick.color": "#3d434c",
    "ytick.color": "#3d434c",
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "figure.dpi": 110,
    "savefig.dpi": 200,
    "figure.facecolor": "white",
}

ROTATIONS = ("roll", "pitch", "yaw")
#: Symbols of paper and textbook: index of a degree of freedom, from 1.
INDEX = {"surge": 1, "sway": 2, "heave": 3, "roll": 4, "pitch": 5, "yaw": 6}
#: Units of matrix entries by the number of rotations in (force, motion).
UNITS = {
    "A": ("kg", "kg m", "kg m\u00b2"),
    "B": ("kg/s", "kg m/s", "kg m\u00b2/s"),
    "C": ("N/m", "N", "N m"),
    "K": ("N/m", "N", "N m"),
}
_SUPERSCRIPT = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")


def styled(draw: Callable[P, Any]) -> Callable[P, Any]:
    """Run a drawing function under the common style; a keyword ``save`` of the function also writes the figure to a file."""

    @wraps(draw)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> Any:
        import matplotlib as mpl

        with mpl.rc_context(STYLE):
            fig = draw(*args, **kwargs)
            save = kwargs.get("save")
            if save is not None:
                write(fig, save)  # type: ignore[arg-type]
        return fig

    return wrapper


def new_figure(height: float, width: float = WIDTH) -> Any:
    """Return an empty figure that belongs to no window; notebooks show it as the result of a cell."""
    from matplotlib.figure import Figure

    if "ipykernel" in sys.modules:
        import matplotlib.pyplot  # noqa: F401  registers the display of figures in the notebook
    return Figure(figsize=(width, height), layout="constrained")


@styled
def custom(draw: Callable[[Any, Any], None], data: Any, *, height: float = 3.6, save: str | Path | None = None) -> Any:
    """Let a function draw into a figure of the common style.

    Parameters
    ----------
    draw : callable
        Called as ``draw(data, fig)`` with an empty figure.
    data : object
    height : float
        in.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    fig = new_figure(height)
    draw(data, fig)
    return fig


def show(*figures: Any) -> None:
    """Show figures in windows and wait until they are closed.

    Parameters
    ----------
    *figures : matplotlib.figure.Figure
    """
    import matplotlib.pyplot as plt

    for fig in figures:
        window = plt.figure(figsize=fig.get_size_inches()).canvas.manager
        window.canvas.figure = fig  # type: ignore[union-attr]
        fig.set_canvas(window.canvas)  # type: ignore[union-attr]
    plt.show()


def to_png(fig: Any, *, dpi: int = 170) -> bytes:
    """Return a figure as the bytes of a PNG file.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
    dpi : int
        Pixels per inch.
    """
    buffer = io.BytesIO()
    fig.savefig(buffer, format="png", dpi=dpi, metadata={"Software": None})
    return buffer.getvalue()


def write(fig: Any, path: str | Path) -> Path:
    """Write a figure to a file, whole or not at all; the ending chooses the format (png, svg, pdf).

    Parameters
    ----------
    fig : matplotlib.figure.Figure
    path : str or Path

    Returns
    -------
    Path
    """
    path = Path(path)
    if path.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise InputError(f"figure: a file name that ends in .png, .svg or .pdf expected, {path.name!r} found.")
    return write_whole(path, lambda part: fig.savefig(part, format=path.suffix[1:].lower()))


def power(values: ArrayLike) -> tuple[float, str]:
    """Return a factor 10^(3k) that brings values to a readable size, and how it is written on an axis.

    Examples
    --------
    >>> power([0.0, 2.5e7])[0]
    1000000.0
    """
    largest = float(np.nanmax(np.abs(values), initial=0.0))
    if largest == 0.0 or 0.1 <= largest < 1e4:
        return 1.0, ""
    exponent = 3 * int(np.floor(np.log10(largest) / 3 + 1e-9))
    return 10.0**exponent, f"10{str(exponent).translate(_SUPERSCRIPT)} "


def is_rotation(dof: str) -> bool:
    """Whether a degree of freedom is an angle."""
    return dof in ROTATIONS


def matrix_unit(row: str, column: str, letter: str) -> str:
    """Return the unit of an entry of added mass A, damping B, stiffness C or retardation function K.

    Examples
    --------
    >>> matrix_unit("heave", "pitch", "K")
    'N'
    """
    return UNITS[letter][int(is_rotation(row)) + int(is_rotation(column))]


def degrees(dof: str, values: ArrayLike) -> tuple[Array, str]:
    """Return a motion for display, rotations in degrees, and its unit."""
    values = np.asarray(values, dtype=float)
    return (np.degrees(values), "deg") if is_rotation(dof) else (values, "m")


def subscript(row: str, column: str | None = None) -> str:
    """Return the index of an entry as the literature writes it, e.g. 35; names outside the six dofs stay as they are."""
    if row in INDEX and (column is None or column in INDEX):
        return f"{INDEX[row]}{INDEX[column] if column else ''}"
    return row if column is None else f"{row},{column}"


def panels(fig: Any, count: int, columns: int) -> list[Any]:
    """Return `count` axes in rows of `columns`."""
    rows = -(-count // columns)
    axes = fig.subplots(rows, columns, squeeze=False).ravel()
    for extra in axes[count:]:
        extra.remove()
    return list(axes[:count])


def shades(count: int) -> list[Any]:
    """Return colours from dark to light for an ordered family of curves."""
    if count <= len(CYCLE):
        return list(CYCLE[:count])
    import matplotlib as mpl

    return list(mpl.colormaps["viridis"](np.linspace(0.0, 0.88, count)))


def some_of(count: int, most: int = 7) -> NDArray[np.int64]:
    """Return the places of at most so many of a number of directions, evenly, from the first on."""
    return np.arange(0, count, max(1, -(-(count - 1) // (most - 1))))


def legend_of_directions(fig: Any, ax: Any, shown: int, count: int) -> None:
    """Put the directions of the waves, which one of the axes names, above a figure; told when not all are drawn."""
    handles, labels = ax.get_legend_handles_labels()
    some = f" ({shown} of {count} directions)" if shown < count else ""
    title = f"waves travel towards{some}"
    fig.legend(handles, labels, loc="outside upper right", ncols=shown, title=title, title_fontsize=7.5)


def choose(names: Sequence[str], wanted: Sequence[str] | None, what: str) -> list[str]:
    """Return the wanted names, all by default; unknown ones are an error."""
    names = [str(n) for n in names]
    if wanted is None:
        return names
    unknown = [w for w in wanted if w not in names]
    if unknown:
        raise InputError(f"{what}: names among {', '.join(names)} expected, {', '.join(map(str, unknown))} found.")
    return list(wanted)
