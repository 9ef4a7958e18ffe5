"""Hulls through stations: volumes against independent integration, closed ends, the lines' own features kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.inspect import check_mesh
from ogilvie.mesh.loft import from_offsets
from ogilvie.mesh.s175 import BEAM, DRAUGHT, LENGTH, s175, s175_offsets
from ogilvie.mesh.sections import lofted
from ogilvie.mesh.topology import edges
from ogilvie.mesh.wetted import area_of, wet


def section_area(points, draught):
    """Area of both sides below the water, by trapezoids between the points (keel first)."""
    p = np.array(points) - [0.0, draught]
    part = wet(p)
    return 0.0 if part is None else 2.0 * area_of(part)


def volume_of(stations, draught):
    """Volume and centroid by a monotone cubic through the areas of the stations as given."""
    x = np.array([s[0] for s in stations])
    A = np.array([section_area(p, draught) for _, p in stations])
    order = np.argsort(x)
    x, A = x[order], A[order]
    fine = np.linspace(x[0], x[-1], 4001)
    a = PchipInterpolator(x, A)(fine)
    return np.trapezoid(a, fine), np.trapezoid(a * fine, fine) / np.trapezoid(a, fine)


def mgf(path):
    """Stations of a .mgf file as (x forward, points keel first)."""
    lines = path.read_text().split("\n")
    first = next(i for i, line in enumerate(lines) if line.strip().isdigit() and i > 3)
    k, out = first + 1, []
    for _ in range(int(lines[first])):
        n = int(lines[k + 1])
        out.append((-float(lines[k]), [tuple(map(float, line.split())) for line in lines[k + 2 : k + 2 + n]][::-1]))
        k += 3 + n
    return out


def barge(rake=0.0, top=8.0):
    """Box of 100 x 20 m with straight rakes of 10 m, their upper ends `rake` above the baseline."""
    box = [(0.0, 0.0), (10.0, 0.0), (10.0, top)]
    end = [(0.0, rake), (10.0, rake), (10.0, top)]
    return [(-50.0, end), (-40.0, box), (0.0, box), (40.0, box), (50.0, end)]


def wigley(n=31, m=15, L=100.0, B=10.0, T=6.25):
    def half_breadth(x, z):
        return 0.5 * B * (1 - (2 * x / L) ** 2) * (1 - np.minimum(z, 0.0) ** 2 / T**2)

    z = np.r_[np.linspace(-T, 0.0, m), 0.4 * T]
    return [(x, np.stack([half_breadth(x, z), z], axis=1)) for x in np.linspace(-L / 2, L / 2, n)]


def raked_ship():
    """Vee sections, raked stem and rounded stern profile, both ends above the water."""
    out = []
    for x in np.linspace(-51.0, 54.0, 31):
        keel = 6.0 * (max(x - 38.0, 0.0) / 14.0) ** 2 + 6.0 * (max(-x - 36.0, 0.0) / 13.0) ** 3
        z = keel + (10.0 - keel) * np.linspace(0.0, 1.0, 41) ** 2
        b = 8.0 * (1.0 - (x / 60.0) ** 4)
        out.append((x, np.stack([b * np.sqrt(np.maximum(z - keel, 0.0) / 10.0), z], axis=1)))
    return out


# ---- closed forms


@pytest.mark.parametrize("panels", [100, 900])
def test_box_barge_is_exact(panels):
    mesh = from_offsets(barge(0.0), draught=5.0, panels=panels)
    assert mesh.volume == pytest.approx(100.0 * 20.0 * 5.0, rel=1e-9)
    assert hydrostatics(mesh).waterplane_area == pytest.approx(2000.0, rel=1e-9)
    assert check_mesh(mesh).findings == ()


@pytest.mark.parametrize(("rake", "volume", "length"), [(4.0, 9200.0, 100.0), (6.0, 8833.3333, 96.66667)])
def test_raked_barge_with_knuckles(rake, volume, length):
    mesh = from_offsets(barge(rake), draught=5.0, panels=900, knuckles=(-40.0, 40.0))
    assert mesh.volume == pytest.approx(volume, rel=1e-3)
    assert mesh.length == pytest.approx(length, rel=1e-6)
    assert mesh.center_of_buoyancy[0] == pytest.approx(0.0, abs=1e-6)
    assert check_mesh(mesh).ok


def test_chine_is_a_line_of_the_mesh():
    mesh = from_offsets(barge(0.0), draught=5.0, panels=500)
    edge = (mesh.vertices[:, 1] == 10.0) & (mesh.vertices[:, 2] == -5.0)
    x = np.sort(mesh.vertices[edge, 0])
    assert x[0] == -50.0
    assert x[-1] == 50.0
    assert np.diff(x).max() < 8.0


def test_wigley_hull_through_its_offsets():
    mesh = from_offsets(wigley(), panels=1500)
    h = hydrostatics(mesh)
    assert mesh.volume == pytest.approx(4.0 / 9.0 * 100 * 10 * 6.25, rel=1e-3)
    assert h.waterplane_area == pytest.approx(2.0 / 3.0 * 1000.0, rel=1e-3)
    assert h.center_of_buoyancy[2] == pytest.approx(-6.25 * 3.0 / 8.0, rel=2e-3)
    assert check_mesh(mesh).findings == ()


def test_more_stations_bring_the_wigley_hull_closer():
    exact = 4.0 / 9.0 * 100 * 10 * 6.25
    errors = [abs(from_offsets(wigley(n, n), panels=800).volume / exact - 1.0) for n in (9, 17, 33)]
    assert errors[0] > 2.5 * errors[1] > 2.5 * 2.5 * errors[2]


def test_volume_does_not_depend_on_the_number_of_panels():
    volumes = [from_offsets(wigley(), panels=n).volume for n in (200, 800, 2500)]
    np.testing.assert_allclose(volumes, volumes[-1], rtol=1e-6)


# ---- real ships


@pytest.mark.parametrize("panels", [300, 1000, 2500])
def test_s175_mesh_is_closed_and_clean_with_the_published_volume(panels):
    mesh = s175(panels=panels)
    assert check_mesh(mesh).findings == ()
    assert 0.8 * panels < 2 * mesh.n_faces <= panels
    assert mesh.volume == pytest.approx(0.572 * LENGTH * BEAM * DRAUGHT, rel=3e-3)  # Cb 0.572
    assert mesh.center_of_buoyancy[0] == pytest.approx(-2.547, abs=0.001 * LENGTH)
    assert mesh.beam == pytest.approx(BEAM, rel=1e-6)
    assert mesh.draught == pytest.approx(DRAUGHT, rel=1e-9)


def test_s175_table_by_trapezoids():
    x = np.array([s[0] for s in s175_offsets()])
    A = np.array([section_area(p, DRAUGHT) for _, p in s175_offsets()])
    assert -np.trapezoid(A, x) == pytest.approx(24015.0, rel=1e-4)
    assert np.trapezoid(A * x, x) / np.trapezoid(A, x) == pytest.approx(-2.547, abs=2e-3)


def test_s175_table_is_the_published_one(shared_data):
    published = mgf(shared_data / "mss_shipx_s175" / "shipx_geometry.mgf")
    for (x, p), (x0, p0) in zip(s175_offsets(), published, strict=True):
        assert x == pytest.approx(x0, abs=1e-4)
        np.testing.assert_allclose(p, p0, atol=1e-5)


@pytest.mark.parametrize("draught", [4.0, 6.0])
def test_supply_vessel_with_skeg_and_overhang(draught, shared_data):
    stations = mgf(shared_data / "mss_shipx_supply" / "shipx_geometry.mgf")
    mesh = from_offsets(stations, draught=draught, panels=1200, name="supply")
    volume, lcb = volume_of(stations, draught)
    assert mesh.volume == pytest.approx(volume, rel=3e-3)
    assert mesh.center_of_buoyancy[0] == pytest.approx(lcb, abs=0.08)
    assert check_mesh(mesh).ok
    if draught == 6.0:
        assert mesh.volume == pytest.approx(6207.0, rel=3e-3)
        assert mesh.center_of_buoyancy[0] == pytest.approx(-5.386, abs=0.08)


# ---- ends


def test_raked_stem_and_stern_end_where_the_profile_leaves_the_water():
    stations = raked_ship()
    mesh = from_offsets(stations, draught=6.0, panels=1200)
    assert mesh.volume == pytest.approx(volume_of(stations, 6.0)[0], rel=3e-3)
    assert mesh.bounds[1, 0] == pytest.approx(52.0, abs=0.2)
    assert mesh.bounds[0, 0] == pytest.approx(-49.0, abs=0.3)
    assert check_mesh(mesh).ok
    on_stem = (mesh.vertices[:, 1] == 0.0) & (mesh.vertices[:, 0] > 46.0)
    assert on_stem.sum() > 5  # lines end on the stem, they do not all run to its top


def skeg_ship():
    """Wall-sided hull whose after body is a thin skeg below a shallow counter; the post is at x = -40."""
    body = [(0.0, 0.0), (6.0, 0.0), (8.0, 2.0), (8.0, 7.0)]
    skeg = [(0.0, 0.0), (0.8, 0.0), (0.8, 3.0), (3.0, 4.0), (7.0, 5.0), (7.5, 7.0)]
    post = [(0.0, 0.0), (0.0, 3.5), (3.0, 4.2), (7.0, 5.0), (7.5, 7.0)]
    counter = [(0.0, 4.2), (3.0, 4.4), (6.0, 5.0), (7.0, 7.0)]
    stem = [(0.0, 0.0), (0.0, 7.0)]
    return [(-48.0, counter), (-40.0, post), (-30.0, skeg), (-15.0, body), (10.0, body), (20.0, body), (48.0, stem)]


def test_skeg_ends_in_a_post_and_the_counter_carries_on():
    mesh = from_offsets(skeg_ship(), draught=6.0, panels=1200)
    assert check_mesh(mesh).ok
    assert mesh.volume == pytest.approx(volume_of(skeg_ship(), 6.0)[0], rel=2e-2)  # seven stations
    v = mesh.vertices
    behind = v[v[:, 0] < -40.0 - 1e-6]
    assert behind[:, 2].min() > -2.6  # nothing of the skeg behind the post
    post = v[(np.abs(v[:, 0] + 40.0) < 1e-9) & (v[:, 2] < -2.5 - 1e-6)]
    assert len(post) > 2
    assert np.all(post[:, 1] == 0.0)


def bulb_ship():
    """Wedge bow that ends at x = 40 at the water, with a round bulb of 2.5 m below that goes on to x = 46."""
    out = []
    for x in (-40.0, -20.0, 0.0, 15.0, 28.0, 36.0):
        b = 8.0 * min(1.0, (40.0 - x) / 30.0)
        z = np.linspace(0.0, 8.0, 17)
        round_part = np.sqrt(np.maximum(2.5**2 - (z - 2.5) ** 2, 0.0))
        out.append((x, np.stack([np.maximum(b * np.minimum(1.0, z / 2.0) ** 0.4, round_part), z], axis=1)))
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 15)
    for x, r in ((40.0, 2.5), (43.0, 2.2), (45.0, 1.3)):
        out.append((x, np.stack([r * np.cos(angle).clip(1e-12), 2.5 + r * np.sin(angle)], axis=1)))
    return out


def test_bulb_ahead_of_the_stem():
    mesh = from_offsets(bulb_ship(), draught=6.0, panels=1500)
    assert check_mesh(mesh).ok
    at_water = mesh.vertices[mesh.vertices[:, 2] == 0.0]
    assert at_water[:, 0].max() == pytest.approx(40.0, abs=1e-6)
    assert 45.5 < mesh.bounds[1, 0] < 47.0  # round nose on the last section
    assert mesh.volume == pytest.approx(volume_of(bulb_ship(), 6.0)[0], rel=1e-2)


def test_round_nose_and_flat_plate():
    half = [(x, [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]) for x in (-20.0, 0.0, 20.0)]
    flat = from_offsets(half, draught=2.0, panels=600, bow="flat")
    nose = from_offsets(half, draught=2.0, panels=600, bow="round")
    assert flat.bounds[1, 0] == pytest.approx(20.0)
    assert nose.bounds[1, 0] == pytest.approx(24.0)
    assert nose.volume - flat.volume == pytest.approx(0.5 * np.pi * 4.0**2 * 2.0, rel=0.02)
    assert check_mesh(nose).ok


# ---- invariances


def test_order_of_points_and_stations_does_not_matter():
    stations = wigley(15, 9)
    shuffled = [(x, p[::-1]) for x, p in stations[::-1]]
    a, b = from_offsets(stations, panels=400), from_offsets(shuffled, panels=400)
    np.testing.assert_allclose(a.vertices, b.vertices, atol=1e-9)


def test_heights_above_baseline_or_above_the_water():
    stations = raked_ship()
    lowered = [(x, p - [0.0, 6.0]) for x, p in stations]
    a, b = from_offsets(stations, draught=6.0, panels=400), from_offsets(lowered, panels=400)
    np.testing.assert_allclose(a.vertices, b.vertices, atol=1e-9)


@settings(max_examples=4, deadline=None)
@given(st.floats(0.05, 20.0))
def test_offsets_scale(factor):
    stations = raked_ship()
    a = from_offsets(stations, draught=6.0, panels=300)
    b = from_offsets([(x * factor, p * factor) for x, p in stations], draught=6.0 * factor, panels=300)
    assert b.volume == pytest.approx(a.volume * factor**3, rel=1e-6)
    np.testing.assert_allclose(b.bounds, a.bounds * factor, rtol=1e-6, atol=1e-6 * factor)


def test_bow_and_stern_exchanged_give_the_mirror_image():
    stations = raked_ship()
    a = from_offsets(stations, draught=6.0, panels=600)
    b = from_offsets([(-x, p) for x, p in stations], draught=6.0, panels=600)
    assert b.volume == pytest.approx(a.volume, rel=1e-9)
    np.testing.assert_allclose(b.center_of_buoyancy, a.center_of_buoyancy * [-1, 1, 1], atol=1e-6)


def test_nothing_overshoots_the_stations():
    lines = lofted(raked_ship(), draught=6.0)
    curves = lines.main.sections(np.linspace(-51.0, 54.0, 500))
    assert curves[..., 0].min() >= 0.0
    assert curves[..., 0].max() <= max(p[:, 0].max() for _, p in raked_ship()) + 1e-9
    assert curves[..., 1].min() >= -6.0 - 1e-9


def test_parallel_midbody_stays_parallel():
    lines = lofted(barge(4.0), draught=5.0)
    middle = lines.main.sections(np.linspace(-40.0, 40.0, 50))
    np.testing.assert_allclose(middle, np.broadcast_to(middle[0], middle.shape), atol=1e-12)


def test_deeper_draughts_hold_more():
    volumes = [from_offsets(raked_ship(), draught=d, panels=400).volume for d in (3.0, 4.0, 5.0, 6.0, 7.0)]
    assert np.all(np.diff(volumes) > 0.0)


def test_deck_and_missing_centreline_point():
    open_top = [(x, [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0)]) for x in (-50.0, 0.0, 50.0)]
    decked = [(x, [(10.0, 0.0), (10.0, 8.0), (5.0, 8.2), (0.0, 8.3)]) for x in (-50.0, 0.0, 50.0)]
    a, b = from_offsets(open_top, draught=5.0, panels=300), from_offsets(decked, draught=5.0, panels=300)
    np.testing.assert_allclose(a.vertices, b.vertices, atol=1e-12)


# ---- above the water


def open_edge_heights(mesh):
    start, end, _ = edges(mesh.faces)
    pairs = set(zip(start.tolist(), end.tolist(), strict=True))
    z = mesh.vertices[:, 2]
    on_plane = mesh.vertices[:, 1] == 0.0
    return np.array([min(z[a], z[b]) for a, b in pairs if (b, a) not in pairs and not (on_plane[a] and on_plane[b])])


@pytest.mark.parametrize(
    ("stations", "options"),
    [
        (raked_ship(), {"draught": 6.0}),
        (barge(6.0), {"draught": 5.0, "knuckles": (-40.0, 40.0)}),
        (skeg_ship(), {"draught": 6.0}),
        (bulb_ship(), {"draught": 6.0}),
        (wigley(), {}),
    ],
    ids=["raked", "barge", "skeg", "bulb", "wigley"],
)
def test_freeboard_is_joined_to_the_wet_hull_up_to_the_tops_of_the_stations(stations, options):
    wet_hull = from_offsets(stations, panels=800, **options)
    whole = from_offsets(stations, panels=800, above_water=True, **options)
    assert whole.immersed().volume == pytest.approx(wet_hull.volume, rel=1e-9)
    tops = [np.array(p)[-1, 1] - options.get("draught", 0.0) for x, p in stations]
    assert whole.bounds[1, 2] == pytest.approx(max(tops), abs=1e-9)
    assert open_edge_heights(whole).min() > 0.2  # nothing is open near the water


# ---- refusals

GOOD = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]


@pytest.mark.parametrize(
    ("stations", "options", "message"),
    [
        ([(0.0, GOOD)], {}, "at least two"),
        ([(0.0, GOOD), (0.0, GOOD)], {}, "found twice"),
        ([(0.0, GOOD), (1.0, [(0.0, 0.0), (np.nan, 1.0)])], {}, "finite"),
        ([(0.0, GOOD), (1.0, [(0.0, 0.0, 1.0)])], {}, r"\(n, 2\)"),
        ([(0.0, GOOD), (1.0, [(0.0, 0.0), (-2.0, 1.0)])], {}, ">= 0"),
        ([(0.0, GOOD), (1.0, [(0.0, 0.0), (2.0, 1.0)])], {}, "up to the water"),
        ([(0.0, GOOD), (9.0, GOOD)], {"draught": -1.0}, "below the water"),
        ([(0.0, GOOD), (9.0, GOOD)], {"panels": 10}, "panels"),
        ([(0.0, GOOD), (9.0, GOOD)], {"bow": "sharp"}, "bow"),
        ([(0.0, GOOD), (9.0, GOOD)], {"knuckles": (3.0,)}, "x of stations"),
        (
            [(0.0, GOOD), (5.0, GOOD), (7.0, [(0.0, 0.0), (1.0, 0.5), (0.0, 1.0)]), (9.0, GOOD)],
            {},
            "one outline",
        ),
    ],
)
def test_nonsense_stations_are_refused(stations, options, message):
    with pytest.raises(InputError, match=message):
        from_offsets(stations, **{"draught": 2.0, **options})


def test_freeboard_needs_points_above_the_water():
    stations = [(x, [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0)]) for x in (0.0, 9.0)]
    assert from_offsets(stations, draught=2.0, panels=100).volume == pytest.approx(9.0 * 8.0 * 2.0)
    with pytest.raises(InputError, match="above_water"):
        from_offsets(stations, draught=2.0, panels=100, above_water=True)


def test_public_name():
    assert shapes.from_offsets is from_offsets
