"""Candidates of very many root triangles, by a hierarchy of boxes about neighbouring ones.

Far from everything triangles are long and point outwards, so boxes are made in *charts*: the plane
itself, and, where |x| ≤ 4|y| and |y| is large, the projective coordinates x/y and 1/y, likewise
with x and y exchanged.  There a box is a quadrilateral of the plane, perhaps with corners at
infinity.

In each chart a box about some triangles is divided across the axis along which it holds most of
them, so that both halves have the same number; their candidates are sifted from its own.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from harness.diagram.fast.jit import compiled
from harness.diagram.fast.memory import borrowed, release
from harness.diagram.fast.records import grown
from harness.diagram.fast.roots import Floats, Ints
from harness.diagram.fast.sifting import borrowed_work, borrowed_world, new_work, sift_box

#: So many triangles share their candidates, and all do if there are so few candidates.
TOGETHER, FEW = 16, 6
#: A chart is sifted in so many parts, on several threads.
PARTS = 32
#: A box is made larger by so much, against its coordinates, for roundings.
ROUNDING = 2.0**-48
#: The plane's own chart reaches so far, against the size of all segments.
NEAR = 2.0
#: Charts: the axis that is divided by, and its sign; the plane itself comes last.
OUTER = ((0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0))
PLANE = len(OUTER)


@compiled
def sift_boxes(points, index, axis, sign, n, segments, size, sense, definite, world):
    """Candidates of the triangles ``index`` (k,) of ``points`` (r, 3, 2) in a chart.

    Reorders ``index``.  Returns the first and the number of the candidates of each, in the new
    order, and all candidates (the first n are all segments).
    """
    count = len(index)
    first, number = np.zeros(count, np.int64), np.zeros(count, np.int64)
    flat = np.empty(4 * n + 1024, np.int64)
    for a in range(n):
        flat[a] = a
    used = n
    kept_work = new_work(n)
    w, world, segments = borrowed_work(kept_work), borrowed_world(world), borrowed(segments)
    kept_small = (np.ones(3), np.ones(4), np.zeros((4, 4)), np.empty((3, 4)), np.empty(n, np.int64))
    ones, weights, box = borrowed(kept_small[0]), borrowed(kept_small[1]), borrowed(kept_small[2])
    three, ids = borrowed(kept_small[3]), borrowed(kept_small[4])
    kept_keys = np.empty(count)
    points, index, keys = borrowed(points), borrowed(index), borrowed(kept_keys)
    # Where the stretch begins and ends, first and count of the candidates of the one around it.
    stack = np.empty((128, 4), np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0, count, 0, n
    top = 1 if count > 0 else 0
    while top > 0:
        top -= 1
        start, stop, source, m = stack[top]
        _around(points, index[start:stop], axis, sign, box, weights)
        ids[:m] = flat[source : source + m]
        kept = sift_box(
            ids, m, box, weights, three, ones, segments, size, sense, definite, world, w
        )
        if kept < m:
            flat = grown(flat, used + kept)
            flat[used : used + kept] = ids[:kept]
            source, m = used, kept
            used += kept
        if stop - start <= TOGETHER or m <= FEW:
            first[start:stop], number[start:stop] = source, m
            continue
        divide(points, index[start:stop], keys[start:stop])
        middle = (start + stop) // 2
        stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3] = start, middle, source, m
        stack[top + 1, 0], stack[top + 1, 1] = middle, stop
        stack[top + 1, 2], stack[top + 1, 3] = source, m
        top += 2
    release(kept_work, kept_small, kept_keys)
    return first, number, flat[:used].copy()


@compiled
def divide(points, index, keys):
    """Reorder some triangles so that the first half of them lies before the second half along the
    axis, of the main direction and its normal, along which there are most."""
    ux, uy = _main_direction(points, index)
    best, along = -1.0, 0
    for axis in range(2):
        vx, vy = (ux, uy) if axis == 0 else (-uy, ux)
        low, high, lengths = np.inf, -np.inf, 0.0
        for k in range(len(index)):
            a, b = _extent(points[index[k]], vx, vy)
            low, high = min(low, a + b), max(high, a + b)
            lengths += b - a
        if high - low > best * lengths:
            best, along = (high - low) / max(lengths, 1e-300), axis
    vx, vy = (ux, uy) if along == 0 else (-uy, ux)
    for k in range(len(index)):
        a, b = _extent(points[index[k]], vx, vy)
        keys[k] = a + b
    _select(keys, index, len(index) // 2)


@compiled
def _extent(triangle, vx, vy):
    """The range of a triangle along a vector."""
    a = triangle[0, 0] * vx + triangle[0, 1] * vy
    b = triangle[1, 0] * vx + triangle[1, 1] * vy
    c = triangle[2, 0] * vx + triangle[2, 1] * vy
    return min(a, b, c), max(a, b, c)


@compiled
def _select(keys, index, wanted):
    """Reorder so that no key before ``wanted`` is greater than any after it (quickselect)."""
    low, high = 0, len(keys) - 1
    while low < high:
        pivot = keys[(low + high) // 2]
        i, j = low, high
        while i <= j:
            while keys[i] < pivot:
                i += 1
            while keys[j] > pivot:
                j -= 1
            if i <= j:
                keys[i], keys[j] = keys[j], keys[i]
                index[i], index[j] = index[j], index[i]
                i, j = i + 1, j - 1
        if wanted <= j:
            high = j
        elif wanted >= i:
            low = i
        else:
            return


@compiled
def _around(points, index, axis, sign, box, weights):
    """A quadrilateral of the plane (corners in order, and their weights) about some triangles.

    In the chart it is a rectangle along the longest sides of the triangles, unless that would reach
    beyond infinity; then along the axes, and if need be down to infinity.

    It is larger than the triangles by a bound on all roundings.  With u = 2⁻⁵³ and the greatest
    values P of |s·ux| + |t·uy| and Q of |t·ux| + |s·uy|, a coordinate p is off by at most 3uP (its
    computation), 4uP (corners are rounded, and divided in an outer chart), 6uP (ux² + uy² is 1 up
    to 3u), 6uP (the way back to s and t) and 2uP (that to the plane), likewise q with Q: less than
    2⁻⁴⁸P and 2⁻⁴⁸Q.  Along the axes uy is 0, so there the rounding of t does not depend on s,
    which may be very much larger.
    """
    ux, uy = _main_direction(points, index)
    for turn in range(2):
        if turn == 1:
            ux, uy = 1.0, 0.0
        p0 = q0 = np.inf
        p1 = q1 = -np.inf
        most_p = most_q = 0.0
        for k in index:
            for c in range(3):
                s, t = points[k, c, 0], points[k, c, 1]
                p, q = s * ux + t * uy, t * ux - s * uy
                p0, p1 = min(p0, p), max(p1, p)
                q0, q1 = min(q0, q), max(q1, q)
                most_p = max(most_p, abs(s * ux) + abs(t * uy))
                most_q = max(most_q, abs(t * ux) + abs(s * uy))
        slack = 1e-6 * (p1 - p0) + ROUNDING * most_p
        p0, p1 = p0 - slack, p1 + slack
        slack = 1e-6 * (q1 - q0) + ROUNDING * most_q
        q0, q1 = q0 - slack, q1 + slack
        if sign == 0.0:
            least = -np.inf
        elif turn == 0:  # a turned box must stay well away from infinity
            least = 1e-9 * (abs(p0) + abs(p1) + abs(q0) + abs(q1))
        else:  # t is q: the far side of the box may be at infinity, never the near one
            least = 1e-9 * q1
        beyond = False
        for k in range(4):
            p = p0 if k in (0, 3) else p1
            q = q0 if k < 2 else q1
            s, t = p * ux - q * uy, p * uy + q * ux
            weights[k] = 1.0
            if sign == 0.0:
                box[k, 0], box[k, 2] = s, t
            elif t > least:
                box[k, 2 * axis], box[k, 2 - 2 * axis] = 1.0 / t * sign, s / t * sign
            else:
                beyond = True
                weights[k] = 0.0
                box[k, 2 * axis], box[k, 2 - 2 * axis] = sign, s * sign
        if not beyond:
            break


@compiled
def _main_direction(points, index):
    """About the direction of the longest sides of some triangles, as a unit vector."""
    ux = uy = 0.0
    for k in index:
        longest = bx = by = 0.0
        for c in range(3):
            x = points[k, c, 0] - points[k, c - 1, 0]
            y = points[k, c, 1] - points[k, c - 1, 1]
            if x * x + y * y > longest:
                longest, bx, by = x * x + y * y, x, y
        if bx * ux + by * uy < 0.0:
            bx, by = -bx, -by
        ux, uy = ux + bx, uy + by
    length = np.sqrt(ux * ux + uy * uy)
    if length > 0.0:
        return ux / length, uy / length
    return 1.0, 0.0


def _in_chart(points: Floats, weights: Floats, axis: int, sign: float) -> Floats:
    """Homogeneous points (k, 3, 2), (k, 3) in an outer chart: (other axis, weight)/axis."""
    with np.errstate(all="ignore"):
        along = points[:, :, axis] * sign
        return np.stack([points[:, :, 1 - axis] * sign / along, weights / along], axis=2)


def _charts(points: Floats, weights: Floats, size: float) -> Ints:
    """A chart for every triangle."""
    chart = np.full(len(points), PLANE)
    far = (np.abs(points).max(axis=(1, 2)) > NEAR * size) | (weights == 0).any(axis=1)
    for number, (axis, sign) in enumerate(OUTER):
        along, across = points[:, :, axis] * sign, np.abs(points[:, :, 1 - axis])
        inside = ((along > 0.25 * size * weights) & (along > 0.25 * across)).all(axis=1)
        chart[far & inside & (chart == PLANE)] = number
    return chart


def sift_triangles(
    triangles: Ints,
    coordinates: Floats,
    weights: Floats,
    n: int,
    segments: Floats,
    size: float,
    sense: float,
    definite: bool,
    world: tuple[Ints, Floats, Ints, Ints, Ints],
    workers: int,
) -> tuple[Ints, Ints, Ints]:
    """Candidates of root triangles (r, 3): first, number, and all of them.

    The result does not depend on the number of ``workers``.
    """
    points, w = coordinates[triangles][:, :, [0, 2]], weights[triangles]
    chart = _charts(points, w, size)
    # What is in no chart takes all segments.
    chart[(chart == PLANE) & (w == 0).any(axis=1)] = -1
    jobs = []
    for number in range(PLANE + 1):
        rows = np.flatnonzero(chart == number)
        if not len(rows):
            continue
        axis, sign = OUTER[number] if number < PLANE else (0, 0.0)
        at = points[rows] if number == PLANE else _in_chart(points[rows], w[rows], axis, sign)
        index = np.arange(len(rows))
        keys = np.empty(len(rows))
        stretches = [index]
        while len(stretches) < PARTS and len(stretches[0]) > 4 * TOGETHER:
            for stretch in stretches:
                divide(at, stretch, keys[: len(stretch)])
            stretches = [half for x in stretches for half in (x[: len(x) // 2], x[len(x) // 2 :])]
        jobs += [(rows, at, stretch, axis, sign) for stretch in stretches]

    def run(job: Any) -> Any:
        return sift_boxes(*job[1:], n, segments, size, sense, definite, world)

    with ThreadPoolExecutor(workers) as pool:
        found = list(pool.map(run, jobs))
    first = np.zeros(len(triangles), dtype=np.int64)
    count = np.full(len(triangles), n, dtype=np.int64)
    start, lists = n, [np.arange(n)]
    for job, (some_first, some_count, flat) in zip(jobs, found, strict=True):
        roots = job[0][job[2]]
        first[roots], count[roots] = some_first + start, some_count
        start += len(flat)
        lists.append(flat)
    return first, count, np.concatenate(lists)
