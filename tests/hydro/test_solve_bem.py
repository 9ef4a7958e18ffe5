"""The panel method against exact solutions, identities, symmetry, and Capytaine's own solver."""

import numpy as np
import pytest

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.frames import shift_matrix
from ogilvie.hydro.bem_case import resolved_wavenumber
from ogilvie.hydro.bem_depth import exponentials, spectrum
from ogilvie.hydro.bem_forces import SPEED_TERMS
from ogilvie.hydro.bem_kernel import force_vectors
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.bem_waves import incident
from ogilvie.hydro.capytaine import _green_function, _influence, solve_bem
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.shapes import hemisphere
from ogilvie.waves.dispersion import encounter_frequency, frequency, group_velocity, wavenumber

G, RHO = 9.81, 1000.0
FAST = {"g": G, "rho": RHO, "cache": False, "workers": 1, "progress": False}


def sheet(points):
    """Panels of a grid of points (n, m, 3); a side of the grid that shrinks to a point makes triangles."""
    n, m = points.shape[:2]
    i = np.arange(n * m).reshape(n, m)
    faces = np.stack([i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]], axis=-1).reshape(-1, 4)
    vertices = points.reshape(-1, 3)
    clean = []
    for f in faces:
        corners = [j for k, j in enumerate(f) if not np.allclose(vertices[j], vertices[f[k - 1]], atol=1e-12)]
        clean.append(corners if len(corners) == 4 else [*corners, corners[-1]])
    return vertices, np.array(clean)


def ellipsoid(n=6, nl=2, *, axes=(1.0, 1.0, 1.0), skew=0.0, lid=True):
    """Lower half of an ellipsoid, graded to the waterline, with its waterplane; `skew` makes the bow fuller than the stern."""
    down = 0.5 * np.pi * np.linspace(0.0, 1.0, n + 1)[:, None] ** 1.5
    if skew == 0.0:
        symmetry, turn = "xz+yz", np.linspace(0.0, 0.5 * np.pi, n + 1)
    else:
        symmetry, turn = "xz", np.linspace(0.0, np.pi, 2 * n + 1)
    scale = np.array(axes)

    def fuller(p):
        return p * np.stack([1.0 + skew * p[..., 0], 1.0 + 0.5 * skew * p[..., 0], np.ones_like(p[..., 0])], axis=-1)

    hull = np.stack([np.cos(down) * np.cos(turn), np.cos(down) * np.sin(turn), -np.sin(down) + 0.0 * turn], axis=-1)
    r = 1.0 - np.linspace(0.0, 1.0, nl + 1)[:, None] ** 1.5
    plane = np.stack([r * np.cos(turn), r * np.sin(turn), 0.0 * r * turn], axis=-1)
    top = PanelMesh(*sheet(fuller(plane) * scale), symmetry=symmetry, name="lid") if lid else None
    return PanelMesh(*sheet(fuller(hull) * scale), symmetry=symmetry, name="ellipsoid", lid=top)


def sphere(radius, depth, n=8):
    """A submerged sphere."""
    down = np.linspace(0.0, np.pi, 2 * n + 1)[:, None]
    turn = np.linspace(0.0, 0.5 * np.pi, n + 1)
    p = np.stack([np.sin(down) * np.cos(turn), np.sin(down) * np.sin(turn), np.cos(down) + 0.0 * turn], axis=-1)
    return PanelMesh(*sheet(radius * p - [0.0, 0.0, depth]), symmetry="xz+yz", name="sphere")


def relative(a, b):
    return np.abs(np.asarray(a) - np.asarray(b)).max() / np.abs(np.asarray(b)).max()


# ---- the exact hemisphere (Hulme 1982, tabulated in the shared reference)


@pytest.fixture(scope="module")
def exact(shared_reference):
    table = np.genfromtxt(shared_reference / "hemisphere_exact.csv", delimiter=",", comments="#", skip_header=3)
    return table[(table[:, 0] >= 0.05) & (table[:, 0] <= 4.0)]


