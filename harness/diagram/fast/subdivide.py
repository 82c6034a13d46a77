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

from harness.diagram.fast.classify import (
    beaten_by_two,
    classify_definite,
    is_blurred,
    may_tie_at_corner,
)
from harness.diagram.fast.forms import (
    coefficients,
    error_factor,
    halve,
    relation,
    surely_positive,
)
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, FAILED, HARD
from harness.diagram.fast.mixed import classify_mixed
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
def localise(norms, start, m, lam, share):
    """ML and MQ of all candidates on a triangle, columns 0 and 1, from those of the root, 2 and 3.

    Column 4 holds the root's corners at which L is zero (3 bits) and at which Q is (3 bits).  At
    a point λ only the other corners contribute to L, so |L| ≤ ML·Σ λ_k over these, and roundings
    are as much smaller.  If Q is zero at just one corner, |q(λ, λ')| ≤ MQ·(Σ λ_k + Σ λ'_k) likewise.
    """
    for bits in range(1, 8):
        most = 0.0
        for p in range(3):
            total = 0.0
            for k in range(3):
                if not bits >> k & 1:
                    total += lam[3 * p + k]
            most = max(most, total)
        share[bits] = most
    for a in range(start, start + m):
        flags = int(norms[a, 4])
        norms[a, 0] = norms[a, 2] * share[flags & 7]
        ends = flags >> 3
        norms[a, 1] = norms[a, 3]
        if ends == 1 or ends == 2 or ends == 4:
            norms[a, 1] *= min(1.0, 2.0 * share[ends])


@compiled
def _line_sign(tables, row, error):
    """The sign of L on the triangle if it is certainly constant in its interior, else 0."""
    positive = negative = 0
    for k in range(3):
        if tables[row, k] > error:
            positive += 1
        elif tables[row, k] < -error:
            negative += 1
        elif tables[row, k] != 0.0:
            return 0
    if positive and negative:
        return 0
    return 1 if positive else (-1 if negative else 0)


@compiled
def _form_sign(tables, row, error):
    """1 if Q ≥ 0 on the triangle, −1 if Q ≤ 0, certainly; else 0."""
    positive = negative = 0
    for k in range(3, 9):
        if tables[row, k] > error:
            positive += 1
        elif tables[row, k] < -error:
            negative += 1
        elif tables[row, k] != 0.0:
            return 0
    if positive and negative:
        return 0
    return 1 if positive else (-1 if negative else 0)


@compiled
def beats(tables, i, j, lt, ls, qt, qs, bound, far, known):
    """Whether the first candidate certainly wins against the second all over the triangle.

    ``lt``, ``ls``: signs of L (0: not constant).  ``qt``, ``qs``: signs of Q (0: not constant).
    """
    if lt != 0 and ls != 0:
        return surely_positive(tables, i, j, lt, ls, bound, far, known)
    if qt == 1 and qs == -1:
        return True
    if lt != 0:  # |L_s| is ±L_s: one sign suffices where Q_t ≥ 0, else take both
        one = surely_positive(tables, i, j, lt, 1.0, bound, far, known)
        if qt == 1:
            return one or surely_positive(tables, i, j, lt, -1.0, bound, far, known)
        return one and surely_positive(tables, i, j, lt, -1.0, bound, far, known)
    if ls != 0:  # likewise for |L_t|, where Q_s ≤ 0
        one = surely_positive(tables, i, j, 1.0, ls, bound, far, known)
        if qs == -1:
            return one or surely_positive(tables, i, j, -1.0, ls, bound, far, known)
        return one and surely_positive(tables, i, j, -1.0, ls, bound, far, known)
    return False


@compiled
def collinear_beats(tables, i, j, length_i, length_j, bound):
    """The same for two segments on one line: G > 0."""
    for k in range(3, 9):
        if not tables[i, k] * length_j - tables[j, k] * length_i > bound:
            return False
    return True


@compiled
def _best_at(tables, start, m, corner):
    """The candidate with the greatest Q/|L| at a corner (3: the middle), in doubles."""
    best, bq, bl = -1, 0.0, 1.0
    for a in range(m):
        r = start + a
        if corner < 3:
            q, line = tables[r, 3 + corner], abs(tables[r, corner])
        else:
            q = tables[r, 3] + tables[r, 4] + tables[r, 5]
            q += 2.0 * (tables[r, 6] + tables[r, 7] + tables[r, 8])
            line = abs(tables[r, 0] + tables[r, 1] + tables[r, 2])
        if q == 0.0 and line == 0.0:
            continue
        if best < 0 or q * bl > bq * line:
            best, bq, bl = a, q, line
    return best


