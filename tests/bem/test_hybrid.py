"""Retardation functions of the hybrid method: the hemisphere against its exact solution, identities, refusals."""

from functools import cache

import numpy as np
import pytest
from octants import hemisphere_in_hemisphere

from ogilvie.bem.curved_split import side_points, split_at_waterline
from ogilvie.bem.hybrid import hybrid_bem
from ogilvie.bem.hybrid_case import flared
from ogilvie.bem.inner_mesh import inner_mesh
from ogilvie.body import RigidBody
from ogilvie.errors import InputError
from ogilvie.mesh.shapes import box, hemisphere

UNIT = 2 / 3 * np.pi  # of added mass and K of the hemisphere of radius 1


@cache
def hemisphere_result(duration=40.0):
    return hybrid_bem(hemisphere(1.0), duration=duration, dt=0.05, rho=1.0, g=1.0)


def test_limits_of_the_hemisphere():
    """K33(0) = 3/16, A33 = 1/2, A11 = 4/pi - 1; no motion about the centre moves water."""
    K = hemisphere_result()
    assert K.K[0, 2, 2] / UNIT == pytest.approx(3 / 16, rel=5e-4)
    assert K.A_inf[2, 2] / UNIT == pytest.approx(0.5, rel=1e-4)
    for i in (0, 1):
        assert K.A_inf[i, i] / UNIT == pytest.approx(4 / np.pi - 1, rel=2e-3)
    assert np.abs(K.K[:, 3:, 3:]).max() < 1e-6
    np.testing.assert_array_equal(K.K, K.K.transpose(0, 2, 1))
    np.testing.assert_allclose(K.K[:, 0, 0], K.K[:, 1, 1], atol=1e-4)
    assert int(K.notes[-1].split()[6]) <= 2000


@pytest.mark.parametrize(("dof", "column", "most", "late"), [(2, 0, 0.05, 0.05), (0, 1, 0.6, 0.05)])
def test_retardation_of_the_hemisphere(shared_reference, dof, column, most, late):
    """In percent of K(0): within 0.05 (heave) and 0.6 (surge) at all times, 0.05 after t = 12."""
    t, *exact = np.loadtxt(shared_reference / "hemisphere_K.csv", delimiter=",", skiprows=2, usecols=(0, 1, 2), unpack=True)
    K = hemisphere_result()
    np.testing.assert_allclose(K.t, t, atol=1e-9)
    error = 100 * np.abs(K.K[:, dof, dof] / UNIT - exact[column]) / exact[column][0]
    assert error.max() <= most
    assert error[K.t > 12].max() <= late
    assert error.max() / 100 < 4 * K.discretisation_error[dof, dof]  # the estimate is of the right size


@pytest.mark.parametrize("jitter", [0.0, 0.4])
def test_nothing_is_left_late(jitter):
    mesh = hemisphere_in_hemisphere(
        k=2, depths=[0, 0.12, 1], across=[0, 0.04, 0.2, 0.45, 0.7, 1], control=[0, 0.3, 1], jitter=jitter
    )
    K = hybrid_bem(mesh, duration=1000.0, dt=0.5, rho=1.0, g=1.0, order=3)
    for i in (0, 1, 2):
        late = np.abs(K.K[(K.t > 300.0), i, i]).max()
        assert late <= 2e-4 * K.K[0, i, i]


def test_scaling_and_time_step():
    """Froude: lengths x 4, times x 2, K x rho g L^2; a coarser table has the same values."""
    small = hemisphere_result()
    large = hybrid_bem(hemisphere(4.0), duration=20.0, dt=0.2, rho=1000.0, g=1.0)
    np.testing.assert_allclose(
        large.K[:, 2, 2], small.K[: 2 * len(large.t) : 2, 2, 2] * 1000.0 * 16.0, rtol=0, atol=2e-4 * large.K[0, 2, 2]
    )
    np.testing.assert_allclose(large.A_inf[:3, :3], small.A_inf[:3, :3] * 1000.0 * 64.0, atol=1e-6 * large.A_inf[2, 2])


