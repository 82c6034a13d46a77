"""Flips on the arrays of :mod:`harness.mesh.stars`: one edge of two triangles for the other."""

from __future__ import annotations

from harness.geometry.jit import compiled
from harness.mesh.angles import ROUND, TINY


@compiled
def index_in(v, w, offsets, degrees, ring):
    """Where w is in the star of v; −1 if it is not there."""
    for i in range(degrees[v]):
        if ring[offsets[v] + i] == w:
            return i
    return -1


@compiled
def step_in(v, i, by, offsets, degrees, ring, closed):
    """The neighbour of v one place after (``by`` 1) or before (−1) place i; −1 past the end."""
    i += by
    if i < 0 or i >= degrees[v]:
        if not closed[v]:
            return -1
        i += degrees[v] if i < 0 else -degrees[v]
    return ring[offsets[v] + i]


@compiled
def remove(v, w, offsets, degrees, ring):
    """Take w out of the star of v."""
    i = index_in(v, w, offsets, degrees, ring)
    for j in range(offsets[v] + i, offsets[v] + degrees[v] - 1):
        ring[j] = ring[j + 1]
    degrees[v] -= 1


@compiled
def insert(v, u, w, offsets, degrees, ring):
    """Put w into the star of v, after u."""
    i = index_in(v, u, offsets, degrees, ring) + 1
    for j in range(offsets[v] + degrees[v], offsets[v] + i, -1):
        ring[j] = ring[j - 1]
    ring[offsets[v] + i] = w
    degrees[v] += 1


@compiled
def has_room(v, offsets, degrees):
    """Whether the star of v can take another neighbour."""
    return degrees[v] < offsets[v + 1] - offsets[v]


@compiled
def is_left(a, b, c, x, y):
    """Whether a, b, c are proven to turn left (coordinates of at most 1)."""
    left = (x[b] - x[a]) * (y[c] - y[a])
    right = (y[b] - y[a]) * (x[c] - x[a])
    return left - right > ROUND * (abs(left) + abs(right)) + TINY


@compiled
def can_flip(v, w, offsets, degrees, ring, closed, x, y):
    """The ends (a, b) of the edge that would replace v–w: a on its left; (−1, −1) if none can.

    Both new triangles must be proven to be positive, the edge must not be there already, and
    every star must keep a triangle (three if it is closed).
    """
    i = index_in(v, w, offsets, degrees, ring)
    if i < 0:
        return -1, -1
    a = step_in(v, i, 1, offsets, degrees, ring, closed)
    b = step_in(v, i, -1, offsets, degrees, ring, closed)
    if (
        a < 0
        or b < 0
        or a == b
        or degrees[v] <= 3 - (not closed[v])
        or degrees[w] <= 3 - (not closed[w])
    ):
        return -1, -1
    if not (has_room(a, offsets, degrees) and has_room(b, offsets, degrees)):
        return -1, -1
    if not (is_left(v, b, a, x, y) and is_left(w, a, b, x, y)):
        return -1, -1
    if index_in(a, b, offsets, degrees, ring) >= 0:
        return -1, -1
    return a, b


@compiled
def flip(v, w, a, b, offsets, degrees, ring, closed):
    """Replace the edge v–w by a–b, a on the left of v–w; undone by flip(a, b, w, v)."""
    remove(v, w, offsets, degrees, ring)
    remove(w, v, offsets, degrees, ring)
    insert(a, v, b, offsets, degrees, ring)
    insert(b, w, a, offsets, degrees, ring)
