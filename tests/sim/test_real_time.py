"""Keeping time: deadlines on a clock of the test's own, so that no load of the machine can make them fail."""

import json
import signal
import socket
import threading
import time
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

import ogilvie as og
from ogilvie.errors import OgilvieWarning
from ogilvie.post.broadcast import UdpSender
from ogilvie.sim.latency import Latencies, Percentiles, readable
from ogilvie.sim.pacing import SPIN, Clock
from ogilvie.sim.real_time import run_real_time
from ogilvie.sim.real_time_report import RealTimeReport

TICK = 1e-5
DT = 0.1


class ToyTime:
    """Time that passes in sleeps and where the test says so."""

    def __init__(self, oversleep: float = 0.0) -> None:
        self.t, self.oversleep, self.sleeps = 1000.0, oversleep, []

    def now(self) -> float:
        self.t += 1e-7
        return self.t

    def sleep(self, seconds: float) -> None:
        self.sleeps.append(seconds)
        self.t += max(seconds, TICK) + (self.oversleep if seconds > 0.0 else 0.0)
        assert len(self.sleeps) < 100_000, "no end of waiting"

    @property
    def clock(self) -> Clock:
        return Clock(self.now, self.sleep)


class ToyStepper:
    """Steps that take the time that the test wants."""

    def __init__(self, world: ToyTime, cost=lambda k: 0.01, dt: float = DT) -> None:
        self.world, self.cost, self.dt, self.k, self.forces = world, cost, dt, 0, []

    @property
    def state(self) -> og.State:
        return og.State(time=self.k * self.dt)

    def step(self, external_force=None) -> og.State:
        self.k += 1
        self.forces.append(external_force)
        self.world.t += self.cost(self.k)
        return self.state


def paced(duration, cost=lambda k: 0.01, oversleep=0.0, listener_cost=0.0, **options):
    """Run on toy time; the report, and when each state was handed out after the start of the clock."""
    world, heard = ToyTime(oversleep), []
    stepper = ToyStepper(world, cost)

    def listener(state):
        heard.append((state.time, world.t - 1000.0 - cost(1)))
        world.t += listener_cost

    report = run_real_time(stepper, duration, listeners=[listener], clock=world.clock, **options)
    return SimpleNamespace(report=report, heard=np.array(heard), world=world, stepper=stepper)


# deadlines


@pytest.mark.parametrize("factor", [0.5, 1.0, 7.0])
@pytest.mark.parametrize("oversleep", [0.0, 1e-4])
def test_states_come_at_their_time_and_do_not_drift(factor, oversleep):
    run = paced(200 * DT, cost=lambda k: 0.2 * DT / factor, oversleep=oversleep, factor=factor)
    due = run.heard[:, 0] / factor
    assert len(due) == 200
    late = run.heard[:, 1] - due
    assert late.min() >= -1e-9
    assert late.max() <= 2 * TICK  # the error of the last is that of the first: nothing adds up
    assert run.report.missed == 0
    assert run.report.wall == pytest.approx(200 * DT / factor, abs=1e-3)
    assert run.report.simulated == pytest.approx(200 * DT)


def test_the_end_of_a_wait_is_spun_and_the_rest_slept():
    run = paced(10 * DT, cost=lambda k: 0.0)
    slept = sum(run.world.sleeps)
    assert slept == pytest.approx(10 * (DT - SPIN), rel=0.01)
    assert max(run.world.sleeps) <= 0.1
    assert 0 < run.world.sleeps.count(0.0) < 20 * SPIN / TICK


def test_an_oversleep_shows_as_jitter_of_the_wake_up():
    run = paced(5 * DT, oversleep=2e-3)
    assert run.report.wake_up.max == pytest.approx(2e-3 - SPIN, abs=TICK)
    assert run.report.wake_up.count == 5
    assert run.report.missed == 0  # the states were ready


