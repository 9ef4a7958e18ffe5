"""Wave excitation: interpolation in frequency and heading, symmetry, and what the data do not cover."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.base import Surroundings

MIRROR = np.array([1, -1, 1, -1, 1, -1])
BODY = og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))


def smooth_force(omega, direction):
    """Smooth, with the symmetry F(-b) = S F(b) of a mirror-symmetric hull; (n_w, n_b, 6)."""
    w, b = np.asarray(omega, dtype=float)[:, None], np.asarray(direction, dtype=float)[None, :]
    c, s = np.cos(b), np.sin(b)
    size = np.exp(-0.5 * w**2 + 1.5j * w**2 * c)
    return np.stack([1j * c * size, 2j * s * size, 3 * size, 1j * s * size, 2j * c * size, s * c * size], axis=-1)


def hydro(direction, omega=None, force=smooth_force, coupling=0.0, **more):
    omega = np.linspace(0.1, 2.5, 49) if omega is None else omega
    A = np.tile(np.eye(6), (len(omega), 1, 1))
    A[:, 0, 1] = coupling
    return og.hydro_from_arrays(
        omega=omega,
        added_mass=A,
        radiation_damping=0 * A,
        wave_direction=np.radians(direction),
        excitation_force=force(omega, np.radians(direction)),
        **more,
    )


ALL_AROUND = {
    "0..180": np.arange(0, 181, 15),
    "0..345": np.arange(0, 346, 15),
    "-165..180": np.arange(-165, 181, 15),
    "-180..0": np.arange(-180, 1, 15),
    "180..360": np.arange(180, 361, 15),
    "7.5..172.5": np.arange(7.5, 173, 15),
}


@pytest.mark.parametrize("name", ALL_AROUND)
def test_any_layout_of_headings_gives_the_force_all_around(name):
    load = og.WaveExcitation(hydro(ALL_AROUND[name]))
    b = np.linspace(-7.0, 7.0, 101)
    w = np.full(len(b), 0.83)
    exact = smooth_force([0.83], b)[0]
    assert np.abs(load.force(w, b) - exact).max() < 2e-3
    assert load.force(w, b + 2 * np.pi) == pytest.approx(load.force(w, b), abs=1e-9)
    assert load.force(w, -b) == pytest.approx(load.force(w, b) * MIRROR, abs=1e-9)


def test_tabulated_values_are_kept():
    data = hydro(np.arange(0, 181, 30))
    load = og.WaveExcitation(data)
    for i, b in enumerate(data.wave_direction.values):
        assert load.force(data.omega.values, b) == pytest.approx(data.excitation_force.values[:, i], abs=1e-12)


def test_interpolation_in_frequency_is_of_fourth_order():
    b = np.radians(150.0)
    w = np.linspace(0.5, 2.0, 333)
    errors = []
    for n in (13, 25, 49):
        load = og.WaveExcitation(hydro([150.0], omega=np.linspace(0.1, 2.5, n)))
        errors.append(np.abs(load.force(w, b) - smooth_force(w, [b])[:, 0]).max())
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4.0, abs=0.4)


def test_headings_of_a_sector():
    """Quartering to head seas on both sides, across 180 deg."""
    load = og.WaveExcitation(hydro(np.arange(90, 181, 15)))
    b = np.radians([-100.0, 100.0, 170.0, 190.0, 180.0])
    assert np.abs(load.force(np.full(5, 0.8), b) - smooth_force([0.8], b)[0]).max() < 2e-3
    with pytest.raises(og.InputError, match=r"headings relative to the bow.*45 deg found"):
        load.force([0.8], np.radians(45.0))


def test_wide_gaps_are_not_interpolated():
    load = og.WaveExcitation(hydro([50.0]))
    assert load.force([0.8], np.radians(-50.0)) == pytest.approx(load.force([0.8], np.radians(50.0)) * MIRROR)
    for bad in (0.0, 49.0, 180.0):
        with pytest.raises(og.InputError, match="at most 60 deg apart"):
            load.force([0.8], np.radians(bad))


def test_unsymmetric_hull_is_not_mirrored():
    for data in (hydro(np.arange(0, 181, 15), coupling=0.1), hydro(np.arange(0, 181, 15), force=one_sided)):
        load = og.WaveExcitation(data)
        load.force([0.8], 1.0)
        with pytest.raises(og.InputError, match="headings relative to the bow"):
            load.force([0.8], -1.0)


def one_sided(omega, direction):
    force = smooth_force(omega, direction)
    force[..., 1] += 0.5  # sway in head seas
    return force


def test_frequency_outside_is_refused():
    load = og.WaveExcitation(hydro([180.0]))
    with pytest.raises(og.InputError, match=r"frequencies within 0\.1\.\.2\.5 rad/s expected"):
        load.force([2.6], np.pi)


def wave(omega, amplitude):
    return og.Sea(omega=omega, direction=np.full(len(omega), np.pi), amplitude=amplitude, phase=np.zeros(len(omega)))


def test_lost_energy_is_refused_or_reported():
    transfer = og.WaveExcitation(hydro([180.0])).bind(Surroundings(BODY)).wave
    assert transfer(wave([0.5, 1.0], [1.0, 1.0]), 0.0).shape == (2, 6)
    with pytest.raises(og.InputError, match=r"50 % of its variance lies outside"):
        transfer(wave([0.5, 3.0], [1.0, 1.0]), 0.0)
    with pytest.warns(og.OgilvieWarning, match=r"0\.01 % of its variance lies outside"):
        force = transfer(wave([0.5, 3.0], [1.0, 0.01]), 0.0)
    assert not force[1].any()
    assert force[0].any()


def test_heading_turns_the_waves():
    transfer = og.WaveExcitation(hydro(np.arange(0, 181, 15))).bind(Surroundings(BODY)).wave
    sea = og.Sea(omega=[0.7], direction=[1.0], amplitude=[1.0], phase=[0.0])
    turned = og.Sea(omega=[0.7], direction=[1.4], amplitude=[1.0], phase=[0.0])
    assert transfer(turned, 0.4) == pytest.approx(transfer(sea, 0.0), abs=1e-12)


def test_mismatches_are_reported():
    load = og.WaveExcitation(hydro([180.0], water_depth=20.0))
    with pytest.warns(og.OgilvieWarning, match="water depth of 20 m, the sea for inf m"):
        load.bind(Surroundings(BODY)).wave(wave([0.5], [1.0]), 0.0)
    deep = og.WaveExcitation(hydro([180.0], water_depth=900.0)).bind(Surroundings(BODY))
    deep.wave(wave([0.5], [1.0]), 0.0)  # the waves do not feel either bottom
    with pytest.warns(og.OgilvieWarning, match="coefficients hold for 0 m/s, the vessel sails at 5 m/s"):
        load.bind(Surroundings(BODY, speed=5.0))


def test_few_degrees_of_freedom():
    w = np.linspace(0.2, 2.0, 9)
    Z = np.zeros((9, 1, 1))
    data = og.hydro_from_arrays(
        omega=w,
        added_mass=Z,
        radiation_damping=Z,
        dofs=("heave",),
        wave_direction=[np.pi],
        excitation_force=np.ones((9, 1, 1)),
    )
    assert og.WaveExcitation(data).force([0.5], np.pi)[0] == pytest.approx([0, 0, 1, 0, 0, 0])


def test_data_without_forces():
    w, Z = np.linspace(0.2, 2.0, 9), np.zeros((9, 6, 6))
    with pytest.raises(og.InputError, match="excitation_force expected"):
        og.WaveExcitation(og.hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z))
    with pytest.raises(og.InputError, match=r"xarray.Dataset"):
        og.WaveExcitation({"excitation_force": 1})


def in_parts(**more):
    data = hydro(np.arange(0, 181, 30), **more)
    return data.assign(Froude_Krylov_force=(0.6 + 0.3j) * data.excitation_force)


def test_parts_add_up_to_the_whole():
    data = in_parts()
    alone = data.assign(diffraction_force=data.excitation_force - data.Froude_Krylov_force).drop_vars("Froude_Krylov_force")
    w, b = np.linspace(0.2, 2.0, 30), np.linspace(-3.0, 3.0, 30)
    for source in (data, alone):
        parts = [og.WaveExcitation(source, part=part) for part in ("diffraction", "Froude-Krylov")]
        for speed in (0.0, 7.0):
            whole = og.WaveExcitation(source).force(w, b, speed)
            assert sum(part.force(w, b, speed) for part in parts) == pytest.approx(whole, abs=1e-12)
        assert parts[1].force(w, b, 7.0) == pytest.approx(parts[1].force(w, b, 0.0), abs=1e-12)  # no speed in it
        assert np.abs(parts[0].force(w, b, 7.0) - parts[0].force(w, b, 0.0)).max() > 0.1
    assert og.WaveExcitation(data, part="diffraction").force([0.5], [np.pi]) == pytest.approx(
        (0.4 - 0.3j) * og.WaveExcitation(data).force([0.5], [np.pi])
    )


def test_a_part_covers_its_own_effect():
    data = in_parts()
    names = {part: og.WaveExcitation(data, part=part).name for part in ("total", "diffraction", "Froude-Krylov")}
    assert names == {"total": "excitation", "diffraction": "diffraction", "Froude-Krylov": "froude_krylov"}
    both = (og.WaveExcitation(data, part="diffraction"), og.WaveExcitation(data, part="Froude-Krylov"))
    og.Vessel(BODY, loads=both)
    with pytest.raises(og.errors.DoubleCountingError, match="diffraction force"):
        og.Vessel(BODY, loads=(og.WaveExcitation(data), both[0]))
    with pytest.raises(og.InputError, match="Froude_Krylov_force or diffraction_force expected"):
        og.WaveExcitation(hydro([180.0]), part="diffraction")
    with pytest.raises(og.InputError, match="part: one of"):
        og.WaveExcitation(data, part="incident")


def test_measured_vessel_is_symmetric(shared_data):
    """The tanker's data go all around; both sides mirror each other within the accuracy of the panel code."""
    data = og.read_hydro(shared_data / "mss_wamit_tanker" / "tanker.1")
    load = og.WaveExcitation(data)
    b = np.radians(np.arange(5.0, 180.0, 10.0))
    w = np.full(len(b), 0.6)
    a, m = load.force(w, b), load.force(w, -b) * MIRROR
    assert np.abs(a - m).max(axis=0) / np.abs(a).max(axis=0) == pytest.approx(np.zeros(6), abs=5e-3)