def hemisphere_errors(exact, Ka, n, nl, **options):
    """Differences of A33, B33, A11, B11 (n_Ka, 4) as parts of each exact curve's largest value."""
    w, volume = np.sqrt(G * Ka), 2.0 / 3.0 * np.pi
    hydro = solve_bem(ellipsoid(n, nl), omega=w, **FAST, **options)
    A, B = hydro.added_mass.values, hydro.radiation_damping.values
    found = np.stack([A[:, 2, 2], B[:, 2, 2] / np.sqrt(G), A[:, 0, 0], B[:, 0, 0] / np.sqrt(G)], axis=1) / (RHO * volume)
    root = np.sqrt(exact[:, 0])
    curves = np.stack([exact[:, 1], exact[:, 2] * root, exact[:, 3], exact[:, 4] * root], axis=1)
    wanted = np.stack([np.interp(Ka, exact[:, 0], c) for c in curves.T], axis=1)
    return (found - wanted) / curves.max(axis=0)


def test_hemisphere_converges_with_the_square_of_the_panel_size(exact):
    Ka = np.array([0.05, 0.5, 1.0, 1.75, 2.5, 3.25, 4.0])  # on the table's own points; 2.5 is next to an irregular frequency
    coarse = np.abs(hemisphere_errors(exact, Ka, 6, 2)).max(axis=0)
    fine = np.abs(hemisphere_errors(exact, Ka, 12, 4)).max(axis=0)
    assert np.all(fine < 0.008)  # 576 panels of the hull and 192 of the lid
    assert np.all(coarse / fine > 2.5), coarse / fine


def test_irregular_frequency_is_removed_by_the_lid_and_only_by_it(exact):
    sweep = np.arange(2.5, 2.64, 0.01)
    damaged = np.abs(hemisphere_errors(exact, sweep, 8, 3, irregular_frequencies="keep"))[:, :2].max()
    cured = np.abs(hemisphere_errors(exact, sweep, 8, 3)).max()
    assert damaged > 0.1
    assert cured < 0.012


def test_lid_is_made_where_the_hull_brings_none(exact):
    Ka = np.array([2.54, 2.56, 2.58])
    hull = hemisphere(1.0, panels=400)
    hydro = solve_bem(hull, omega=np.sqrt(G * Ka), **FAST)
    assert hydro.attrs["lid_panels"] > 50
    found = hydro.added_mass.values[:, 2, 2] / (RHO * 2.0 / 3.0 * np.pi)
    np.testing.assert_allclose(found, np.interp(Ka, exact[:, 0], exact[:, 1]), rtol=0.01)
    assert solve_bem(sphere(0.5, 2.0, n=3), omega=[1.0], **FAST).attrs["lid_panels"] == 0


def test_limits_of_zero_and_infinite_frequency():
    hydro = solve_bem(ellipsoid(12, 0, lid=False), omega=[1.0], irregular_frequencies="keep", **FAST)
    scale = RHO * 2.0 / 3.0 * np.pi
    zero, infinite = np.diag(hydro.added_mass_zero) / scale, np.diag(hydro.added_mass_inf) / scale
    np.testing.assert_allclose(zero[:3], [0.5, 0.5, 0.830951], rtol=5e-3)
    np.testing.assert_allclose(infinite[:3], [4.0 / np.pi - 1.0] * 2 + [0.5], rtol=5e-3)


def test_excitation_of_the_hemisphere_by_haskind(exact):
    row = exact[np.isin(exact[:, 0], [0.1, 0.5, 1.0, 2.0, 4.0])]
    Ka = row[:, 0]
    X = np.abs(solve_bem(ellipsoid(12, 4), omega=np.sqrt(G * Ka), **FAST).excitation_force.values[:, 0]) / (RHO * G * np.pi)
    X3, X1 = np.sqrt(4.0 * row[:, 2] / (3.0 * np.pi * Ka)), np.sqrt(8.0 * row[:, 4] / (3.0 * np.pi * Ka))
    np.testing.assert_allclose(X[:, 2], X3, atol=0.005 * X3.max())
    np.testing.assert_allclose(X[:, 0], X1, atol=0.005 * X1.max())


# ---- identities