def test_a_slow_step_is_caught_up_and_none_is_left_out():
    """Step 5 takes 3.5 periods: states 5 to 7 are late, state 8 is on time."""
    run = paced(12 * DT, cost=lambda k: 0.35 if k == 5 else 0.01)
    r = run.report
    assert run.heard[:, 0] == pytest.approx(DT * np.arange(1, 13))
    late = run.heard[:, 1] - run.heard[:, 0]
    assert late[4:7] == pytest.approx([0.25, 0.16, 0.07], abs=1e-4)
    assert np.delete(late, [4, 5, 6]).max() < 1e-4
    assert (r.missed, r.stretches, r.caught_up) == (3, 1, 1)
    assert r.largest_lateness == pytest.approx(0.25, abs=1e-4)
    assert r.mean_lateness == pytest.approx(0.16, abs=1e-4)
    assert r.longest_behind == pytest.approx(0.27, abs=1e-4)
    assert r.final_lateness == 0.0
    assert "missed  3 (25 %), by 250 ms at most and 160 ms on average; behind once" in str(r)
    assert "caught up each time" in str(r)


def test_two_stretches():
    r = paced(20 * DT, cost=lambda k: 0.15 if k in (4, 12) else 0.01).report
    assert (r.missed, r.stretches, r.caught_up) == (2, 2, 2)


def test_slow_listeners_delay_and_are_told():
    r = paced(10 * DT, listener_cost=0.15, patience=60.0).report
    assert r.output.mean == pytest.approx(0.15, abs=1e-4)
    assert r.missed == 9
    assert r.stretches - r.caught_up == 1
    assert "behind at the end" in str(r)


def test_the_first_step_is_done_before_the_clock_starts():
    r = paced(10 * DT, cost=lambda k: 5.0 if k == 1 else 0.01).report
    assert r.missed == 0
    assert r.computing.count == 9
    assert r.computing.max == pytest.approx(0.01, abs=1e-4)
    assert r.wall == pytest.approx(1.0, abs=1e-3)


def test_too_slow_is_warned_of_once_and_all_steps_are_done():
    with pytest.warns(OgilvieWarning) as caught:
        run = paced(50 * DT, cost=lambda k: 0.2, patience=2.0)
    assert [str(w.message)[:25] for w in caught] == ["real time: behind for 2.1"]
    assert "no step is left out" in str(caught[0].message)
    assert run.report.steps == len(run.heard) == 50
    assert run.report.missed == 49
    assert run.report.final_lateness == pytest.approx(49 * 0.1, abs=1e-3)
    assert run.report.wall == pytest.approx(0.1 + 49 * 0.2, abs=1e-3)  # the first waits for its deadline


def test_no_warning_within_patience():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert paced(50 * DT, cost=lambda k: 0.2, patience=60.0).report.missed == 49


def test_listeners_hear_every_so_many_steps():
    run = paced(10 * DT, every=3)
    assert run.heard[:, 0] == pytest.approx([0.3, 0.6, 0.9])
    assert run.report.output.count == 3
    assert run.report.steps == 10


def test_on_step_gives_forces_from_the_present_state():
    seen = []

    def push(state):
        seen.append(state.time)
        return None if state.time < 0.15 else [state.time, 0, 0, 0, 0, 0]

    run = paced(4 * DT, on_step=push)
    assert seen == pytest.approx([0.0, 0.1, 0.2, 0.3])
    assert run.stepper.forces[:2] == [None, None]
    assert [f[0] for f in run.stepper.forces[2:]] == pytest.approx([0.2, 0.3])


# interrupts


def interrupt_at(k, times=1):
    def listener(state):
        if round(state.time / DT) == k:
            for _ in range(times):
                signal.raise_signal(signal.SIGINT)

    return listener


@pytest.fixture
def ordinary_interrupts():
    former = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, former)


@pytest.mark.parametrize("times", [1, 2])
@pytest.mark.parametrize("duration", [100 * DT, float("inf")])
def test_an_interrupt_ends_the_run_with_the_report_so_far(ordinary_interrupts, duration, times):
    world = ToyTime()
    stepper = ToyStepper(world)
    report = run_real_time(stepper, duration, listeners=[interrupt_at(7, times)], clock=world.clock)
    assert report.interrupted
    assert report.steps == stepper.k == 7
    assert "interrupted" in str(report)


