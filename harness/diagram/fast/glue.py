"""From leaves to a planar map: arcs in every leaf, glued along the sides of all triangles.

*Ports* and *pieces* share numbers, the slots: piece s is the part of a triangle's boundary after
port s, counter-clockwise.  An *arc* is the part of an edge in one leaf; its ends are ports, or
vertices v written as −1 − v.  Half-arc 2a runs from its first end to its second, 2a + 1 back.

Two triangles with a common side see the same ports there, in opposite order and with the same
owners between them; that they do is checked.  So no coordinate is compared: the sides of a halved
triangle are concatenations of those of its halves, as linked lists, in constant time, and each
common side is walked along once.  Pieces that meet are united (union–find): a cell is a class.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import (
    ARC,
    CROSSING,
    QUAD,
    SADDLE,
    TIED,
    TRIPLE,
    TWO_ARCS,
)
from harness.diagram.fast.memory import borrowed, release
from harness.diagram.fast.records import LEAF
from harness.diagram.fast.subdivide import DEEPEST


@compiled
def count_parts(kinds, choices):
    """The number of arcs, vertices and half-arcs at vertices in all leaves but the hard ones."""
    arcs = vertices = ends = 0
    for leaf in range(len(kinds)):
        kind, choice = kinds[leaf], choices[leaf]
        if kind == ARC:
            arcs += 1
        elif kind == TWO_ARCS:
            arcs += 2
        elif kind == TRIPLE:
            arcs, vertices, ends = arcs + 3, vertices + 1, ends + 3
        elif kind == CROSSING or choice == TIED:
            arcs, vertices, ends = arcs + 4, vertices + 1, ends + 4
        elif kind == QUAD:
            arcs, vertices, ends = arcs + 5, vertices + 2, ends + 6
        elif kind == SADDLE:
            arcs += 2
    return arcs, vertices, ends


@compiled
def expand(kinds, choices, first_slot, arcs, leaf_of_arc, vertices, out_first, out, inward, parent):
    """Write the arcs of all leaves but the hard ones.

    ``arcs`` (a, 4): ends, piece to the left, piece to the right.  ``vertices`` (v, 2): leaf, and 0
    or 1 for the first or second vertex in it.  ``out`` (CSR): half-arcs leaving each vertex,
    counter-clockwise.  ``inward`` (s,): the half-arc that enters the leaf at each port.
    """
    a = v = e = 0
    out_first[0] = 0
    for leaf in range(len(kinds)):
        kind, choice, s = kinds[leaf], choices[leaf], first_slot[leaf]
        if kind == ARC:
            a = _join(arcs, leaf_of_arc, inward, a, leaf, s, 2, 0, 1)
        elif kind == TWO_ARCS or (kind == SADDLE and choice != TIED):
            p = choice
            a = _join(arcs, leaf_of_arc, inward, a, leaf, s, 4, p, p + 1)
            a = _join(arcs, leaf_of_arc, inward, a, leaf, s, 4, p + 2, (p + 3) % 4)
            unite(parent, s + 1 - p, s + 3 - p)
        elif kind in (TRIPLE, CROSSING) or choice == TIED:
            k = 3 if kind == TRIPLE else 4
            vertices[v, 0], vertices[v, 1] = leaf, 0
            for r in range(k):
                a, e = _spoke(arcs, leaf_of_arc, inward, out, a, e, leaf, s, k, r, v)
            v += 1
            out_first[v] = e
        elif kind == QUAD:
            # With choice 0 slots 0 and 2 share an edge: its ends have the ports 1, 2 and 3, 0.
            p = 1 - choice
            inner = a
            arcs[a, 0], arcs[a, 1] = -1 - v, -2 - v
            arcs[a, 2], arcs[a, 3] = s + (p + 3) % 4, s + (p + 1) % 4
            leaf_of_arc[a] = leaf
            a += 1
            for half in range(2):
                vertices[v, 0], vertices[v, 1] = leaf, half
                for r in range(2):
                    a, e = _spoke(
                        arcs, leaf_of_arc, inward, out, a, e, leaf, s, 4, (p + 2 * half + r) % 4, v
                    )
                out[e] = 2 * inner + half
                e += 1
                v += 1
                out_first[v] = e


@compiled
def _join(arcs, leaf_of_arc, inward, a, leaf, s, k, x, y):
    """An arc from port x to port y of a leaf with k ports."""
    arcs[a, 0], arcs[a, 1] = s + x, s + y
    arcs[a, 2], arcs[a, 3] = s + (x + k - 1) % k, s + x
    inward[s + x], inward[s + y] = 2 * a, 2 * a + 1
    leaf_of_arc[a] = leaf
    return a + 1


@compiled
def _spoke(arcs, leaf_of_arc, inward, out, a, e, leaf, s, k, r, v):
    """An arc from vertex v to port r of a leaf with k ports."""
    arcs[a, 0], arcs[a, 1] = -1 - v, s + r
    arcs[a, 2], arcs[a, 3] = s + r, s + (r + k - 1) % k
    inward[s + r] = 2 * a + 1
    out[e] = 2 * a
    leaf_of_arc[a] = leaf
    return a + 1, e + 1


@compiled
def find(parent, x):
    """The representative of x (path halving)."""
    while parent[x] != x:
        parent[x] = parent[parent[x]]
        x = parent[x]
    return x


@compiled
def unite(parent, x, y):
    """Unite two classes under the lesser representative."""
    x, y = find(parent, x), find(parent, y)
    if x < y:
        parent[y] = x
    elif y < x:
        parent[x] = y


@compiled
def _glue(one, two, following, previous, owner, parent, mate):
    """Glue a side to the opposite one; False if they do not see the same.

    A side: first port, last port, first piece, last piece (port −1: none).
    """
    p, q = one[0], two[1]
    x, y = one[2], two[3]
    while True:
        if owner[x] != owner[y]:
            return False
        unite(parent, x, y)
        if p < 0 or q < 0:
            return p < 0 and q < 0
        mate[p], mate[q] = q, p
        x = p
        q_before = previous[q]
        y = two[2] if q_before < 0 else q_before
        p, q = following[p], q_before


@compiled
def _concatenate(one, two, following, previous, owner, parent, result):
    """The side that consists of two sides, one after the other; False if owners differ."""
    if owner[one[3]] != owner[two[2]]:
        return False
    unite(parent, one[3], two[2])
    result[2], result[3] = one[2], two[3]
    if one[0] < 0:
        result[0], result[1] = two[0], two[1]
    elif two[0] < 0:
        result[0], result[1] = one[0], one[1]
    else:
        following[one[1]] = two[0]
        previous[two[0]] = one[1]
        result[0], result[1] = one[0], two[1]
    return True


@compiled
def _leaf_sides(s, k, place, following, previous, sides):
    """The sides of a leaf, opposite to its corners 0, 1, 2."""
    for position in range(3):
        side = sides[(position + 2) % 3]
        side[0] = side[1] = -1
        if k == 0:
            side[2] = side[3] = s
            continue
        first = last = s + k - 1
        for r in range(k):
            if place[s + r] < 2 * position + 1:
                first = s + r
            if place[s + r] <= 2 * position + 1:
                last = s + r
            if place[s + r] == 2 * position + 1:
                if side[0] < 0:
                    side[0] = s + r
                    previous[s + r] = -1
                else:
                    previous[s + r] = side[1]
                    following[side[1]] = s + r
                side[1] = s + r
                following[s + r] = -1
        side[2], side[3] = first, last


@compiled
def glue_tree(
    tokens,
    position,
    kinds,
    leaf,
    first_slot,
    ports,
    place,
    owner,
    following,
    previous,
    parent,
    mate,
    sides,
):
    """Glue everything inside one root triangle; its own sides go to ``sides`` (3, 4).

    Returns (position after its tokens, number of the next leaf), or (−1, leaf) at a contradiction.
    """
    kept = (np.empty((DEEPEST + 2, 3, 4), np.int64), np.empty((DEEPEST + 2, 2), np.int64))
    kept_sides = (np.empty(4, np.int64), np.empty(4, np.int64))
    # Sides of triangles; corner opposite to the halved side, halves done.
    stack, waiting = borrowed(kept[0]), borrowed(kept[1])
    one, two = borrowed(kept_sides[0]), borrowed(kept_sides[1])
    depth = top = 0
    while True:
        token = tokens[position]
        position += 1
        if token != LEAF:
            waiting[depth, 0], waiting[depth, 1] = token, 0
            depth += 1
            continue
        s = first_slot[leaf]
        _leaf_sides(s, ports[leaf], place, following, previous, stack[top])
        top += 1
        leaf += 1
        while depth > 0 and waiting[depth - 1, 1] == 1:
            depth -= 1
            k = waiting[depth, 0]
            first, second = stack[top - 2], stack[top - 1]
            if not (
                _glue(first[1], second[2], following, previous, owner, parent, mate)
                and _concatenate(first[0], second[0], following, previous, owner, parent, one)
            ):
                release(kept, kept_sides)
                return -1, leaf
            two[:] = first[2]
            first[k] = one
            first[(k + 1) % 3] = second[1]
            first[(k + 2) % 3] = two
            top -= 1
        if depth == 0:
            sides[:] = stack[0]
            release(kept, kept_sides)
            return position, leaf
        waiting[depth - 1, 1] = 1


@compiled
def glue_all(
    roots,
    tokens,
    kinds,
    first_slot,
    ports,
    place,
    owner,
    opposite,
    following,
    previous,
    parent,
    mate,
    sides,
):
    """Glue inside all roots, then the roots along their common sides.

    ``roots`` (r,): number of each root, in the order of the tokens.  ``opposite`` (r, 3): 3·root +
    side on the other side, or −1 on the boundary.  Returns −1, or a leaf where something is wrong.
    """
    following, previous, parent, mate = (
        borrowed(following),
        borrowed(previous),
        borrowed(parent),
        borrowed(mate),
    )
    tokens, kinds, first_slot, ports = (
        borrowed(tokens),
        borrowed(kinds),
        borrowed(first_slot),
        borrowed(ports),
    )
    place, owner, sides = borrowed(place), borrowed(owner), borrowed(sides)
    position = leaf = 0
    for root in roots:
        position, leaf = glue_tree(
            tokens,
            position,
            kinds,
            leaf,
            first_slot,
            ports,
            place,
            owner,
            following,
            previous,
            parent,
            mate,
            sides[root],
        )
        if position < 0:
            return leaf
    for root in range(len(roots)):
        for k in range(3):
            other = opposite[root, k]
            if other > 3 * root + k and not _glue(
                sides[root, k],
                sides[other // 3, other % 3],
                following,
                previous,
                owner,
                parent,
                mate,
            ):
                return -2 - root
    return -1
