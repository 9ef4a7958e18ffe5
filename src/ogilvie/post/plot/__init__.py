"""Figures: each function returns a matplotlib ``Figure``, with units on every axis (degrees for angles), and takes ``save``."""

from ogilvie.post.plot._drift import drift
from ogilvie.post.plot._hull import hull
from ogilvie.post.plot._mooring import mooring
from ogilvie.post.plot._motions import motions, response_spectra
from ogilvie.post.plot._overview import overview
from ogilvie.post.plot._radiation import coefficients, retardation
from ogilvie.post.plot._style import custom, show, to_png, write
from ogilvie.post.plot._track import controls, track
from ogilvie.post.plot._waves import excitation, rao, spectrum
from ogilvie.post.plot._wind import wind_coefficients

__all__ = [
    "coefficients",
    "controls",
    "custom",
    "drift",
    "excitation",
    "hull",
    "mooring",
    "motions",
    "overview",
    "rao",
    "response_spectra",
    "retardation",
    "show",
    "spectrum",
    "to_png",
    "track",
    "wind_coefficients",
    "write",
]