def test_an_interrupt_in_a_long_wait_is_heard(ordinary_interrupts):
    world = ToyTime()

    def sleep(seconds):
        world.sleep(seconds)
        if world.t > 1000.5:
            signal.raise_signal(signal.SIGINT)

    heard = []
    report = run_real_time(ToyStepper(world, dt=1e6), 5e6, listeners=[heard.append], clock=Clock(world.now, sleep))
    assert report.interrupted
    assert world.t < 1001.0
    assert heard == []  # no state before its time


def test_an_interrupt_leaves_the_stepper_in_order(ordinary_interrupts, barge, seas):
    """The run goes on afterwards as if nothing had been."""
    stepper, other = og.Stepper(barge.ship, seas.one, dt=DT), og.Stepper(barge.ship, seas.one, dt=DT)
    report = run_real_time(stepper, 50.0, factor=100.0, listeners=[interrupt_at(20)], patience=1e3)
    assert report.interrupted
    assert report.steps == 20
    for _ in range(30):
        expected = other.step()
    for _ in range(10):
        state = stepper.step()
    assert state.time == expected.time
    assert np.array_equal(state.eta, expected.eta)


def test_what_a_listener_raises_ends_the_run_and_restores_the_handler(ordinary_interrupts):
    world = ToyTime()
    with pytest.raises(ZeroDivisionError):
        run_real_time(ToyStepper(world), 1.0, listeners=[lambda state: 1 / 0], clock=world.clock)


def test_outside_the_main_thread():
    found = []
    world = ToyTime()
    thread = threading.Thread(target=lambda: found.append(run_real_time(ToyStepper(world), 1.0, clock=world.clock)))
    thread.start()
    thread.join()
    assert found[0].steps == 10
    assert not found[0].interrupted


# the real clock: only what no load can change


def test_wall_clock_never_ahead_and_same_numbers_as_the_stepper_alone(barge, seas):
    stepper, alone = og.Stepper(barge.ship, seas.one, dt=0.02), og.Stepper(barge.ship, seas.one, dt=0.02)
    heard = []
    began = time.perf_counter()
    report = run_real_time(stepper, 0.6, factor=2.0, listeners=[lambda s: heard.append((time.perf_counter(), s))], patience=1e3)
    assert report.steps == len(heard) == 30
    for _, state in heard:
        expected = alone.step()
        assert state.time == expected.time
        assert np.array_equal(state.eta, expected.eta)
    assert all(at >= began + 0.01 * (i + 1) for i, (at, _) in enumerate(heard))  # no state before its time
    assert report.wall >= 0.3
    assert report.computing.count == 29
    assert report.wake_up.count == 30 - report.missed
    assert 0.0 < report.computing.p50 <= report.computing.p99 <= report.computing.max


@pytest.mark.parametrize("name", ["ship", "ship_convolution"])
def test_states_arrive_in_order_with_the_same_numbers(barge, seas, name):
    """A real socket and a real thread that listens: every datagram, in order, bit for bit."""
    stepper, alone = og.Stepper(getattr(barge, name), seas.one, dt=0.01), og.Stepper(getattr(barge, name), seas.one, dt=0.01)
    with listening() as ear, UdpSender("127.0.0.1", ear.port) as sender:
        report = run_real_time(stepper, 1.0, factor=5.0, listeners=[sender], patience=1e3)
        lines = ear.wait(100)
    assert (report.steps, sender.sent, sender.errors) == (100, 100, 0)
    for line in lines:
        found, expected = json.loads(line), alone.step()
        assert found == {"version": 1, "t": expected.time, "eta": expected.eta.tolist(), "nu": expected.nu.tolist()}
        assert line.endswith(b"}\n")


