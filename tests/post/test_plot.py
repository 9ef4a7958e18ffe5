"""Figures show the numbers that they are given, with units on every axis."""

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.errors import InputError
from ogilvie.post import plot
from ogilvie.post.plot._overview import _in_the_world
from ogilvie.post.plot._scene import Camera, hull_surface, moved, waterline
from ogilvie.post.plot._style import matrix_unit, power

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


@pytest.fixture(scope="module")
def hydro():
    w = np.linspace(0.05, 4.0, 60)
    K_hat = 1j * w / ((1j * w + 0.4) ** 2 + 1)
    size = np.diag((1.0, 1.0, 2.0, 3.0, 3.0, 1.0)) * 1e5
    size[0, 4] = size[4, 0] = 0.5e5
    X = np.exp(-w[:, None, None]) * np.ones((60, 2, 6)) * 1e5 * np.exp(1j * w)[:, None, None]
    return og.hydro_from_arrays(
        omega=w,
        added_mass=(2 + K_hat.imag / w)[:, None, None] * size,
        radiation_damping=K_hat.real[:, None, None] * size,
        added_mass_inf=2 * size,
        added_mass_zero=2.2 * size,
        wave_direction=[np.pi / 2, np.pi],
        excitation_force=X,
        hydrostatic_stiffness=np.diag([0, 0, 1e6, 1e6, 1e6, 0]),
    )


@pytest.fixture(scope="module")
def memory(hydro):
    K = og.retardation(hydro, duration=20.0, dt=0.1)
    return K, og.identify(K, method="realization", order=4)


@pytest.fixture(scope="module")
def response(hydro):
    body = og.RigidBody(3e5, [0.0, 0.0, 0.0], np.diag([3e5, 4e5, 5e5]))
    return og.rao(hydro, body, stiffness=np.diag([1e4, 1e4, 0, 0, 0, 1e4]), damping=np.diag([1e5] * 6))


@pytest.fixture(scope="module")
def sea():
    return og.irregular(og.jonswap(hs=2.0, tp=8.0), direction=np.pi, seed=range(2), n=50)


@pytest.fixture(scope="module")
def run(sea):
    t = np.arange(0.0, 400.0, 0.5)
    eta = np.stack([np.sin(0.6 * t + k) * 0.1 * (k + 1) for k in range(6)], axis=-1)
    data = {"eta": (("realisation", "time", "dof"), np.stack([eta, 0.5 * eta]))}
    data["elevation"] = (("realisation", "time"), sea.elevation(t))
    return xr.Dataset(data, {"time": t, "dof": list(DOFS)})


@pytest.fixture(scope="module")
def hull():
    return og.shapes.box(40.0, 12.0, 4.0, panels=80)


def drifting(hydro):
    """The data set with a mean drift over frequency, alike from all directions."""
    shape = (hydro.sizes["omega"], hydro.sizes["wave_direction"], hydro.sizes["influenced_dof"])
    drift = -1e4 * np.broadcast_to(hydro.omega.values[:, None, None] ** 2, shape)
    return hydro.assign(mean_drift=(("omega", "wave_direction", "influenced_dof"), drift))


@pytest.fixture(scope="module")
def every(hydro, memory, response, sea, run, hull):
    """All figures by name."""
    spectrum = og.jonswap(hs=2.0, tp=8.0)
    return {
        "coefficients": plot.coefficients(hydro, ssm=memory[1]),
        "entry": plot.coefficients(hydro, entries=[("surge", "pitch")]),
        "retardation": plot.retardation(*memory),
        "excitation": plot.excitation(hydro),
        "drift": plot.drift(drifting(hydro)),
        "rao": plot.rao(response),
        "spectrum": plot.spectrum(spectrum, sea=sea),
        "motions": plot.motions(run),
        "response_spectra": plot.response_spectra(run),
        "hull": plot.hull(hull),
        "overview": plot.overview(hull, run, sea=sea, spectrum=spectrum, response=response),
    }


def panels(fig):
    """Axes that show data in a frame."""
    return [ax for ax in fig.axes if ax.axison and ax.has_data()]


def test_every_panel_has_units_on_both_axes(every):
    for name, fig in every.items():
        fig.draw_without_rendering()
        for ax in panels(fig):
            texts = [ax.get_ylabel(), ax.get_title(loc="left")]
            assert any("[" in t and "]" in t for t in texts), (name, texts)
        columns: dict[float, list] = {}
        for ax in panels(fig):
            columns.setdefault(round(ax.get_position().x0, 2), []).append((round(ax.get_position().y0, 2), ax.get_xlabel()))
        for found in columns.values():  # the lowest of each column; a twin has its label once
            assert any("[" in label for y, label in found if y == min(found)[0]), name


