"""Looking at one triangle: who may still win in it, and whether it is a leaf."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.choice import side_to_halve
from harness.diagram.fast.classify import (
    beaten_by_two,
    classify_definite,
    is_blurred,
    may_tie_at_corner,
)
from harness.diagram.fast.fine import FINE, fine_root_table, fine_table
from harness.diagram.fast.fine_points import fine_quad_choice, suspects_hub
from harness.diagram.fast.forms import error_factor, relation
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, FAILED, HARD, OPEN, QUAD
from harness.diagram.fast.memory import borrowed
from harness.diagram.fast.mixed import classify_mixed
from harness.diagram.fast.prune import find_signs, keep, localise, prune, prune_pairs
from harness.diagram.fast.sides import (
    MOST_PAIRED,
    all_pairs,
    beaten_by_one,
    compact,
    new_scratch,
)

#: Columns of ``norms``: ML and MQ on the triangle, on the root; flags; number of the candidate in
#: its root; ML and MQ of the fine table.
NORMS = 8
#: Corners are exact in doubles: so many halvings between a corner and the root's, else finer.
FINE_FROM = 50
#: After so many halvings without losing a candidate a tie of many is suspected.
HUB = 5


@compiled
def new_desk(widest):
    """Working space for ``examine`` with up to ``widest`` candidates."""
    rows = widest + MOST_PAIRED
    return (
        (np.zeros(4, np.int64), np.zeros(rows, np.int64), np.zeros(rows, np.int64)),
        np.zeros(rows, np.int64),
        np.ones(MOST_PAIRED),
        new_scratch(),
        np.ones(8),
        (np.empty((widest, 18)), np.empty((widest, NORMS)), np.empty(widest, np.int64)),
    )


@compiled
def borrowed_desk(desk):
    """(work, sides, scratch, share, room for fine tables), borrowed from what ``new_desk`` made."""
    pivots, beaten, sides, scratch, share, room = desk
    return (
        (borrowed(pivots[0]), borrowed(pivots[1]), borrowed(pivots[2]), borrowed(beaten)),
        borrowed(sides),
        (
            borrowed(scratch[0]),
            borrowed(scratch[1]),
            borrowed(scratch[2]),
            borrowed(scratch[3]),
            borrowed(scratch[4]),
            borrowed(scratch[5]),
            borrowed(scratch[6]),
            borrowed(scratch[7]),
        ),
        borrowed(share),
        (borrowed(room[0]), borrowed(room[1]), borrowed(room[2])),
    )


@compiled
def examine(tables, norms, ids, start, m, factor, place, scene, desk):
    """Drop candidates, and classify the triangle.

    ``place``: (far, spots, exponents, lam, corners of the root) of the triangle; ``scene``:
    (definite, world, special) and ``desk``: (work, sides, scratch, share, room for fine tables) of
    the subdivision.  Returns the number of candidates left, of tests, and the kind of leaf, its
    ports and choice; HARD if halving would not help: rounding blurs the contest, or there may be a
    tie at a special corner.
    """
    definite, world, special = scene
    work, sides, scratch, _, _ = desk
    far, spots, exponents, lam, corners = place
    lsign, qsign, tests = work[1], work[2], 0
    if m > MOST_PAIRED:
        m, tests = prune(tables, norms, ids, start, m, factor, far, definite, work, world, spots)
        if m > MOST_PAIRED:
            return m, tests, FAILED, 0, 0
    else:
        find_signs(tables, norms, start, m, factor, definite, work)
    if m > 1 and not definite and _is_mixed(m, ids, start, lsign, world[0]):
        tests += m * (m - 1)
        m = prune_pairs(tables, norms, ids, start, m, factor, far, work, world, spots)
    if m > 1 and not definite and _is_mixed(m, ids, start, lsign, world[0]):
        if m > 2 or qsign[0] == 0 or qsign[0] != qsign[1]:
            return m, tests, FAILED, 0, 0
        bound = factor * (
            norms[start, 1] * norms[start + 1, 0] + norms[start + 1, 1] * norms[start, 0]
        )
        known = relation(ids[start], ids[start + 1], world[2], world[3], world[4], spots)
        kind, ports, choice = classify_mixed(
            tables, start, start + 1, lsign[0], lsign[1], qsign[0], bound, far, known, scratch
        )
        return m, tests, kind, ports, choice
    if m > 1:
        tests += m * (m - 1) // 2
        for a in range(m):
            sides[a] = lsign[a] if lsign[a] != 0 else 1
        all_pairs(tables, start, m, sides, norms, factor, far, world, spots, ids, scratch)
        beaten = work[3]
        if beaten_by_one(m, scratch, beaten) < m:
            compact(m, sides, scratch, beaten)
            m = keep(tables, norms, ids, start, m, lsign, qsign, beaten)
        if m > 2 and beaten_by_two(m, scratch, beaten) < m:
            compact(m, sides, scratch, beaten)
            m = keep(tables, norms, ids, start, m, lsign, qsign, beaten)
    if m == 1:
        scratch[4][0, 0], scratch[4][0, 1] = 1, 0
        return m, tests, EMPTY, 0, 0
    if m <= 4:
        kind, ports, choice = classify_definite(m, scratch)
        if kind != FAILED:
            return m, tests, kind, ports, choice
    if is_blurred(m, scratch) or may_tie_at_corner(m, scratch, exponents, lam, corners, special):
        return m, tests, HARD, 0, 0
    return m, tests, FAILED, 0, 0


@compiled
def _is_mixed(m, ids, start, lsign, lines):
    """Whether the line of some candidate crosses the triangle (two on one line do not matter)."""
    if m == 2 and lines[ids[start]] >= 0 and lines[ids[start]] == lines[ids[start + 1]]:
        return False
    for a in range(m):
        if lsign[a] == 0:
            return True
    return False


@compiled
def _are_cubics(m, ids, far, world):
    """Whether no factor was divided out of F for any two candidates; see ``all_pairs``."""
    lines, classes = world[0], world[2]
    for a in range(m):
        for b in range(a):
            i, j = ids[a], ids[b]
            if lines[i] >= 0 and lines[i] == lines[j]:
                return False
            if far != 0 and classes[i] >= 0 and classes[i] == classes[j]:
                return False
    return True


@compiled
def examine_finely(norms, ids, start, m, place, scene, desk, source, patience, probe):
    """The same in double-double, for the candidates from ``start`` on.

    ``source``: (segments, corners of the root, weights, size, sense, tables of the root, whether
    these are computed).  With ``probe`` nothing changes unless the triangle turns out to be a leaf.
    """
    tables, fine_norms, fine_ids = desk[4]
    segments, root_corners, root_weights, size, sense, of_root, known = source
    lam = place[3]
    for a in range(m):
        candidate, number = ids[start + a], int(norms[start + a, 5])
        flags = int(norms[start + a, 4])
        if not known[number]:
            fine_root_table(
                segments[candidate],
                root_corners,
                root_weights,
                flags & 7,
                flags >> 3,
                size,
                sense,
                of_root[number],
                norms[start + a, 6:8],
            )
            known[number] = True
            of_root[number, 18], of_root[number, 19] = norms[start + a, 6], norms[start + a, 7]
        norms[start + a, 6], norms[start + a, 7] = of_root[number, 18], of_root[number, 19]
        fine_table(of_root[number], flags & 7, flags >> 3, lam, tables[a])
        fine_norms[a] = norms[start + a]
        fine_ids[a] = candidate
    localise(fine_norms, 0, m, lam, desk[3], 6)
    left, tests, kind, ports, choice = examine(
        tables, fine_norms, fine_ids, 0, m, FINE, place, scene, desk
    )
    if kind == QUAD and choice == OPEN:
        if _are_cubics(left, fine_ids, place[0], scene[1]):
            choice = fine_quad_choice(tables, fine_norms, desk[1], desk[2])
    elif (
        kind == FAILED
        and patience > HUB
        and suspects_hub(tables, fine_norms, left, desk[0][1], desk[2][6])
    ):
        kind = HARD
    if probe and kind == FAILED:
        return m, tests, kind, ports, choice
    for a in range(left):
        norms[start + a] = fine_norms[a]
        ids[start + a] = fine_ids[a]
    return left, tests, kind, ports, choice


@compiled
def look(tables, norms, ids, start, m, frame, place, scene, desk, source):
    """Examine a triangle in doubles, and in double-double where that may help.

    ``frame``: (depth, patience, fine) of the triangle; fine: not in doubles.  Returns what
    ``examine`` does, the corner opposite to the side to halve if it is no leaf, and whether its
    halves are to be examined in double-double only.
    """
    depth, patience, fine = frame
    e = place[2]
    lsign = desk[0][1]
    tests = 0
    if not fine:
        factor = error_factor(depth)
        localise(norms, start, m, place[3], desk[3], 2)
        m, tests, kind, ports, choice = examine(
            tables, norms, ids, start, m, factor, place, scene, desk
        )
        if kind != FAILED and kind != HARD and not (kind == QUAD and choice == OPEN):
            return m, tests, kind, ports, choice, 0, False
        k, probe = 0, False
        if kind == FAILED:
            k, blurred = side_to_halve(tables, norms, start, m, depth, lsign, factor)
            fine = blurred or max(e[(k + 1) % 3], e[(k + 2) % 3]) >= FINE_FROM
            probe = not fine and m > 2 and patience > HUB and patience % 8 == 6
            if not fine and not probe:
                return m, tests, kind, ports, choice, k, False
    else:
        probe = False
    m, more, kind, ports, choice = examine_finely(
        norms, ids, start, m, place, scene, desk, source, patience, probe
    )
    tests += more
    if kind == FAILED and not probe:
        room = desk[4]
        k, _ = side_to_halve(room[0], room[1], 0, m, depth, lsign, FINE)
    return m, tests, kind, ports, choice, k, not probe