def test_nobody_at_the_port_does_no_harm(barge, seas):
    with listening() as ear:
        port = ear.port  # nobody has it afterwards
    with UdpSender("127.0.0.1", port) as sender:
        report = run_real_time(og.Stepper(barge.ship, seas.one, dt=0.01), 0.5, factor=10.0, listeners=[sender], patience=1e3)
    assert (report.steps, sender.sent + sender.errors) == (50, 50)


class listening:
    """A thread that takes in what comes to a port of its own."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.05)
        self.port = self.socket.getsockname()[1]
        self.heard, self.over = [], False
        self.thread = threading.Thread(target=self._listen, daemon=True)

    def _listen(self):
        while not self.over:
            try:
                self.heard.append(self.socket.recv(65536))
            except TimeoutError:
                continue

    def wait(self, count, patience=30.0):
        """What was heard, once there are so many datagrams."""
        end = time.monotonic() + patience
        while len(self.heard) < count and time.monotonic() < end:
            time.sleep(0.01)
        assert len(self.heard) == count
        return self.heard

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over = True
        self.thread.join()
        self.socket.close()


# bad input


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"duration": 0.0}, "duration: a positive number"),
        ({"duration": -float("inf")}, "duration"),
        ({"duration": float("nan")}, "duration"),
        ({"duration": 0.01}, "at least one step of 0.1 s expected, 0.01 s found"),
        ({"factor": 0.0}, "factor"),
        ({"factor": "fast"}, "factor"),
        ({"every": 0}, "every: a whole number of steps >= 1 expected, 0 found"),
        ({"every": 1.5}, "every"),
        ({"patience": float("nan")}, "patience"),
    ],
)
def test_bad_input(options, words):
    world = ToyTime()
    with pytest.raises(og.InputError, match=words):
        run_real_time(ToyStepper(world), **{"duration": 1.0, "clock": world.clock} | options)


# latencies


@pytest.mark.parametrize("seed", range(3))
def test_percentiles_are_those_of_the_sorted_times(seed):
    times = np.exp(np.random.default_rng(seed).normal(-9.0, 2.0, 5000))
    taken = Latencies()
    for t in times:
        taken.add(float(t))
    found = taken.percentiles()
    ranked = np.sort(times)[[2499, 4749, 4949, 4994]]
    assert [found.p50, found.p95, found.p99, found.p999] == pytest.approx(ranked, rel=0.00502)
    assert found.max == times.max()
    assert found.mean == pytest.approx(times.mean())
    assert found.count == 5000


def test_latencies_without_any_and_beyond_the_classes():
    assert Latencies().percentiles().count == 0
    assert str(Latencies().percentiles()) == "none taken"
    taken = Latencies()
    for t in (0.0, 1e-12, 1e9):
        taken.add(t)
    assert taken.percentiles().p50 <= 1.1e-8
    assert taken.percentiles().max == 1e9


def test_report_before_the_first_step(ordinary_interrupts):
    def stop(state):
        raise KeyboardInterrupt

    world = ToyTime()
    report = run_real_time(ToyStepper(world), 1.0, on_step=stop, clock=world.clock)
    assert (report.steps, report.interrupted, report.wall) == (0, True, 0.0)
    assert "0 s in 0 steps" in str(report)


def test_report_is_readable():
    p = Percentiles(10, 1e-4, 1e-4, 2e-4, 3e-4, 4e-4, 0.012)
    text = str(RealTimeReport(10, 1.0, 0.1, 0.1, 10.0, 0, 0.0, 0.0, 0, 0, 0.0, 0.0, p, p, Percentiles(0, *(6 * [0.0])), False))
    assert text.splitlines() == [
        "1 s in 10 steps of 100 ms, 0.1 s on the clock (10 x real time)",
        "deadlines missed  0 (0 %)",
        "computing         50 %: 100 us, 95 %: 200 us, 99 %: 300 us, 99.9 %: 400 us, max: 12 ms",
        "wake-up           50 %: 100 us, 95 %: 200 us, 99 %: 300 us, 99.9 %: 400 us, max: 12 ms",
    ]
    assert readable(float("inf")) == "inf s"
