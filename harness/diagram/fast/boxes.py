"""Candidates of very many root triangles, by a hierarchy of boxes about neighbouring ones.

Triangles are sorted along a curve that fills the plane (bits of the ranks of their middles,
interleaved).  A *box* holds all triangles of a stretch of that order; its candidates
are sifted from those of the stretch of twice the length.  Triangles at infinity take all segments.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.jit import compiled
from harness.diagram.fast.roots import Floats, Ints
from harness.diagram.fast.sifting import new_work, sift_box
from harness.diagram.fast.subdivide import grown

#: So many triangles share their candidates, and all do if there are so few candidates.
TOGETHER, FEW = 8, 6


def in_curve_order(middles: Floats) -> Ints:
    """The order of points (k, 2) along a curve; O(k log k)."""
    count = len(middles)
    code = np.zeros(count, dtype=np.int64)
    for axis in range(2):
        rank = np.empty(count, dtype=np.int64)
        rank[np.argsort(middles[:, axis], kind="stable")] = np.arange(count)
        for bit in range(int(count).bit_length()):
            code |= (rank >> bit & 1) << (2 * bit + axis)
    order: Ints = np.argsort(code)
    return order


@compiled
def sift_boxes(low, high, n, segments, size, sense, definite, world):
    """Candidates of triangles with boxes ``low``, ``high`` (k, 2), in their order: the first and
    the number of each, and all (the first n are all segments)."""
    count = len(low)
    first, number = np.zeros(count, np.int64), np.zeros(count, np.int64)
    flat = np.empty(4 * n + 1024, np.int64)
    for a in range(n):
        flat[a] = a
    used = n
    ids = np.empty(n, np.int64)
    w = new_work(n)
    ones = np.ones(3)
    box, three = np.zeros((4, 4)), np.empty((3, 4))
    # Where the stretch begins and ends, first and count of the candidates of the one around it.
    stack = np.empty((128, 4), np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0, count, 0, n
    top = 1 if count > 0 else 0
    while top > 0:
        top -= 1
        start, stop, source, m = stack[top]
        _around(low, high, start, stop, size, box)
        ids[:m] = flat[source : source + m]
        kept = sift_box(ids, m, box, three, ones, segments, size, sense, definite, world, w)
        if kept < m:
            flat = grown(flat, used + kept)
            flat[used : used + kept] = ids[:kept]
            source, m = used, kept
            used += kept
        if stop - start <= TOGETHER or m <= FEW:
            first[start:stop], number[start:stop] = source, m
            continue
        middle = (start + stop) // 2
        stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3] = start, middle, source, m
        stack[top + 1, 0], stack[top + 1, 1] = middle, stop
        stack[top + 1, 2], stack[top + 1, 3] = source, m
        top += 2
    return first, number, flat[:used].copy()


@compiled
def _around(low, high, start, stop, size, box):
    """A rectangle (4 corners, counter-clockwise) about some boxes."""
    x0, y0 = low[start, 0], low[start, 1]
    x1, y1 = high[start, 0], high[start, 1]
    for k in range(start, stop):
        x0, y0 = min(x0, low[k, 0]), min(y0, low[k, 1])
        x1, y1 = max(x1, high[k, 0]), max(y1, high[k, 1])
    reach = max(max(abs(x0), abs(x1)), max(abs(y0), abs(y1)))
    slack = 1e-6 * max(x1 - x0, y1 - y0) + 1e-12 * max(size, reach)
    x0, y0, x1, y1 = x0 - slack, y0 - slack, x1 + slack, y1 + slack
    box[0, 0], box[1, 0], box[2, 0], box[3, 0] = x0, x1, x1, x0
    box[0, 2], box[1, 2], box[2, 2], box[3, 2] = y0, y0, y1, y1


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
) -> tuple[Ints, Ints, Ints]:
    """Candidates of root triangles (r, 3): first, number, and all of them."""
    finite = np.flatnonzero(weights[triangles].all(axis=1))
    at = coordinates[triangles[finite]][:, :, [0, 2]]
    low, high = at.min(axis=1), at.max(axis=1)
    order = in_curve_order(low + high)
    some_first, some_number, flat = sift_boxes(
        low[order], high[order], n, segments, size, sense, definite, world
    )
    first = np.zeros(len(triangles), dtype=np.int64)
    number = np.full(len(triangles), n, dtype=np.int64)
    first[finite[order]], number[finite[order]] = some_first, some_number
    return first, number, flat
