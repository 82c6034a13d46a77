"""Root triangles from the arrangement of all lines: no segment's line crosses any of them.

Where the smallest angle wins, a segment owns the extension of its own line: nothing else happens
there, but at crossings of several lines and on the segments themselves.  So the sides of the faces
of the arrangement may be sides of root triangles, and each face is a fan about a free point.
A side along a segment is replaced by two, by way of a free point beside it, since an edge may run
along the segment.  At infinity free directions stand between those of the lines.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cmp_to_key
from itertools import pairwise

import numpy as np

from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.arrangement import Arrangement, arrange
from harness.diagram.fast.insertion import inserted
from harness.diagram.fast.lines import Lines, lines_of, points_on
from harness.diagram.fast.plane import turns_left
from harness.diagram.fast.prepare import Prepared
from harness.diagram.fast.roots import Floats, Ints, Roots, between, free_number
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction
from harness.geometry.predicates import orientation

U = 2.0**-53


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
    far = _directions(lines, corners, list(directions), seed)
    middles = _middles(corners, lines, arrangement, far, seed)
    triangles = [
        *_along_extensions(arrangement, far, middles),
        *_along_segments(corners, arrangement, middles, seed),
        *_along_gaps(arrangement, far, middles),
    ]
    none = np.zeros((0, 3), dtype=np.int64)
    inside = [hub for hub in hubs if not _is_on_line(lines, hub)]
    rows = inserted(corners, np.concatenate(triangles), inside, seed)
    return Roots(corners, rows, {}, none, np.full(len(rows), -1, dtype=np.int64))


def _is_on_line(lines: Lines, point: RationalPoint) -> bool:
    """Whether a point lies on some line."""
    here = lines.in_integers(point)
    return any(lines.contains(i, here) for i in range(len(lines.d)))


class _Far:
    """Corners at infinity.

    ``of_line`` (2r,): of the lines' directions; ``chains``: the corners from each of these to the
    next, both included.
    """

    def __init__(self, of_line: Ints, chains: list[list[int]]) -> None:
        self.of_line, self.chains = of_line, chains

    def met(self, arrangement: Arrangement, half: int) -> list[int]:
        """The corners at infinity of a face to which a half-edge leads."""
        direction = -1 - int(arrangement.heads[half])
        return self.chains[direction] if arrangement.gap[half] else [int(self.of_line[direction])]


def _directions(
    lines: Lines, corners: ArrangedCorners, more: list[RationalPoint], seed: int
) -> _Far:
    """All corners at infinity, counter-clockwise."""
    count = int(lines.rank.max()) + 1
    # As long as everything is large: halfway from a point to infinity is as far out again.
    reach = Fraction(float(np.abs(corners.frame).max())) / corners.prepared.scale
    vectors: list[RationalPoint] = [(Fraction(0), Fraction(0))] * (2 * count)
    rows: list[list[int]] = [[] for _ in range(count)]
    for i, k in enumerate(lines.rank.tolist()):
        size = max(map(abs, lines.d[i]))
        dx, dy = (reach * Fraction(part, size) for part in lines.d[i])
        vectors[k] = dx, dy
        vectors[k + count] = -vectors[k][0], -vectors[k][1]
        rows[k] += [2 * segment for segment in lines.segments[i]]
    numbers = [
        corners.add(vector, sorted(rows[k % count]), weight=0.0, special=bool(rows[k % count]))
        for k, vector in enumerate(vectors)
    ]
    stations = list(zip(vectors, numbers, [bool(row) for row in rows] * 2, strict=True))
    chains = [
        _chain(corners, station, stations[(k + 1) % len(stations)], more, seed)
        for k, station in enumerate(stations)
    ]
    return _Far(np.array(numbers), chains)


#: A corner at infinity: its direction, its number, and whether it is special.
Station = tuple[RationalPoint, int, bool]


def _chain(
    corners: ArrangedCorners, start: Station, stop: Station, more: list[RationalPoint], seed: int
) -> list[int]:
    """The corners at infinity from one station to the next, less than half a turn further: the
    directions of ``more`` between them, and free ones between special ones."""
    scale = max(map(abs, start[0]))
    inside = [d for d in more if turns_left(start[0], d) and turns_left(d, stop[0])]
    found = [start]
    for x, y in sorted(inside, key=cmp_to_key(_by_turn)):
        long = (x * scale, y * scale)
        found.append((long, corners.add(long, weight=0.0, special=True), True))
    chain = [start[1]]
    for (d, _, one), (e, number, two) in pairwise([*found, stop]):
        if one and two:
            free = between(d, e, free_number(5 + len(chain), seed))
            if not (turns_left(d, free) and turns_left(free, e)):
                raise Contradiction("no room for a free direction")
            chain.append(corners.add(free, weight=0.0))
        chain.append(number)
    return chain


def _by_turn(d: RationalPoint, e: RationalPoint) -> int:
    """Order of directions within less than half a turn, counter-clockwise."""
    return -1 if turns_left(d, e) else 1


def _middles(
    corners: ArrangedCorners, lines: Lines, arrangement: Arrangement, far: _Far, seed: int
) -> Ints:
    """A free point in every face."""
    heads, face, faces = arrangement.heads, arrangement.face, arrangement.faces
    half = np.arange(len(heads))
    weight = 1.0 + np.modf(half * 0.7548776662466927 + 0.1371 * (seed + 1))[0]
    finite = heads >= 0
    at = corners.frame[np.maximum(heads, 0)]
    total = np.bincount(face[finite], weight[finite], minlength=faces)
    middles = np.empty((faces, 2))
    for axis in range(2):
        summed = np.bincount(face[finite], weight[finite] * at[finite, 2 * axis], minlength=faces)
        middles[:, axis] = summed / total
    for h in np.flatnonzero(heads < 0).tolist():
        chain = far.met(arrangement, h)
        middles[face[h]] += _shares(chain, seed) @ corners.frame[chain, 0::2]
    first = corners.add_free(middles)
    for f in np.flatnonzero(~_surely_inside(corners, lines, arrangement, middles)).tolist():
        corners.replace(first + f, _exact_middle(corners, arrangement, far, f, weight, seed))
    return first + np.arange(faces)


def _surely_inside(
    corners: ArrangedCorners, lines: Lines, arrangement: Arrangement, middles: Floats
) -> np.ndarray:
    """Whether points, one in each face, are certainly inside it."""
    to_frame = corners.prepared.scale / lines.unit
    d = np.array([[float(x) for x in v] for v in lines.d])
    c = np.array([float(Fraction(c) * to_frame) for c in lines.c])
    half = np.arange(len(arrangement.heads))
    line = arrangement.line[half >> 1]
    x, y = middles[arrangement.face].T
    one, two, three = d[line, 0] * y, d[line, 1] * x, c[line]
    value = np.where(half & 1, -1.0, 1.0) * (one - two - three)
    sure = value > 16 * U * (np.abs(one) + np.abs(two) + np.abs(three))
    inside: np.ndarray = np.bincount(arrangement.face, ~sure, minlength=arrangement.faces) == 0
    return inside


def _exact_middle(
    corners: ArrangedCorners,
    arrangement: Arrangement,
    far: _Far,
    face: int,
    weight: Floats,
    seed: int,
) -> RationalPoint:
    """A point inside a face, as a rational combination of its corners."""
    halves = arrangement.cycle[arrangement.first[face] : arrangement.first[face + 1]].tolist()
    x = y = total = Fraction(0)
    for h in halves:
        head = int(arrangement.heads[h])
        if head >= 0:
            w = Fraction(float(weight[h]))
            px, py = corners.exact_corner(head)
            x, y, total = x + w * px, y + w * py, total + w
    x, y = x / total, y / total
    for h in halves:
        if arrangement.heads[h] < 0:
            chain = far.met(arrangement, h)
            for corner, share in zip(chain, _shares(chain, seed).tolist(), strict=True):
                dx, dy = corners.exact_corner(corner)
                x, y = x + Fraction(share) * dx, y + Fraction(share) * dy
    return x, y


def _shares(chain: Sequence[int], seed: int) -> Floats:
    """Weights of corners at infinity in a free point."""
    return np.array([float(free_number(k + 9, seed)) / len(chain) for k in range(len(chain))])


def _ends(arrangement: Arrangement, far: _Far) -> tuple[Ints, Ints]:
    """The corners in which every half-edge begins and ends."""
    heads = arrangement.heads
    head = np.where(heads >= 0, heads, far.of_line[np.where(heads < 0, -1 - heads, 0)])
    return head.reshape(-1, 2)[:, ::-1].ravel(), head


def _along_extensions(arrangement: Arrangement, far: _Far, middles: Ints) -> list[Ints]:
    """The triangles at pieces outside segments."""
    tail, head = _ends(arrangement, far)
    rows = np.flatnonzero(~np.repeat(arrangement.inside, 2))
    return [np.column_stack([tail[rows], head[rows], middles[arrangement.face[rows]]])]


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
        exact = [corners.exact_corner(int(c[k])) for c in (v, w, left, right)]
        corners.replace(int(numbers[k]), _exact_bend(exact, k, seed))
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
    """Whether c lies to the left of ab, for points rounded to doubles."""
    one = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
    two = (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    size = np.abs(np.concatenate([a, b, c], axis=1)).max(axis=1)
    reach = np.abs(np.concatenate([b - a, c - a], axis=1)).max(axis=1)
    sure: np.ndarray = one - two > 32 * U * (np.abs(one) + np.abs(two) + size * reach)
    return sure


def _exact_bend(exact: Sequence[RationalPoint], number: int, seed: int) -> RationalPoint:
    """A free point beside the side vw, visible from a point on either side of it."""
    v, w, left, right = exact
    on_side = between(v, w, free_number(number, seed + 1))
    t = free_number(number, seed + 2) / 64
    for _ in range(60):
        point = between(on_side, left, t)
        if orientation(w, point, right) > 0 and orientation(point, v, right) > 0:
            return point
        t /= 16
    raise Contradiction("no room for a free point beside a side")


def _along_gaps(arrangement: Arrangement, far: _Far, middles: Ints) -> list[Ints]:
    """The triangles at infinity, between the directions of lines."""
    rows = [
        (one, two, int(middles[arrangement.face[h]]))
        for h in np.flatnonzero(arrangement.gap).tolist()
        for one, two in pairwise(far.chains[-1 - arrangement.heads[h]])
    ]
    return [np.array(rows, dtype=np.int64)]
