"""Looking at one triangle: who may still win in it, and whether it is a leaf."""

from __future__ import annotations

from harness.diagram.fast.classify import (
    beaten_by_two,
    classify_definite,
    is_blurred,
    may_tie_at_corner,
)
from harness.diagram.fast.fine import FINE, fine_root_table, fine_table
from harness.diagram.fast.forms import relation
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, FAILED, HARD
from harness.diagram.fast.mixed import classify_mixed
from harness.diagram.fast.prune import keep, localise, prune
from harness.diagram.fast.sides import MOST_PAIRED, all_pairs

#: Columns of ``norms``: ML and MQ on the triangle, on the root; flags; number of the candidate in
#: its root; ML and MQ of the fine table.
NORMS = 8


@compiled
def examine(
    tables, norms, ids, start, m, factor, place, definite, world, work, sides, scratch, special
):
    """Drop candidates, and classify the triangle.

    ``place``: (far, spots, exponents, lam, corners of the root) of the triangle.  Returns the
    number of candidates left, of tests, and the kind of leaf, its ports and choice; HARD if halving
    would not help: rounding blurs the contest, or there may be a tie at a special corner.
    """
    far, spots, exponents, lam, corners = place
    m, tests = prune(tables, norms, ids, start, m, factor, far, definite, work, world, spots)
    lsign, qsign = work[1], work[2]
    if m == 1:
        scratch[4][0, 0], scratch[4][0, 1] = 1, 0
        return m, tests, EMPTY, 0, 0
    if m > MOST_PAIRED:
        return m, tests, FAILED, 0, 0
    mixed = False
    for a in range(m):
        mixed = mixed or lsign[a] == 0
        sides[a] = lsign[a] if lsign[a] != 0 else 1
    lines = world[0]
    if m == 2 and lines[ids[start]] >= 0 and lines[ids[start]] == lines[ids[start + 1]]:
        mixed = False
    if not mixed:
        all_pairs(tables, start, m, sides, norms, factor, far, world, spots, ids, scratch)
        if m > 2 and beaten_by_two(m, scratch, work[3]) < m:
            m = keep(tables, norms, ids, start, m, lsign, qsign, work[3])
            for a in range(m):
                sides[a] = lsign[a] if lsign[a] != 0 else 1
            all_pairs(tables, start, m, sides, norms, factor, far, world, spots, ids, scratch)
        if m == 1:
            scratch[4][0, 0], scratch[4][0, 1] = 1, 0
            return m, tests, EMPTY, 0, 0
        if m <= 4:
            kind, ports, choice = classify_definite(m, scratch)
            if kind != FAILED:
                return m, tests, kind, ports, choice
        if is_blurred(m, scratch) or may_tie_at_corner(
            m, scratch, exponents, lam, corners, special
        ):
            return m, tests, HARD, 0, 0
        return m, tests, FAILED, 0, 0
    if m == 2 and qsign[0] != 0 and qsign[0] == qsign[1]:
        bound = factor * (
            norms[start, 1] * norms[start + 1, 0] + norms[start + 1, 1] * norms[start, 0]
        )
        known = relation(ids[start], ids[start + 1], world[2], world[3], world[4], spots)
        kind, ports, choice = classify_mixed(
            tables, start, start + 1, lsign[0], lsign[1], qsign[0], bound, far, known, scratch
        )
        return m, tests, kind, ports, choice
    return m, tests, FAILED, 0, 0


@compiled
def examine_finely(
    fine,
    norms,
    ids,
    start,
    m,
    place,
    definite,
    world,
    work,
    sides,
    scratch,
    special,
    share,
    source,
):
    """The same in double-double; ``fine`` = (tables, norms, ids) is room for it.

    ``source``: (segments, corners of the root, weights, size, sense, tables of the root, whether
    these are computed).  The candidates left, from ``start`` on, lose their tables of doubles.
    """
    tables, fine_norms, fine_ids = fine
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
    localise(fine_norms, 0, m, lam, share, 6)
    m, tests, kind, ports, choice = examine(
        tables,
        fine_norms,
        fine_ids,
        0,
        m,
        FINE,
        place,
        definite,
        world,
        work,
        sides,
        scratch,
        special,
    )
    for a in range(m):
        norms[start + a] = fine_norms[a]
        ids[start + a] = fine_ids[a]
    return m, tests, kind, ports, choice