@compiled
def prune(tables, norms, ids, start, m, factor, far, definite, work, world, spots):
    """Drop candidates beaten by a pivot; the number left, moved to the front (stable)."""
    pivots, lsign, qsign, beaten = work
    count = 0
    for corner in range(4):
        best = _best_at(tables, start, m, corner)
        new = best >= 0
        for r in range(count):
            new = new and pivots[r] != best
        if new:
            pivots[count] = best
            count += 1
    for a in range(m):
        beaten[a] = 0
        if definite:
            lsign[a] = 1
            qsign[a] = 0
        else:
            lsign[a] = _line_sign(tables, start + a, factor * norms[start + a, 0])
            qsign[a] = _form_sign(tables, start + a, factor * norms[start + a, 1])
    tests = 0
    for a in range(m):
        for r in range(count):
            p = pivots[r]
            if p == a or beaten[p]:
                continue
            tests += 1
            if _tested(tables, norms, ids, start, p, a, lsign, qsign, factor, far, world, spots):
                beaten[a] = 1
                break
    kept = keep(tables, norms, ids, start, m, lsign, qsign, beaten)
    if 1 < kept <= 6:
        kept = _prune_pairs(
            tables, norms, ids, start, kept, lsign, qsign, beaten, factor, far, world, spots
        )
    return kept, tests


@compiled
def keep(tables, norms, ids, start, m, lsign, qsign, beaten):
    """Move the candidates that are not beaten to the front; their number."""
    kept = 0
    for a in range(m):
        if not beaten[a]:
            if kept != a:
                for c in range(9):
                    tables[start + kept, c] = tables[start + a, c]
                for c in range(5):
                    norms[start + kept, c] = norms[start + a, c]
                ids[start + kept] = ids[start + a]
                lsign[kept] = lsign[a]
                qsign[kept] = qsign[a]
            kept += 1
    return kept


@compiled
def _tested(tables, norms, ids, start, p, a, lsign, qsign, factor, far, world, spots):
    lines, lengths, classes, tie_first, ties = world
    i, j = ids[start + p], ids[start + a]
    if lines[i] >= 0 and lines[i] == lines[j]:
        bound = factor * (norms[start + p, 1] * lengths[j] + norms[start + a, 1] * lengths[i])
        return collinear_beats(tables, start + p, start + a, lengths[i], lengths[j], bound)
    bound = factor * (
        norms[start + p, 1] * norms[start + a, 0] + norms[start + a, 1] * norms[start + p, 0]
    )
    known = relation(i, j, classes, tie_first, ties, spots)
    return beats(
        tables, start + p, start + a, lsign[p], lsign[a], qsign[p], qsign[a], bound, far, known
    )


@compiled
def _prune_pairs(tables, norms, ids, start, m, lsign, qsign, beaten, factor, far, world, spots):
    for a in range(m):
        beaten[a] = 0
    for a in range(m):
        for p in range(m):
            if (
                p != a
                and not beaten[p]
                and _tested(
                    tables, norms, ids, start, p, a, lsign, qsign, factor, far, world, spots
                )
            ):
                beaten[a] = 1
                break
    kept = keep(tables, norms, ids, start, m, lsign, qsign, beaten)
    return kept


#: Neighbouring coefficients, and the corner opposite to the side along which they are.
_STEPS_ALONG = np.array(
    [[1, 6, 0], [6, 8, 0], [8, 2, 0], [3, 4, 0], [5, 9, 0], [9, 7, 0]]
    + [[2, 7, 1], [7, 4, 1], [4, 0, 1], [8, 9, 1], [9, 3, 1], [6, 5, 1]]
    + [[0, 3, 2], [3, 5, 2], [5, 1, 2], [4, 9, 2], [9, 6, 2], [7, 8, 2]]
)


