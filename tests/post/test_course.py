"""Motions about a mean course: closed forms, a vessel that keeps its place, one that turns; tracks and controls drawn."""

import numpy as np
import pytest
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.post import plot
from ogilvie.post.course import about_course, courses, mean_course
from ogilvie.post.report_course import course_rows

DOFS = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
T = np.arange(0.0, 400.0, 0.5)


def made(eta, *, motions="large", **signals) -> xr.Dataset:
    dims = ("realisation", "time", "dof") if eta.ndim == 3 else ("time", "dof")
    data = {"eta": (dims, eta), "nu": (dims, np.zeros_like(eta))}
    for owner_and_name, (values, unit) in signals.items():
        owner, name = owner_and_name.split(": ")
        data[f"{owner}_{name}".replace(" ", "_")] = ("time", values, {"units": unit, "signal": name})
    return xr.Dataset(data, {"time": T, "dof": DOFS}, {"motions": motions, "speed": 8.0})


def sailing(course=0.6, speed=8.0, heading=0.5) -> tuple[np.ndarray, np.ndarray]:
    """Poses on a straight track with harmonic motion about it, and that motion; whole periods, so that the line stays."""
    w = 2 * np.pi / 50.0
    xi = np.stack([np.cos(w * T), 2 * np.sin(w * T), 0.3 + np.cos(w * T), *[0.1 * np.sin(w * T)] * 3], axis=1)
    c, s = np.cos(course), np.sin(course)
    eta = xi.copy()
    eta[:, 0], eta[:, 1] = c * (speed * T + xi[:, 0]) - s * xi[:, 1], s * (speed * T + xi[:, 0]) + c * xi[:, 1]
    eta[:, 5] += heading
    return eta, xi


def test_a_straight_track_gives_back_the_motion_about_it():
    """A line fitted to harmonic motion of amplitude a over n periods is wrong by a few a / n at most."""
    eta, xi = sailing()
    course = mean_course(T, eta)
    assert course.speed == pytest.approx(8.0, rel=3e-3)
    assert course.direction == pytest.approx(0.6, abs=3e-3)
    assert course.heading == pytest.approx(0.5, abs=1e-3)
    assert course.drift_angle == pytest.approx(0.1, abs=3e-3)
    about = about_course(made(eta)).eta.values
    np.testing.assert_allclose(about[:, :2], xi[:, :2], atol=0.6)
    np.testing.assert_allclose(about[:, 2:], xi[:, 2:], atol=1e-3)


def test_the_same_from_any_place_in_any_direction():
    eta, _ = sailing()
    turned, _ = sailing(course=0.6 + 2.0, heading=0.5 + 2.0 + 2 * np.pi)
    turned[:, :2] += [500.0, -3000.0]
    np.testing.assert_allclose(about_course(made(turned)).eta.values, about_course(made(eta)).eta.values, atol=1e-9)


def test_a_vessel_that_keeps_its_place_has_no_course():
    eta = 0.05 * np.random.default_rng(1).normal(size=(len(T), 6)) + [10.0, -4.0, 0.0, 0.0, 0.0, 1.0]
    (course,) = courses(made(eta))
    assert course.speed == 0.0
    np.testing.assert_allclose(course.start, [10.0, -4.0], atol=0.1)
    c, s = np.cos(course.heading), np.sin(course.heading)
    expected = (eta[:, :2] - course.start) @ [[c, -s], [s, c]]
    np.testing.assert_allclose(about_course(made(eta)).eta.values[:, :2], expected)
    assert course_rows(made(eta))[0][0] == "mean place, x"


def test_a_vessel_that_turns_keeps_what_has_a_mean():
    eta, _ = sailing()
    eta[:, 5] = np.linspace(0.0, 4.0 * np.pi, len(T))
    assert about_course(made(eta)).dof.values.tolist() == ["heave", "roll", "pitch"]
    assert course_rows(made(eta))[0] == ("course", "turns by up to 720 deg: no mean track")


def test_each_realisation_has_its_own_course():
    eta = np.stack([sailing()[0], sailing(course=-0.4)[0]])
    found = courses(made(eta), skip=50.0)
    np.testing.assert_allclose([c.direction for c in found], [0.6, -0.4], atol=5e-3)
    assert about_course(made(eta)).eta.dims == ("realisation", "time", "dof")


def test_small_motions_stay_as_they_are():
    run = made(sailing()[0], motions="small")
    assert about_course(run) is run
    assert course_rows(run) == []


def test_course_in_words():
    rows = dict(course_rows(made(sailing()[0], **{"autopilot: rudder angle": (0.1 * np.ones_like(T), "rad")})))
    assert 15.0 < float(rows["speed over ground"].removesuffix(" kn")) < 16.0
    assert rows["mean heading"] == "28.6 deg"
    assert rows["rudder angle"] == "mean 5.73, std 0, largest 5.73 deg"


def test_the_track_of_a_ship_that_sails_and_of_one_that_stays():
    fig = plot.track(made(sailing()[0]), length=150.0)
    assert [ax.get_xlabel().split(" [")[0] for ax in fig.axes] == ["x", "distance along the mean track, towards 34.4 deg"]
    assert fig.axes[0].get_aspect() == 1.0
    still = plot.track(
        made(0.5 * np.random.default_rng(2).normal(size=(len(T), 6)) * [1, 1, 1, 0, 0, 0]), length=150.0, beam=30.0
    )
    assert [ax.get_title(loc="left") for ax in still.axes] == ["track of O, vessel to scale", "the same, enlarged"]
    outline = still.axes[0].patches[0].get_path().vertices
    np.testing.assert_allclose(np.ptp(outline, axis=0), [150.0, 30.0], rtol=1e-6)


def test_controls_show_what_was_recorded():
    signals = {
        "autopilot: heading reference": (np.full_like(T, 0.5), "rad"),
        "autopilot: rudder angle": (np.full_like(T, 0.1), "rad"),
        "speed_keeping: speed reference": (np.full_like(T, 8.0), "m/s"),
        "speed_keeping: thrust": (np.full_like(T, 5e5), "N"),
        "positioning: thrust of aft forward": (np.full_like(T, 3e3), "N"),
        "positioning: thrust of aft to port": (np.full_like(T, 4e3), "N"),
    }
    axes = plot.controls(made(sailing()[0], **signals)).axes
    titles = ["heading", "speed ahead", "rudder angle, positive turns to port", "thrust"]
    assert [ax.get_title(loc="left") for ax in axes] == titles
    lines = {line.get_label(): line for ax in axes for line in ax.get_lines()}
    np.testing.assert_allclose(lines["rudder"].get_ydata(), np.degrees(0.1))
    np.testing.assert_allclose(lines["aft"].get_ydata()[0] / lines["thrust"].get_ydata()[0], 5e3 / 5e5)  # |(3, 4)| = 5
    assert lines["reference"].get_linestyle() == "--"


@pytest.mark.parametrize("draw", [plot.track, plot.controls])
def test_small_motions_have_no_track(draw):
    with pytest.raises(InputError, match="a run of large motions expected"):
        draw(made(sailing()[0], motions="small"))
