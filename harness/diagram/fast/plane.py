"""Root triangles from a triangulation of endpoints: of the plane, and of any polygon."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from fractions import Fraction
from functools import cmp_to_key
from itertools import pairwise
from typing import Any

import numpy as np

from harness.diagram.fast.roots import (
    Corners,
    Floats,
    Roots,
    between,
    free_number,
    free_wall_point,
    rounded_about,
)
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction
from harness.geometry.instance import Instance
from harness.geometry.predicates import orientation


def clipped_ears(points: list[RationalPoint]) -> list[tuple[int, int, int]]:
    """A triangulation of a simple polygon by its vertices: O(n²) to O(n³), for few vertices."""
    left = list(range(len(points)))
    triangles = []
    while len(left) > 3:
        for at in range(len(left)):
            a, b, c = left[at - 1], left[at], left[(at + 1) % len(left)]
            pa, pb, pc = points[a], points[b], points[c]
            if orientation(pa, pb, pc) > 0 and not any(
                _in_triangle(points[p], pa, pb, pc) for p in left if p not in (a, b, c)
            ):
                triangles.append((a, b, c))
                del left[at]
                break
        else:
            # Only flat corners are left between others: they cannot be cut off as triangles.
            raise Contradiction("the polygon has no ear")
    triangles.append((left[0], left[1], left[2]))
    return triangles


def with_points(
    points: list[RationalPoint],
    triangles: list[tuple[int, int, int]],
    more: Iterable[RationalPoint],
) -> list[tuple[int, int, int]]:
    """A triangulation of ``points`` with more points inside, which are appended to ``points``.

    O(triangles) for each.
    """
    for p in more:
        points.append(p)
        triangles = with_corner(points, triangles, len(points) - 1)
    return triangles


def with_corner(
    points: list[RationalPoint], triangles: list[tuple[int, int, int]], new: int
) -> list[tuple[int, int, int]]:
    """A triangulation with one more of the points as a corner, which lies inside."""
    p, result = points[new], []
    for a, b, c in triangles:
        if not _in_triangle(p, points[a], points[b], points[c]):
            result.append((a, b, c))
            continue
        for x, y in ((a, b), (b, c), (c, a)):
            if orientation(points[x], points[y], p) > 0:  # else p lies on that side
                result.append((x, y, new))
    return result


def _in_triangle(p: RationalPoint, a: RationalPoint, b: RationalPoint, c: RationalPoint) -> bool:
    """Whether p lies in a closed counter-clockwise triangle."""
    return orientation(a, b, p) >= 0 and orientation(b, c, p) >= 0 and orientation(c, a, p) >= 0


def refined(
    points: list[RationalPoint],
    incident: list[list[int]],
    triangles: list[tuple[int, int, int]],
    walls: dict[tuple[int, int], int],
    seed: int,
    free: frozenset[int] = frozenset(),
) -> Roots:
    """A triangulation in which no two of the given points (but along walls) are neighbours.

    All points are special but those numbered in ``free``.  Every triangle gets a free point, every
    side that is no wall a free point close to it, on the line from its middle to the free point of
    one of its triangles.
    """
    corners = Corners()
    for point, row in zip(points, incident, strict=True):
        corners.add(point, row, special=len(corners.exact) not in free)
    middles = []
    for t, (a, b, c) in enumerate(triangles):
        u, v = free_number(3 * t, seed), free_number(3 * t + 1, seed)
        on_side = between(points[a], points[b], u)
        x, y = between(on_side, points[c], v * Fraction(2, 3))
        rounded = rounded_about((x, y), points[0])
        inside = _strictly_in(rounded, points[a], points[b], points[c])
        middles.append(corners.add(rounded if inside else (x, y)))
    across: defaultdict[frozenset[int], list[int]] = defaultdict(list)
    for t, corner in enumerate(triangles):
        for k in range(3):
            across[frozenset((corner[k], corner[(k + 1) % 3]))].append(t)
    bend: dict[frozenset[int], int] = {}
    result, region_of = [], []
    pieces: dict[tuple[int, int], int] = {}
    for t, corner in enumerate(triangles):
        for k in range(3):
            a, b = corner[k], corner[(k + 1) % 3]
            side = frozenset((a, b))
            if (a, b) in walls:
                on_wall = free_wall_point(corners, a, b, a, seed)
                result += [(middles[t], a, on_wall), (middles[t], on_wall, b)]
                pieces[a, on_wall] = pieces[on_wall, b] = walls[a, b]
                region_of += [t, t]
                continue
            if len(across[side]) == 1 or a in free or b in free:
                result.append((middles[t], a, b))
                region_of.append(t)
                continue
            if side not in bend:
                # The first triangle at the side is this one, so it is on the left of ab.
                left, right = (corners.exact[middles[other]] for other in across[side][:2])
                point = beside(points[a], points[b], left, right, len(bend), seed)
                bend[side] = corners.add(point)
            result += [(middles[t], a, bend[side]), (middles[t], bend[side], b)]
            # The free point beside the side may lie outside this triangle.
            region_of += [-1 if across[side][0] != t else t] * 2
    regions = np.array(triangles, dtype=np.int64)
    return Roots(corners, np.array(result, dtype=np.int64), pieces, regions, np.array(region_of))


def _strictly_in(p: RationalPoint, a: RationalPoint, b: RationalPoint, c: RationalPoint) -> bool:
    return orientation(a, b, p) > 0 and orientation(b, c, p) > 0 and orientation(c, a, p) > 0


def beside(
    v: RationalPoint,
    w: RationalPoint,
    left: RationalPoint,
    right: RationalPoint,
    number: int,
    seed: int,
) -> RationalPoint:
    """A free point beside vw on its left side, visible from a point on either side.

    It lies on the way from an inner point of vw to ``left``, and so near to vw that the turns at
    v and w as seen from ``right`` are still to the left.
    """
    on_side = between(v, w, free_number(number, seed + 1))
    t = free_number(number, seed + 2) / 64
    for _ in range(60):
        point = between(on_side, left, t)
        if orientation(w, point, right) > 0 and orientation(point, v, right) > 0:
            return point
        t /= 16
    raise Contradiction("no room for a free point beside a side")


def plane_roots(
    instance: Instance,
    seed: int,
    hubs: Iterable[RationalPoint] = (),
    directions: Iterable[RationalPoint] = (),
) -> Roots:
    """Roots of the whole plane; ``hubs`` and ``directions`` become special corners."""
    from scipy.spatial import Delaunay

    segments = instance.rational_segments()
    points = list(dict.fromkeys([*(point for segment in segments for point in segment), *hubs]))
    origin = points[0]
    floats = np.array([[float(x - origin[0]), float(y - origin[1])] for x, y in points])
    centre = (floats.min(axis=0) + floats.max(axis=0)) / 2
    reach = float(np.ptp(floats, axis=0).max())
    turn = 0.3 + 0.7 * float(free_number(1, seed))
    corners_far = [
        (
            origin[0] + Fraction(float(centre[0] + 6 * reach * np.cos(turn + 2 * np.pi * k / 3))),
            origin[1] + Fraction(float(centre[1] + 6 * reach * np.sin(turn + 2 * np.pi * k / 3))),
        )
        for k in range(3)
    ]
    incident = [*incidences(instance, points), [], [], []]
    points += corners_far
    floats = np.concatenate(
        [floats, [[float(x - origin[0]), float(y - origin[1])] for x, y in corners_far]]
    )
    simplices = Delaunay((floats - centre) / reach).simplices
    triangles = []
    for a, b, c in simplices.tolist():
        turn_sign = orientation(points[a], points[b], points[c])
        if turn_sign == 0:
            raise Contradiction("the triangulation of the endpoints is degenerate")
        triangles.append((a, b, c) if turn_sign > 0 else (a, c, b))
    n = len(points)
    # Points that doubles do not tell apart are no corners yet.
    for missing in sorted(set(range(n)) - set(simplices.ravel().tolist())):
        triangles = with_corner(points, triangles, missing)
    inner = refined(points, incident, triangles, {}, seed, frozenset((n - 3, n - 2, n - 1)))
    outermost: list[RationalPoint] = [
        (Fraction(float(x - centre[0])), Fraction(float(y - centre[1]))) for x, y in floats[-3:]
    ]
    outer = []
    marked = parallel_directions(instance)
    parallel = [d for d, _ in marked]
    for direction in directions:
        if not any(same_direction(direction, d) for d in parallel):
            parallel.append(direction)
            marked.append((direction, []))
    ends = [inner.corners.add(d, weight=0.0) for d in outermost]
    for k in range(3):
        a, b = n - 3 + k, n - 3 + (k + 1) % 3
        low, high = outermost[k], outermost[(k + 1) % 3]
        between_them = [(d, row) for d, row in marked if turns_left(low, d) and turns_left(d, high)]
        between_them.sort(key=lambda one: turn_key(one[0]))
        chain = [ends[k]]
        for direction, row in between_them:
            if inner.corners.special[chain[-1]]:
                last = inner.corners.exact[chain[-1]]
                chain.append(inner.corners.add(_free_direction(last, direction, seed), weight=0.0))
            chain.append(inner.corners.add(direction, row, weight=0.0, special=True))
        chain.append(ends[(k + 1) % 3])
        outer.append((b, a, chain[0]))
        outer += [(b, d, e) for d, e in pairwise(chain)]
    return Roots(
        inner.corners,
        np.concatenate([inner.triangles, outer]),
        {},
        inner.regions,
        np.concatenate([inner.region_of, np.full(len(outer), -1)]),
    )


#: Points and segments are looked at in one table while it has at most so many entries.
LARGEST_TABLE = 4_000_000


def incidences(instance: Instance, points: list[RationalPoint]) -> list[list[int]]:
    """For every point the segments that end there, 2·segment + 1, and those whose line passes
    through it, 2·segment; of very many points and segments the former only.

    O(points · segments) in doubles, exact where these leave it open.
    """
    if len(points) * instance.n > LARGEST_TABLE:
        ending: dict[RationalPoint, list[int]] = {point: [] for point in points}
        for k, segment in enumerate(instance.rational_segments()):
            for point in segment:
                if point in ending:
                    ending[point].append(2 * k + 1)
        return [sorted(ending[point]) for point in points]
    rows: list[list[int]] = [[] for _ in points]
    for number, k in _near_lines(instance, points).tolist():
        a, b = instance.rational_segment(k)
        if points[number] in (a, b):
            rows[number].append(2 * k + 1)
        elif orientation(a, b, points[number]) == 0:
            rows[number].append(2 * k)
    return [sorted(row) for row in rows]


def _near_lines(instance: Instance, points: list[RationalPoint]) -> Any:
    """Pairs (point, segment) of which the point may be on the segment's line, (k, 2)."""
    origin = points[0]
    p = np.array([_about(point, origin) for point in points])
    ends = _ends_about(instance, origin)
    d = ends[:, 1] - ends[:, 0]
    to_a = ends[None, :, 0] - p[:, None]
    across = np.abs(to_a[..., 0] * d[:, 1] - to_a[..., 1] * d[:, 0])
    reach = np.abs(ends).max() + np.abs(p).max()
    return np.argwhere(across <= 1e-9 * reach * np.abs(d).sum(axis=1))


