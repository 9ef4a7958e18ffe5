"""WAMIT's numeric output files, from a stem or any of the files, as one dimensional data set."""

from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ogilvie.errors import FormatError, InputError
from ogilvie.hydro import wamit_tables
from ogilvie.hydro.wamit_dimension import Tables, dataset
from ogilvie.hydro.wamit_parameters import collect

RESPONSES = ("3", "2", "3fk", "3sc", "4")
DRIFTS = ("9", "7", "8")
TABLES = ("1", *RESPONSES, *DRIFTS, "12d", "12s", "hst")
RUN_FILES = ("out", "frc", "gdf", "pot", "cfg")


def read_wamit(
    path: str | Path,
    *,
    ulen: float | None = None,
    rho: float | None = None,
    g: float | None = None,
    water_depth: float | None = None,
) -> xr.Dataset:
    """Read the WAMIT files of one body.

    Parameters
    ----------
    path : path
        The stem ("run/tanker") or any of the files ("run/tanker.1", "run/tanker.out"); .gz is understood.
    ulen, rho, g, water_depth : float, optional
        Length scale (m), density (kg/m3), gravity (m/s2), depth (m). Those not given are taken from .out, .frc, .gdf, .pot, or
        assumed (1 m, 1025, 9.80665, deep); the attributes `ulen_source` and so on say which.

    Returns
    -------
    xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`.

    Raises
    ------
    FormatError
        A damaged, truncated or contradictory file; several bodies.

    Notes
    -----
    With L = ULEN and k = 0 for translations, 1 for rotations (per index): A = rho L^(3+k) A', B = rho omega L^(3+k) B',
    X = rho g L^(2+k) X', C = rho g L^(2+k) C', motions L^-k, mean drift and quadratic transfer functions rho g L^(1+k).
    Exciting forces come from `.3`, or by Haskind's relation from `.2` if there is no `.3`.

    References
    ----------
    WAMIT User Manual, chapters 3 and 4.
    """
    stem, files = wamit_files(Path(path))
    if "1" not in files:
        found = ", ".join(file.name for file in files.values()) or "none of WAMIT's files"
        raise FormatError(f"{stem}: a file {stem.name}.1 with added mass and damping expected, {found} found. Add it.")
    parameters = collect(files, ulen=ulen, rho=rho, g=g, water_depth=water_depth)
    source = "WAMIT " + ", ".join(file.name for file in files.values())
    return dataset(read_tables(files), parameters, name=stem.name, source=source)


def wamit_files(path: Path) -> tuple[Path, dict[str, Path]]:
    """Return the stem and the files of a run: suffix in lower case without dot -> path.

    Examples
    --------
    >>> wamit_files(Path("nowhere/hull.1"))
    Traceback (most recent call last):
    ...
    ogilvie.errors.InputError: nowhere: an existing folder expected, none found. Check the path.
    """
    if not path.parent.is_dir():
        raise InputError(f"{path.parent}: an existing folder expected, none found. Check the path.")
    stem = path.with_name(split_name(path.name)[0])
    files: dict[str, Path] = {}
    for candidate in sorted(path.parent.iterdir(), key=lambda file: (file.suffix.lower() == ".gz", file.name)):
        name, suffix = split_name(candidate.name)
        if suffix and name.lower() == stem.name.lower() and candidate.is_file():
            files.setdefault(suffix, candidate)
    order = (*TABLES, *RUN_FILES)
    return stem, {suffix: files[suffix] for suffix in order if suffix in files}


def read_tables(files: Mapping[str, Path]) -> Tables:
    """Read every table that is there."""
    return Tables(
        radiation=wamit_tables.radiation(files["1"]),
        responses={suffix: wamit_tables.response(files[suffix]) for suffix in RESPONSES if suffix in files},
        drifts={suffix: wamit_tables.drift(files[suffix]) for suffix in DRIFTS if suffix in files},
        quadratics={s: wamit_tables.quadratic(files[s], difference=s == "12d") for s in ("12d", "12s") if s in files},
        stiffness=wamit_tables.hydrostatics(files["hst"]) if "hst" in files else None,
    )


def split_name(name: str) -> tuple[str, str]:
    """Split "hull.3fk.gz" into ("hull", "3fk"); the suffix is empty where it is none of WAMIT's."""
    bare = name[:-3] if name.lower().endswith(".gz") else name
    if bare.lower().endswith(".out.head"):
        bare = bare[:-5]
    stem, dot, suffix = bare.rpartition(".")
    return (stem, suffix.lower()) if dot and stem and suffix.lower() in (*TABLES, *RUN_FILES) else (name, "")
