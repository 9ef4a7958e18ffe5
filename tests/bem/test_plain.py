"""The plain hybrid method: its parts against exact potentials, the whole against the floating hemisphere."""

import numpy as np
import pytest

from ogilvie.bem.curved import CurvedMesh
from ogilvie.bem.flat_panels import FlatPanels
from ogilvie.bem.flat_panels_influence import rankine_by_parity
from ogilvie.bem.plain import impulse_response, plain_hybrid
from ogilvie.bem.plain_boundary import FlatBoundary, flat_boundary, hemisphere_boundary
from ogilvie.bem.plain_matrices import histories, leapfrog_limit, responses
from ogilvie.bem.transient_green import transient_green
from ogilvie.errors import ConvergenceError, InputError

COARSE = hemisphere_boundary(1.0, 3.0, around=12, rings=(6, 8, 6))
VOLUME = 2 / 3 * np.pi
EVEN = np.array([[1, 1]])


def control(n):
    """Return a boundary with a control surface of 4 n x n quadrilaterals."""
    return hemisphere_boundary(1.0, 2.0, around=4 * n, rings=(n, n, n), grading=1.0)


def source_inside(panels, t, image):
    """Return chi, chi_n (n, n_t) on panels for an impulsive source at (0, 0, -0.4), and psi, psi_n (n,)."""
    xi = np.array([0.0, 0.0, -0.4])
    d, d_image = panels.centers - xi, panels.centers - xi * [1, 1, -1]
    r, r_image = np.linalg.norm(d, axis=1), np.linalg.norm(d_image, axis=1)
    psi = 1 / r - image / r_image
    psi_n = np.einsum("nk,nk->n", panels.normals, -d / r[:, None] ** 3 + image * d_image / r_image[:, None] ** 3)
    G = transient_green(panels.centers[:, None], xi, t, g=1.0)
    return G.value, np.einsum("nk,ntk->nt", panels.normals, G.gradient), psi, psi_n


def test_instantaneous_outer_potential():
    """psi = 1/r - 1/r' of a source inside the control surface: psi = Z psi_n."""
    errors = []
    for n in (3, 6, 12):
        b = control(n)
        Z = responses(b, EVEN)[0].Z
        _, _, psi, psi_n = source_inside(b.control, [0.0], 1.0)
        errors.append(np.sqrt(np.mean((Z @ psi_n - psi) ** 2)) / np.abs(psi).max())
    assert errors[2] < 0.01
    assert np.all(np.divide(errors[:-1], errors[1:]) > 1.9)


def test_memory_of_the_outer_potential():
    """chi = G_f of a source inside: chi_C = Z chi_n - Y r_C with r_C from its own history, Eqs. (20)-(23), signs and all."""
    errors = []
    for n, step in ((3, 0.2), (6, 0.1)):
        b, steps = control(n), round(6.0 / step)
        t = step * np.arange(1, steps + 1)
        response = responses(b, EVEN)[0]
        W = histories(b, EVEN, g=1.0, step=step, steps=steps, points=2)[0]
        chi, chi_n, psi, psi_n = source_inside(b.control, t, 1.0)
        worst = []
        for M in range(1, steps + 1):
            r_C = W[:, M - 1] @ np.concatenate([psi, psi_n])
            for m in range(1, M):
                r_C += step * W[:, M - m - 1] @ np.concatenate([chi[:, m - 1], chi_n[:, m - 1]])
            worst.append(np.abs(response.Z @ chi_n[:, M - 1] - response.Y @ r_C - chi[:, M - 1]).max())
        errors.append(max(worst) / np.abs(chi).max())
    assert errors[1] < 0.04
    assert errors[1] < 0.45 * errors[0]


def test_inner_problem_of_a_linear_potential():
    """phi = z: A phi = B phi_n on the boundary of the inner fluid."""
    b = COARSE
    (B, A) = rankine_by_parity(b.panels.centers, b.panels, EVEN)[0]
    A = A + 2 * np.pi * np.eye(len(A))
    phi, phi_n = b.panels.centers[:, 2], b.panels.normals[:, 2]
    assert np.sqrt(np.mean((A @ phi - B @ phi_n) ** 2)) < 0.05 * np.sqrt(np.mean((A @ phi) ** 2))


def test_free_surface_operator_is_symmetric_and_positive():
    n_c, n_f, _ = COARSE.counts
    T = responses(COARSE, EVEN)[0].X[n_c : n_c + n_f, n_c:] * COARSE.free.areas[:, None]
    assert np.linalg.norm(T - T.T) < 0.15 * np.linalg.norm(T)
    assert np.linalg.eigvalsh(T + T.T).min() > 0


