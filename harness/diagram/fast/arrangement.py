"""The arrangement of lines: the convex faces into which they cut the plane.

The points on a line and its two ends at infinity cut it into pieces; piece q of line i runs from
the point q − 1 of that line to the point q (the ends are before the first and after the last).
Half-edge 2e runs along piece e, 2e + 1 back; the face of a half-edge is to its left.  Where a
half-edge arrives, its face goes on with the next line clockwise from where it came.  At infinity
parallel lines meet, so there a face goes back along the next parallel line to the left, or from the
last of them to the next direction, across a *gap*.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from harness.diagram.fast.jit import compiled
from harness.diagram.fast.line_points import Points
from harness.diagram.fast.lines import Lines
from harness.diagram.fast.roots import Ints


@dataclass(frozen=True, eq=False)
class Arrangement:
    """``heads`` (h,): the point in which each half-edge ends, −1 − k for direction k at infinity.

    Directions 0 … r − 1 are those of the lines by angle, r … 2r − 1 the opposite ones.  ``gap``
    (h,): whether the half-edge ends at infinity and the face goes on at the next direction.
    ``face`` (h,), ``faces``: their number.  ``first`` (f + 1,), ``cycle`` (h,): the half-edges of
    each face, counter-clockwise.  ``inside`` (e,): whether a piece is inside a segment.
    ``line`` (e,): the line of each piece.
    """

    heads: Ints
    gap: Ints
    face: Ints
    faces: int
    first: Ints
    cycle: Ints
    inside: Ints
    line: Ints
    directions: int

    def tails(self) -> Ints:
        """Where each half-edge begins, as ``heads``."""
        found: Ints = self.heads.reshape(-1, 2)[:, ::-1].ravel()
        return found


def arrange(lines: Lines, points: Points) -> Arrangement:
    """The arrangement; O(points) after sorting."""
    count, total = len(lines.d), len(points.line)
    base = points.first[:-1] + np.arange(count)  # the first piece of each line
    position = np.arange(total) - points.first[points.line]
    arriving = base[points.line] + position  # the piece before a point; the next is after it
    after = np.full(2 * (total + count), -1, dtype=np.int64)
    _turn_at_points(lines, points, arriving, after)
    gap = np.zeros(len(after), dtype=bool)
    directions = int(lines.rank.max()) + 1
    _turn_at_infinity(lines, base, points.first[1:] + np.arange(count), after, gap)
    heads = np.empty((total + count, 2), dtype=np.int64)
    heads[arriving, 0] = points.vertex
    heads[arriving + 1, 1] = points.vertex
    heads[base + np.diff(points.first), 0] = -1 - lines.rank
    heads[base, 1] = -1 - directions - lines.rank
    face, first, cycle = _traced(after)
    return Arrangement(
        heads=heads.ravel(),
        gap=gap,
        face=face,
        faces=len(first) - 1,
        first=first,
        cycle=cycle,
        inside=_inside(lines, points, base, total + count),
        line=np.repeat(np.arange(count), np.diff(points.first) + 1),
        directions=directions,
    )


def _turn_at_points(lines: Lines, points: Points, arriving: Ints, after: Ints) -> None:
    """What follows every half-edge that ends at a finite point.

    The lines through a point by angle are l₀ … l_k; after arriving along l_r, r > 0, one goes back
    along l_{r−1}, and after l₀ on along l_k; with all signs changed if one came backwards.
    """
    rank = lines.rank[points.line]
    order = np.lexsort((rank, points.vertex))
    vertex = points.vertex[order]
    begins = np.ones(len(order), dtype=bool)
    begins[1:] = vertex[1:] != vertex[:-1]
    starts = np.flatnonzero(begins)
    stops = np.append(starts[1:], len(order))
    group = np.cumsum(begins) - 1
    before = np.where(begins, stops[group] - 1, np.arange(len(order)) - 1)
    here, there = arriving[order], arriving[order[before]]
    # Forwards over piece a and onwards over a + 1; backwards over a + 1 and onwards over a.
    on, back = 2 * (there + 1), 2 * there + 1
    after[2 * here] = np.where(begins, on, back)
    after[2 * (here + 1) + 1] = np.where(begins, back, on)


def _turn_at_infinity(
    lines: Lines, first_piece: Ints, last_piece: Ints, after: Ints, gap: np.ndarray
) -> None:
    """What follows every half-edge that ends at infinity.

    The lines of one direction are ordered by c, that is from the right to the left.
    """
    by_direction: list[list[int]] = [[] for _ in range(int(lines.rank.max()) + 1)]
    for i, rank in enumerate(lines.rank.tolist()):
        by_direction[rank].append(i)
    for row in by_direction:
        row.sort(key=lines.c.__getitem__)
    count = len(by_direction)
    for k, row in enumerate(by_direction):
        for right, left in pairwise(row):
            after[2 * last_piece[right]] = 2 * last_piece[left] + 1
            after[2 * first_piece[left] + 1] = 2 * first_piece[right]
        leftmost, rightmost = row[-1], row[0]
        if k + 1 < count:
            following = by_direction[k + 1]
            after[2 * last_piece[leftmost]] = 2 * last_piece[following[0]] + 1
            after[2 * first_piece[rightmost] + 1] = 2 * first_piece[following[-1]]
        else:
            following = by_direction[0]
            after[2 * last_piece[leftmost]] = 2 * first_piece[following[-1]]
            after[2 * first_piece[rightmost] + 1] = 2 * last_piece[following[0]] + 1
        gap[2 * last_piece[leftmost]] = gap[2 * first_piece[rightmost] + 1] = True


@compiled
def _traced(after):
    """Faces as cycles of ``after``: the face of every half-edge, and the cycles in CSR form."""
    face = np.full(len(after), -1, np.int64)
    first = np.zeros(len(after) + 1, np.int64)
    cycle = np.empty(len(after), np.int64)
    faces = used = 0
    for start in range(len(after)):
        if face[start] >= 0:
            continue
        half = start
        while face[half] < 0:
            face[half] = faces
            cycle[used] = half
            used += 1
            half = after[half]
        faces += 1
        first[faces] = used
    return face, first[: faces + 1].copy(), cycle


def _inside(lines: Lines, points: Points, base: Ints, pieces: int) -> Ints:
    """Whether each piece is a part of a segment."""
    inside = np.zeros(pieces, dtype=bool)
    for i, members in enumerate(lines.segments):
        row = points.vertex[points.first[i] : points.first[i + 1]]
        for k in members:
            low, high = sorted(int(np.flatnonzero(row == v)[0]) for v in points.ends[k])
            inside[base[i] + low + 1 : base[i] + high + 1] = True
    return inside