def _about(point: RationalPoint, origin: RationalPoint) -> list[float]:
    return [float(point[0] - origin[0]), float(point[1] - origin[1])]


def are_coarse(points: Floats) -> bool:
    """Whether rounding moves points (k, 2) by more than 1e-14 of their spread, so that differences
    must be taken before."""
    return bool(np.spacing(np.abs(points).max()) > 1e-14 * np.ptp(points, axis=0).max())


def _ends_about(instance: Instance, origin: RationalPoint) -> Floats:
    """The endpoints (n, 2, 2) about a point, with errors far below 1e-9 of their spread."""
    ends = instance.segments
    if not are_coarse(ends.reshape(-1, 2)):
        about: Floats = ends - np.array([float(c) for c in origin])
        return about
    exact = instance.rational_segments()
    return np.array([[_about(point, origin) for point in segment] for segment in exact])


def same_direction(d: RationalPoint, e: RationalPoint) -> bool:
    """Whether two vectors differ only in length."""
    return d[0] * e[1] == d[1] * e[0] and d[0] * e[0] + d[1] * e[1] > 0


def turns_left(d: RationalPoint, e: RationalPoint) -> bool:
    """Whether direction e lies less than half a turn to the left of direction d."""
    return d[0] * e[1] - d[1] * e[0] > 0