def test_steps_are_the_published_sums():
    """Eqs. (18)-(25) with their double sums over the history, (19) with the normal derivative that it lacks."""
    b, g, step, steps = COARSE, 9.81, 0.05, 25
    n_c, n_f, _ = b.counts
    response = responses(b, EVEN)[0]
    W = histories(b, EVEN, g=g, step=step, steps=steps, points=1)[0]
    heave = b.modes[:, 2:3]
    psi, chi = impulse_response(response, W, heave, b.counts, g=g, step=step)
    start = response.V @ heave[:, 0]
    np.testing.assert_allclose(psi[:, 0], start[n_c + n_f :])
    psi_n, rise = start[:n_c], start[n_c : n_c + n_f]
    history, surface = [], []  # (chi, chi_n) on C, chi_n on F for m = 1, 2, ...
    for M in range(1, steps + 1):
        f = -g * M * step * rise - g * step**2 * sum(((M - m) * e for m, e in enumerate(surface, 1)), np.zeros(n_f))
        r_C = W[:, M - 1] @ np.concatenate([response.Z @ psi_n, psi_n])
        r_C = r_C + step * sum((W[:, M - m - 1] @ h for m, h in enumerate(history, 1)), np.zeros(n_c))
        x = response.X @ np.concatenate([r_C, f])
        history.append(np.concatenate([response.Z @ x[:n_c] - response.Y @ r_C, x[:n_c]]))
        surface.append(x[n_c : n_c + n_f])
        np.testing.assert_allclose(chi[M, :, 0], x[n_c + n_f :], rtol=1e-9, atol=1e-12)


def test_the_stated_limit_of_the_time_step_is_the_limit():
    response = responses(COARSE, EVEN)[0]
    limit = leapfrog_limit(response, COARSE.counts, g=1.0)
    sizes = []
    for part in (0.97, 1.03):
        W = histories(COARSE, EVEN, g=1.0, step=part * limit, steps=80, points=1)[0]
        chi = impulse_response(response, W, COARSE.modes[:, 2:3], COARSE.counts, g=1.0, step=part * limit)[1]
        sizes.append(np.abs(chi[-10:]).max() / np.abs(chi[:10]).max())
    assert sizes[0] < 1.0
    assert sizes[1] > 1e3


@pytest.mark.parametrize("symmetry", ["none", "xz"])
def test_symmetry_changes_the_cost_alone(symmetry):
    part = hemisphere_boundary(1.0, 3.0, around=8, rings=(4, 5, 4))
    whole = part.expanded()
    if symmetry == "xz":
        keep = [FlatPanels(p.corners[p.centers[:, 1] > 0], symmetry="xz") for p in (whole.hull, whole.free, whole.control)]
        whole = FlatBoundary(*keep)
    one, other = (plain_hybrid(b, duration=4.0, dt=0.1, rho=1.0, g=1.0) for b in (part, whole))
    np.testing.assert_allclose(other.K, one.K, atol=1e-5 * np.abs(one.K).max())
    np.testing.assert_allclose(other.A_inf, one.A_inf, atol=1e-5)
    assert other.storage["history"] >= one.storage["history"]


def test_a_hemisphere_by_its_symmetries():
    result = plain_hybrid(COARSE, duration=5.0, rho=1.0, g=1.0)
    K = result.K / np.abs(result.K).max()
    np.testing.assert_allclose(K[:, 0, 0], K[:, 1, 1], atol=1e-6)
    np.testing.assert_allclose(K[:, 0, 4], K[:, 4, 0], atol=0.01)
    assert np.abs(K[:, 2, [0, 1, 3, 4, 5]]).max() == 0
    assert np.abs(K[:, 3:, 3:]).max() < 0.02  # nothing turns a sphere about its centre


def test_known_limits_of_the_hemisphere():
    result = plain_hybrid(hemisphere_boundary(), duration=0.5, dt=0.1, rho=1.0, g=1.0)
    mass, start = np.diag(result.A_inf) / VOLUME, result.K[0] / VOLUME
    assert mass[2] == pytest.approx(1 / 2, rel=0.005)
    assert mass[0] == pytest.approx(4 / np.pi - 1, rel=0.03)
    assert start[2, 2] == pytest.approx(3 / 16, rel=0.005)
    assert start[0, 0] == pytest.approx(0.547683, rel=0.05)


def test_retardation_functions_of_the_hemisphere(shared_reference):
    exact = np.loadtxt(shared_reference / "hemisphere_K.csv", delimiter=",", skiprows=2)
    result = plain_hybrid(hemisphere_boundary(), duration=20.0, dt=0.1, dofs=("surge", "heave"), rho=1.0, g=1.0)
    for i, column, allowed in ((1, 1, 0.03), (0, 2, 0.09)):
        K = result.K[:, i, i] / VOLUME
        wanted = np.interp(result.t, exact[:, 0], exact[:, column])
        assert np.abs(K - wanted).max() < allowed * exact[0, column]


