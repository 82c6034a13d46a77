"""Changes of connectivity: flips that even out the degrees, and flips that are tried out.

A flip alone often makes angles worse, and the mesh better once the vertices around have moved.
So a step here is a flip *and* the smoothing of the patch around it; it is kept only if the sorted
vector of the least angles of the patch's triangles rises in lexicographic order, and undone else.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.mesh.angles import star_least, triangle_least
from harness.mesh.edges import can_flip, flip
from harness.mesh.patches import gather, smooth_patch
from harness.mesh.queue import filled, pop, put

RADIUS, ROUNDS = 3, 10
SHARP = 40.0, 300.0
GAIN = 1e-5
"""Radians by which the first angle that changes must rise."""
TRIED = 6
"""Flips tried for one vertex: those that even out the degrees most."""


@compiled
def ideal_degrees(offsets, degrees, ring, closed, x, y):
    """The number of neighbours that each vertex should have: one triangle for every 60°."""
    ideal = np.full(len(degrees), 6)
    for v in range(len(degrees)):
        if closed[v] or degrees[v] < 2:
            continue
        turn = 0.0
        for i in range(offsets[v], offsets[v] + degrees[v] - 1):
            ux, uy = x[ring[i]] - x[v], y[ring[i]] - y[v]
            wx, wy = x[ring[i + 1]] - x[v], y[ring[i + 1]] - y[v]
            turn += np.arctan2(ux * wy - uy * wx, ux * wx + uy * wy)
        ideal[v] = max(1, round(turn * 3.0 / np.pi)) + 1
    return ideal


@compiled
def evens(v, w, a, b, degrees, ideal):
    """By how much the sum of squares of (degree − ideal) falls if v–w becomes a–b."""
    return 2 * (
        (degrees[v] - ideal[v])
        + (degrees[w] - ideal[w])
        - (degrees[a] - ideal[a])
        - (degrees[b] - ideal[b])
        - 2
    )


@compiled
def raises(v, w, a, b, x, y):
    """By how much the least of the six angles at an edge v–w rises if it becomes a–b, radians."""
    before = min(
        triangle_least(x[v], y[v], x[w], y[w], x[a], y[a]),
        triangle_least(x[v], y[v], x[b], y[b], x[w], y[w]),
    )
    after = min(
        triangle_least(x[v], y[v], x[b], y[b], x[a], y[a]),
        triangle_least(x[w], y[w], x[a], y[a], x[b], y[b]),
    )
    return after - before


@compiled
def even_out(offsets, degrees, ring, closed, x, y, ideal, floor):
    """Flip wherever that evens out the degrees; how many flips.

    No new triangle gets an angle below ``floor`` (radians).  The sum of squares falls with every
    flip, so this ends.
    """
    flips, changed = 0, True
    while changed:
        changed = False
        for v in range(len(degrees)):
            i = 0
            while i < degrees[v]:
                w = ring[offsets[v] + i]
                i += 1
                if w < v:
                    continue
                a, b = can_flip(v, w, offsets, degrees, ring, closed, x, y)
                if a < 0 or evens(v, w, a, b, degrees, ideal) <= 0:
                    continue
                if (
                    triangle_least(x[v], y[v], x[b], y[b], x[a], y[a]) < floor
                    or triangle_least(x[w], y[w], x[a], y[a], x[b], y[b]) < floor
                ):
                    continue
                flip(v, w, a, b, offsets, degrees, ring, closed)
                flips += 1
                changed = True
    return flips


@compiled
def lawson(offsets, degrees, ring, closed, x, y):
    """Flip wherever that raises the least of the six angles at an edge; how many flips.

    The sorted vector of all angles rises with every flip, so this ends: in a Delaunay mesh, but
    for ties within GAIN (Lawson 1977, Sibson 1978).
    """
    flips, changed = 0, True
    while changed:
        changed = False
        for v in range(len(degrees)):
            i = 0
            while i < degrees[v]:
                w = ring[offsets[v] + i]
                i += 1
                if w < v:
                    continue
                a, b = can_flip(v, w, offsets, degrees, ring, closed, x, y)
                if a >= 0 and raises(v, w, a, b, x, y) > GAIN:
                    flip(v, w, a, b, offsets, degrees, ring, closed)
                    flips += 1
                    changed = True
    return flips


@compiled
def vector_of(patch, count, offsets, degrees, ring, closed, x, y, mark, tick, found):
    """The least angles of all triangles at vertices of a patch, sorted; their number.

    ``mark[v] == tick`` tells the vertices of the patch; each triangle counts once.
    """
    m = 0
    for c in range(count):
        v = patch[c]
        k = degrees[v]
        for i in range(k if closed[v] else k - 1):
            a = ring[offsets[v] + i]
            b = ring[offsets[v] + (i + 1 if i + 1 < k else 0)]
            if (mark[a] == tick and a < v) or (mark[b] == tick and b < v):
                continue
            found[m] = triangle_least(x[v], y[v], x[a], y[a], x[b], y[b])
            m += 1
    found[:m].sort()
    return m


@compiled
def is_better(old, m, new, k):
    """Whether a sorted vector of k angles is above one of m: the first that differs is greater.

    The one that ends first is above where all else is equal.
    """
    for i in range(min(m, k)):
        if new[i] != old[i]:
            return new[i] > old[i] + GAIN
    return k < m


@compiled
def candidates(v, offsets, degrees, ring, closed, x, y, ideal, ends, scores):
    """The flips of edges at and around v, best evening first; their number, at most TRIED.

    ``ends``: rows (v, w, a, b); ``scores``: by how much each evens out the degrees.
    """
    count = 0
    k = degrees[v]
    for i in range(2 * k):
        u = v if i < k else ring[offsets[v] + i - k]
        w = ring[offsets[v] + (i if i < k else (i - k + 1) % k)]
        a, b = can_flip(u, w, offsets, degrees, ring, closed, x, y)
        if a < 0:
            continue
        score = evens(u, w, a, b, degrees, ideal) + raises(u, w, a, b, x, y)
        if count == TRIED and score <= scores[count - 1]:
            continue
        j = count if count < TRIED else TRIED - 1
        count = min(count + 1, TRIED)
        while j > 0 and scores[j - 1] < score:
            scores[j] = scores[j - 1]
            ends[j] = ends[j - 1]
            j -= 1
        scores[j] = score
        ends[j, 0], ends[j, 1], ends[j, 2], ends[j, 3] = u, w, a, b
    return count


@compiled
def try_flips(waiting, offsets, degrees, ring, closed, free, x, y, ideal, target, budget):
    """Worst vertex first, try flips with smoothing, until ``budget`` visits are used.

    ``waiting``: (n,), the vertices that are still to be looked at, kept from call to call.
    ``target``: radians; vertices with no smaller angle are left alone.  Returns (visits, moves,
    flips, whether nothing is left).
    """
    n = len(degrees)
    keys = np.full(n, np.inf)
    for v in np.flatnonzero(free):
        keys[v] = star_least(v, offsets, degrees, ring, closed, x, y)
    heap, place, size = filled(keys, np.flatnonzero(waiting))
    mark, patch = np.full(n, -1), np.empty(n, np.int64)
    old_x, old_y = np.empty(n), np.empty(n)
    old, new = np.empty(len(ring)), np.empty(len(ring))
    ends, scores = np.empty((TRIED, 4), np.int64), np.empty(TRIED)
    visits = moves = flips = tick = 0
    while size > 0 and visits < budget:
        v, size = pop(heap, place, keys, size)
        if keys[v] >= target:
            size = 0
            break
        found = candidates(v, offsets, degrees, ring, closed, x, y, ideal, ends, scores)
        for c in range(found):
            u, w, a, b = ends[c]
            tick += 1
            many = gather(v, RADIUS, offsets, degrees, ring, free, mark, tick, patch)
            for i in range(many):
                old_x[i], old_y[i] = x[patch[i]], y[patch[i]]
            count = many  # a triangle that changes may have fixed vertices only
            for s in (u, w, a, b):
                if mark[s] != tick:
                    mark[s] = tick
                    patch[count] = s
                    count += 1
            m = vector_of(patch, count, offsets, degrees, ring, closed, x, y, mark, tick, old)
            flip(u, w, a, b, offsets, degrees, ring, closed)
            moved = smooth_patch(patch, many, ROUNDS, *SHARP, offsets, degrees, ring, x, y)
            visits += many * ROUNDS
            k = vector_of(patch, count, offsets, degrees, ring, closed, x, y, mark, tick, new)
            if is_better(old, m, new, k):
                flips += 1
                moves += moved
                for i in range(many):
                    s = patch[i]
                    key = star_least(s, offsets, degrees, ring, closed, x, y)
                    size = put(heap, place, keys, size, s, key)
                break
            for i in range(many):
                x[patch[i]], y[patch[i]] = old_x[i], old_y[i]
            flip(a, b, w, u, offsets, degrees, ring, closed)
    waiting[:] = place >= 0
    return visits, moves, flips, size == 0
