"""Edges as chains of arcs, and the walks around cells, as arrays."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.glue import find
from harness.diagram.fast.jit import compiled


@compiled
def start_of(arcs, half):
    """Where a half-arc starts: a port, or −1 − vertex."""
    return arcs[half >> 1, half & 1]


@compiled
def _onwards(arcs, mate, inward, half):
    """The half-arc that continues an edge after ``half``, or −1 if a node is there."""
    end = arcs[half >> 1, 1 - (half & 1)]
    if end < 0 or mate[end] < 0:
        return -1
    return inward[mate[end]]


@compiled
def join_arcs(arcs, mate, inward, node_of_vertex, node_of_port, parent):
    """All edges, loops last.

    Returns ``edges`` (e, 6): start and end node (−1: loop), first and last half-arc, piece to the
    left and to the right; and ``edge_of_arc`` (a, 2): edge, and 1 if the arc runs backwards in it.
    """
    count = len(arcs)
    edge_of_arc = np.full((count, 2), -1, arcs.dtype)
    edges = np.empty((max(count, 1), 6), np.int64)
    e = 0
    for loops in range(2):
        for first in range(2 * count):
            if edge_of_arc[first >> 1, 0] >= 0:
                continue
            start = start_of(arcs, first)
            if loops == 0:
                node = node_of_vertex[-1 - start] if start < 0 else node_of_port[start]
                if node < 0:
                    continue
            else:
                node = -1
            half = last = first
            while half >= 0 and edge_of_arc[half >> 1, 0] < 0:
                edge_of_arc[half >> 1, 0] = e
                edge_of_arc[half >> 1, 1] = half & 1
                last = half
                half = _onwards(arcs, mate, inward, half)
            edges[e, 0] = node
            edges[e, 1] = -1
            if loops == 0:
                end = arcs[last >> 1, 1 - (last & 1)]
                edges[e, 1] = node_of_vertex[-1 - end] if end < 0 else node_of_port[end]
            edges[e, 2], edges[e, 3] = first, last
            side = first & 1
            edges[e, 4] = find(parent, arcs[first >> 1, 2 + side])
            edges[e, 5] = find(parent, arcs[first >> 1, 3 - side])
            e += 1
    return edges[:e].copy(), edge_of_arc


@compiled
def number_classes(parent, owner):
    """The number of every slot's class (in order of their least slots), and how many there are.

    Slots without an owner are not in use and get −1.
    """
    number = np.empty(len(parent), parent.dtype)
    count = 0
    for s in range(len(parent)):
        if owner[s] < 0:
            number[s] = -1
            continue
        root = find(parent, s)
        if root == s:
            number[s] = count
            count += 1
        else:
            number[s] = number[root]
    return number, count


@compiled
def count_components(nodes, edges, kinds_infinity, kinds_boundary, bounded):
    """Components of edges ∪ nodes ∪ boundary of the domain, loops among them.

    ``kinds_infinity``, ``kinds_boundary`` (nodes,): flags.  All infinite ends are one point.
    """
    parent = np.arange(nodes + 2)
    infinity, boundary = nodes, nodes + 1
    far = False
    for v in range(nodes):
        if kinds_infinity[v]:
            _merge(parent, v, infinity)
            far = True
        if kinds_boundary[v]:
            _merge(parent, v, boundary)
    loops = 0
    for e in range(len(edges)):
        if edges[e, 0] < 0:
            loops += 1
        else:
            _merge(parent, edges[e, 0], edges[e, 1])
    parts = 0
    for v in range(nodes):
        if find(parent, v) == v:
            parts += 1
    parts += 0 if find(parent, infinity) != infinity else (1 if far else 0)
    parts += 0 if find(parent, boundary) != boundary else (1 if bounded else 0)
    return parts + loops


@compiled
def _merge(parent, x, y):
    x, y = find(parent, x), find(parent, y)
    if x < y:
        parent[y] = x
    elif y < x:
        parent[x] = y