def test_froude_scaling():
    small = plain_hybrid(COARSE, duration=2.0, dt=0.1, rho=1.0, g=1.0)
    large_boundary = hemisphere_boundary(4.0, 12.0, around=12, rings=(6, 8, 6))
    unit = np.sqrt(4.0 / 9.81)
    large = plain_hybrid(large_boundary, duration=2.0 * unit, dt=0.1 * unit, rho=1000.0, g=9.81)
    np.testing.assert_allclose(large.A_inf[:3, :3], small.A_inf[:3, :3] * 1000.0 * 64, rtol=1e-6)
    np.testing.assert_allclose(large.K[:, 2, 2], small.K[:, 2, 2] * 1000.0 * 64 / unit**2, rtol=1e-5)


def test_result_is_a_retardation_table():
    result = plain_hybrid(COARSE, duration=2.0, dofs=("heave",), rho=1.0, g=1.0)
    table = result.retardation()
    assert table.dofs == ("heave",)
    assert table.dt == pytest.approx(0.5 * result.step_limit)
    assert table.duration >= 2.0
    assert set(result.seconds) == {"rankine", "green", "run"}


def curved_hemisphere(radius):
    """Return one curved panel for each of hull and free surface and control surface of a quarter (a singular pole)."""
    u = 0.5 * (1 - np.cos(np.pi * np.arange(9) / 8))
    a, b = np.meshgrid(u * np.pi / 2, u, indexing="ij")

    def shell(r):
        c = np.cos(0.5 * np.pi * b)
        return np.stack([r * np.cos(a) * c, r * np.sin(a) * c, -r * np.sin(0.5 * np.pi * b)], axis=-1)

    flat = np.stack([(1 + (radius - 1) * b) * np.cos(a), (1 + (radius - 1) * b) * np.sin(a), 0 * a], axis=-1)
    hull = shell(1.0)
    points = np.stack([hull, np.swapaxes(flat, 0, 1), np.swapaxes(shell(radius), 0, 1)])
    return CurvedMesh(points, np.array([0, 1, 2]), radius, symmetry="xz+yz")


def test_flat_panels_of_a_curved_boundary():
    mesh = curved_hemisphere(3.0)
    b = flat_boundary(mesh, divisions=8)
    assert b.counts == (64, 64, 64)
    result = plain_hybrid(b, duration=0.5, dt=0.1, dofs=("heave",), rho=1.0, g=1.0)
    assert result.A_inf[0, 0] / VOLUME == pytest.approx(0.5, rel=0.05)


def test_panels_turned_over_or_missing_are_found():
    b = COARSE
    turned = FlatBoundary(FlatPanels(b.hull.corners[:, [1, 0, 3, 2]], symmetry="xz+yz"), b.free, b.control)
    with pytest.raises(InputError, match="Look for gaps"):
        plain_hybrid(turned, duration=1.0)
    gap = FlatBoundary(b.hull, FlatPanels(b.free.corners[3:], symmetry="xz+yz"), b.control)
    with pytest.raises(InputError, match="gaps"):
        plain_hybrid(gap, duration=1.0)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"dt": 2.0}, r"dt below 0\.\d+ s expected, 2 s found.* dt=0\.\d+ works"),
        ({"dt": -1.0}, "dt: a positive number"),
        ({"duration": 0.0}, "duration: a positive number"),
        ({"rho": np.nan}, "rho"),
        ({"dofs": ("dive",)}, "dofs"),
        ({"points": 0}, "points"),
        ({"memory_limit": 1e4}, "at most 1e\\+04 bytes"),
    ],
)
def test_bad_arguments_are_explained(arguments, words):
    with pytest.raises(InputError, match=words):
        plain_hybrid(COARSE, **({"duration": 5.0} | arguments))


def test_the_time_step_that_is_named_works():
    with pytest.raises(InputError) as error:
        plain_hybrid(COARSE, duration=2.0, dt=5.0)
    step = float(str(error.value).split("dt=")[1].split()[0])
    assert np.all(np.isfinite(plain_hybrid(COARSE, duration=2.0, dt=step).K))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: hemisphere_boundary(2.0, 1.0), "radius < control_radius"),
        (lambda: hemisphere_boundary(around=10), "multiple of 4"),
        (lambda: FlatBoundary(COARSE.hull, COARSE.hull, COARSE.control), "on z = 0"),
        (lambda: FlatBoundary(COARSE.free, COARSE.free, COARSE.control), "centres of all panels below"),
        (lambda: FlatBoundary(FlatPanels(COARSE.hull.corners), COARSE.free, COARSE.control), "one symmetry"),
        (lambda: flat_boundary(curved_hemisphere(3.0), divisions=0), "divisions >= 1"),
    ],
)
def test_bad_boundaries_are_explained(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_growth_is_noticed(monkeypatch):
    import ogilvie.bem.plain as plain

    monkeypatch.setattr(plain, "leapfrog_limit", lambda *_, **__: 10.0)
    with pytest.raises(ConvergenceError, match="the solution grows"):
        plain_hybrid(COARSE, duration=20.0, dt=0.8, dofs=("surge", "heave"), rho=1.0, g=1.0, points=1)
