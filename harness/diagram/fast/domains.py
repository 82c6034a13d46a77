"""Root triangles of the three domains; see :mod:`harness.diagram.fast.roots`."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import partial

import numpy as np

from harness.diagram.fast.plane import (
    LARGEST_TABLE,
    are_coarse,
    clipped_ears,
    incidences,
    refined,
    with_points,
)
from harness.diagram.fast.roots import (
    Corners,
    Roots,
    between,
    free_number,
    free_wall_point,
    rounded_about,
)
from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance
from harness.geometry.kernel import Kernel
from harness.geometry.predicates import orientation


def kernel_roots(
    instance: Instance, kernel: Kernel, seed: int, hubs: Sequence[RationalPoint] = ()
) -> tuple[Roots, list[tuple[int, int]]]:
    """Roots of a kernel with m sides, and the *spans* of the chord triangles.

    ``hubs`` inside become special corners, and then there are no spans.  Otherwise the triangles
    0 … m − 1 cut off the corners; triangle m + k has the span ``spans[k]``: all of
    it lies beyond the chord from g_i to g_j, for i < j < i + m.
    """
    corners, m = Corners(), len(kernel.sides)
    flat = _flat_points(instance, kernel)
    if flat or hubs:
        return _kernel_with_points(instance, kernel, flat, hubs, seed)
    ends = _endpoint_numbers(instance, kernel)
    for k, point in enumerate(kernel.corners):
        corners.add(point, ends[k], special=True)
    for k in range(m):
        a, b = kernel.corners[k], kernel.corners[(k + 1) % m]
        corners.add(between(a, b, free_number(k, seed)), [2 * kernel.sides[k]])
    triangles = [(m + (k - 1) % m, k, m + k) for k in range(m)]
    walls = {}
    for k in range(m):
        walls[k, m + k] = k
        walls[m + (k - 1) % m, k] = (k - 1) % m
    spans: list[tuple[int, int]] = []
    third, two_thirds = m // 3, 2 * m // 3
    triangles.append((m, m + third, m + two_thirds))
    spans.append((0, m))
    todo = [(0, third), (third, two_thirds), (two_thirds, m)]
    while todo:
        low, high = todo.pop()
        if high - low >= 2:
            middle = (low + high) // 2
            triangles.append((m + low % m, m + middle % m, m + high % m))
            spans.append((low, high))
            todo += [(low, middle), (middle, high)]
    return _roots(corners, triangles, walls), spans


def _roots(
    corners: Corners, triangles: list[tuple[int, int, int]], walls: dict[tuple[int, int], int]
) -> Roots:
    """Roots that are not sifted in regions."""
    none = np.zeros((0, 3), dtype=np.int64)
    unsifted = np.full(len(triangles), -1, dtype=np.int64)
    return Roots(corners, np.array(triangles, dtype=np.int64), walls, none, unsifted)


def _endpoint_numbers(instance: Instance, kernel: Kernel) -> list[list[int]]:
    """For every corner of the kernel the segments whose lines meet there.

    Of very large polygons only the two that bound the kernel.
    """
    if len(kernel.corners) * instance.n <= LARGEST_TABLE:
        return incidences(instance, kernel.corners)
    rows = []
    for k, corner in enumerate(kernel.corners):
        row = []
        for edge in (kernel.sides[k - 1], kernel.sides[k]):
            row.append(2 * edge + (corner in instance.rational_segment(edge)))
        rows.append(row)
    return rows


def _flat_points(instance: Instance, kernel: Kernel) -> dict[int, list[RationalPoint]]:
    """The polygon's vertices strictly inside sides of its kernel, in order along each side.

    There are some only if several edges lie on one line.  Candidates are found in doubles, with
    differences off by less than 2e-14·size.  Such a vertex is no farther from a corner than the
    side is long: so both products are off by less than 1e-13·size·length, or, of a side shorter
    than 1e-10·size, are less than 1e-9·size·length themselves.
    """
    vertices, ends = instance.floats, kernel.floats
    size = float(np.ptp(vertices, axis=0).max())
    if are_coarse(vertices):
        x0, y0 = kernel.corners[0]
        exact = [instance.exact_vertex(k) for k in range(instance.n)]
        vertices = np.array([[float(x - x0), float(y - y0)] for x, y in exact])
        ends = np.array([[float(x - x0), float(y - y0)] for x, y in kernel.corners])
    found: dict[int, list[RationalPoint]] = {}
    m = len(kernel.sides)
    for k in range(m):
        a, d = ends[k], ends[(k + 1) % m] - ends[k]
        length = float(np.hypot(*d))
        offset = vertices - a
        across = np.abs(offset[:, 0] * d[1] - offset[:, 1] * d[0])
        along = offset @ d
        near = np.flatnonzero(
            (across <= 1e-9 * size * length)
            & (along >= -1e-9 * size * length)
            & (along <= length * length + 1e-9 * size * length)
        )
        inside = [
            p
            for p in map(instance.exact_vertex, near.tolist())
            if _strictly_inside(kernel.corners[k], kernel.corners[(k + 1) % m], p)
        ]
        if inside:
            found[k] = sorted(inside, key=partial(_distance, kernel.corners[k]))
    return found


def _distance(start: RationalPoint, p: RationalPoint) -> Fraction:
    return abs(p[0] - start[0]) + abs(p[1] - start[1])


def _strictly_inside(a: RationalPoint, b: RationalPoint, p: RationalPoint) -> bool:
    """Whether p lies in the open segment ab."""
    if p in (a, b) or orientation(a, b, p) != 0:
        return False
    return min(a, b) < p < max(a, b)


def _kernel_with_points(
    instance: Instance,
    kernel: Kernel,
    flat: dict[int, list[RationalPoint]],
    hubs: Sequence[RationalPoint],
    seed: int,
) -> tuple[Roots, list[tuple[int, int]]]:
    """The kernel as a fan if vertices of the polygon lie inside its sides; with hubs triangulated
    and refined."""
    points: list[RationalPoint] = []
    wall: list[int] = []
    for k, corner in enumerate(kernel.corners):
        for point in (corner, *flat.get(k, ())):
            points.append(point)
            wall.append(k)
    incident = incidences(instance, points)
    if hubs:
        return _with_hubs(instance, points, incident, wall, hubs, seed), []
    return fan(points, incident, wall, free_point(kernel.corners, seed), seed), []


def _with_hubs(
    instance: Instance,
    points: list[RationalPoint],
    incident: list[list[int]],
    wall: list[int],
    hubs: Sequence[RationalPoint],
    seed: int,
) -> Roots:
    """Roots of a polygon, given with what :func:`fan` takes, with special corners inside."""
    n = len(points)
    around = list(points)
    triangles = with_points(around, clipped_ears(points), hubs)
    rows = incident + incidences(instance, list(hubs))
    walls = {(k, (k + 1) % n): wall[k] for k in range(n)}
    return refined(around, rows, triangles, walls, seed)


def free_point(corners: list[RationalPoint], seed: int) -> RationalPoint:
    """A free point of a convex polygon, near the middle: a rounded mean with free weights."""
    m = len(corners)
    weights = [Fraction(1) + free_number(k, seed) / 8 for k in range(m)]
    x = sum((w * c[0] for w, c in zip(weights, corners, strict=True)), Fraction(0)) / sum(weights)
    y = sum((w * c[1] for w, c in zip(weights, corners, strict=True)), Fraction(0)) / sum(weights)
    rounded = rounded_about((x, y), corners[0])
    inside = all(orientation(corners[k - 1], corners[k], rounded) > 0 for k in range(m))
    return rounded if inside else (x, y)


def fan(
    points: list[RationalPoint],
    incident: list[list[int]],
    wall: list[int],
    centre: RationalPoint,
    seed: int,
) -> Roots:
    """The triangles from a point to the sides of a polygon that is star-shaped about it."""
    corners, n = Corners(), len(points)
    for point, row in zip(points, incident, strict=True):
        corners.add(point, row, special=True)
    middle = corners.add(centre)
    triangles, walls = [], {}
    for k in range(n):
        following = (k + 1) % n
        free = free_wall_point(corners, k, following, k, seed)
        triangles += [(middle, k, free), (middle, free, following)]
        walls[k, free] = walls[free, following] = wall[k]
    return _roots(corners, triangles, walls)


def interior_roots(
    instance: Instance, kernel: Kernel, seed: int, hubs: Sequence[RationalPoint] = ()
) -> Roots:
    """Roots of the interior of a polygon; ``hubs`` inside become special corners."""
    n = instance.n
    order = range(n) if instance.orientation > 0 else range(n - 1, -1, -1)
    points = [instance.exact_vertex(k) for k in order]
    incident = incidences(instance, points)
    wall = list(range(n))
    if hubs:
        return _with_hubs(instance, points, incident, wall, hubs, seed)
    if kernel.has_interior:
        return fan(points, incident, wall, free_point(kernel.corners, seed), seed)
    return refined(
        points, incident, clipped_ears(points), {(k, (k + 1) % n): k for k in wall}, seed
    )