def test_every_figure_becomes_a_png(every):
    for fig in every.values():
        png = plot.to_png(fig, dpi=50)
        assert png.startswith(b"\x89PNG")
        assert len(png) > 3000


def test_no_figure_belongs_to_a_window(every):
    assert all(fig.number if hasattr(fig, "number") else True for fig in every.values())
    assert all(getattr(fig.canvas, "manager", None) is None for fig in every.values())


def curve(ax, label=None):
    """Data of the first line, or of that with a label."""
    lines = [line for line in ax.get_lines() if label is None or line.get_label() == label]
    return lines[0].get_xdata(), lines[0].get_ydata()


def test_coefficients_are_those_of_the_data(every, hydro):
    ax = next(a for a in every["coefficients"].axes if a.get_title(loc="left").startswith("A33"))
    w, A = curve(ax)
    np.testing.assert_array_equal(w, hydro.omega)
    factor = 10.0 ** (3 * round(np.log10(hydro.added_mass.values[0, 2, 2] / A[0]) / 3))
    np.testing.assert_allclose(A * factor, hydro.added_mass.values[:, 2, 2])


def test_the_model_lies_on_the_data_that_it_was_made_from(every):
    for ax in every["coefficients"].axes:
        w, data = curve(ax)
        _, fit = (line := ax.get_lines()[1]).get_data()
        np.testing.assert_allclose(np.interp(w[3:], line.get_xdata(), fit), data[3:], atol=0.03 * np.abs(data).max())


def test_couplings_are_chosen_by_name(every, hydro):
    fig = every["entry"]
    assert [ax.get_title(loc="left").split()[0] for ax in fig.axes] == ["A15", "B15"]
    with pytest.raises(InputError, match="pairs of surge, sway"):
        plot.coefficients(hydro, entries=[("surge", "surf")])


def test_retardation_shows_couplings_that_are_not_zero(every):
    titles = [ax.get_title(loc="left").split()[0] for ax in every["retardation"].axes]
    assert titles == ["K11", "K22", "K33", "K44", "K55", "K66", "K15"]


def test_rotations_are_in_degrees(every, run):
    fig = every["motions"]
    roll = next(ax for ax in fig.axes if ax.get_ylabel().startswith("roll"))
    assert roll.get_ylabel() == "roll [deg]"
    top = max(np.abs(line.get_ydata()).max() for line in roll.get_lines())
    assert top == pytest.approx(np.degrees(np.abs(run.eta.values[..., 3]).max()))
    heave = next(ax for ax in fig.axes if ax.get_ylabel().startswith("heave"))
    assert max(np.abs(line.get_ydata()).max() for line in heave.get_lines()) == pytest.approx(0.3, rel=1e-3)


def test_rao_of_a_rotation_is_in_degrees_per_metre(every, response):
    upper = next(ax for ax in every["rao"].axes if ax.get_title(loc="left") == "pitch")
    assert upper.get_ylabel() == "[deg/m]"
    _, size = curve(upper)
    np.testing.assert_allclose(size, np.degrees(np.abs(response.sel(dof="pitch").values[:, 0])))


def test_the_area_of_the_response_spectrum_is_the_variance(every, run):
    ax = next(a for a in every["response_spectra"].axes if a.get_title(loc="left") == "heave")
    w, S = curve(ax)
    assert np.trapezoid(S, w) == pytest.approx(float(run.eta.sel(dof="heave").var("time").mean()), rel=0.02)


def test_the_components_of_a_sea_hold_its_energy(every, sea):
    ax = every["spectrum"].axes[0]
    stairs = next(p for p in ax.patches if type(p).__name__ == "StepPatch")
    values, edges, _ = stairs.get_data()
    assert np.sum(values * np.diff(edges)) == pytest.approx(0.5 * np.sum(sea.amplitude[0] ** 2))


def test_a_regular_sea_is_drawn_as_a_line():
    fig = plot.spectrum(None, sea=og.regular(amplitude=1.5, period=9.0, direction=np.pi))
    assert "amplitude [m]" in fig.axes[0].get_ylabel()
    with pytest.raises(InputError, match="a spectrum, a sea or both"):
        plot.spectrum(None)


def test_a_window_of_a_run(run):
    fig = plot.motions(run, dofs=["heave"], window=(100.0, 150.0))
    assert fig.axes[-1].get_xlim() == (100.0, 150.0)
    with pytest.raises(InputError, match="a window"):
        plot.motions(run, window=(1000.0, 2000.0))
    with pytest.raises(InputError, match="names among surge, sway"):
        plot.motions(run, dofs=["heeve"])


