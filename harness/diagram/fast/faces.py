"""Root triangles from the arrangement of all lines: no segment's line crosses any of them.

Where the smallest angle wins, a segment owns the extension of its own line: nothing else happens
there, but at crossings of several lines and on the segments themselves.  So the sides of the faces
of the arrangement may be sides of root triangles, and each face is a fan about a free point.
A side along a segment is replaced by two, by way of a free point beside it, since an edge may run
along the segment.  At infinity free directions stand between those of the lines.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.arrangement import Arrangement, arrange
from harness.diagram.fast.far import Far, far_corners, free_middles
from harness.diagram.fast.forms import U
from harness.diagram.fast.insertion import inserted
from harness.diagram.fast.line_points import TINY, Points, points_on, within_hull
from harness.diagram.fast.lines import Lines, lines_of
from harness.diagram.fast.plane import beside
from harness.diagram.fast.prepare import Prepared
from harness.diagram.fast.roots import Floats, Ints, Roots
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction


def arranged_roots(
    prepared: Prepared,
    seed: int,
    hubs: Sequence[RationalPoint] = (),
    directions: Iterable[RationalPoint] = (),
) -> Roots:
    """Roots of the whole plane, for the smallest angle.

    ``hubs`` and ``directions`` become special corners.
    """
    lines = lines_of(prepared, seed)
    points = points_on(lines, hubs)
    arrangement = arrange(lines, points)
    corners = ArrangedCorners(prepared, lines, points)
    far = far_corners(lines, corners, list(directions), seed)
    everywhere = np.ones(arrangement.faces, dtype=bool)
    middles = free_middles(corners, lines, arrangement, everywhere, far, seed)
    triangles = [
        _along_extensions(arrangement, far, middles),
        *_along_segments(corners, arrangement, middles, seed),
        _along_gaps(arrangement, far, middles),
    ]
    return _roots(corners, np.concatenate(triangles), {}, hubs, seed)


def arranged_interior(prepared: Prepared, seed: int, hubs: Sequence[RationalPoint] = ()) -> Roots:
    """Roots of the interior of a polygon, for the smallest angle.

    Only points on the lines near the polygon's convex hull are looked at; what is outside the
    polygon need not be an arrangement.

    Raises Contradiction if the polygon's two sides are not told apart.
    """
    lines = lines_of(prepared, seed, squares=False)
    points = points_on(lines, hubs, within_hull(lines))
    arrangement = arrange(lines, points)
    corners = ArrangedCorners(prepared, lines, points)
    along = _along_polygon(lines, points, arrangement)
    inside = _filled(arrangement, along)
    middles = free_middles(corners, lines, arrangement, inside, None, seed)
    tails, heads = arrangement.tails(), arrangement.heads
    rows = np.flatnonzero(inside[arrangement.face])
    triangles = np.column_stack([tails[rows], heads[rows], middles[arrangement.face[rows]]])
    walls = {(int(tails[h]), int(heads[h])): side for h, side in along.items()}
    return _roots(corners, triangles, walls, hubs, seed)


def _roots(
    corners: ArrangedCorners,
    triangles: Ints,
    walls: dict[tuple[int, int], int],
    hubs: Sequence[RationalPoint],
    seed: int,
) -> Roots:
    """Roots of given triangles, with hubs."""
    inside = [hub for hub in hubs if not _is_on_line(corners.lines, hub)]
    rows = inserted(corners, triangles, inside, seed)
    none = np.zeros((0, 3), dtype=np.int64)
    return Roots(corners, rows, walls, none, np.full(len(rows), -1, dtype=np.int64))


def _along_polygon(lines: Lines, points: Points, arrangement: Arrangement) -> dict[int, int]:
    """The half-edges along a polygon's edges with its interior to their left, and the number of
    the polygon's side, counter-clockwise."""
    first = points.first + np.arange(len(points.first))
    found = {}
    n = len(lines.ends)
    forwards = lines.orientation > 0
    for i, members in enumerate(lines.segments):
        row = points.vertex[points.first[i] : points.first[i + 1]]
        for k in members:
            start, stop = (int(np.flatnonzero(row == v)[0]) for v in points.ends[k])
            pieces = range(first[i] + min(start, stop) + 1, first[i] + max(start, stop) + 1)
            side = k if forwards else (n - 2 - k) % n
            found.update({2 * e + (start > stop): side for e in pieces})
    return found


