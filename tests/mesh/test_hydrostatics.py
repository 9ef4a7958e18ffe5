"""Hydrostatics against formulas, derivatives, WAMIT and HAMS; equilibrium against wall-sided formulas."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from ogilvie.body import RigidBody
from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import about_origin
from ogilvie.mesh.equilibrium import equilibrium
from ogilvie.mesh.files import load_mesh
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.panels import PanelMesh

RHO, G = 1025.0, 9.81


def _weight(mass, *cog):
    return SimpleNamespace(mass=mass, cog=np.array(cog, dtype=float))


def _prism(points, draught):
    """Vertical prism on a convex polygon (n, 2), anticlockwise; open at z = 0."""
    n = len(points)
    v = np.concatenate(
        [np.c_[points, np.full(n, -draught)], np.c_[points, np.zeros(n)], [[*np.mean(points, axis=0), -draught]]]
    )
    i, j = np.arange(n), (np.arange(n) + 1) % n
    return PanelMesh(
        v, np.concatenate([np.stack([i, j, j + n, i + n], 1), np.stack([j, i, 0 * i + 2 * n, 0 * i + 2 * n], 1)]), name="prism"
    )


# ---- formulas


@pytest.mark.parametrize("symmetry", ["none", "xz", "xz+yz"])
def test_box(box, symmetry):
    L, B, T, KG = 8.0, 4.0, 2.0, 1.7
    s = hydrostatics(box(L, B, -T, 0.0, symmetry=symmetry, deck=False), cog=(0.0, 0.0, KG - T), rho=RHO, g=G)
    assert s.volume == pytest.approx(L * B * T)
    assert s.displacement == s.mass == pytest.approx(RHO * L * B * T)
    assert (s.length, s.beam, s.draught) == (L, B, T)
    assert s.waterplane_area == pytest.approx(L * B)
    assert s.center_of_flotation == pytest.approx([0.0, 0.0], abs=1e-14)
    assert pytest.approx(T / 2) == s.KB
    assert pytest.approx(B**2 / (12 * T)) == s.BM_T
    assert pytest.approx(L**2 / (12 * T)) == s.BM_L
    assert pytest.approx(T / 2 + B**2 / (12 * T) - KG) == s.GM_T
    assert pytest.approx(T / 2 + L**2 / (12 * T) - KG) == s.GM_L
    expected = RHO * G * np.diag([0, 0, L * B, L * B * T * s.GM_T, L * B * T * s.GM_L, 0])
    assert s.stiffness == pytest.approx(expected, abs=1e-9 * expected.max())


@pytest.mark.parametrize("n", [3, 4, 5, 6, 12, 37])
def test_regular_prism(n):
    R, T = 3.0, 1.2
    angle = 2 * np.pi * (np.arange(n) + 0.3) / n
    area = n / 2 * R**2 * np.sin(2 * np.pi / n)
    inertia = n / 24 * R**4 * np.sin(2 * np.pi / n) * (2 + np.cos(2 * np.pi / n))
    s = hydrostatics(_prism(R * np.c_[np.cos(angle), np.sin(angle)], T), cog=(0, 0, 0))
    assert s.volumes == pytest.approx([area * T] * 3, rel=1e-12)
    assert s.waterplane_area == pytest.approx(area, rel=1e-12)
    assert s.waterplane_inertia == pytest.approx(inertia * np.eye(2), abs=1e-11 * inertia)
    assert s.wetted_area == pytest.approx(area + 2 * n * R * np.sin(np.pi / n) * T, rel=1e-12)
    assert pytest.approx(T / 2) == s.KB


def test_triangular_waterplane_about_its_centroid():
    triangle = np.array([[0.0, 0], [6, 0], [0, 3]])
    s = hydrostatics(_prism(triangle, 1.0))
    assert s.center_of_flotation == pytest.approx([2.0, 1.0])
    assert s.inertia_about_flotation == pytest.approx(
        np.array([[6**3 * 3, -(6**2) * 3**2 / 2], [-(6**2) * 3**2 / 2, 6 * 3**3]]) / 36
    )
    assert s.waterplane_inertia[0, 1] == pytest.approx(6**2 * 3**2 / 24)
    assert pytest.approx(6 * 3**3 / 36 / 9) == s.BM_T


def test_hemisphere_converges_to_its_formulas(sphere):
    """C44 of a hemisphere about its centre is zero: pressure has no moment."""
    errors = []
    for n in (8, 16, 32):
        s = hydrostatics(sphere(n).immersed(), cog=(0, 0, 0), rho=1.0, g=1.0)
        errors.append(
            [abs(s.KB + s.center_of_buoyancy[2] - 0 - (1 - 2 * 3 / 8)), abs(s.waterplane_area - np.pi), abs(s.stiffness[3, 3])]
        )
    errors = np.array(errors)[:, 1:]
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(2.0, abs=0.25)
    assert s.center_of_buoyancy[2] == pytest.approx(-3 / 8, abs=2e-3)


def test_submerged_body_has_no_waterplane(sphere):
    s = hydrostatics(sphere(8, center=(0, 0, -5)), cog=(0, 0, -5.5), rho=1.0, g=1.0)
    assert (s.waterplane_area, s.length, s.beam, s.BM_T) == (0.0, 0.0, 0.0, 0.0)
    assert np.isnan(s.center_of_flotation).all()
    assert s.stiffness[2, 2] == 0.0
    assert s.stiffness[3, 3] == pytest.approx(0.5 * s.volume)  # weight below buoyancy
    assert pytest.approx(0.5) == s.GM_T
    assert "nan" in str(s)


# ---- identities


def _load(mesh, body):
    """Force and moment of water and weight about O, by the pressure on the wetted part."""
    wet = mesh.immersed()
    V, b = wet.volume, wet.center_of_buoyancy
    F = RHO * G * V - body.mass * G
    M = np.cross(b, [0, 0, RHO * G * V]) + np.cross(body.cog, [0, 0, -body.mass * G])
    return np.array([0, 0, F, *M])


@given(st.integers(0, 10**6))
@settings(max_examples=10, deadline=None)
def test_stiffness_is_the_derivative_of_the_force(blob, seed):
    hull = blob(seed)
    rng = np.random.default_rng(seed)
    body = _weight(RHO * 50.0, *rng.uniform(-0.5, 0.5, 3))
    C = hydrostatics(hull.immersed(), body=body, rho=RHO, g=G).stiffness
    h = 1e-5
    moves = {
        2: lambda m, d: m.translated((0, 0, d)),
        3: lambda m, d: m.rotated(phi=d),
        4: lambda m, d: m.rotated(theta=d),
        5: lambda m, d: m.rotated(psi=d),
    }
    for dof, move in moves.items():
        loads = []
        for d in (h, -h):
            point = PanelMesh([body.cog, [0, 0, 0], [1, 0, 0]], [[0, 1, 2, 2]])
            loads.append(_load(move(hull, d), _weight(body.mass, *move(point, d).vertices[0])))
        numeric = -(loads[0] - loads[1]) / (2 * h)
        assert numeric[2:] == pytest.approx(C[2:, dof], abs=2e-5 * np.abs(C).max())
    assert np.abs(C[:2]).max() == np.abs(C[:, :2]).max() == 0.0


def test_stiffness_about_another_point(blob):
    hull = blob(2).immersed()
    b = hull.center_of_buoyancy
    offset = np.array([1.5, -0.7, 0.0])
    here = hydrostatics(hull, cog=(b[0], b[1], 0.3))
    there = hydrostatics(hull.translated(offset), cog=(b[0] + 1.5, b[1] - 0.7, 0.3))
    assert there.stiffness == pytest.approx(about_origin(here.stiffness, offset), abs=1e-9 * np.abs(there.stiffness).max())


def test_froude_scaling(blob):
    hull = blob(4).immersed()
    a, b = hydrostatics(hull, cog=(0.1, 0, 0.2)), hydrostatics(hull.scaled(3.0), cog=(0.3, 0, 0.6))
    factor = 3.0 ** np.array([2, 2, 2, 3, 3, 3])
    scale = factor[:, None] * 3.0 ** np.array([0, 0, 0, 1, 1, 1])
    assert b.stiffness == pytest.approx(a.stiffness * scale, rel=1e-9, abs=1e-6)
    assert pytest.approx(3 * a.GM_T) == b.GM_T


def test_weight_given_as_body_or_as_point(box):
    hull = box(high=0.0, deck=False)
    body = RigidBody.from_hull(hull, kg=1.0, gyradii=(1.3, 2.0, 2.0))
    assert hydrostatics(hull, body=body).stiffness == pytest.approx(hydrostatics(hull, cog=(0, 0, -1)).stiffness, abs=1e-6)
    moored = hydrostatics(hull, body=_weight(0.9 * body.mass, 0, 0, 0.5))
    free = hydrostatics(hull, cog=(0, 0, 0.5))
    assert moored.stiffness[3, 3] - free.stiffness[3, 3] == pytest.approx(0.1 * body.mass * moored.g * 0.5)


def test_without_weight(box):
    s = hydrostatics(box(high=0.0, deck=False), rho=RHO, g=G)
    assert s.stiffness[3, 3] == pytest.approx(RHO * G * (8 * 4**3 / 12 - 64.0))
    assert "GM" not in str(s)
    with pytest.raises(InputError, match="cog="):
        _ = s.GM_T


def test_table(box):
    text = str(hydrostatics(box(high=0.0, deck=False), cog=(0, 0, 0)))
    assert "hydrostatics of box" in text
    assert "65.6 t" in text
    assert all(word in text for word in ("waterplane area", "GM transverse", "m3", "KB"))


@pytest.mark.parametrize(
    "call",
    [
        lambda m: hydrostatics(m.flipped()),
        lambda m: hydrostatics(m.translated((0, 0, 1))),
        lambda m: hydrostatics(m, rho=-1.0),
        lambda m: hydrostatics(m, g=float("nan")),
        lambda m: hydrostatics(m, cog=(0.0, 1.0)),
        lambda m: hydrostatics(m, cog=(0, 0, 0), body=_weight(1.0, 0, 0, 0)),
    ],
)
def test_bad_input(box, call):
    with pytest.raises(InputError, match="expected"):
        call(box(high=0.0, deck=False))


# ---- ships and other codes


def test_ships_against_published_values(shared_data):
    """Paper C (Vu): DTMB 5415, S 2979 m2, LCB -0.55 %, GM_T 1.95 m; SSPA: KVLCC2, KG 18.6 m, GM_T 5.73 m, LCB 171.27 m."""
    dtmb = hydrostatics(load_mesh(shared_data / "dtmb5415_hull/dtmb5415_maorg.gdf"), cog=(-0.76, 0, 7.55 - 6.15))
    assert pytest.approx(1.95, abs=4e-3) == dtmb.GM_T
    assert dtmb.wetted_area == pytest.approx(2979.8, rel=1e-3)
    assert dtmb.center_of_buoyancy[0] / 142.0 == pytest.approx(-0.0054, abs=1e-4)
    assert 290.0 < dtmb.GM_L < 310.0
    tanker = hydrostatics(load_mesh(shared_data / "kvlcc2_hull/kvlcc2_fine.gdf"), cog=(11.15, 0, 18.6 - 20.8))
    assert pytest.approx(5.685, abs=1e-2) == tanker.GM_T
    assert tanker.wetted_area == pytest.approx(27610, rel=1e-3)
    assert tanker.waterplane_area == pytest.approx(16690, rel=1e-3)
    assert 160.0 + tanker.center_of_buoyancy[0] == pytest.approx(171.15, abs=0.01)


# mesh, .hst, mass (kg; None: rho V), cog, tolerance of the one-point rule, of the exact integrals (parts of the largest term)
HST = [
    ("mss_wamit_tanker/tanker.gdf", "mss_wamit_tanker/tanker.hst", 94620210.0, (3.93, 0, 2.5), 5e-5, 4e-3),
    ("mss_wamit_fpso/fpso_low.gdf", "mss_wamit_fpso/fpso.hst", None, (0.788631, 0, -1.0), 3e-3, 1e-3),
    ("mss_wamit_semisub/semisub_low.gdf", "mss_wamit_semisub/semisub.hst", 51979800.0, (0, 0, -0.5), 8e-3, 8e-3),
    ("wecsim_cylinder/cyl.gdf", "wecsim_cylinder/cyl.hst", None, (0, 0, 0), 1e-6, 1e-3),
    ("wecsim_ellipsoid/ellipsoid.gdf", "wecsim_ellipsoid/ellipsoid.hst", None, (0, 0, 0), 2e-6, 1e-3),
    ("wecsim_sphere_drift/sphere.GDF", "wecsim_sphere_drift/sphere.hst", None, (0, 0, 0), 1e-6, 3e-3),
    ("hams_certtest/Cylinder/Input/HullMesh.pnl", "hams_certtest/Cylinder/Output_Benchmark/Wamit_format/Buoy.hst",
     1604.0, (0, 0, -601.23 / 1604.0), 6e-5, 1.2e-2),
    ("hams_certtest/Moonpool/Input/HullMesh.pnl", "hams_certtest/Moonpool/Output_Benchmark/Wamit_format/Buoy.hst",
     None, (0, 0, 0), 2e-3, 4e-3),
]  # fmt: skip


def _read_hst(path):
    C = np.zeros((6, 6))
    for line in path.read_text().splitlines():
        words = line.split()
        if words[0].isdigit() and words[1].isdigit():
            C[int(words[0]) - 1, int(words[1]) - 1] = float(words[2])
    return C


def _one_point(mesh, mass, cog):
    """Stiffness / (rho g) as WAMIT and HAMS integrate it: value at the centroid times area."""
    hull = mesh.full()
    x, y, z = hull.centers.T
    n = -hull.area_vectors.T
    Vb = [-(c * c * s).sum() / 2 for c, s in zip((x, y, z), n, strict=True)]
    C = np.zeros((6, 6))
    C[2, 2], C[2, 3], C[2, 4] = n[2].sum(), (y * n[2]).sum(), -(x * n[2]).sum()
    C[3, 3] = (y * y * n[2]).sum() + Vb[2] - mass * cog[2]
    C[4, 4] = (x * x * n[2]).sum() + Vb[2] - mass * cog[2]
    C[3, 4] = -(x * y * n[2]).sum()
    return C


@pytest.mark.parametrize(
    ("file", "hst", "mass", "cog", "one_point", "exact"), HST, ids=[row[0].split("/")[0] + row[0][-12:-4] for row in HST]
)
def test_stiffness_of_other_codes(shared_data, file, hst, mass, cog, one_point, exact):
    mesh = load_mesh(shared_data / file)
    given_C = _read_hst(shared_data / hst)
    body = _weight(mass or RHO * mesh.volume, *cog)
    s = hydrostatics(mesh, body=body, rho=RHO, g=G)
    C, simple = s.stiffness / (RHO * G), _one_point(mesh, body.mass / RHO, cog)
    S_L, S_T = s.waterplane_inertia.diagonal()
    depth = s.volume * abs(s.center_of_buoyancy[2])
    length, area = np.sqrt(S_L / s.waterplane_area), s.waterplane_area
    terms = {
        (2, 2): area,
        (2, 3): area * length,
        (2, 4): area * length,
        (3, 3): S_T + depth,
        (4, 4): S_L + depth,
        (3, 4): S_L + depth,
    }
    for (i, j), term in terms.items():
        assert simple[i, j] == pytest.approx(given_C[i, j], abs=one_point * term), f"one-point C{i + 1}{j + 1}"
        assert C[i, j] == pytest.approx(given_C[i, j], abs=exact * term), f"exact C{i + 1}{j + 1}"
        assert C[j, i] == C[i, j]
    assert C[3, 5] == pytest.approx(given_C[3, 5], abs=1e-3 * s.volume * length)


# ---- equilibrium


def test_box_floats_at_its_draught(box):
    hull = box(8.0, 4.0, -2.0, 1.0, symmetry="xz+yz")
    rest = equilibrium(hull, _weight(RHO * 32.0 * 1.25, 0, 0, -1.0), rho=RHO)
    assert rest.sinkage == pytest.approx(2.0 - 1.25, abs=1e-12)
    assert (rest.heel, rest.trim, rest.hull.symmetry) == (0.0, 0.0, "xz+yz")
    assert rest.hydrostatics.draught == pytest.approx(1.25, abs=1e-12)
    assert "sinkage 0.75 m" in str(rest)


def _wall_sided(offset, z_G, *, T, width, low):
    """Angle with offset cos = sin (GM + BM tan^2 / 2); exact while the deck and the bottom stay where they are."""
    BM = width**2 / (12 * T)
    GM = low + T / 2 + BM - z_G
    return brentq(lambda a: offset * np.cos(a) - np.sin(a) * (GM + 0.5 * BM * np.tan(a) ** 2), -0.6, 0.6, xtol=1e-15)


@pytest.mark.parametrize("y", [0.05, -0.1, 0.2])
@pytest.mark.parametrize("symmetry", ["none", "xz"])
def test_offset_weight_heels_a_box_exactly(box, y, symmetry):
    hull = box(8.0, 4.0, -2.0, 1.0, symmetry=symmetry)
    rest = equilibrium(hull, _weight(RHO * 32.0 * 1.5, 0, y, -1.5), rho=RHO)
    assert rest.heel == pytest.approx(-_wall_sided(y, -1.5, T=1.5, width=4.0, low=-2.0), abs=1e-11)  # weight to port: port down
    assert rest.trim == pytest.approx(0.0, abs=1e-12)
    assert rest.iterations < 12


@pytest.mark.parametrize("x", [0.2, -0.5])
def test_offset_weight_trims_a_box_exactly(box, x):
    hull = box(8.0, 4.0, -2.0, 1.0, symmetry="xz")
    rest = equilibrium(hull, _weight(RHO * 32.0 * 1.5, x, 0, -1.5), rho=RHO)
    assert rest.trim == pytest.approx(_wall_sided(x, -1.5, T=1.5, width=8.0, low=-2.0), abs=1e-11)  # weight forward: bow down
    assert rest.heel == 0.0
    assert rest.hull.symmetry == "xz"


@given(st.integers(0, 10**6))
@settings(max_examples=8, deadline=None)
def test_at_rest_buoyancy_carries_the_weight(blob, seed):
    rng = np.random.default_rng(seed)
    body = _weight(RHO * rng.uniform(30, 50), *rng.uniform(-0.2, 0.2, 2), -1.5)
    rest = equilibrium(blob(seed, amount=0.15), body, rho=RHO)
    s = rest.hydrostatics
    assert s.displacement == pytest.approx(body.mass, rel=1e-10)
    assert s.center_of_buoyancy[:2] == pytest.approx(rest.cog[:2], abs=1e-9)
    assert np.linalg.eigvalsh(s.stiffness[2:5, 2:5]).min() > 0
    assert np.abs(s.stiffness[3:5, 5]).max() < 1e-6 * np.abs(s.stiffness).max()
    again = equilibrium(rest.hull.translated((0, 0, 0)), _weight(body.mass, *rest.cog), rho=RHO) if rest.heel == 0 else rest
    assert again.hydrostatics.volume == pytest.approx(s.volume)


@pytest.mark.parametrize(
    "file",
    [
        "kvlcc2_hull/kvlcc2_fine.gdf",
        "mss_wamit_tanker/tanker.gdf",
        "mss_wamit_fpso/fpso_low.gdf",
        "mss_wamit_semisub/semisub_low.gdf",
    ],
)
def test_lighter_ship_comes_up(shared_data, file):
    """Wetted hulls, three of them with gaps between their patches: those are not taken for open hatches."""
    hull = load_mesh(shared_data / file)
    V, b = hull.volume, hull.center_of_buoyancy
    zG = b[2] + 1.0
    rest = equilibrium(hull, _weight(0.98 * RHO * V, b[0], 0, zG), rho=RHO)
    assert rest.sinkage == pytest.approx(0.02 * V / hydrostatics(hull).waterplane_area, rel=0.05)
    assert rest.hydrostatics.displacement == pytest.approx(0.98 * RHO * V, rel=1e-10)
    assert rest.heel == 0.0
    with pytest.raises(ConvergenceError, match=r"sinks.*up to the deck"):
        equilibrium(hull, _weight(1.02 * RHO * V, b[0], 0, zG), rho=RHO)


def test_what_cannot_float_upright(box):
    hull, open_box = box(8.0, 4.0, -2.0, 1.0, symmetry="xz"), box(8.0, 4.0, -2.0, 1.0, deck=False)
    with pytest.raises(ConvergenceError, match="sinks"):
        equilibrium(hull, _weight(RHO * 97.0, 0, 0, -1.5), rho=RHO)
    with pytest.raises(ConvergenceError, match=r"capsizes.*not stable.*GM_T -"):
        equilibrium(hull, _weight(RHO * 48.0, 0, 0, 3.0), rho=RHO)
    with pytest.raises(ConvergenceError, match=r"capsizes|less imbalance|not reached"):
        equilibrium(hull, _weight(RHO * 48.0, 0, 5.0, -1.5), rho=RHO)
    with pytest.raises(ConvergenceError, match="floods: its open upper edge"):
        equilibrium(open_box, _weight(RHO * 70.0, 0, 0.62, -1.5), rho=RHO)
    assert equilibrium(open_box, _weight(RHO * 48.0, 0, 0.1, -1.5), rho=RHO).heel < 0
    with pytest.raises(InputError, match="flipped"):
        equilibrium(hull.flipped(), _weight(RHO * 48.0, 0, 0, -1.5))
    with pytest.raises(InputError, match="positive"):
        equilibrium(hull, _weight(-1.0, 0, 0, -1.5))