@compiled
def _turns(c, k, tiny):
    """Whether a cubic that vanishes at corner k changes sign with the direction from there."""
    if k == 0:
        one, two, near, middle, far = c[3], c[4], c[5], c[9], c[7]
    elif k == 1:
        one, two, near, middle, far = c[6], c[5], c[8], c[9], c[3]
    else:
        one, two, near, middle, far = c[7], c[8], c[4], c[9], c[6]
    if abs(one) > tiny or abs(two) > tiny:
        return one * two < 0.0
    return near * middle < 0.0 or middle * far < 0.0 or near * far < 0.0


@compiled
def side_to_halve(tables, start, m, depth, lsign):
    """The corner opposite to the side along which the contest varies most.

    The variation of F between the first candidate and some others, along each side, relative to
    its size.
    """
    variation = np.zeros(3)
    zeros, turning = np.zeros(3, np.int64), np.zeros(3, np.int64)
    along = np.zeros(3)
    pairs = 0
    for a in range(1, min(m, 6)):
        both = lsign[0] == 0 or lsign[a] == 0
        for sign in range(2 if both else 1):
            st = -1.0 if lsign[0] < 0 else 1.0
            ss = -1.0 if (lsign[a] < 0) != (sign == 1) else 1.0
            c = coefficients(tables, start, start + a, st, ss)
            size = 0.0
            for r in range(10):
                size = max(size, abs(c[r]))
            if size == 0.0:
                continue
            pairs += 1
            for r in range(3):
                if abs(c[r]) <= 1e-13 * size:
                    zeros[r] += 1
                    turning[r] += _turns(c, r, 1e-13 * size)
            for r in range(18):
                k = _STEPS_ALONG[r, 2]
                step = abs(c[_STEPS_ALONG[r, 0]] - c[_STEPS_ALONG[r, 1]]) / size
                along[k] = max(along[k], step)
            for k in range(3):
                variation[k] += along[k]
                along[k] = 0.0
    # Where all tie at a corner and some F changes sign with the direction, its far side is halved
    # every second time: cutting across would repeat the same picture, smaller and smaller.
    if depth & 1:
        for k in range(3):
            if pairs > 0 and zeros[k] == pairs and turning[k] > 0:
                return k
    best = 0
    for k in range(1, 3):
        if variation[k] > variation[best]:
            best = k
    return best


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
    :func:`harness.diagram.fast.tables.root_table`.  ``special`` (c,): whether a corner is.  ``incident`` (CSR): the segments whose line
    passes through a corner; 2·segment + 1 if the corner is its endpoint, else 2·segment.
    ``candidates``: segments to consider in each root, from ``candidate_first`` on.  ``definite``: every L is ≥ 0 on the
    whole domain.  ``world``: (lines, lengths, classes) of :class:`harness.diagram.fast.prepare.Prepared`, and the
    known ties (first row of each corner, rows; see :func:`harness.diagram.fast.forms.relation`).
    ``most``: triangles allowed in a root.

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
    lines, lengths, classes, tie_first, ties = world
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
                middle_far = (far >> q & 1) & (far >> r & 1)
                # Second half (P, M, R) below, first half (P, Q, M) on top of the stack.
                for half in range(2):
                    f = top + half
                    frames[f, 0] = start + half * m
                    frames[f, 1] = m
                    frames[f, 2] = depth + 1
                    frames[f, 3] = patience
                    x, y = (r, -1) if half == 0 else (q, -1)
                    bits = far >> k & 1
                    corners[f, 0:3] = lam[3 * k : 3 * k + 3]
                    exponents[f, 0] = e[k]
                    if half == 0:
                        corners[f, 6:9] = lam[3 * r : 3 * r + 3]
                        exponents[f, 2] = e[r]
                        exponents[f, 1] = finer
                        bits |= middle_far << 1 | (far >> r & 1) << 2
                        for c in range(3):
                            corners[f, 3 + c] = 0.5 * (lam[3 * q + c] + lam[3 * r + c])
                    else:
                        corners[f, 3:6] = lam[3 * q : 3 * q + 3]
                        exponents[f, 1] = e[q]
                        exponents[f, 2] = finer
                        bits |= (far >> q & 1) << 1 | middle_far << 2
                        for c in range(3):
                            corners[f, 6 + c] = 0.5 * (lam[3 * q + c] + lam[3 * r + c])
                    frames[f, 4] = bits
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
