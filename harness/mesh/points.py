"""Insertion and deletion of interior vertices, each tried out together with smoothing.

As with flips, a step is kept only if the sorted vector of the least angles of the triangles that
it changes rises in lexicographic order; a vector that ends first is above where all else is equal.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.mesh.angles import star_least, triangle_least
from harness.mesh.edges import can_flip, flip, has_room, index_in, insert, remove, step_in
from harness.mesh.patches import gather, smooth_patch
from harness.mesh.queue import filled, pop, put
from harness.mesh.steps import is_better, vector_of

RADIUS, ROUNDS = 3, 10
SHARP = 40.0, 300.0
MOST = 1024
"""No step looks at more vertices."""
ROOM = 12
"""Places in the star of a vertex that may be inserted."""


@compiled
def split(v, w, z, offsets, degrees, ring, closed, x, y):
    """Put vertex z into the middle of the interior edge v–w; whether that is possible."""
    i = index_in(v, w, offsets, degrees, ring)
    a = step_in(v, i, 1, offsets, degrees, ring, closed)
    b = step_in(v, i, -1, offsets, degrees, ring, closed)
    if a < 0 or b < 0 or not (has_room(a, offsets, degrees) and has_room(b, offsets, degrees)):
        return False
    x[z], y[z] = 0.5 * (x[v] + x[w]), 0.5 * (y[v] + y[w])
    ring[offsets[v] + i] = z
    ring[offsets[w] + index_in(w, v, offsets, degrees, ring)] = z
    insert(a, v, z, offsets, degrees, ring)
    insert(b, w, z, offsets, degrees, ring)
    ring[offsets[z]], ring[offsets[z] + 1] = w, a
    ring[offsets[z] + 2], ring[offsets[z] + 3] = v, b
    degrees[z], closed[z] = 4, True
    return True


@compiled
def delete(v, offsets, degrees, ring, closed, x, y):
    """Take out an interior vertex: flips until it has three neighbours; whether it worked.

    Each flip cuts off the corner of the star that makes the best triangle.  If it fails, the
    stars of v and its neighbours must be restored.
    """
    while degrees[v] > 3:
        best, chosen, left, right = -1.0, -1, -1, -1
        for i in range(degrees[v]):
            w = ring[offsets[v] + i]
            a, b = can_flip(v, w, offsets, degrees, ring, closed, x, y)
            if a >= 0:
                least = triangle_least(x[w], y[w], x[a], y[a], x[b], y[b])
                if least > best:
                    best, chosen, left, right = least, w, a, b
        if chosen < 0:
            return False
        flip(v, chosen, left, right, offsets, degrees, ring, closed)
    for i in range(3):
        w = ring[offsets[v] + i]
        if degrees[w] <= 3 - (not closed[w]):
            return False
    for i in range(3):
        remove(ring[offsets[v] + i], v, offsets, degrees, ring)
    degrees[v] = 0
    return True


@compiled
def save(count, watched, offsets, degrees, ring, x, y, kept, old_x, old_y):
    """Keep the stars and places of some vertices: rows (degree, neighbours …)."""
    for i in range(count):
        v = watched[i]
        old_x[i], old_y[i] = x[v], y[v]
        kept[i, 0] = degrees[v]
        for j in range(degrees[v]):
            kept[i, j + 1] = ring[offsets[v] + j]


@compiled
def restore(count, watched, offsets, degrees, ring, x, y, kept, old_x, old_y):
    """Undo whatever was done to these vertices."""
    for i in range(count):
        v = watched[i]
        x[v], y[v] = old_x[i], old_y[i]
        degrees[v] = kept[i, 0]
        for j in range(degrees[v]):
            ring[offsets[v] + j] = kept[i, j + 1]


@compiled
def watch(v, offsets, degrees, ring, free, mark, tick, patch):
    """The free vertices near v, and all of two steps around it; (free ones, all)."""
    many = gather(v, RADIUS, offsets, degrees, ring, free, mark, tick, patch)
    count = many
    for i in range(-1, degrees[v]):
        u = v if i < 0 else ring[offsets[v] + i]
        for j in range(offsets[u], offsets[u] + degrees[u]):
            if mark[ring[j]] != tick:
                mark[ring[j]] = tick
                patch[count] = ring[j]
                count += 1
    return many, count


@compiled
def operation(number, v, z, offsets, degrees, ring, closed, x, y):
    """Step ``number`` at v: delete v, split edges at v and around it, delete neighbours."""
    k = degrees[v]
    if number == 0:
        return delete(v, offsets, degrees, ring, closed, x, y)
    number -= 1
    if number < k:
        return split(v, ring[offsets[v] + number], z, offsets, degrees, ring, closed, x, y)
    number -= k
    u, w = ring[offsets[v] + number % k], ring[offsets[v] + (number + 1) % k]
    if number < k:
        return split(u, w, z, offsets, degrees, ring, closed, x, y)
    return closed[u] and delete(u, offsets, degrees, ring, closed, x, y)


@compiled
def put_last(i, many, patch, kept, old_x, old_y):
    """Exchange place i of a patch and of what is kept with the last of its first ``many``."""
    j = many - 1
    patch[i], patch[j] = patch[j], patch[i]
    old_x[i], old_x[j] = old_x[j], old_x[i]
    old_y[i], old_y[j] = old_y[j], old_y[i]
    for column in range(kept.shape[1]):
        kept[i, column], kept[j, column] = kept[j, column], kept[i, column]


@compiled
def smooth_around(z, patch, alive, offsets, degrees, ring, x, y):
    """Smooth a patch, with a new vertex z (or −1) in turn with the others; the moves."""
    if z < 0:
        return smooth_patch(patch, alive, ROUNDS, *SHARP, offsets, degrees, ring, x, y)
    one, moved = np.full(1, z), 0
    for _ in range(2):
        moved += smooth_patch(one, 1, 2, *SHARP, offsets, degrees, ring, x, y)
        moved += smooth_patch(patch, alive, ROUNDS // 2, *SHARP, offsets, degrees, ring, x, y)
    return moved


@compiled
def attempt(number, v, z, tick, mesh, free, space):
    """Try step ``number`` at v, which inserts z if that is not −1; undone if it is no better.

    ``space``: room for the patch and what is kept of it.  Returns whether it is better, visits,
    moves, how many vertices of the patch are to be looked at again, and the vertex that is gone
    or −1.
    """
    offsets, degrees, ring, closed, x, y = mesh
    mark, patch, kept, old_x, old_y, old, new = space
    many, count = watch(v, offsets, degrees, ring, free, mark, tick, patch)
    if count > len(kept):
        return False, 0, 0, 0, -1
    save(count, patch, offsets, degrees, ring, x, y, kept, old_x, old_y)
    m = vector_of(patch, count, offsets, degrees, ring, closed, x, y, mark, tick, old)
    visits = moved = 0
    if operation(number, v, z, offsets, degrees, ring, closed, x, y):
        alive, gone = many, -1
        for i in range(many):
            if degrees[patch[i]] == 0:
                gone, alive = patch[i], many - 1
                put_last(i, many, patch, kept, old_x, old_y)  # smoothed are the first ones
                break
        all_of_it = count
        if z >= 0:
            mark[z] = tick
            patch[count] = z
            all_of_it += 1
        moved = smooth_around(z, patch, alive, offsets, degrees, ring, x, y)
        visits = alive * ROUNDS
        k = vector_of(patch, all_of_it, offsets, degrees, ring, closed, x, y, mark, tick, new)
        if is_better(old, m, new, k):
            return True, visits, moved, all_of_it, gone
    restore(count, patch, offsets, degrees, ring, x, y, kept, old_x, old_y)
    if z >= 0:
        degrees[z], closed[z] = 0, False
    return False, visits, 0, 0, -1


@compiled
def look_again(patch, count, mesh, free, keys, heap, place, size):
    """New keys for the vertices of a patch that has changed; the new size of the queue."""
    offsets, degrees, ring, closed, x, y = mesh
    for i in range(count):
        s = patch[i]
        if free[s]:
            key = star_least(s, offsets, degrees, ring, closed, x, y)
            size = put(heap, place, keys, size, s, key)
        elif place[s] >= 0:  # it is gone: it comes last
            size = put(heap, place, keys, size, s, np.inf)
    return size


@compiled
def try_points(waiting, offsets, degrees, ring, closed, free, x, y, origins, born, target, budget):
    """Worst vertex first, try insertions and deletions, until ``budget`` visits are used.

    ``waiting``: (n,), the vertices still to be looked at, kept from call to call.  ``origins``:
    for each vertex the one that it was made beside.  ``born[0]``: the next place for a vertex.
    ``target``: radians.  Returns (visits, moves, steps kept, whether nothing is left).
    """
    n = len(degrees)
    keys = np.full(n, np.inf)
    for v in np.flatnonzero(free):
        keys[v] = star_least(v, offsets, degrees, ring, closed, x, y)
    heap, place, size = filled(keys, np.flatnonzero(waiting))
    mesh = (offsets, degrees, ring, closed, x, y)
    patch = np.empty(n, np.int64)
    kept = np.empty((min(n, MOST), int(np.diff(offsets).max()) + 1), np.int64)
    vectors = np.empty(len(ring)), np.empty(len(ring))
    space = (np.full(n, -1), patch, kept, np.empty(n), np.empty(n), *vectors)
    visits = moves = steps = tick = 0
    while size > 0 and visits < budget:
        v, size = pop(heap, place, keys, size)
        if keys[v] >= target:
            size = 0
            break
        k = degrees[v]
        for number in range(1 + 3 * k):
            inserts = 1 <= number <= 2 * k
            z = born[0] if inserts else -1
            dies = v if number == 0 else ring[offsets[v] + (number - 1) % k]
            if z >= n or not (inserts or free[dies]):
                continue
            tick += 1
            better, seen, moved, count, gone = attempt(number, v, z, tick, mesh, free, space)
            visits += seen
            if not better:
                continue
            steps += 1
            moves += moved
            if inserts:
                born[0] += 1
                free[z], origins[z] = True, origins[v]
            if gone >= 0:
                free[gone] = False
            size = look_again(patch, count, mesh, free, keys, heap, place, size)
            break
    waiting[:] = (place >= 0) & free
    return visits, moves, steps, size == 0
