"""What a case would come to grief on is told by its check: units, weight, stability, directions without data."""

import warnings

import numpy as np
import pytest

from ogilvie.app import build
from ogilvie.app.angles import in_radians, looks_like_radians
from ogilvie.app.case import parse_case
from ogilvie.app.foresight import foresee, foresee_data
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.mesh.files import write_mesh
from ogilvie.mesh.shapes import box

BARGE = """
[hull]
shape = "box"
length = 100.0
beam = 20.0
draught = 5.0
panels = 100
[body]
kg = 6.0
gyradii = [7.0, 29.0, 29.0]
[coefficients]
omega_min = 0.2
omega_max = 1.6
directions_deg = [90, 135, 180]
[sea]
hs = 2.0
tp = 9.0
[simulation]
duration = 600.0
"""


def look(*changes: tuple[str, str], folder: str = ".") -> list[str]:
    """The warnings of a changed barge."""
    text = BARGE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    case = parse_case(text, folder=folder)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", OgilvieWarning)
        foresee(case, build.make_hull(case))
    return [str(w.message) for w in caught]


def refused(*changes: tuple[str, str], **options: str) -> str:
    with pytest.raises(InputError) as error:
        look(*changes, **options)
    return str(error.value)


def test_a_sound_case_passes_without_a_word():
    assert look() == []


def test_mass_is_compared_with_what_the_hull_displaces():
    displaced = 1025.0 * 100 * 20 * 5
    assert "Tonnes? Multiply by 1000" in refused(("kg = 6.0", f"kg = 6.0\nmass = {displaced / 1000}"))
    assert "draught and unit" in refused(("kg = 6.0", f"kg = 6.0\nmass = {3 * displaced}"))
    (heavy,) = look(("kg = 6.0", f"kg = 6.0\nmass = {1.1 * displaced}"))
    assert "10.0% more than" in heavy
    assert look(("kg = 6.0", f"kg = 6.0\nmass = {1.01 * displaced}")) == []


def test_a_capsizing_vessel_is_refused_where_restoring_is_linear():
    # KM of a box = T/2 + B^2/(12 T) = 2.5 + 6.667 m
    assert "GM -0.833 m: the vessel capsizes" in refused(("kg = 6.0", "kg = 10.0"))
    assert "kg from the keel" in refused(("kg = 6.0", "zg = 5.0"))
    assert look(("kg = 6.0", "kg = 9.1")) == []
    assert look(("kg = 6.0", "kg = 10.0"), ("[simulation]", "[loads]\nmooring_stiffness = { roll = 1e9 }\n[simulation]")) == []


@pytest.mark.parametrize("radii", ["[7000, 29000, 29000]", "[0.35, 0.29, 0.29]"])
def test_radii_of_gyration_of_another_unit_are_refused(radii):
    assert "no vessel of this hull" in refused(("[7.0, 29.0, 29.0]", radii))


def test_a_mesh_in_millimetres_is_noticed_and_can_be_read(tmp_path):
    hull = box(100.0, 20.0, 5.0, panels=100)
    write_mesh(hull.scaled(1000.0), tmp_path / "mm.gdf")
    shape = BARGE[: BARGE.index("[body]")]
    assert "hull.unit = 0.001" in refused((shape, '\n[hull]\nfile = "mm.gdf"\n'), folder=tmp_path)
    assert look((shape, '\n[hull]\nfile = "mm.gdf"\nunit = 0.001\n'), folder=tmp_path) == []


def test_a_mesh_cut_at_its_waterline_is_not_sunk_below_it(tmp_path):
    write_mesh(box(100.0, 20.0, 5.0, panels=100), tmp_path / "cut.gdf")
    shape = BARGE[: BARGE.index("[body]")]
    message = refused((shape, '\n[hull]\nfile = "cut.gdf"\ndraught = 5.1\n'), folder=tmp_path)
    assert "at most 5 m" in message
    assert "needs no draught" in message


def test_panels_that_look_inwards_can_be_healed(tmp_path):
    write_mesh(box(100.0, 20.0, 5.0, panels=100).flipped(), tmp_path / "in.gdf")
    shape = BARGE[: BARGE.index("[body]")]
    assert "hull.heal = true" in refused((shape, '\n[hull]\nfile = "in.gdf"\n'), folder=tmp_path)
    case = parse_case(BARGE.replace(shape, '\n[hull]\nfile = "in.gdf"\nheal = true\n'), folder=tmp_path)
    with pytest.warns(OgilvieWarning, match="hull.heal"):
        assert build.make_hull(case).volume == pytest.approx(1e4)


