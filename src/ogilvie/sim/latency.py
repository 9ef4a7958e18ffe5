"""Percentiles of times that are taken in a loop: constant memory, no allocation while it runs."""

from dataclasses import dataclass
from itertools import accumulate
from math import ceil, exp, inf, isinf, log, nan

#: Shortest and longest time told apart, s, and the relative width of a class.
SHORTEST, LONGEST, WIDTH = 1e-8, 1e4, 0.01
_CLASSES = int(log(LONGEST / SHORTEST) / WIDTH) + 1


@dataclass(frozen=True)
class Percentiles:
    """How long something took, s: number of times taken, mean, percentiles (within 0.5 %) and the longest.

    Examples
    --------
    >>> print(Percentiles(count=1000, mean=2e-5, p50=1.9e-5, p95=3e-5, p99=5e-5, p999=2e-4, max=1.5e-3))
    50 %: 19 us, 95 %: 30 us, 99 %: 50 us, 99.9 %: 200 us, max: 1.5 ms
    """

    count: int
    mean: float
    p50: float
    p95: float
    p99: float
    p999: float
    max: float

    def __str__(self) -> str:
        if not self.count:
            return "none taken"
        named = {"50 %": self.p50, "95 %": self.p95, "99 %": self.p99, "99.9 %": self.p999, "max": self.max}
        return ", ".join(f"{name}: {readable(value)}" for name, value in named.items())


class Latencies:
    """Times in classes that are 1 % wide.

    Examples
    --------
    >>> times = Latencies()
    >>> for i in range(1, 101):
    ...     times.add(1e-3 * i)
    >>> found = times.percentiles()
    >>> round(found.p50, 3), round(found.p99, 3), found.max
    (0.05, 0.099, 0.1)
    """

    def __init__(self) -> None:
        self._classes = [0] * _CLASSES
        self._count, self._sum, self._max = 0, 0.0, -inf

    def add(self, seconds: float) -> None:
        """Take in one time, s; what is shorter or longer than the classes reach goes to the first or last of them."""
        place = int(log(seconds / SHORTEST) / WIDTH) if seconds > SHORTEST else 0
        self._classes[min(place, _CLASSES - 1)] += 1
        self._count += 1
        self._sum += seconds
        if seconds > self._max:
            self._max = seconds

    def percentiles(self) -> Percentiles:
        """Return mean, percentiles (nearest rank) and maximum so far; NaN where nothing was taken in."""
        if not self._count:
            return Percentiles(0, nan, nan, nan, nan, nan, nan)
        p50, p95, p99, p999 = (self._rank(share) for share in (0.5, 0.95, 0.99, 0.999))
        return Percentiles(self._count, self._sum / self._count, p50, p95, p99, p999, self._max)

    def _rank(self, share: float) -> float:
        """The middle of the class that holds the time with this rank, or the maximum where that is less."""
        wanted = ceil(share * self._count - 1e-9)
        place = next(i for i, seen in enumerate(accumulate(self._classes)) if seen >= wanted)
        return min(SHORTEST * exp((place + 0.5) * WIDTH), self._max)


def readable(seconds: float) -> str:
    """Return a time with a unit that suits it.

    Examples
    --------
    >>> readable(2.5e-5), readable(0.0123), readable(4.0), readable(0.0)
    ('25 us', '12.3 ms', '4 s', '0 s')
    """
    if seconds == 0.0 or isinf(seconds):
        return f"{seconds:g} s"
    size = abs(seconds)
    value, unit = (seconds, "s") if size >= 1.0 else (1e3 * seconds, "ms") if size >= 1e-3 else (1e6 * seconds, "us")
    return f"{value:.3g} {unit}"
