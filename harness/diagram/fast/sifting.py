"""Short lists of candidates for the root triangles, from one long list."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.forms import error_factor
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.memory import borrowed, release
from harness.diagram.fast.prune import prune
from harness.diagram.fast.records import grown
from harness.diagram.fast.tables import root_table


@compiled
def new_work(n):
    """Working space for :func:`sift`."""
    return (
        np.empty((n, 9)),
        np.empty((n, 8)),
        (
            np.zeros(4, np.int64),
            np.zeros(n, np.int64),
            np.zeros(n, np.int64),
            np.zeros(n, np.int64),
        ),
        np.full(3, -1),
        np.empty(n, np.int64),
        np.empty(n, np.int64),
    )


@compiled
def borrowed_work(w):
    """What ``new_work`` made, borrowed."""
    tables, norms, work, spots, one, two = w
    return (
        borrowed(tables),
        borrowed(norms),
        (borrowed(work[0]), borrowed(work[1]), borrowed(work[2]), borrowed(work[3])),
        borrowed(spots),
        borrowed(one),
        borrowed(two),
    )


@compiled
def borrowed_world(world):
    """See :data:`harness.diagram.fast.build.World`; borrowed."""
    lines, lengths, classes, tie_first, ties = world
    return (
        borrowed(lines),
        borrowed(lengths),
        borrowed(classes),
        borrowed(tie_first),
        borrowed(ties),
    )


@compiled
def sift(ids, m, corners, weights, far, segments, size, sense, definite, world, w):
    """Keep in ``ids`` (m,) the candidates that no pivot beats all over a triangle; their number."""
    tables, norms, work, spots, _, _ = w
    for a in range(m):
        root_table(segments[ids[a]], corners, weights, 0, 0, size, sense, tables[a], norms[a, 0:2])
    kept, _ = prune(tables, norms, ids, 0, m, error_factor(0), far, definite, work, world, spots)
    return kept


@compiled
def sift_regions(regions, corners, weights, n, segments, size, sense, definite, world):
    """Candidates of each region (triangles of corners), in CSR form; the last is the whole."""
    first = np.zeros(len(regions) + 2, np.int64)
    flat = np.empty(1024, np.int64)
    kept = (np.empty(n, np.int64), np.empty((3, 4)), np.empty(3))
    ids, three, ones = borrowed(kept[0]), borrowed(kept[1]), borrowed(kept[2])
    kept_work = new_work(n)
    w, world, segments = borrowed_work(kept_work), borrowed_world(world), borrowed(segments)
    for r in range(len(regions) + 1):
        for a in range(n):
            ids[a] = a
        left = n
        if r < len(regions):
            far = 0
            for k in range(3):
                three[k] = corners[regions[r, k]]
                ones[k] = weights[regions[r, k]]
                if ones[k] == 0.0:
                    far |= 1 << k
            left = sift(ids, n, three, ones, far, segments, size, sense, definite, world, w)
        flat = grown(flat, first[r] + left)
        flat[first[r] : first[r] + left] = ids[:left]
        first[r + 1] = first[r] + left
    release(kept, kept_work)
    return first, flat[: first[-1]].copy()


@compiled
def _box(points, low, high, size, corners):
    """A rectangle (4 corners, counter-clockwise) along a chord about points low … high."""
    ax, ay = points[low, 0], points[low, 1]
    dx, dy = points[high, 0] - ax, points[high, 1] - ay
    length = np.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        dx, dy, length = 1.0, 0.0, 1.0
    dx, dy = dx / length, dy / length
    least_s = least_t = np.inf
    most_s = most_t = -np.inf
    for k in range(low, high + 1):
        x, y = points[k, 0] - ax, points[k, 1] - ay
        s, t = x * dx + y * dy, y * dx - x * dy
        least_s, most_s = min(least_s, s), max(most_s, s)
        least_t, most_t = min(least_t, t), max(most_t, t)
    slack = 1e-6 * max(most_s - least_s, most_t - least_t) + 1e-12 * size
    least_s, most_s, least_t, most_t = (
        least_s - slack,
        most_s + slack,
        least_t - slack,
        most_t + slack,
    )
    for k in range(4):
        s = least_s if k in (0, 3) else most_s
        t = least_t if k < 2 else most_t
        corners[k, 0], corners[k, 2] = ax + s * dx - t * dy, ay + s * dy + t * dx
        corners[k, 1] = corners[k, 3] = 0.0


@compiled
def sift_kernel(chain, m, n, segments, size, sense, world):
    """Candidates of the root triangles of a kernel, in the order of ``kernel_roots``, in CSR form.

    ``chain`` (2m + 1, 2): the points g_0, c_1, g_1, …, g_m = g_0 of its boundary.  Candidates of a
    chord triangle are those of the rectangle about all that lies beyond its chord, sifted from
    those of the piece it is part of.
    """
    triangles = 2 * m - 2
    owner_first = np.zeros(triangles, np.int64)
    owner_count = np.zeros(triangles, np.int64)
    flat = np.empty(4 * n + 1024, np.int64)
    used = 0
    kept_work = new_work(n)
    w, world, segments = borrowed_work(kept_work), borrowed_world(world), borrowed(segments)
    kept_small = (np.ones(3), np.ones(4), np.empty((4, 4)), np.empty((3, 4)), np.empty(n, np.int64))
    ones, weights, box = borrowed(kept_small[0]), borrowed(kept_small[1]), borrowed(kept_small[2])
    three, ids = borrowed(kept_small[3]), borrowed(kept_small[4])
    # low, high, first and count of the candidates of the piece around it.
    stack = np.empty((4 * m + 16, 4), np.int64)
    for a in range(n):
        flat[a] = a
    used = n
    # The middle triangle takes what a box about everything leaves.
    _box(chain, 0, 2 * m, size, box)
    kept = n
    for a in range(n):
        ids[a] = a
    kept = sift_box(ids, kept, box, weights, three, ones, segments, size, sense, True, world, w)
    flat = grown(flat, used + kept)
    flat[used : used + kept] = ids[:kept]
    first, count = used, kept
    used += kept
    number = m
    owner_first[number], owner_count[number] = first, count
    number += 1
    top = 0
    for low, high in ((0, m // 3), (m // 3, 2 * m // 3), (2 * m // 3, m)):
        stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3] = low, high, first, count
        top += 1
    while top > 0:
        top -= 1
        low, high, first, count = stack[top]
        _box(chain, 2 * low, 2 * high, size, box)
        ids[:count] = flat[first : first + count]
        kept = sift_box(
            ids, count, box, weights, three, ones, segments, size, sense, True, world, w
        )
        flat = grown(flat, used + kept)
        flat[used : used + kept] = ids[:kept]
        first, count = used, kept
        used += kept
        if high - low == 1:
            owner_first[high % m], owner_count[high % m] = first, count
            continue
        owner_first[number], owner_count[number] = first, count
        number += 1
        middle = (low + high) // 2
        stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3] = low, middle, first, count
        stack[top + 1, 0], stack[top + 1, 1] = middle, high
        stack[top + 1, 2], stack[top + 1, 3] = first, count
        top += 2
    release(kept_work, kept_small)
    return owner_first, owner_count, flat[:used].copy()


@compiled
def sift_box(ids, m, box, weights, three, ones, segments, size, sense, definite, world, w):
    """Keep the candidates that may win in one of the halves of a quadrilateral (4, 4), (4,)."""
    if m <= 1:
        return m
    before, both = w[4], w[5]
    before[:m] = ids[:m]
    both[:m] = ids[:m]
    far = _half(box, weights, 1, three, ones)
    one = sift(ids, m, three, ones, far, segments, size, sense, definite, world, w)
    far = _half(box, weights, 2, three, ones)
    two = sift(both, m, three, ones, far, segments, size, sense, definite, world, w)
    if one == m or two == m:
        ids[:m] = before[:m]
        return m
    # Both kept the order; those that one of them kept.
    i = j = kept = 0
    for k in range(m):
        candidate, wanted = before[k], False
        if i < one and ids[i] == candidate:
            i, wanted = i + 1, True
        if j < two and both[j] == candidate:
            j, wanted = j + 1, True
        if wanted:
            before[kept] = candidate
            kept += 1
    ids[:kept] = before[:kept]
    return kept


@compiled
def _half(box, weights, k, three, ones):
    """Corners 0, k, k + 1 of a quadrilateral as a triangle; which of them are at infinity."""
    three[0], three[1], three[2] = box[0], box[k], box[k + 1]
    ones[0], ones[1], ones[2] = weights[0], weights[k], weights[k + 1]
    far = 0
    for corner in range(3):
        if ones[corner] == 0.0:
            far |= 1 << corner
    return far