def test_the_weight_acts_where_the_buoyancy_does():
    assert look(("kg = 6.0", "cog = [0.5, 0.0, 1.0]")) == []
    (off,) = look(("kg = 6.0", "cog = [4.0, 0.0, 1.0]"))
    assert "4 m from the centre of buoyancy" in off
    assert "Counted from another point" in refused(("kg = 6.0", "cog = [54.0, 0.0, 1.0]"))
    assert "y = -11" in refused(("kg = 6.0", "cog = [0.0, -11.0, 1.0]"))


def test_proportions_that_no_ship_has_are_doubted():
    (wide,) = look(("length = 100.0", "length = 15.0"), ("[7.0, 29.0, 29.0]", "[7.0, 5.0, 8.0]"))
    assert "x forward" in wide
    ship = ('shape = "box"', 'shape = "particulars"\ncb = 0.7')
    (deep,) = look(ship, ("draught = 5.0", "draught = 25.0"), ("kg = 6.0", "kg = 12.0"), ("panels = 100", "panels = 400"))
    assert deep.startswith("hull.draught: 25")


def test_an_origin_far_from_amidships_is_doubted(tmp_path):
    write_mesh(box(100.0, 20.0, 5.0, panels=100).translated((50.0, 0.0, 0.0)), tmp_path / "ap.gdf")
    (doubt,) = look((BARGE[: BARGE.index("[body]")], '\n[hull]\nfile = "ap.gdf"\n'), folder=tmp_path)
    assert "50 m from the origin" in doubt
    assert "hull.offset = [-50, 0, 0]" in doubt
    moved = '\n[hull]\nfile = "ap.gdf"\noffset = [-50, 0, 0]\n'
    assert look((BARGE[: BARGE.index("[body]")], moved), folder=tmp_path) == []


def test_water_shallower_than_the_draught_of_a_file_is_refused(tmp_path):
    write_mesh(box(100.0, 20.0, 5.0, panels=100), tmp_path / "box.gdf")
    shape = BARGE[: BARGE.index("[body]")]
    assert "draught of the hull, 5 m" in refused((shape, '\n[hull]\nfile = "box.gdf"\n[water]\ndepth = 4\n'), folder=tmp_path)


def test_a_sea_from_where_nothing_is_solved_is_refused():
    for direction in ("180", "135", "-100", "225", "-180"):
        assert look(("tp = 9.0", f"tp = 9.0\ndirection_deg = {direction}")) == []
    message = refused(("tp = 9.0", "tp = 9.0\ndirection_deg = 45"))
    assert "45 deg from its bow" in message
    assert "90..270 deg" in message
    assert "coefficients.directions_deg" in message
    assert look(("tp = 9.0", "tp = 9.0\ndirection_deg = 45"), ("[hull]", "[vessel]\nheading_deg = -90\n[hull]")) == []


def test_a_gap_of_directions_is_seen_too():
    assert "no two of them more than 60 deg apart" in refused(
        ("[90, 135, 180]", "[0, 180]"), ("tp = 9.0", "tp = 9.0\ndirection_deg = 90")
    )


def test_a_spread_sea_needs_directions_around_the_main_one():
    assert "spread" in refused(("tp = 9.0", "tp = 9.0\nspreading = 4.0"), ("[90, 135, 180]", "[150, 180]"))


def test_a_sea_of_too_few_components_is_refused_before_the_work():
    assert "Take at least" in refused(("duration = 600.0", "duration = 20.0"))


def test_a_result_larger_than_the_machine_is_refused_before_the_work():
    assert "GB" in refused(("duration = 600.0", "duration = 600.0\nrealisations = 99999\ndt = 0.001"))