@pytest.mark.parametrize("depth", [np.inf, 3.0, 1.0])
def test_damping_is_radiated_energy(depth):
    """Haskind: B_ij = k/(8 pi rho g c_g) integral of X_i X_j* over all directions, at any depth; error of the mesh 1-2 %."""
    b = np.arange(48) * 2.0 * np.pi / 48
    w = np.array([1.2, 2.4, 3.6])
    hydro = solve_bem(ellipsoid(10, 3, axes=(2.0, 0.8, 0.7)), omega=w, wave_direction=b, water_depth=depth, **FAST)
    X, k = hydro.excitation_force.values, wavenumber(w, depth, g=G)
    factor = k / (8.0 * np.pi * RHO * G * group_velocity(w, depth, g=G)) * 2.0 * np.pi / len(b)
    far = np.einsum("wbi,wbj->wij", X, X.conj()).real * factor[:, None, None]
    B = hydro.radiation_damping.values
    for i in (0, 1, 2, 4, 5):
        np.testing.assert_allclose(far[:, i, i], B[:, i, i], atol=0.02 * B[:, i, i].max())


def test_reciprocity_and_positive_damping():
    hydro = solve_bem(ellipsoid(6, 2, axes=(2.0, 0.8, 0.7), skew=0.2), omega=[1.0, 2.5, 4.0], **FAST)
    for name in ("added_mass", "radiation_damping"):
        M = hydro[name].values
        size = np.sqrt(np.einsum("wii->wi", np.abs(M)).max(axis=0))
        assert (np.abs(M - M.transpose(0, 2, 1)) / np.outer(size, size)).max() < 0.01
    for B in hydro.radiation_damping.values:
        assert np.linalg.eigvalsh(0.5 * (B + B.T)).min() > -1e-3 * np.abs(np.diag(B)).max()


def test_long_waves_fix_the_conventions():
    """In long waves X3 -> C33, and surge leads by 90 deg where waves travel forward: exp(+i omega t)."""
    hull = ellipsoid(6, 2)
    body = RigidBody.from_gyradii(RHO * hull.volume, cog=[0.0, 0.0, -0.4], gyradii=[0.5, 0.5, 0.5])
    b = np.array([0.0, 0.5 * np.pi, np.pi])
    hydro = solve_bem(hull, body, omega=[0.05], wave_direction=b, **FAST)
    X = hydro.excitation_force.values[0]
    C = hydro.hydrostatic_stiffness.values
    np.testing.assert_allclose(X[:, 2], C[2, 2], rtol=0.01)
    # acceleration of the water at O: i omega (g/omega) k (cos b, sin b) -> force (m + A) i g k
    k = 0.05**2 / G
    A0 = hydro.added_mass_zero.values
    expected = 1j * G * k * (RHO * hull.volume + A0[0, 0])
    np.testing.assert_allclose(X[0, 0], expected, rtol=0.01)
    np.testing.assert_allclose(X[1, 1], expected, rtol=0.01)
    np.testing.assert_allclose(X[2, 0], -expected, rtol=0.01)
    np.testing.assert_allclose(hydro.inertia_matrix.values, body.matrix)
    assert C[3, 3] == pytest.approx(RHO * G * (np.pi / 4 - 2 / 3 * np.pi * (3 / 8 - 0.4)), rel=0.03)


def test_another_origin():
    """A hull that lies d further ahead: M' = H(d)^T M H(d) with H of the old origin's place, X' = exp(-ik.d) H(d)^T X."""
    hull, d = ellipsoid(5, 2, axes=(2.0, 0.8, 0.7), skew=0.2), np.array([0.7, 0.0, 0.0])
    w, b = np.array([2.0]), np.array([0.4])
    moved = PanelMesh(
        hull.vertices + d, hull.faces, symmetry="xz", lid=PanelMesh(hull.lid.vertices + d, hull.lid.faces, symmetry="xz")
    )
    here, there = (solve_bem(m, omega=w, wave_direction=b, **FAST) for m in (hull, moved))
    H = shift_matrix(d)
    for name in ("added_mass", "radiation_damping", "added_mass_inf", "added_mass_zero"):
        M = here[name].values
        np.testing.assert_allclose(there[name].values, H.T @ M @ H, atol=1e-8 * np.abs(M).max())
    X = here.excitation_force.values[0, 0] * np.exp(-1j * w[0] ** 2 / G * d[0] * np.cos(b[0]))
    np.testing.assert_allclose(there.excitation_force.values[0, 0], H.T @ X, atol=1e-8 * np.abs(X).max())


