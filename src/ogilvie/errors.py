"""What can go wrong, in a few kinds. Every message says what was expected, what was found and what to do."""

__all__ = [
    "ConventionError",
    "ConvergenceError",
    "DoubleCountingError",
    "FormatError",
    "InputError",
    "OgilvieError",
    "OgilvieWarning",
]


class OgilvieError(Exception):
    """Base of all errors that the package raises on purpose; the command line prints it and exits with code 2."""


class InputError(OgilvieError, ValueError):
    """An argument is outside what the function can work with (negative mass, Hs < 0, wrong shape, NaN)."""


class FormatError(OgilvieError, ValueError):
    """A file is not what it should be; the message names file, line, what was expected and what was found."""


class ConventionError(OgilvieError, ValueError):
    """Signs, phases or frames of a data set contradict the project's convention (two-phase probe)."""


class DoubleCountingError(OgilvieError, ValueError):
    """Two loads cover one physical effect; the message names both."""


class ConvergenceError(OgilvieError, RuntimeError):
    """An iteration or a time stepping did not reach a usable answer."""


class OgilvieWarning(UserWarning):
    """Something the user should know and that does not stop the work."""