def data(directions) -> object:
    w, shape = np.linspace(0.2, 1.6, 15), (15, 6, 6)
    A = np.broadcast_to(np.diag([1e6, 1e7, 1e7, 1e8, 1e9, 1e9]), shape)
    X = np.ones((15, len(directions), 6), dtype=complex)
    M = np.diag([1e7, 1e7, 1e7, 5e8, 8e9, 8e9])
    return hydro_from_arrays(
        omega=w,
        added_mass=A,
        radiation_damping=0.1 * A,
        wave_direction=np.radians(directions),
        excitation_force=X,
        inertia_matrix=M,
    )


FILE = """
[coefficients]
file = "data.nc"
[body]
mass = 1.0e7
zg = 0.0
gyradii = [7.0, 28.0, 28.0]
[sea]
hs = 2.0
tp = 9.0
direction_deg = 150
[simulation]
duration = 600.0
"""


def file_case(tmp_path, *changes):
    (tmp_path / "data.nc").touch()
    text = FILE
    for old, new in changes:
        text = text.replace(old, new)
    return parse_case(text, folder=tmp_path)


def test_the_directions_of_a_file_hold_that_of_the_sea(tmp_path):
    foresee_data(file_case(tmp_path), data([120.0, 150.0, 180.0]))
    with pytest.raises(InputError, match=r"sea.direction_deg: 150.*coefficients.file"):
        foresee_data(file_case(tmp_path), data([0.0, 30.0, 60.0]))


def test_mass_and_inertia_are_compared_with_those_of_a_file(tmp_path):
    hydro = data([150.0])
    with pytest.raises(InputError, match="Tonnes"):
        foresee_data(file_case(tmp_path, ("1.0e7", "1.0e4")), hydro)
    with pytest.raises(InputError, match="in roll about O"):
        foresee_data(file_case(tmp_path, ("[7.0, 28.0, 28.0]", "[0.35, 0.25, 0.25]")), hydro)


def test_another_height_of_the_centre_of_gravity_is_told(tmp_path):
    """The stiffness 5e8 N m changes by -m g dz, a fifth for a metre."""
    hydro = data([150.0]).assign(hydrostatic_stiffness=(("influenced_dof", "radiating_dof"), 5e8 * np.eye(6)))
    foresee_data(file_case(tmp_path), hydro)
    with pytest.warns(OgilvieWarning, match=r"z = 1 m.*change by -20%"):
        foresee_data(file_case(tmp_path, ("zg = 0.0", "zg = 1.0")), hydro)


@pytest.mark.parametrize("angle", np.radians([15.0, 30.0, 45.0, 90.0, -135.0, 180.0, 270.0]))
def test_angles_in_radians_are_recognised_to_two_decimals(angle):
    assert looks_like_radians(float(angle))
    assert looks_like_radians(round(float(angle), 4))


@pytest.mark.parametrize("angle", [0.0, 1.0, 3.0, 2.5, -0.5, 7.5, 45.0, 180.0, 157.3, 1.4, 0.1])
def test_plain_degrees_are_not_taken_for_radians(angle):
    assert not looks_like_radians(angle)


def test_radians_are_found_wherever_a_key_says_deg():
    text = BARGE.replace("[90, 135, 180]", "[1.5708, 135, 180]").replace("tp = 9.0", "tp = 9.0\ndirection_deg = 3.1416")
    text += "initial = { roll_deg = 0.5236 }\n[autopilot]\nmax_moment = 1e8\nschedule = [[0, 0], [100, 1.0472]]\n"
    said = list(in_radians(parse_case(text)))
    assert [line.split(":")[0] for line in said] == [
        "coefficients.directions_deg[0]",
        "sea.direction_deg",
        "autopilot.schedule[1][1]",
        "simulation.initial.roll_deg",
    ]
    assert "180 deg in radians" in said[1]


def test_poses_and_speeds_that_nobody_means_are_doubted():
    (roll,) = look(("duration = 600.0", "duration = 600.0\ninitial = { roll_deg = 80 }"))
    assert "small motions are linear" in roll
    (heave,) = look(("duration = 600.0", "duration = 600.0\ninitial = { heave = 8 }"))
    assert "draught, 5 m" in heave
    (fast,) = look(("[hull]", "[vessel]\nspeed_knots = 60\n[hull]"))
    assert "Froude number 0.99" in fast


def test_density_and_gravity_have_their_units():
    for line in ("rho = 1.025", "g = 32.2"):
        with pytest.raises(InputError, match="water"):
            parse_case(BARGE + f"[water]\n{line}\n")