def test_froude_scaling():
    s = 50.0
    hull = ellipsoid(5, 2, axes=(2.0, 0.8, 0.7))
    large = hull.scaled(s) if hull.scaled(s).lid is not None else hull.scaled(s).with_lid(hull.lid.scaled(s))
    small = solve_bem(hull, omega=[2.0], wave_direction=[0.4], **FAST)
    big = solve_bem(large, omega=[2.0 / np.sqrt(s)], wave_direction=[0.4], **FAST)
    power = np.array([1.0] * 3 + [s] * 3)
    np.testing.assert_allclose(
        big.added_mass.values, small.added_mass.values * s**3 * np.outer(power, power), rtol=1e-7, atol=1e-3
    )
    np.testing.assert_allclose(
        big.excitation_force.values, small.excitation_force.values * s**2 * power, rtol=1e-6, atol=1e-6 * s**2
    )


# ---- symmetry, other codes


@pytest.mark.parametrize("depth", [np.inf, 1.5])
def test_symmetry_changes_nothing_but_the_cost(depth):
    quarter = ellipsoid(4, 2, axes=(2.0, 0.8, 0.7))
    options = {"omega": [1.5, 3.0], "wave_direction": [0.3, 2.0], "water_depth": depth, "speed": 0.7, **FAST}
    reference = solve_bem(quarter, **options)
    assert reference.attrs["panels"] == 4 * quarter.n_faces
    for symmetry in ("xz", "none"):
        other = solve_bem(quarter.with_symmetry(symmetry), **options)
        assert other.attrs["panels"] == 4 * quarter.n_faces
        assert other.attrs["lid_panels"] == 4 * quarter.lid.n_faces
        for name in reference.data_vars:
            assert relative(other[name], reference[name]) < 1e-10, name


def test_same_numbers_as_capytaines_own_solver():
    import capytaine as cpt

    hull = ellipsoid(3, axes=(2.0, 0.8, 0.7), lid=False).full()
    mesh = cpt.Mesh(hull.vertices, [list(dict.fromkeys(f)) for f in hull.faces.tolist()], auto_clean=False)
    body = cpt.FloatingBody(mesh=mesh, dofs=cpt.rigid_body_dofs(rotation_center=(0.0, 0.0, 0.0)))
    solver = cpt.BEMSolver(method="direct", green_function=_green_function())
    w, b = 2.0, 0.6
    settings = {"body": body, "omega": w, "g": G, "rho": RHO}
    names = list(body.dofs)
    hydro = solve_bem(hull, omega=[w], wave_direction=[b], irregular_frequencies="keep", **FAST)
    for j, dof in enumerate(names):
        result = solver.solve(cpt.RadiationProblem(radiating_dof=dof, **settings), _check_wavelength=False)
        for name in ("added_mass", "radiation_damping"):
            theirs = np.array([getattr(result, name)[i] for i in names])
            np.testing.assert_allclose(hydro[name].values[0, :, j], theirs, atol=1e-9 * np.abs(hydro[name].values).max())
    result = solver.solve(cpt.DiffractionProblem(wave_direction=b, **settings), _check_wavelength=False)
    theirs = np.conj([result.forces[i] for i in names])  # exp(-i omega t) there; their wave is sampled at the centres
    assert relative(hydro.diffraction_force.values[0, 0], theirs) < 0.03


# ---- finite depth


def test_bottom_mounted_cylinder_of_maccamy_and_fuchs():
    """|F1| = 4 rho g a tanh(kh)/(k^2 |H1'(ka)|): from kh = 0.02, below what Capytaine's own fit allows, to 4."""
    from scipy.special import h1vp

    h, n, m = 2.0, 8, 10
    turn, z = np.linspace(0.0, 0.5 * np.pi, n + 1), -h * np.linspace(0.0, 1.0, m + 1)[:, None]
    wall = np.stack([np.cos(turn) + 0.0 * z, np.sin(turn) + 0.0 * z, z + 0.0 * turn], axis=-1)
    panels = HullPanels(PanelMesh(*sheet(wall), symmetry="xz+yz"))
    green = _green_function()
    for k in (0.01, 0.1, 0.5, 1.0, 2.0):
        w = float(frequency(k, h, g=G))
        g = force_vectors(panels, lambda mirror, k=k: _influence(green, panels, k, h, mirror), K=w**2 / G).conj()
        force, v = incident(panels, omega=w, k=k, direction=np.array([0.0]), depth=h, rho=1.0, g=G)
        total = force[0, 0] + 1j * w * np.einsum("cp,c,p->", -v[0], panels.dof_signs[:, 0], g[0])
        assert abs(total) == pytest.approx(4.0 * G * np.tanh(k * h) / (k**2 * abs(h1vp(1, k))), rel=0.008)


