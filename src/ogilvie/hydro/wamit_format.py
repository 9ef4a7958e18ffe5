"""Numbers and rows as WAMIT prints them."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.hydro.wamit_text import Array


def rotations(hydro: xr.Dataset) -> Array:
    """Return 0.0 for translations and 1.0 for rotations."""
    return np.array([float(DOFS.index(name) > 2) for name in hydro.influenced_dof.values])


def mode_numbers(hydro: xr.Dataset) -> list[int]:
    """Return the number of each degree of freedom, from 1."""
    return [DOFS.index(name) + 1 for name in hydro.influenced_dof.values]


def periods(hydro: xr.Dataset) -> Iterator[tuple[int, float]]:
    """Yield index and period of each frequency, shortest period first, as WAMIT's users list them."""
    omega = hydro.omega.values
    for f in range(len(omega))[::-1]:
        yield f, 2.0 * np.pi / omega[f]


def exponential(value: float) -> str:
    """Return 14 characters; exponents have two digits, so what is below 1e-99 is zero."""
    size = abs(value)
    if size >= 9.9999e99:
        raise InputError(
            f"write_wamit: numbers below 1e100 expected, {value:g} found. Choose a larger ulen or correct the data."
        )
    return f"{value if size > 1e-99 else 0.0:14.6E}"


def polar(value: complex) -> str:
    """Return amplitude, phase (deg), real and imaginary part and the end of the line."""
    phase = np.degrees(np.angle(value)) if value != 0 else 90.0
    return f"{exponential(abs(value))}{phase:14.6E}{exponential(value.real)}{exponential(value.imag)}\n"
