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

from harness.diagram.fast.choice import far_of_half, half_of
from harness.diagram.fast.examine import NORMS, borrowed_desk, look, new_desk
from harness.diagram.fast.fine import FINEST
from harness.diagram.fast.forms import halve
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, FAILED, HARD
from harness.diagram.fast.memory import borrowed, release
from harness.diagram.fast.tables import root_table

LEAF = 3
#: A triangle is the result of so many halvings at most, else it is handed over as hard.
DEEPEST = 400
#: After so many halvings without losing a candidate a triangle is handed over as hard.
PATIENCE = 200


@compiled
def grown(array, needed):
    """``array`` with room for ``needed`` rows, contents kept."""
    if needed <= len(array):
        return array
    bigger = np.empty((max(needed, 2 * len(array)), *array.shape[1:]), array.dtype)
    bigger[: len(array)] = array
    return bigger


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
    tables, norms, ids = borrowed(kept[0]), borrowed(kept[1]), borrowed(kept[2])
    # Start, count, depth, patience, far, fine; corners and halvings behind them.
    kept_frames = (np.zeros((256, 6), np.int64), np.zeros((256, 18)), np.zeros((256, 3), np.int64))
    frames, corners = borrowed(kept_frames[0]), borrowed(kept_frames[1])
    exponents = borrowed(kept_frames[2])
    kept_root = (np.empty((widest, 20)), np.zeros(widest, np.bool_), np.empty((3, 4)), np.empty(3))
    of_root, known = borrowed(kept_root[0]), borrowed(kept_root[1])
    root_corners, root_weights = borrowed(kept_root[2]), borrowed(kept_root[3])
    tokens = np.empty(1024, np.int8)
    kinds = np.empty(512, np.int8)
    choices = np.empty(512, np.int8)
    slots = np.empty((1024, 2), np.int32)
    first_slot = np.empty(513, np.int64)
    shapes = np.empty((256, 9))
    low_rows, lows = np.empty(16, np.int64), np.empty((16, 9))
    points = np.empty((256, 2))
    shape_roots = np.empty(256, np.int32)
    open_first = np.empty(65, np.int64)
    open_ids = np.empty(256, np.int64)
    n_tokens = n_leaves = n_slots = n_shapes = n_lows = n_open = n_open_ids = 0
    kept_desk = new_desk(widest)
    desk = borrowed_desk(kept_desk)
    scratch = desk[2]
    segments, triangles = borrowed(segments), borrowed(triangles)
    special, tie_first = borrowed(special), borrowed(world[3])
    scene = (
        definite,
        (
            borrowed(world[0]),
            borrowed(world[1]),
            borrowed(world[2]),
            tie_first,
            borrowed(world[4]),
        ),
        special,
    )
    statistics = np.zeros(6, np.int64)
    kept_small = (np.empty(3, np.int64), np.empty(3, np.int64), np.empty(18))
    spots, e, lam = borrowed(kept_small[0]), borrowed(kept_small[1]), borrowed(kept_small[2])
    for root in order:
        m = candidate_count[root]
        far = 0
        for k in range(3):
            root_corners[k] = corners_dd[triangles[root, k]]
            root_weights[k] = weights[triangles[root, k]]
            if root_weights[k] == 0.0:
                far |= 1 << k
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
            tables,
            norms,
            ids,
        )
        known[:] = False
        source = (segments, root_corners, root_weights, size, sense, of_root, known)
        exponents[0] = 0
        corners[0] = 0.0
        for k in range(3):
            corners[0, 4 * k] = 1.0
        for step in path:
            lam[:] = corners[0]
            e[:] = exponents[0]
            half_of(lam, e, step >> 1, step & 1, corners[0], exponents[0])
            for a in range(m):
                halve(tables, a, step >> 1, widest)
                if step & 1 == 0:
                    tables[a] = tables[widest]
        frames[0, 0], frames[0, 1], frames[0, 2] = 0, m, len(path)
        frames[0, 3], frames[0, 4], frames[0, 5] = 0, far, 0
        before = statistics[0]
        # Where one root has failed, nothing is gained by more.
        allowed = 0 if statistics[5] else most + 300 * m * m
        top = 1
        while top > 0:
            top -= 1
            start, m, depth = frames[top, 0], frames[top, 1], frames[top, 2]
            patience, far = frames[top, 3], frames[top, 4]
            e[:] = exponents[top]
            lam[:] = corners[top]
            for k in range(3):
                spots[k] = -1
                if e[k] == 0:
                    for c in range(3):
                        corner = triangles[root, c]
                        if lam[3 * k + c] == 1.0 and tie_first[corner] < tie_first[corner + 1]:
                            spots[k] = corner
            place = (far, spots, e, lam, triangles[root])
            statistics[0] += 1
            had = m
            m, tests, kind, ports, choice, k, fine = look(
                tables,
                norms,
                ids,
                start,
                m,
                (depth, patience, frames[top, 5] == 1),
                place,
                scene,
                desk,
                source,
            )
            statistics[1] += tests
            patience = 0 if m < had else patience + 1
            if kind == FAILED and statistics[0] - before > allowed:
                kind, statistics[5] = HARD, 1
            if kind == FAILED and (
                max(e[(k + 1) % 3], e[(k + 2) % 3]) >= FINEST
                or depth >= DEEPEST
                or (patience > PATIENCE and m <= 12)
            ):
                kind = HARD
            if n_tokens + 1 > len(tokens):
                tokens = grown(tokens, n_tokens + 1)
            if kind == FAILED:
                tokens[n_tokens] = k
                n_tokens += 1
                needed = start + 2 * m
                if needed > len(tables):
                    kept = (grown(kept[0], needed), grown(kept[1], needed), grown(kept[2], needed))
                    tables, norms, ids = borrowed(kept[0]), borrowed(kept[1]), borrowed(kept[2])
                for a in range(m):
                    if not fine:
                        halve(tables, start + a, k, start + m + a)
                    norms[start + m + a] = norms[start + a]
                    ids[start + m + a] = ids[start + a]
                if top + 2 > len(frames):
                    kept_frames = (
                        grown(kept_frames[0], top + 2),
                        grown(kept_frames[1], top + 2),
                        grown(kept_frames[2], top + 2),
                    )
                    frames, corners = borrowed(kept_frames[0]), borrowed(kept_frames[1])
                    exponents = borrowed(kept_frames[2])
                # The second half (P, M, R) below, the first (P, Q, M) on top of the stack.
                for half in range(2):
                    second = half == 0
                    f = top + half
                    half_of(lam, e, k, second, corners[f], exponents[f])
                    frames[f, 0], frames[f, 1], frames[f, 2] = start + half * m, m, depth + 1
                    frames[f, 3], frames[f, 5] = patience, fine
                    frames[f, 4] = far_of_half(far, k, second)
                top += 2
                continue
            tokens[n_tokens] = LEAF
            n_tokens += 1
            if n_leaves + 1 > len(kinds):
                kinds, choices = grown(kinds, n_leaves + 1), grown(choices, n_leaves + 1)
                first_slot = grown(first_slot, len(kinds) + 1)
            kinds[n_leaves] = kind
            choices[n_leaves] = choice
            first_slot[n_leaves] = n_slots
            n_leaves += 1
            statistics[4] += fine
            count = 0 if kind == HARD else max(ports, 1)
            if n_slots + count > len(slots):
                slots = grown(slots, n_slots + count)
            for c in range(count):
                slots[n_slots + c, 0] = scratch[4][c, 0]
                slots[n_slots + c, 1] = ids[start + scratch[4][c, 1]]
            n_slots += count
            if kind != EMPTY:
                if n_shapes + 1 > len(shapes):
                    shapes, points = grown(shapes, n_shapes + 1), grown(points, n_shapes + 1)
                    shape_roots = grown(shape_roots, n_shapes + 1)
                shapes[n_shapes] = lam[:9]
                if lam[9:].any():
                    if n_lows + 1 > len(lows):
                        low_rows, lows = grown(low_rows, n_lows + 1), grown(lows, n_lows + 1)
                    low_rows[n_lows], lows[n_lows] = n_shapes, lam[9:]
                    n_lows += 1
                points[n_shapes] = scratch[6]
                shape_roots[n_shapes] = root
                n_shapes += 1
                if kind == HARD or choice < 0:
                    open_first = grown(open_first, n_open + 2)
                    open_first[n_open] = n_open_ids
                    open_ids = grown(open_ids, n_open_ids + m)
                    open_ids[n_open_ids : n_open_ids + m] = ids[start : start + m]
                    n_open_ids += m
                    n_open += 1
                    statistics[2 if kind == HARD else 3] += 1
    first_slot[n_leaves] = n_slots
    open_first[n_open] = n_open_ids
    release(kept, kept_frames, kept_root, kept_desk, kept_small)
    return (
        tokens[:n_tokens].copy(),
        kinds[:n_leaves].copy(),
        choices[:n_leaves].copy(),
        first_slot[: n_leaves + 1].copy(),
        slots[:n_slots].copy(),
        shapes[:n_shapes].copy(),
        low_rows[:n_lows].copy(),
        lows[:n_lows].copy(),
        points[:n_shapes].copy(),
        shape_roots[:n_shapes].copy(),
        open_first[: n_open + 1].copy(),
        open_ids[:n_open_ids].copy(),
        statistics,
    )
