"""Halving triangles until each is a leaf, with ever shorter lists of candidates.

A triangle carries the segments that may still win somewhere in it.  A few of them, the winners
at the corners and in the middle, serve as pivots: a candidate that a pivot beats on the whole
triangle (ten Bernstein coefficients of one sign) is dropped.  If few are left and the triangle is
a leaf (:mod:`harness.diagram.fast.classify`) it is recorded, otherwise a side is halved.

The record of a root is a *token* per triangle in preorder, 0, 1, 2 for the corner opposite to the
halved side or that of a leaf, and the leaves in that order (:mod:`harness.diagram.fast.records`).
Candidates' tables lie on one stack.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.choice import far_of_half, half_of
from harness.diagram.fast.examine import NORMS, borrowed_desk, look, new_desk
from harness.diagram.fast.fine import FINEST
from harness.diagram.fast.forms import halve
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, FAILED, HARD
from harness.diagram.fast.memory import borrowed, release
from harness.diagram.fast.records import (
    enlarged,
    finished,
    grown,
    is_full,
    lent,
    new_records,
    record_halving,
    record_leaf,
    room_of,
)
from harness.diagram.fast.sifting import borrowed_world
from harness.diagram.fast.tables import root_table

#: A triangle is the result of so many halvings at most, else it is handed over as hard.
DEEPEST = 400
#: After so many halvings without losing a candidate a triangle is handed over as hard.
PATIENCE = 200

#: Columns of a frame, a triangle that waits: first candidate, number of them, halvings so far, how
#: many of the last without losing a candidate, corners at infinity, only in double-double.
START, NUMBER, DEPTH, IDLE, FAR, IS_FINE = range(6)
#: Statistics: triangles, tests, hard leaves, open leaves, leaves in double-double, whether a root
#: had too many triangles.
TRIANGLES, TESTS, HARD_LEAVES, OPEN_LEAVES, FINE_LEAVES, TOO_MANY = range(6)


@compiled
def _root_tables(
    candidates,
    triangle,
    incident_first,
    incident,
    segments,
    corners,
    weights,
    size,
    sense,
    tables,
    norms,
    ids,
):
    """Tables and norms of the candidates over a root triangle."""
    for a in range(len(candidates)):
        ids[a] = candidates[a]
        zeros = ends = 0
        for k in range(3):
            for z in range(incident_first[triangle[k]], incident_first[triangle[k] + 1]):
                if incident[z] >> 1 == ids[a]:
                    zeros |= 1 << k
                    if incident[z] & 1:
                        ends |= 1 << k
        root_table(
            segments[ids[a]],
            corners,
            weights,
            zeros,
            ends,
            size,
            sense,
            tables[a],
            norms[a, 2:4],
        )
        norms[a, 4] = zeros + 8 * ends
        norms[a, 5] = a


@compiled
def _first_frame(path, m, far, spare, tables, frames, small):
    """The part of a root at the end of ``path`` as the only frame; ``spare``: a free table."""
    waiting, corners, exponents = frames
    _, e, lam = small
    exponents[0] = 0
    corners[0] = 0.0
    for k in range(3):
        corners[0, 4 * k] = 1.0
    for step in path:
        lam[:] = corners[0]
        e[:] = exponents[0]
        half_of(lam, e, step >> 1, step & 1, corners[0], exponents[0])
        for a in range(m):
            halve(tables, a, step >> 1, spare)
            if step & 1 == 0:
                tables[a] = tables[spare]
    waiting[0] = 0
    waiting[0, NUMBER], waiting[0, DEPTH], waiting[0, FAR] = m, len(path), far


@compiled
def _spot(triangle, k, e, lam, tie_first):
    """The number of corner k among the corners of roots if ties are known there, else −1."""
    if e[k] == 0:
        for c in range(3):
            corner = triangle[c]
            if lam[3 * k + c] == 1.0 and tie_first[corner] < tie_first[corner + 1]:
                return corner
    return -1


@compiled
def _descend(
    top,
    root,
    triangle,
    lists,
    frames,
    records,
    count,
    small,
    scene,
    desk,
    source,
    limit,
    statistics,
):
    """Look at the triangles on the stack until it is empty or room is short; what is left on it.

    ``lists``: tables, norms and numbers of the candidates; ``frames``: the stack with its corners
    and their exponents; ``limit``: triangles this root may come to.
    """
    tables, norms, ids = lists
    waiting, corners, exponents = frames
    spots, e, lam = small
    scratch = desk[2]
    tie_first = scene[1][3]
    rows, most_waiting, room = len(tables), len(waiting), room_of(records)
    while top > 0:
        top -= 1
        start, had, depth = waiting[top, START], waiting[top, NUMBER], waiting[top, DEPTH]
        if start + 2 * had > rows or top + 2 > most_waiting or is_full(room, count, had):
            return top + 1
        idle, far = waiting[top, IDLE], waiting[top, FAR]
        for k in range(3):
            e[k] = exponents[top, k]
        for c in range(18):
            lam[c] = corners[top, c]
        for k in range(3):
            spots[k] = _spot(triangle, k, e, lam, tie_first)
        statistics[TRIANGLES] += 1
        m, tests, kind, ports, choice, k, fine = look(
            tables,
            norms,
            ids,
            start,
            had,
            (depth, idle, waiting[top, IS_FINE] == 1),
            (far, spots, e, lam, triangle),
            scene,
            desk,
            source,
        )
        statistics[TESTS] += tests
        idle = 0 if m < had else idle + 1
        if kind == FAILED and statistics[TRIANGLES] > limit:
            kind, statistics[TOO_MANY] = HARD, 1
        if kind == FAILED and (
            max(e[(k + 1) % 3], e[(k + 2) % 3]) >= FINEST
            or depth >= DEEPEST
            or (idle > PATIENCE and m <= 12)
        ):
            kind = HARD
        if kind != FAILED:
            record_leaf(records, count, (start, m), (kind, ports, choice), ids, scratch, lam, root)
            statistics[FINE_LEAVES] += fine
            if kind == HARD:
                statistics[HARD_LEAVES] += 1
            elif kind != EMPTY and choice < 0:
                statistics[OPEN_LEAVES] += 1
            continue
        record_halving(records, count, k)
        for a in range(start, start + m):
            if not fine:
                halve(tables, a, k, a + m)
            for c in range(NORMS):
                norms[a + m, c] = norms[a, c]
            ids[a + m] = ids[a]
        # The second half (P, M, R) below, the first (P, Q, M) on top of the stack.
        for half in range(2):
            second = half == 0
            half_of(lam, e, k, second, corners[top], exponents[top])
            waiting[top, START], waiting[top, NUMBER] = start + half * m, m
            waiting[top, DEPTH], waiting[top, IDLE] = depth + 1, idle
            waiting[top, FAR], waiting[top, IS_FINE] = far_of_half(far, k, second), fine
            top += 1
    return top


@compiled
def subdivide(
    order,
    path,
    triangles,
    corners_dd,
    weights,
    special,
    incident_first,
    incident,
    candidate_first,
    candidate_count,
    candidates,
    segments,
    size,
    sense,
    definite,
    world,
    most,
):
    """Subdivide the root triangles numbered in ``order``, or one part of each.

    ``path``: halvings that lead to that part, as 2·k for the first and 2·k + 1 for the second half
    when the side opposite to corner k is halved.

    ``triangles`` (r, 3): corners, counter-clockwise.  ``corners_dd`` (c, 4), ``weights`` (c,): see
    :func:`harness.diagram.fast.tables.root_table`.  ``special`` (c,): whether a corner is.
    ``incident`` (CSR): the segments whose line passes through a corner; 2·segment + 1 if the corner
    is its endpoint, else 2·segment.  ``candidates``: segments to consider in each root, from
    ``candidate_first`` on.  ``definite``: every L is ≥ 0 on the whole domain.  ``world``: (lines,
    lengths, classes) of :class:`harness.diagram.fast.prepare.Prepared`, and the known ties (first
    row of each corner, rows; see :func:`harness.diagram.fast.forms.relation`).  ``most``: triangles
    allowed in a root, and 300 m² more with m candidates.

    Returns (tokens, leaf kinds, choices, first slot of each leaf, slots: place and owner, λ of the
    corners of the leaves that are not empty, which of them have low parts, and these, a point in
    each, root of each,
    first candidate and candidates of the open leaves, statistics: triangles, tests, hard leaves,
    open leaves, leaves in double-double, whether a root had too many triangles).
    """
    widest = 0
    for r in order:
        widest = max(widest, candidate_count[r])
    rows = 4 * widest + 64
    kept = (np.empty((rows, 9)), np.empty((rows, NORMS)), np.empty(rows, np.int64))
    kept_frames = (np.zeros((256, 6), np.int64), np.zeros((256, 18)), np.zeros((256, 3), np.int64))
    records = new_records(widest)
    count = np.zeros(7, np.int64)
    kept_root = (np.empty((widest, 20)), np.zeros(widest, np.bool_), np.empty((3, 4)), np.empty(3))
    of_root, known = borrowed(kept_root[0]), borrowed(kept_root[1])
    root_corners, root_weights = borrowed(kept_root[2]), borrowed(kept_root[3])
    kept_desk = new_desk(widest)
    desk = borrowed_desk(kept_desk)
    segments, triangles = borrowed(segments), borrowed(triangles)
    scene = (definite, borrowed_world(world), borrowed(special))
    statistics = np.zeros(6, np.int64)
    kept_small = (np.empty(3, np.int64), np.empty(3, np.int64), np.empty(18))
    small = (borrowed(kept_small[0]), borrowed(kept_small[1]), borrowed(kept_small[2]))
    for root in order:
        m = candidate_count[root]
        far = 0
        for k in range(3):
            root_corners[k] = corners_dd[triangles[root, k]]
            root_weights[k] = weights[triangles[root, k]]
            if root_weights[k] == 0.0:
                far |= 1 << k
        lists = (borrowed(kept[0]), borrowed(kept[1]), borrowed(kept[2]))
        frames = (borrowed(kept_frames[0]), borrowed(kept_frames[1]), borrowed(kept_frames[2]))
        _root_tables(
            candidates[candidate_first[root] : candidate_first[root] + m],
            triangles[root],
            incident_first,
            incident,
            segments,
            root_corners,
            root_weights,
            size,
            sense,
            lists[0],
            lists[1],
            lists[2],
        )
        known[:] = False
        source = (segments, root_corners, root_weights, size, sense, of_root, known)
        _first_frame(path, m, far, widest, lists[0], frames, small)
        # Where one root has failed, nothing is gained by more.
        limit = statistics[TRIANGLES] + (0 if statistics[TOO_MANY] else most + 300 * m * m)
        top = 1
        while top > 0:
            needed = frames[0][top - 1, START] + 2 * frames[0][top - 1, NUMBER]
            kept = (grown(kept[0], needed), grown(kept[1], needed), grown(kept[2], needed))
            kept_frames = (
                grown(kept_frames[0], top + 1),
                grown(kept_frames[1], top + 1),
                grown(kept_frames[2], top + 1),
            )
            records = enlarged(records, count, widest)
            lists = (borrowed(kept[0]), borrowed(kept[1]), borrowed(kept[2]))
            frames = (borrowed(kept_frames[0]), borrowed(kept_frames[1]), borrowed(kept_frames[2]))
            top = _descend(
                top,
                root,
                triangles[root],
                lists,
                frames,
                lent(records),
                borrowed(count),
                small,
                scene,
                desk,
                source,
                limit,
                borrowed(statistics),
            )
    result = finished(records, count)
    release(kept, kept_frames, kept_root, kept_desk, kept_small, records, count, statistics)
    return (*result, statistics)
