"""Curved meshes of a hemisphere inside a hemisphere (quarter or more), three patches to an octant."""

from itertools import pairwise

import numpy as np

from ogilvie.bem.curved import BODY, CONTROL, FREE, CurvedMesh

X, Y, Z = np.eye(3) * [[1.0], [1.0], [-1.0]]


def _unit(x):
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def _sphere_patch(corners):
    """Function of (s, t) in [0, 1]^2 through four points of the unit sphere: (0,0), (1,0), (1,1), (0,1)."""
    a, b, c, d = (_unit(np.asarray(x, dtype=float)) for x in corners)

    def patch(s, t):
        s, t = s[..., None], t[..., None]
        return _unit((1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d)

    return patch


def panels(patch, s, t, q, flip=False):
    """Panels (n, q, q, 3) of a patch between the values s and t of its sides."""
    x = 0.5 - 0.5 * np.cos(np.pi * np.arange(q) / (q - 1))
    out = []
    for s0, s1 in pairwise(s):
        for t0, t1 in pairwise(t):
            S, T = np.meshgrid(s0 + (s1 - s0) * x, t0 + (t1 - t0) * x, indexing="ij")
            points = patch(S, T)
            out.append(points.transpose(1, 0, 2) if flip else points)
    return out


def sphere_octant(k, depths, q, outwards=True):
    """Panels of x, y > 0 > z of the unit sphere: k round a patch, at the given parameters 0..1 below the waterline."""
    u = np.linspace(0.0, 1.0, k + 1)
    centre = X + Y + Z
    sides = [_sphere_patch((X, X + Y, centre, X + Z)), _sphere_patch((X + Y, Y, Y + Z, centre))]
    out = [p for side in sides for p in panels(side, u, depths, q, flip=outwards)]
    return out + panels(_sphere_patch((X + Z, centre, Y + Z, Z)), u, u, q, flip=outwards)


def annulus(k, radii, q, jitter=0.0):
    """Panels of the quarter annulus on z = 0 between the radii, whose sides are those of the octants of both spheres.

    With jitter every corner inside is moved by up to this part of the distance of its neighbours.
    """
    arcs = [_sphere_patch((X, X + Y, X + Y, X)), _sphere_patch((X + Y, Y, Y, X + Y))]
    s, t = np.meshgrid(np.linspace(0.0, 2.0, 2 * k + 1), radii, indexing="ij")
    move = np.random.default_rng(3).uniform(-jitter, jitter, (2, 2 * k - 1, len(radii) - 2))
    inner = (slice(1, -1), slice(1, -1))
    if k > 1:
        move[0, k - 1] = 0.0  # between the arcs
    s[inner] += move[0] / (2 * k) if k > 1 else 0.0
    t[inner] += move[1] * 0.5 * np.minimum(np.diff(radii)[1:], np.diff(radii)[:-1])
    x = 0.5 - 0.5 * np.cos(np.pi * np.arange(q) / (q - 1))
    a, b = np.meshgrid(x, x, indexing="ij")
    out = []
    for i in range(2 * k):
        for j in range(len(radii) - 1):
            S, T = (
                (1 - a) * (1 - b) * z[i, j] + a * (1 - b) * z[i + 1, j] + a * b * z[i + 1, j + 1] + (1 - a) * b * z[i, j + 1]
                for z in (s, t)
            )
            points = arcs[i // k](S - i // k, 0 * S) * T[..., None]
            out.append(points.transpose(1, 0, 2))
    return out


def graded(n, power=2.0, both=False):
    """Values 0..1 that crowd at 0 (and at 1)."""
    x = np.linspace(0.0, 1.0, n + 1)
    if not both:
        return x**power
    half = (2 * np.minimum(x, 1 - x)) ** power / 2
    return np.where(x < 0.5, half, 1 - half)


def mirrored(points, part, plane):
    """Panels with their mirror images at x = 0 or y = 0, normals kept outwards."""
    other = points * np.where(np.arange(3) == plane, -1.0, 1.0)
    return np.concatenate([points, other.transpose(0, 2, 1, 3)]), np.concatenate([part, part])


def hemisphere_in_hemisphere(*, k=1, depths=2, across=3, control=None, q=7, radius=2.0, symmetry="xz+yz", jitter=0.0):
    """Inner domain between the hemispheres of radius 1 and `radius`; panels by number (graded) or by their sides in 0..1."""
    depths = graded(depths) if np.ndim(depths) == 0 else np.asarray(depths)
    across = graded(across, both=True) if np.ndim(across) == 0 else np.asarray(across)
    control = depths if control is None else graded(control) if np.ndim(control) == 0 else np.asarray(control)
    hull = sphere_octant(k, depths, q, outwards=False)
    outer = [radius * p for p in sphere_octant(k, control, q)]
    free = annulus(k, 1.0 + (radius - 1.0) * across, q, jitter)
    points = np.array(hull + free + outer)
    part = np.repeat([BODY, FREE, CONTROL], [len(hull), len(free), len(outer)])
    if symmetry != "xz+yz":
        points, part = mirrored(points, part, 0)
    if symmetry == "none":
        points, part = mirrored(points, part, 1)
    return CurvedMesh(points, part, radius, symmetry)