def test_drift_is_drawn_in_round_units_where_it_is_known(hydro):
    data = drifting(hydro)
    fig = plot.drift(data)
    assert [ax.get_title(loc="left") for ax in fig.axes] == [d for d in ("surge", "sway", "yaw") if d in data.influenced_dof]
    line = fig.axes[0].lines[0]
    np.testing.assert_allclose(line.get_ydata() * 1e3, data.mean_drift.values[:, 0, 0], rtol=1e-12)
    assert "10\u00b3 N/m\u00b2" in fig.axes[0].get_ylabel()
    with pytest.raises(InputError, match="mean_drift expected, none found"):
        plot.drift(hydro)
    unknown = data.assign(mean_drift=data.mean_drift.where(data.influenced_dof != "surge"))
    with pytest.raises(InputError, match="surge found"):
        plot.drift(unknown, dofs=["surge"])
    vertical = data.assign(mean_drift=data.mean_drift.where(data.influenced_dof == "heave"))
    assert [ax.get_title(loc="left") for ax in plot.drift(vertical).axes] == ["heave"]
    with pytest.raises(InputError, match="a component known"):
        plot.drift(data.assign(mean_drift=np.nan * data.mean_drift))


def test_excitation_needs_forces(hydro):
    with pytest.raises(InputError, match="excitation_force expected, none found"):
        plot.excitation(hydro.drop_vars("excitation_force"))


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_save_writes_the_file_whole(tmp_path, run, ending):
    plot.motions(run, dofs=["heave"], save=tmp_path / f"a.{ending}")
    assert [p.name for p in tmp_path.iterdir()] == [f"a.{ending}"]


def test_save_refuses_other_endings(tmp_path, run):
    with pytest.raises(InputError, match=r"\.png, \.svg or \.pdf expected, 'a.gif' found"):
        plot.motions(run, dofs=["heave"], save=tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


def test_the_common_style_does_not_leak():
    import matplotlib as mpl

    before = mpl.rcParams["font.size"]
    plot.custom(lambda data, fig: fig.add_subplot().plot(data), [1.0, 2.0])
    assert mpl.rcParams["font.size"] == before


@pytest.mark.parametrize(
    ("largest", "factor"), [(0.0, 1.0), (12.0, 1.0), (9999.0, 1.0), (2.5e7, 1e6), (3e-4, 1e-6), (1e12, 1e12)]
)
def test_axis_factors_are_powers_of_a_thousand(largest, factor):
    assert power([largest, -0.1 * largest])[0] == factor


def test_units_of_matrix_entries():
    assert [matrix_unit(*pair, "B") for pair in (("heave", "heave"), ("heave", "pitch"), ("roll", "roll"))] == [
        "kg/s",
        "kg m/s",
        "kg m\u00b2/s",
    ]


def test_the_camera_keeps_right_hands():
    """From ahead port is to the right, from starboard the bow is; up is up."""
    ahead, starboard = Camera(0.0, 0.0), Camera(-np.pi / 2, 0.0)
    np.testing.assert_allclose(ahead.project([0.0, 1.0, 0.0])[0], [1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(starboard.project([1.0, 0.0, 0.0])[0], [1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(Camera(0.7, 0.4).project([0.0, 0.0, 1.0])[0], [0.0, np.cos(0.4)], atol=1e-12)
    assert ahead.project([1.0, 0.0, 0.0])[1] < ahead.project([-1.0, 0.0, 0.0])[1]


def test_positive_pitch_is_bow_down_and_roll_is_starboard_down():
    assert moved([10.0, 0.0, 0.0], [0, 0, 0, 0, 0.1, 0])[2] < 0
    assert moved([0.0, -5.0, 0.0], [0, 0, 0, 0.1, 0, 0])[2] < 0


def test_the_picture_follows_speed_and_heading(run):
    moving = run.assign_attrs(speed=5.0, heading=np.pi / 2)
    pose = _in_the_world(np.array([1.0, 2.0, 0.3, 0.1, 0.2, 0.05]), moving, 10.0)
    np.testing.assert_allclose(pose, [-2.0, 51.0, 0.3, 0.1, 0.2, 0.05 + np.pi / 2], atol=1e-12)


def test_waterline_of_a_box(hull):
    full = hull.full()
    E = waterline(full.vertices[full.faces])
    assert np.linalg.norm(E[:, 1] - E[:, 0], axis=1).sum() == pytest.approx(2 * (40.0 + 12.0))


def test_the_picture_of_a_hull_has_its_panels(hull):
    plain, with_sides = hull_surface(hull), hull_surface(hull, freeboard=2.0)
    assert len(plain.polygons) == hull.full().n_faces
    assert with_sides.polygons[..., 2].max() == pytest.approx(2.0)