@cmp_to_key
def turn_key(d: RationalPoint, e: RationalPoint) -> int:
    """The key to sort different directions within less than half a turn, counter-clockwise."""
    return -1 if turns_left(d, e) else 1


def parallel_directions(instance: Instance) -> list[tuple[RationalPoint, list[int]]]:
    """Both directions of every family of parallel segments, with 2·segment for its members.

    There the lines of all members meet, at infinity.
    """
    families: defaultdict[Fraction | None, list[int]] = defaultdict(list)
    vectors = []
    for k, (a, b) in enumerate(instance.rational_segments()):
        dx, dy = b[0] - a[0], b[1] - a[1]
        vectors.append((dx, dy))
        families[dy / dx if dx else None].append(k)
    result = []
    for members in families.values():
        if len(members) > 1:
            dx, dy = vectors[members[0]]
            row = [2 * k for k in members]
            result += [((dx, dy), row), ((-dx, -dy), row)]
    return result


def _free_direction(d: RationalPoint, e: RationalPoint, seed: int) -> RationalPoint:
    """A free direction between two, in doubles."""
    (dx, dy), (ex, ey) = ((float(v[0]), float(v[1])) for v in (d, e))
    t = float(free_number(5, seed)) / np.hypot(ex, ey)
    s = float(1 - free_number(5, seed)) / np.hypot(dx, dy)
    free = (Fraction(float(s * dx + t * ex)), Fraction(float(s * dy + t * ey)))
    if not (turns_left(d, free) and turns_left(free, e)):
        raise Contradiction("no room for a free direction")
    return free
