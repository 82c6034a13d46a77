"""Stars: the neighbours of every vertex of a triangulation, counter-clockwise.

All loops of this room read a mesh through these arrays: ``offsets`` (n + 1,), ``degrees`` (n,),
``ring``, ``closed`` (n,).  The neighbours of vertex v are ``ring[offsets[v] + i]``, i <
degrees[v]; a closed star (of an interior vertex) is a cycle, an open one a path.  Between one
star and the next some places are free, so that flips need no new arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from harness.geometry.jit import compiled

Ints = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]

SLACK = 4
"""Free places after each star."""
SOUND, TWICE, APART = 0, 1, 2
"""No fault; a directed edge of two triangles; a vertex whose triangles are not one fan."""


class Stars(NamedTuple):
    """The stars of a mesh; see the head of this file."""

    offsets: Ints
    degrees: Ints
    ring: Ints
    closed: Flags


class Fault(NamedTuple):
    """Why triangles are no surface: the triangle, another or −1, the vertex, TWICE or APART."""

    kind: int
    triangle: int
    other: int
    vertex: int


def stars_of(n: int, triangles: Ints) -> tuple[Stars, Fault | None]:
    """The stars of n vertices, and the first fault of a mesh that is no oriented surface; O(n + m).

    ``triangles``: (m, 3), valid indices, no index twice in one triangle.
    """
    *arrays, fault = _link(n, triangles)
    found = Fault(*fault.tolist())
    return Stars(*arrays), None if found.kind == SOUND else found


@compiled
def _link(n, triangles):
    counts = np.zeros(n + 1, np.int64)
    for t in range(len(triangles)):
        for k in range(3):
            counts[triangles[t, k] + 1] += 1
    corners = np.cumsum(counts)
    at = np.empty(corners[n], np.int64)
    fill = corners[:-1].copy()
    for t in range(len(triangles)):
        for k in range(3):
            v = triangles[t, k]
            at[fill[v]] = 3 * t + k
            fill[v] += 1
    offsets = np.zeros(n + 1, np.int64)
    for v in range(n):
        offsets[v + 1] = offsets[v] + counts[v + 1] + 1 + SLACK
    degrees, closed = np.zeros(n, np.int64), np.zeros(n, np.bool_)
    ring = np.full(offsets[n], -1)
    leaving, entering = np.full(n, -1), np.full(n, -1)  # corners at v by first and by last end
    fault = np.array([SOUND, -1, -1, -1])
    for v in range(n):
        first, last = corners[v], corners[v + 1]
        if first == last:
            continue
        for c in range(first, last):
            t, k = at[c] // 3, at[c] % 3
            a, b = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            if leaving[a] != -1 or entering[b] != -1:
                other = leaving[a] if leaving[a] != -1 else entering[b]
                fault[:] = np.array([TWICE, max(t, other // 3), min(t, other // 3), v])
                return offsets, degrees, ring, closed, fault
            leaving[a] = entering[b] = at[c]
        begin = triangles[at[first] // 3, (at[first] % 3 + 1) % 3]
        start = begin
        while entering[start] != -1:
            t, k = entering[start] // 3, entering[start] % 3
            start = triangles[t, (k + 1) % 3]
            if start == begin:
                closed[v] = True
                break
        w, met = start, 0
        while True:
            ring[offsets[v] + degrees[v]] = w
            degrees[v] += 1
            if leaving[w] == -1:
                break
            t, k = leaving[w] // 3, leaving[w] % 3
            w, met = triangles[t, (k + 2) % 3], met + 1
            if w == start:
                break
        for c in range(first, last):
            t, k = at[c] // 3, at[c] % 3
            leaving[triangles[t, (k + 1) % 3]] = entering[triangles[t, (k + 2) % 3]] = -1
        if met != last - first:
            fault[:] = np.array([APART, at[last - 1] // 3, -1, v])
            return offsets, degrees, ring, closed, fault
    return offsets, degrees, ring, closed, fault


@compiled
def triangles_of(offsets, degrees, ring, closed, vertices):
    """The triangles (m, 3) of the stars of the first ``vertices`` vertices, least index first."""
    count = 0
    for v in range(vertices):
        count += degrees[v] if closed[v] else max(degrees[v] - 1, 0)
    found = np.empty((count // 3, 3), np.int64)
    m = 0
    for v in range(vertices):
        k = degrees[v]
        for i in range(k if closed[v] else k - 1):
            a = ring[offsets[v] + i]
            b = ring[offsets[v] + (i + 1 if i + 1 < k else 0)]
            if v < a and v < b:
                found[m, 0], found[m, 1], found[m, 2] = v, a, b
                m += 1
    return found[:m]


@compiled
def windings(offsets, degrees, ring, closed, x, y):
    """How often each closed star of positive triangles turns around its vertex; 0 for open ones.

    Each step turns by less than π, so a full turn enters the upper half plane [0, π) exactly
    once; that is decided by comparing coordinates, which is exact.
    """
    turns = np.zeros(len(degrees), np.int64)
    for v in range(len(degrees)):
        if not closed[v]:
            continue
        last = ring[offsets[v] + degrees[v] - 1]
        below = y[last] < y[v] or (y[last] == y[v] and x[last] < x[v])
        for i in range(degrees[v]):
            w = ring[offsets[v] + i]
            now = y[w] < y[v] or (y[w] == y[v] and x[w] < x[v])
            if below and not now:
                turns[v] += 1
            below = now
    return turns


@compiled
def coloured(offsets, degrees, ring, chosen):
    """The chosen vertices by colour, and where each colour begins: neighbours differ in colour.

    Greedy in the order of the indices; at most one colour more than the greatest degree.
    """
    n = len(degrees)
    colours = np.full(n, -1)
    used = np.full(max(degrees.max(), 0) + 2, -1)
    most = 0
    for v in range(n):
        if not chosen[v]:
            continue
        for i in range(offsets[v], offsets[v] + degrees[v]):
            if colours[ring[i]] >= 0:
                used[colours[ring[i]]] = v
        colour = 0
        while used[colour] == v:
            colour += 1
        colours[v] = colour
        most = max(most, colour + 1)
    starts = np.zeros(most + 1, np.int64)
    for v in range(n):
        if colours[v] >= 0:
            starts[colours[v] + 1] += 1
    starts = np.cumsum(starts)
    order = np.empty(starts[most], np.int64)
    fill = starts.copy()
    for v in range(n):
        if colours[v] >= 0:
            order[fill[colours[v]]] = v
            fill[colours[v]] += 1
    return order, starts
