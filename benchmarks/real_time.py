"""Latency of one step of a vessel with 69 memory states, of a run that keeps real time, and what a Python callback costs.

Percentiles are of every single step, the preparation of wave forces for the next block of steps included. The clock is read
twice per step, which adds about 0.1 us.
"""

import socket
import time
from collections.abc import Callable

import numpy as np

import ogilvie as og
from benchmarks import Measurement
from benchmarks.simulation import rate, vessel
from ogilvie.post.broadcast import UdpSender, json_line
from ogilvie.post.nmea import Nmea
from ogilvie.sim.latency import Latencies, Percentiles
from ogilvie.sim.real_time import run_real_time

DT = 0.01
STEPS = 50_000
PACED = 20.0  # s
BASE = "Stepper.step"


def new_stepper() -> og.Stepper:
    """Return a stepper in waves of 200 components, past its first step."""
    sea = og.irregular(
        og.jonswap(hs=3.0, tp=9.0, gamma=3.3), direction=np.radians(130.0), n=200, omega_range=(0.3, 2.5), seed=1
    )
    stepper = og.Stepper(vessel(), sea, dt=DT)
    stepper.step()
    return stepper


def latencies(work: Callable[[], object], count: int = STEPS) -> Percentiles:
    """Return how long each of many calls took."""
    taken, now = Latencies(), time.perf_counter
    for _ in range(count):
        began = now()
        work()
        taken.add(now() - began)
    return taken.percentiles()


def rows(name: str, found: Percentiles, base: float | None = None) -> list[Measurement]:
    """Return one measurement per percentile; the median as a ratio to a base, where there is one."""
    named = {"50 %": found.p50, "95 %": found.p95, "99 %": found.p99, "99.9 %": found.p999, "max": found.max}
    made = [Measurement(f"{name}, {key}", 1e6 * value, "us") for key, value in named.items()]
    if base is not None:
        made[0] = Measurement(made[0].name, made[0].value, "us", found.p50 / base, BASE)
    return made


def steps_per_second(on_step: Callable[[og.State], object] | None, listener: Callable[[og.State], object] | None) -> float:
    """Return steps per second of a plain loop with a force and a listener in Python, or without."""
    stepper = new_stepper()

    def work() -> None:
        state = stepper.state
        for _ in range(STEPS // 5):
            state = stepper.step(None if on_step is None else on_step(state))  # type: ignore[arg-type]
            if listener is not None:
                listener(state)

    return rate(STEPS // 5, work)


def paced(name: str, **options: object) -> list[Measurement]:
    """Return latencies of a run that keeps real time."""
    report = run_real_time(new_stepper(), PACED, patience=1e9, **options)  # type: ignore[arg-type]
    note = f"{report.steps} steps, {report.stretches} times behind, {1e3 * report.largest_lateness:.3g} ms at most"
    made = [
        Measurement(f"{name}, deadlines missed", report.missed, "steps", note=note),
        *rows(f"{name}, computing", report.computing),
        *rows(f"{name}, wake-up", report.wake_up),
    ]
    return made + (rows(f"{name}, output", report.output) if report.output.count else [])


def measure() -> list[Measurement]:
    """Return the measurements."""
    stepper, force = new_stepper(), np.array([1e4, 0.0, 0.0, 0.0, 0.0, 1e5])
    state = stepper.state
    step = latencies(stepper.step)
    pushed = latencies(lambda: stepper.step(force))
    plain = steps_per_second(None, None)
    with_callback = steps_per_second(lambda s: -1e3 * s.nu, None)
    formats = {"JSON line": json_line, "NMEA, seven sentences": Nmea()}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
        ear.bind(("127.0.0.1", 0))
        with UdpSender("127.0.0.1", ear.getsockname()[1]) as sender:
            sending = rows("UdpSender, JSON, one datagram", latencies(lambda: sender(state), 10_000), step.p50)
            at_work = paced(f"real time at dt {DT:g} with UDP", listeners=(sender,))
    return [
        *rows(BASE, step, step.p50),
        *rows("Stepper.step with a force", pushed, step.p50),
        Measurement("Stepper, no callback", plain, "steps/s", 1.0, "no callback"),
        Measurement("Stepper, force from a Python function", with_callback, "steps/s", with_callback / plain, "no callback"),
        *[m for k, f in formats.items() for m in rows(k, latencies(lambda f=f: f(state), 10_000), step.p50)[:1]],  # type: ignore[misc]
        *sending,
        *paced(f"real time at dt {DT:g}"),
        *at_work,
    ]
