"""A priority queue of vertices whose keys change: a binary heap with the places of its items.

``heap``: the vertices; ``place``: where each is, −1 if it is not in it; ``keys``: by vertex.  Least
key first, ties by the least index, so that the order is always the same.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled


@compiled
def before(keys, v, w):
    """Whether v comes before w."""
    return keys[v] < keys[w] or (keys[v] == keys[w] and v < w)


@compiled
def settle(heap, place, keys, size, i):
    """Bring the vertex at place i, whose key is new, to where it belongs."""
    v = heap[i]
    while i > 0 and before(keys, v, heap[(i - 1) >> 1]):
        up = (i - 1) >> 1
        heap[i] = heap[up]
        place[heap[i]] = i
        i = up
    while True:
        down = 2 * i + 1
        if down >= size:
            break
        if down + 1 < size and before(keys, heap[down + 1], heap[down]):
            down += 1
        if not before(keys, heap[down], v):
            break
        heap[i] = heap[down]
        place[heap[i]] = i
        i = down
    heap[i] = v
    place[v] = i


@compiled
def put(heap, place, keys, size, v, key):
    """Give v this key, and put it in if it is not there; the new size."""
    keys[v] = key
    if place[v] < 0:
        heap[size] = v
        place[v] = size
        size += 1
    settle(heap, place, keys, size, place[v])
    return size


@compiled
def take(heap, place, size):
    """Take out the first vertex, which is heap[0]; the keys must be passed to settle after.

    Returns the new size; the last vertex stands at place 0 and is not settled yet.
    """
    place[heap[0]] = -1
    size -= 1
    if size > 0:
        heap[0] = heap[size]
        place[heap[0]] = 0
    return size


@compiled
def pop(heap, place, keys, size):
    """Take out the first vertex; (vertex, new size)."""
    v = heap[0]
    size = take(heap, place, size)
    if size > 0:
        settle(heap, place, keys, size, 0)
    return v, size


@compiled
def filled(keys, chosen):
    """A heap of the chosen vertices; (heap, place, size)."""
    n = len(keys)
    heap, place, size = np.empty(n, np.int64), np.full(n, -1), 0
    for v in chosen:
        size = put(heap, place, keys, size, v, keys[v])
    return heap, place, size