@pytest.mark.parametrize(
    ("kh", "error"), [(0.01, 4e-3), (0.1, 4e-3), (0.7, 4e-3), (2.0, 4e-3), (5.5, 1e-3), (20.0, 5e-4), (np.inf, 5e-4)]
)
def test_exponentials_of_finite_depth(kh, error):
    rate, amplitude = exponentials(kh)
    x = np.linspace(0.003, 15.0, 777)
    x = x[np.abs(x - kh) > 0.01 * min(kh, 1.0)]
    fit = amplitude @ np.exp(np.outer(rate, x))
    assert (np.abs(fit - spectrum(x, kh)) / (1.0 + x / 5.0)).max() < error
    assert np.array_equal(exponentials(kh), exponentials(kh))


def test_infinite_frequency_between_surface_and_bottom_is_a_series_of_images():
    """phi = 0 on z = 0, phi_z = 0 on z = -h: sources of alternating sign; the fit stands for those above the bottom."""
    rate, amplitude = exponentials(np.inf)
    m = np.arange(1, 4001)
    for R in (0.05, 0.5, 2.0):
        series = np.sum(2.0 * (-1.0) ** (m + 1) / np.hypot(R, 2.0 * m)) + (-1.0) ** len(m) / np.hypot(R, 2.0 * len(m))
        assert np.sum(amplitude / np.hypot(R, rate)) == pytest.approx(series, rel=1e-3)


def test_deep_water_is_the_limit_of_finite_depth():
    hull = ellipsoid(4, 1)
    deep = solve_bem(hull, omega=[2.0, 4.0], **FAST)
    finite = solve_bem(hull, omega=[2.0, 4.0], water_depth=40.0, **FAST)
    assert "added_mass_zero" in deep
    assert "added_mass_zero" not in finite  # grows as log omega
    for name in ("added_mass", "radiation_damping", "excitation_force", "added_mass_inf"):
        assert relative(finite[name], deep[name]) < 2e-3, name


# ---- forward speed


def test_forward_speed_starts_at_zero_speed():
    hull = ellipsoid(5, 2, axes=(2.0, 0.4, 0.3))
    options = {"omega": [1.5, 3.0], "wave_direction": [0.0, 2.0, np.pi], **FAST}
    still, slow = solve_bem(hull, **options), solve_bem(hull, speed=1e-6, **options)
    for name in ("added_mass", "radiation_damping", "excitation_force"):
        assert relative(slow[name], still[name]) < 1e-5


def test_timman_newman_relations_and_speed_terms():
    """A_ij(U) = A_ji(-U): the speed terms of 35 and 53, 26 and 62 are opposite; those of Salvesen, Tuck and Faltinsen."""
    hull, U = ellipsoid(5, 2, axes=(2.0, 0.4, 0.3), skew=0.2), 1.3
    w = np.array([1.5, 2.8])
    still, ahead, astern = (solve_bem(hull, omega=w, speed=u, **FAST) for u in (0.0, U, -U))
    A, B = still.added_mass.values, still.radiation_damping.values
    for name in ("added_mass", "radiation_damping"):
        speed_part = ahead[name].values - 0.5 * (ahead[name].values + astern[name].values)
        np.testing.assert_allclose(speed_part, -speed_part.transpose(0, 2, 1), atol=0.01 * np.abs(speed_part).max())
    AU, BU = ahead.added_mass.values, ahead.radiation_damping.values
    np.testing.assert_allclose(AU[:, 2, 4], A[:, 2, 4] - U * B[:, 2, 2] / w**2)
    np.testing.assert_allclose(BU[:, 2, 4], B[:, 2, 4] + U * A[:, 2, 2])
    np.testing.assert_allclose(BU[:, 4, 2], B[:, 4, 2] - U * A[:, 2, 2])
    np.testing.assert_allclose(
        AU[:, 4, 4], A[:, 4, 4] + U**2 / w**2 * A[:, 2, 2] - U / w**2 * (B[:, 4, 2] - B[:, 2, 4]), rtol=1e-9
    )
    np.testing.assert_allclose(AU[:, 1, 5], A[:, 1, 5] + U * B[:, 1, 1] / w**2)
    np.testing.assert_allclose(BU[:, 1, 5], B[:, 1, 5] - U * A[:, 1, 1])
    limit = still.added_mass_inf.values
    np.testing.assert_allclose(ahead.added_mass_inf.values, limit)
    np.testing.assert_allclose(ahead.radiation_damping_inf.values, U * (limit @ SPEED_TERMS - SPEED_TERMS.T @ limit))


