"""Interrupts (ctrl-C) as a wish to stop between steps."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any


@dataclass(eq=False)
class Stop:
    """Whether an interrupt has come."""

    asked: bool = False

    def __call__(self) -> bool:
        return self.asked


@contextmanager
def heeded_interrupts() -> Iterator[Stop]:
    """Turn an interrupt into a wish to stop, so that no step is torn apart; a second one raises KeyboardInterrupt.

    Another handler of the program than Python's own is left in its place, and so is all outside the main thread.
    """
    stop = Stop()
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield stop
        return

    def handler(signum: int, frame: Any) -> None:
        if stop.asked:
            raise KeyboardInterrupt
        stop.asked = True

    signal.signal(signal.SIGINT, handler)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