def test_planes_of_symmetry_do_not_change_the_result():
    """The same boundary stored as a quarter, a half and whole."""
    kinds = ("xz+yz", "xz", "none")
    mesh = {"depths": [0, 0.2, 1], "across": [0, 0.1, 0.45, 1], "control": [0, 0.3, 1]}
    found = [
        hybrid_bem(hemisphere_in_hemisphere(symmetry=s, **mesh), duration=6.0, dt=0.1, rho=1.0, g=1.0, order=3) for s in kinds
    ]
    for other in found[1:]:
        np.testing.assert_allclose(other.K, found[0].K, atol=3e-4 * found[0].K[0, 0, 0])
        np.testing.assert_allclose(other.A_inf, found[0].A_inf, atol=1e-4 * found[0].A_inf[2, 2])


@pytest.mark.slow
def test_box_does_not_change_with_resolution():
    coarse, fine = (hybrid_bem(box(4.0, 1.0, 0.5), duration=30.0, dt=0.1, rho=1.0, g=1.0, resolution=r) for r in (0.7, 1.0))
    for i, most in ((0, 8e-3), (2, 2e-3)):
        assert np.abs(coarse.K[:, i, i] - fine.K[:, i, i]).max() < most * fine.K[0, i, i]
        assert coarse.A_inf[i, i] == pytest.approx(fine.A_inf[i, i], rel=5e-3)
        assert np.all(np.abs(fine.K[fine.t > 25, i, i]) < 3e-3 * fine.K[0, i, i])


def test_waterline_panels_are_divided_exactly():
    mesh = inner_mesh(hemisphere(1.0))
    fine = split_at_waterline(mesh, share=0.1)
    near = sum(np.abs(side_points(mesh.points, s)[..., 2]).max(axis=1) < 1e-9 for s in range(4))
    added = len(fine.part) - len(mesh.part)
    assert added == 2 * np.sum((mesh.part == 0) & (near > 0))
    hull = fine.points[fine.part == 0]
    assert np.linalg.norm(hull, axis=-1) == pytest.approx(np.ones(hull.shape[:-1]), abs=1e-6)


def test_mass_that_does_not_float_there_is_noted():
    body = RigidBody(mass=5.0, cog=(0.0, 0.0, 0.0), inertia=np.eye(3))
    K = hybrid_bem(hemisphere(1.0), body, duration=1.0, resolution=0.5, rho=1.0, g=1.0)
    assert "displaces" in K.notes[-1]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"duration": -1.0}, "duration > 0"),
        ({"duration": 1.0, "dt": 2.0}, "up to the duration"),
        ({"duration": 1.0, "resolution": 9.0}, "resolution"),
        ({"duration": 1.0, "order": 1}, "order"),
        ({"duration": 1.0, "outer": "none"}, "outer"),
        ({"duration": 1.0, "control_radius": 0.9}, "radius"),
    ],
)
def test_bad_input_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        hybrid_bem(hemisphere(1.0), **change)


def test_water_angle_of_walls_and_flare():
    """A hemisphere's waterline is upright whatever the division; a Wigley hull is wall-sided, the S175 flares."""
    from ogilvie.bem.curved_split import water_angle
    from ogilvie.mesh.shapes import s175, wigley

    mesh = inner_mesh(hemisphere(1.0))
    assert water_angle(mesh) == pytest.approx(np.pi / 2, abs=1e-4)
    assert water_angle(split_at_waterline(mesh)) == pytest.approx(np.pi / 2, abs=1e-4)
    assert water_angle(inner_mesh(wigley(3.0))) == pytest.approx(np.pi / 2, abs=1e-4)
    ship = inner_mesh(s175())
    assert np.radians(120.0) < water_angle(ship) < np.pi
    assert "in the first 0.23 s converges slowly" in flared(ship, 3.3)[0]
    assert flared(mesh, 3.3) == []