def test_speed_terms_are_near_those_of_capytaine():
    """Capytaine integrates U d phi/d x itself: its 35 and 53 are not opposite, but their antisymmetric part is near ours.

    The sign is that of slender-body theory: bow down at speed U, a section that passes a fixed plane moves up with U theta, so
    F3 = -A33 d/dt(z' + U theta) and B35 = U A33.
    """
    import capytaine as cpt

    hull, U, w = ellipsoid(6, 1, axes=(4.0, 0.3, 0.25), lid=False), 1.0, 2.5
    ours = solve_bem(hull, omega=[w], wave_direction=[0.5 * np.pi], speed=U, irregular_frequencies="keep", **FAST)
    full = hull.full()
    mesh = cpt.Mesh(full.vertices, [list(dict.fromkeys(f)) for f in full.faces.tolist()], auto_clean=False)
    body = cpt.FloatingBody(mesh=mesh, dofs=cpt.rigid_body_dofs(rotation_center=(0.0, 0.0, 0.0)))
    solver = cpt.BEMSolver(method="indirect", green_function=_green_function())
    settings = {"body": body, "omega": w, "g": G, "rho": RHO, "forward_speed": U, "wave_direction": 0.5 * np.pi}
    theirs = {
        dof: solver.solve(cpt.RadiationProblem(radiating_dof=dof, **settings), _check_wavelength=False)
        for dof in ("Heave", "Pitch", "Sway", "Yaw")
    }
    for name in ("added_mass", "radiation_damping"):
        M = ours[name].values[0]
        for i, j, one, other in ((2, 4, "Heave", "Pitch"), (1, 5, "Sway", "Yaw")):
            part = 0.5 * (getattr(theirs[other], name)[one] - getattr(theirs[one], name)[other])
            assert 0.5 * (M[i, j] - M[j, i]) == pytest.approx(part, rel=0.25), (name, one)


@pytest.mark.parametrize("speed", [0.0, 3.0, 12.0, 30.0])
def test_deep_small_sphere_in_waves_that_overtake_or_are_overtaken(speed):
    """In unbounded fluid X = rho V (i omega + i omega_e/2) u: the wave's pressure, and added mass that meets it at omega_e."""
    a, d = 0.5, 6.0
    hull = sphere(a, d)
    w, b = np.array([0.4, 0.7, 1.0]), np.array([0.0, 1.0, 2.5])
    hydro = solve_bem(hull, omega=w, wave_direction=b, speed=speed, **FAST)
    k = w**2 / G
    we = encounter_frequency(w[:, None], speed=speed, direction=b, g=G)
    assert (we.min() < -0.1) == (speed > 10.0)
    potential = 1j * G / w * np.exp(-k * d)
    for i, u in ((0, -1j * k[:, None] * np.cos(b)), (1, -1j * k[:, None] * np.sin(b)), (2, k[:, None] * np.ones(3))):
        expected = RHO * hull.volume * (1j * w[:, None] + 0.5j * we) * potential[:, None] * u
        np.testing.assert_allclose(hydro.excitation_force.values[:, :, i], expected, atol=0.012 * np.abs(expected).max())


# ---- data set and input


