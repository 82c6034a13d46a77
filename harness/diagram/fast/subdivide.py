"""Halving triangles until each is a leaf, with ever shorter lists of candidates.

A triangle carries the segments that may still win somewhere in it.  A few of them, the winners
at the corners and in the middle, serve as pivots: a candidate that a pivot beats on the whole
triangle (ten Bernstein coefficients of one sign) is dropped.  If few are left and the triangle is
a leaf (:mod:`harness.diagram.fast.classify`) it is recorded, otherwise a side is halved.

The record of a root is a *token* per triangle in preorder, 0, 1, 2 for the corner opposite to the
halved side or ``LEAF``, and the leaves in that order.  Candidates' tables lie on one stack.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.choice import push_halves, side_to_halve
from harness.diagram.fast.classify import (
    beaten_by_two,
    classify_definite,
    is_blurred,
    may_tie_at_corner,
)
from harness.diagram.fast.forms import error_factor, halve, relation
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, FAILED, HARD
from harness.diagram.fast.mixed import classify_mixed
from harness.diagram.fast.prune import keep, localise, prune
from harness.diagram.fast.sides import MOST_PAIRED, all_pairs, new_scratch
from harness.diagram.fast.tables import root_table

LEAF = 3
#: Corners are exact in doubles: at most this many halvings between a corner and the root's.
FINEST = 50
#: After so many halvings without losing a candidate a triangle is handed over as hard.
PATIENCE = 90


@compiled
def grown(array, needed):
    """``array`` with room for ``needed`` rows, contents kept."""
    if needed <= len(array):
        return array
    bigger = np.empty((max(needed, 2 * len(array)), *array.shape[1:]), array.dtype)
    bigger[: len(array)] = array
    return bigger


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
    allowed in a root.

    Returns (tokens, leaf kinds, choices, first slot of each leaf, slots: place and owner, λ of
    the corners of the leaves that are not empty, a point in each, root of each, first candidate
    and candidates of the open leaves, statistics).
    """
    widest = 0
    for r in order:
        widest = max(widest, candidate_count[r])
    tables = np.empty((4 * widest + 64, 9))
    norms = np.empty((4 * widest + 64, 5))
    ids = np.empty(4 * widest + 64, np.int64)
    frames = np.zeros((256, 5), np.int64)  # start, count, depth, patience, far
    corners = np.zeros((256, 9))
    exponents = np.zeros((256, 3), np.int64)
    tokens = np.empty(1024, np.int8)
    kinds = np.empty(512, np.int8)
    choices = np.empty(512, np.int8)
    slots = np.empty((1024, 2), np.int32)
    first_slot = np.empty(513, np.int64)
    shapes = np.empty((256, 9))
    points = np.empty((256, 2))
    shape_roots = np.empty(256, np.int32)
    open_first = np.empty(65, np.int64)
    open_ids = np.empty(256, np.int64)
    n_tokens = n_leaves = n_slots = n_shapes = n_open = n_open_ids = 0
    scratch = new_scratch()
    work = (
        np.zeros(4, np.int64),
        np.zeros(widest + MOST_PAIRED, np.int64),
        np.zeros(widest + MOST_PAIRED, np.int64),
        np.zeros(widest + MOST_PAIRED, np.int64),
    )
    sides = np.ones(MOST_PAIRED)
    statistics = np.zeros(4, np.int64)
    spots = np.empty(3, np.int64)
    share = np.ones(8)
    e = np.empty(3, np.int64)
    lam = np.empty(9)
    lines, _, classes, tie_first, ties = world
    root_corners = np.empty((3, 4))
    root_weights = np.empty(3)
    for root in order:
        first = candidate_first[root]
        m = candidate_count[root]
        far = 0
        for k in range(3):
            root_corners[k] = corners_dd[triangles[root, k]]
            root_weights[k] = weights[triangles[root, k]]
            if root_weights[k] == 0.0:
                far |= 1 << k
        for a in range(m):
            ids[a] = candidates[first + a]
            zeros = ends = 0
            for k in range(3):
                corner = triangles[root, k]
                for z in range(incident_first[corner], incident_first[corner + 1]):
                    if incident[z] >> 1 == ids[a]:
                        zeros |= 1 << k
                        if incident[z] & 1:
                            ends |= 1 << k
            root_table(
                segments[ids[a]],
                root_corners,
                root_weights,
                zeros,
                ends,
                size,
                sense,
                tables[a],
                norms[a, 2:4],
            )
            norms[a, 4] = zeros + 8 * ends
        frames[0, 0], frames[0, 1], frames[0, 2], frames[0, 3], frames[0, 4] = 0, m, 0, 0, far
        exponents[0] = 0
        corners[0] = 0.0
        for k in range(3):
            corners[0, 4 * k] = 1.0
        before = statistics[0]
        allowed = min(most, 20_000 + 1_000 * m * m)
        for step in path:
            k, q, r = step >> 1, ((step >> 1) + 1) % 3, ((step >> 1) + 2) % 3
            for a in range(m):
                halve(tables, a, k, widest)
                if step & 1 == 0:
                    for c in range(9):
                        tables[a, c] = tables[widest, c]
            e[:] = exponents[0]
            lam[:] = corners[0]
            finer = max(e[q], e[r]) + 1
            p, near, far_end = 3 * k, 3 * q, 3 * r
            for c in range(3):
                middle = 0.5 * (lam[near + c] + lam[far_end + c])
                corners[0, c] = lam[p + c]
                corners[0, 3 + c] = middle if step & 1 else lam[near + c]
                corners[0, 6 + c] = lam[far_end + c] if step & 1 else middle
            exponents[0, 0] = e[k]
            exponents[0, 1] = finer if step & 1 else e[q]
            exponents[0, 2] = e[r] if step & 1 else finer
        frames[0, 2] = len(path)
        top = 1
        while top > 0:
            top -= 1
            start, m, depth = frames[top, 0], frames[top, 1], frames[top, 2]
            patience, far = frames[top, 3], frames[top, 4]
            e[:] = exponents[top]
            lam[:] = corners[top]
            factor = error_factor(depth)
            for k in range(3):
                spots[k] = -1
                if e[k] == 0:
                    for c in range(3):
                        corner = triangles[root, c]
                        if lam[3 * k + c] == 1.0 and tie_first[corner] < tie_first[corner + 1]:
                            spots[k] = corner
            localise(norms, start, m, lam, share)
            kept, tests = prune(
                tables, norms, ids, start, m, factor, far, definite, work, world, spots
            )
            statistics[0] += 1
            statistics[1] += tests
            patience = 0 if kept < m else patience + 1
            m = kept
            kind, ports, choice = FAILED, 0, 0
            lsign, qsign = work[1], work[2]
            if m == 1:
                kind = EMPTY
                scratch[4][0, 0], scratch[4][0, 1] = 1, 0
            elif m <= MOST_PAIRED:
                mixed = False
                for a in range(m):
                    mixed = mixed or lsign[a] == 0
                    sides[a] = lsign[a] if lsign[a] != 0 else 1
                same_line = (
                    m == 2 and lines[ids[start]] >= 0 and lines[ids[start]] == lines[ids[start + 1]]
                )
                if not mixed or same_line:
                    all_pairs(
                        tables, start, m, sides, norms, factor, far, world, spots, ids, scratch
                    )
                    if m > 2 and beaten_by_two(m, scratch, work[3]) < m:
                        m = keep(tables, norms, ids, start, m, lsign, qsign, work[3])
                        for a in range(m):
                            sides[a] = lsign[a] if lsign[a] != 0 else 1
                        all_pairs(
                            tables, start, m, sides, norms, factor, far, world, spots, ids, scratch
                        )
                    if m == 1:
                        kind = EMPTY
                        scratch[4][0, 0], scratch[4][0, 1] = 1, 0
                    elif m <= 4:
                        kind, ports, choice = classify_definite(m, scratch)
                    if kind == FAILED and (
                        is_blurred(m, scratch)
                        or may_tie_at_corner(m, scratch, e, lam, triangles[root], special)
                    ):
                        kind = HARD
                elif m == 2 and qsign[0] != 0 and qsign[0] == qsign[1]:
                    i, j = ids[start], ids[start + 1]
                    bound = factor * (
                        norms[start, 1] * norms[start + 1, 0]
                        + norms[start + 1, 1] * norms[start, 0]
                    )
                    known = relation(i, j, classes, tie_first, ties, spots)
                    kind, ports, choice = classify_mixed(
                        tables,
                        start,
                        start + 1,
                        lsign[0],
                        lsign[1],
                        qsign[0],
                        bound,
                        far,
                        known,
                        scratch,
                    )
            k = side_to_halve(tables, start, m, depth, lsign) if kind == FAILED else 0
            if kind == FAILED:
                q, r = (k + 1) % 3, (k + 2) % 3
                finer = max(e[q], e[r]) + 1
                if (
                    finer > FINEST
                    or (patience > PATIENCE and m <= 12)
                    or statistics[0] - before > allowed
                ):
                    kind = HARD
            tokens = grown(tokens, n_tokens + 1)
            if kind == FAILED:
                tokens[n_tokens] = k
                n_tokens += 1
                top_needed = start + 2 * m
                tables = grown(tables, top_needed)
                norms = grown(norms, top_needed)
                ids = grown(ids, top_needed)
                for a in range(m):
                    halve(tables, start + a, k, start + m + a)
                    norms[start + m + a] = norms[start + a]
                    ids[start + m + a] = ids[start + a]
                if top + 2 > len(frames):
                    frames = grown(frames, top + 2)
                    corners = grown(corners, top + 2)
                    exponents = grown(exponents, top + 2)
                push_halves(
                    frames,
                    corners,
                    exponents,
                    top,
                    start,
                    m,
                    depth,
                    patience,
                    far,
                    k,
                    finer,
                    lam,
                    e,
                )
                top += 2
                continue
            tokens[n_tokens] = LEAF
            n_tokens += 1
            kinds = grown(kinds, n_leaves + 1)
            choices = grown(choices, n_leaves + 1)
            first_slot = grown(first_slot, n_leaves + 2)
            kinds[n_leaves] = kind
            choices[n_leaves] = choice
            first_slot[n_leaves] = n_slots
            n_leaves += 1
            count = max(ports, 1)
            if kind == HARD:
                count = 0
            slots = grown(slots, n_slots + count)
            for c in range(count):
                slots[n_slots + c, 0] = scratch[4][c, 0]
                slots[n_slots + c, 1] = ids[start + scratch[4][c, 1]]
            n_slots += count
            if kind != EMPTY:
                shapes = grown(shapes, n_shapes + 1)
                points = grown(points, n_shapes + 1)
                shape_roots = grown(shape_roots, n_shapes + 1)
                shapes[n_shapes] = lam
                points[n_shapes] = scratch[6]
                shape_roots[n_shapes] = root
                n_shapes += 1
                if kind == HARD or choice < 0:
                    open_first = grown(open_first, n_open + 2)
                    open_first[n_open] = n_open_ids
                    open_ids = grown(open_ids, n_open_ids + m)
                    for a in range(m):
                        open_ids[n_open_ids + a] = ids[start + a]
                    n_open_ids += m
                    n_open += 1
                    statistics[2 if kind == HARD else 3] += 1
    first_slot[n_leaves] = n_slots
    open_first[n_open] = n_open_ids
    return (
        tokens[:n_tokens].copy(),
        kinds[:n_leaves].copy(),
        choices[:n_leaves].copy(),
        first_slot[: n_leaves + 1].copy(),
        slots[:n_slots].copy(),
        shapes[:n_shapes].copy(),
        points[:n_shapes].copy(),
        shape_roots[:n_shapes].copy(),
        open_first[: n_open + 1].copy(),
        open_ids[:n_open_ids].copy(),
        statistics,
    )
