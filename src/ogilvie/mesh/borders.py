"""The border of a panelled half hull: waterline, keel, profiles or the edges of flat ends, on the sides of the unit square."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.chine import Chine
from ogilvie.mesh.topology import edges

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_REACH = 0.15  #: of the length that counts, at the ends of the keel, as much as the draught


def border(vertices: Array, tri: Ints, near: float, edges_of_ends: list[int]) -> list[int]:
    """Return the vertices of the border, in order; all but those of flat ends lie in z = 0 or y = 0."""
    start, end, _ = edges(tri)
    directed = set(zip(start.tolist(), end.tolist(), strict=True))
    after = {a: b for a, b in directed if (b, a) not in directed}
    if len(after) < 4 or len(after) < sum((b, a) not in directed for a, b in directed):
        raise InputError("flattened: one border that does not touch itself expected.")
    loop = [min(after)]
    while after[loop[-1]] != loop[0]:
        loop.append(after[loop[-1]])
        if len(loop) > len(after) or loop[-1] not in after:
            raise InputError("flattened: a closed border expected.")
    if len(loop) < len(after):
        raise InputError(f"flattened: one border expected, more found ({len(after) - len(loop)} sides elsewhere).")
    p = vertices[loop]
    off = (np.abs(p[:, 1]) > near) & (np.abs(p[:, 2]) > near) & ~np.isin(loop, edges_of_ends)
    if off.any():
        at = p[off][0].round(6).tolist()
        raise InputError(
            f"flattened: a border in z = 0 and y = 0 expected, {int(off.sum())} vertices elsewhere, one at {at} m."
        )
    return loop


def corners_of(vertices: Array, loop: list[int], near: float) -> list[int]:
    """Return the places in the loop of stern and bow on the waterline, and of both ends of the keel."""
    p = vertices[loop]
    wet_line = np.flatnonzero((np.abs(p[:, 2]) <= near) & (np.abs(p[:, 1]) <= near))
    stern, bow = (wet_line[np.argmin(p[wet_line, 0])], wet_line[np.argmax(p[wet_line, 0])]) if len(wet_line) else (0, 0)
    keel = np.flatnonzero((np.abs(p[:, 1]) <= near) & (p[:, 2] < -near))
    if len(keel) < 2:
        raise InputError("flattened: a keel on the centreline expected.")
    score = p[keel, 2] / np.abs(p[:, 2]).max()
    along = p[keel, 0] / (_REACH * np.ptp(p[:, 0]))
    return [int(stern), int(bow), int(keel[np.argmin(along + score)]), int(keel[np.argmax(along - score)])]


def on_border(vertices: Array, loop: list[int], corners: list[int], chine: Chine | None) -> tuple[Array, Ints]:
    """Return (u, v) of the vertices of border and chine, zeros elsewhere, and which side each vertex is on."""
    stern, bow, low_stern, low_bow = corners
    uv, side = np.zeros((len(vertices), 2)), np.full(len(vertices), -1)
    ends = {0: (low_stern, stern), 1: (low_bow, bow), 2: (low_stern, low_bow), 3: (stern, bow)}
    for k, (a, b) in ends.items():
        chain = between(loop, a, b, [c for c in corners if c not in (a, b)])
        t = _along(vertices[chain])
        if k < 2 and chine and chine.line[-k] in chain[:-1]:
            at = t[chain.index(chine.line[-k])]
            t = np.interp(t, [0.0, at, 1.0], [0.0, chine.share, 1.0]) if at > 0.0 else chine.share + (1.0 - chine.share) * t
        uv[chain] = np.stack([np.full(len(t), float(k)), t] if k < 2 else [t, np.full(len(t), k - 2.0)], axis=-1)
        side[chain] = k
    if chine:
        line, t = chine.line, _along(vertices[chine.line])
        inner = slice(1, -1)
        uv[line[inner]] = np.stack([t[inner], np.full(len(line) - 2, chine.share)], axis=1)
        side[line] = np.where(np.isin(line, loop) & (side[line] == 2), 2, 4)
    return uv, side


def _along(points: Array) -> Array:
    """Return the share of the length of a line (n, 3) up to each of its points."""
    length = np.cumsum(np.r_[0.0, np.linalg.norm(np.diff(points, axis=0), axis=1)])
    return np.asarray(length / length[-1])


def between(loop: list[int], a: int, b: int, others: list[int]) -> list[int]:
    """Return the vertices of a loop from place a to place b, the way that does not pass the other corners."""
    n = len(loop)
    for step in (1, -1):
        way = [(a + step * i) % n for i in range((step * (b - a)) % n + 1)]
        if not set(way) & set(others):
            return [loop[i] for i in way]
    raise InputError("flattened: waterline and keel between stern and bow expected, the border runs differently.")