def test_data_set():
    hydro = solve_bem(ellipsoid(3, 1), omega=[3.0, 1.0, 2.0], wave_direction=[np.pi, 0.0], **FAST)
    assert hydro.omega.values.tolist() == [1.0, 2.0, 3.0]
    assert hydro.wave_direction.values.tolist() == [0.0, np.pi]
    assert hydro.attrs["time_convention"] == "exp(+iwt)"
    assert hydro.attrs["lid_panels"] == 12
    assert "hydrostatic_stiffness" not in hydro  # it would lack the weight
    np.testing.assert_allclose(hydro.excitation_force, hydro.Froude_Krylov_force + hydro.diffraction_force)
    assert "radiation_damping_inf" not in hydro  # it is zero


def test_threads_change_nothing():
    options = {"omega": [2.0], "g": G, "rho": RHO, "cache": False}
    one, two = (solve_bem(ellipsoid(4, 1), workers=n, **options) for n in (1, 2))
    for name in one.data_vars:
        assert relative(one[name], two[name]) < 1e-12


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"omega": []}, "at least one frequency"),
        ({"omega": [0.0, 1.0]}, "positive, finite"),
        ({"omega": [-1.0]}, "positive, finite"),
        ({"omega": [np.nan]}, "positive, finite"),
        ({"omega": [1.0, 1.0]}, "given twice"),
        ({"wave_direction": [180.0]}, "Degrees"),
        ({"wave_direction": []}, "at least one angle"),
        ({"wave_direction": [0.5, 0.5]}, "given twice"),
        ({"rho": -1.0}, "rho"),
        ({"g": 0.0}, "g: a positive"),
        ({"speed": np.inf}, "speed"),
        ({"water_depth": 0.9}, "more than the draught"),
        ({"water_depth": np.nan}, "more than the draught"),
        ({"water_depth": 100.0, "omega": [0.002]}, "k h >="),
        ({"irregular_frequencies": "maybe"}, "'remove' or 'keep'"),
        ({"workers": 0}, "workers"),
    ],
)
def test_bad_input_is_named(change, message):
    options = {"omega": [1.0], **FAST, **change}
    with pytest.raises(InputError, match=message):
        solve_bem(ellipsoid(3, 1), **options)


def test_slow_encounter_in_shallow_water_is_refused_with_its_direction():
    k = float(wavenumber(1.0, 5.0, g=G))
    with pytest.raises(InputError, match=r"omega 1 rad/s in direction 0 deg"):
        solve_bem(ellipsoid(3, 1), omega=[1.0], wave_direction=[0.0, np.pi], water_depth=5.0, speed=1.0 / k, **FAST)


def test_unusable_hulls_are_refused():
    hull = ellipsoid(3, 1)
    with pytest.raises(InputError, match="normals"):
        solve_bem(PanelMesh(hull.vertices, hull.faces[:, ::-1], symmetry="xz+yz"), omega=[1.0], **FAST)
    with pytest.raises(InputError, match="above z = 0"):
        solve_bem(PanelMesh(hull.vertices + [0.0, 0.0, 0.3], hull.faces, symmetry="xz+yz"), omega=[1.0], **FAST)


def test_mesh_too_large_for_the_memory_is_refused(monkeypatch):
    monkeypatch.setattr("os.sysconf", lambda name: {"SC_PAGE_SIZE": 100, "SC_PHYS_PAGES": 100}[name])
    with pytest.raises(InputError, match=r"store the hull with its symmetry"):
        solve_bem(ellipsoid(4, 1), omega=[1.0], **FAST)


def test_coarse_mesh_warns_with_the_frequency_it_is_good_for():
    hull = ellipsoid(3, 1)
    limit = float(np.sqrt(G * resolved_wavenumber(hull)))
    with pytest.warns(OgilvieWarning, match=f"omega = {limit:.4g} rad/s") as found:
        hydro = solve_bem(hull, omega=[1.0, 1.2 * limit], **FAST)
    assert len(found) == 1
    assert hydro.attrs["omega_resolved"] == pytest.approx(limit)
    assert resolved_wavenumber(ellipsoid(6, 2)) > 1.5 * resolved_wavenumber(hull)
    assert resolved_wavenumber(sphere(0.5, 20.0)) == np.inf  # no wave is felt there