def _filled(arrangement: Arrangement, along: dict[int, int]) -> NDArray[np.bool_]:
    """The faces inside a polygon, from those to the left of its edges, (f,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    sides = arrangement.face.reshape(-1, 2)[~arrangement.inside]
    size = arrangement.faces
    graph = coo_array((np.ones(len(sides)), (sides[:, 0], sides[:, 1])), shape=(size, size))
    _, label = connected_components(graph, directed=False)
    halves = np.array(list(along))
    inside = np.zeros(label.max() + 1, dtype=bool)
    inside[label[arrangement.face[halves]]] = True
    if inside[label[arrangement.face[halves ^ 1]]].any():
        raise Contradiction("the polygon's inside is not apart from its outside")
    filled: NDArray[np.bool_] = inside[label]
    return filled


def _is_on_line(lines: Lines, point: RationalPoint) -> bool:
    """Whether a point lies on some line."""
    here = lines.in_integers(point)
    return any(lines.contains(i, here) for i in range(len(lines.d)))


def _ends(arrangement: Arrangement, far: Far) -> tuple[Ints, Ints]:
    """The corners in which every half-edge begins and ends."""
    heads = arrangement.heads
    head = np.where(heads >= 0, heads, far.of_line[np.where(heads < 0, -1 - heads, 0)])
    return head.reshape(-1, 2)[:, ::-1].ravel(), head


def _along_extensions(arrangement: Arrangement, far: Far, middles: Ints) -> Ints:
    """The triangles at pieces outside segments."""
    tail, head = _ends(arrangement, far)
    rows = np.flatnonzero(~np.repeat(arrangement.inside, 2))
    return np.column_stack([tail[rows], head[rows], middles[arrangement.face[rows]]])


def _along_segments(
    corners: ArrangedCorners, arrangement: Arrangement, middles: Ints, seed: int
) -> list[Ints]:
    """The triangles at pieces of segments, by way of free points beside them."""
    pieces = np.flatnonzero(arrangement.inside)
    if not len(pieces):
        return []
    heads = arrangement.heads
    v, w = heads[2 * pieces + 1], heads[2 * pieces]
    left, right = (middles[arrangement.face[2 * pieces + k]] for k in range(2))
    a, b, p, q = (corners.frame[corner][:, 0::2] for corner in (v, w, left, right))
    spread = np.modf(pieces * 0.5698402909980532 + 0.2713 * (seed + 1))[0][:, None]
    on_side = a + (0.25 + 0.5 * spread) * (b - a)
    bend = on_side + (0.25 + 0.5 * np.modf(7 * spread)[0]) / 64 * (p - on_side)
    sure = (
        _surely_left(a, bend, p)
        & _surely_left(bend, b, p)
        & _surely_left(b, bend, q)
        & _surely_left(bend, a, q)
    )
    numbers = corners.add_free(bend) + np.arange(len(pieces))
    for k in np.flatnonzero(~sure).tolist():
        start, stop, one, two = (corners.exact_corner(int(c[k])) for c in (v, w, left, right))
        corners.replace(int(numbers[k]), beside(start, stop, one, two, k, seed))
    return [
        np.column_stack(row)
        for row in (
            (v, numbers, left),
            (numbers, w, left),
            (w, numbers, right),
            (numbers, v, right),
        )
    ]


def _surely_left(a: Floats, b: Floats, c: Floats) -> np.ndarray:
    """Whether c certainly lies to the left of ab, for points rounded to doubles.

    Let u = 2⁻⁵³, S the greatest coordinate and R the greatest of the differences.  A difference is
    off by 2uS and its rounding, so each product by 4uSR and 3u of it; their difference rounds once
    more.  32u of the products and of SR is far more than all of it, and TINY than underflow.
    """
    size = np.abs(np.concatenate([a, b, c], axis=1)).max(axis=1)
    reach = np.abs(np.concatenate([b - a, c - a], axis=1)).max(axis=1)
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is not certain
        one = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
        two = (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        bound = 32 * U * (np.abs(one) + np.abs(two) + size * reach) + TINY
        sure: np.ndarray = one - two > bound
    return sure


def _along_gaps(arrangement: Arrangement, far: Far, middles: Ints) -> Ints:
    """The triangles at infinity, between the directions of lines."""
    rows = [
        (one, two, int(middles[arrangement.face[h]]))
        for h in np.flatnonzero(arrangement.gap).tolist()
        for one, two in pairwise(far.chains[-1 - arrangement.heads[h]])
    ]
    return np.array(rows, dtype=np.int64)
