"""The tables of all candidates over a root triangle, from coordinates in double-double.

A coordinate is a pair (high, low) whose sum is within 2⁻¹⁰⁵ of it, relatively to the size S of
all coordinates (exactly it, if it is a double).  Differences are rounded once from such pairs; the
rest is plain doubles.  :mod:`harness.diagram.fast.forms` bounds the error.
"""

from __future__ import annotations

from harness.diagram.fast.double import TINY
from harness.diagram.fast.jit import compiled

#: Times S, the least size that a coordinate difference is taken to have in an error bound.
SLACK = 2.0**-50


@compiled
def difference(ah, al, bh, bl):
    """a − b of two double-doubles, rounded once."""
    s = ah - bh
    t = s - ah
    e = (ah - (s - t)) - (bh + t)
    return s + (e + (al - bl))


@compiled
def nonzero(value):
    """A number that rounded to zero but is not known to be zero becomes TINY."""
    return TINY if value == 0.0 else value


@compiled
def root_table(segment, corners, weights, zeros, ends, size, sense, table, norm):
    """The table of one segment over a root triangle, and (ML, MQ).

    ``segment`` (8,): ax, ay, bx, by, high and low parts.  ``corners`` (3, 4), ``weights`` (3,): 1,
    or 0 for a corner at infinity.  ``zeros``, ``ends``: bits of the corners on the segment's line
    and at its endpoints.  ``sense``: 1, or −1 to negate Q.
    """
    slack = SLACK * size
    dx = difference(segment[4], segment[5], segment[0], segment[1])
    dy = difference(segment[6], segment[7], segment[2], segment[3])
    largest = abs(dx) + abs(dy)
    reach = 0.0
    ax0 = ay0 = ax1 = ay1 = ax2 = ay2 = 0.0
    bx0 = by0 = bx1 = by1 = bx2 = by2 = 0.0
    for k in range(3):
        c = corners[k]
        if weights[k] == 0.0:
            ax, ay, bx, by = -c[0], -c[2], -c[0], -c[2]
        else:
            ax = difference(segment[0], segment[1], c[0], c[1])
            ay = difference(segment[2], segment[3], c[2], c[3])
            bx = difference(segment[4], segment[5], c[0], c[1])
            by = difference(segment[6], segment[7], c[2], c[3])
        reach = max(reach, abs(ax) + abs(ay), abs(bx) + abs(by))
        if zeros >> k & 1:
            table[k] = 0.0
        else:
            table[k] = nonzero(ax * dy - ay * dx)
        if ends >> k & 1:
            table[3 + k] = 0.0
        else:
            table[3 + k] = nonzero(sense * (ax * bx + ay * by))
        if k == 0:
            ax0, ay0, bx0, by0 = ax, ay, bx, by
        elif k == 1:
            ax1, ay1, bx1, by1 = ax, ay, bx, by
        else:
            ax2, ay2, bx2, by2 = ax, ay, bx, by
    half = 0.5 * sense
    table[6] = nonzero(half * ((ax0 * bx1 + ay0 * by1) + (ax1 * bx0 + ay1 * by0)))
    table[7] = nonzero(half * ((ax0 * bx2 + ay0 * by2) + (ax2 * bx0 + ay2 * by0)))
    table[8] = nonzero(half * ((ax1 * bx2 + ay1 * by2) + (ax2 * bx1 + ay2 * by1)))
    reach += 4.0 * slack
    norm[0] = reach * (largest + 4.0 * slack)
    norm[1] = reach * reach
