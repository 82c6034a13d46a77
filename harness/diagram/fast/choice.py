"""Which side of a triangle to halve."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.double import sum_of
from harness.diagram.fast.forms import coefficients
from harness.diagram.fast.jit import compiled

#: Neighbouring coefficients, and the corner opposite to the side along which they are.
_STEPS_ALONG = np.array(
    [
        *([1, 6, 0], [6, 8, 0], [8, 2, 0], [3, 4, 0], [5, 9, 0], [9, 7, 0]),
        *([2, 7, 1], [7, 4, 1], [4, 0, 1], [8, 9, 1], [9, 3, 1], [6, 5, 1]),
        *([0, 3, 2], [3, 5, 2], [5, 1, 2], [4, 9, 2], [9, 6, 2], [7, 8, 2]),
    ]
)


#: A cubic less than so many times its error bound is worth computing more precisely.
WORN = 2.0**8


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
def side_to_halve(tables, norms, start, m, depth, lsign, factor):
    """The corner opposite to the side along which the contest varies most, and whether rounding
    blurs the contest.

    The variation of F between the first candidate and some others, along each side, relative to
    its size.  Blurred: some F is near its error bound in the whole triangle.
    """
    variation = np.zeros(3)
    zeros, turning = np.zeros(3, np.int64), np.zeros(3, np.int64)
    along = np.zeros(3)
    pairs = 0
    blurred = False
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
            if size < WORN * factor * (
                norms[start, 1] * norms[start + a, 0] + norms[start + a, 1] * norms[start, 0]
            ):
                blurred = True
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
                return k, blurred
    best = 0
    for k in range(1, 3):
        if variation[k] > variation[best]:
            best = k
    return best, blurred


@compiled
def halfway(lam, p, q, out, r):
    """The middle of corners p and q of a triangle becomes corner r of another; see ``subdivide``.

    Exact as long as double-doubles hold all weights.
    """
    for c in range(3):
        s, e = sum_of(lam[3 * p + c], lam[3 * q + c])
        e += lam[9 + 3 * p + c] + lam[9 + 3 * q + c]
        h = s + e
        out[3 * r + c], out[9 + 3 * r + c] = 0.5 * h, 0.5 * (e - (h - s))


@compiled
def copy_corner(lam, p, out, r):
    """Corner p of a triangle becomes corner r of another."""
    for c in range(3):
        out[3 * r + c], out[9 + 3 * r + c] = lam[3 * p + c], lam[9 + 3 * p + c]


@compiled
def half_of(lam, e, k, second, out, exponents):
    """One half of a triangle whose side opposite to corner k is halved.

    ``lam`` (18,), ``e`` (3,): its corners and how often sides were halved to get them; ``out``,
    ``exponents``: those of its half.  With corners P (number k), Q, R and M the middle of QR, the
    first half is (P, Q, M) and the second (P, M, R).
    """
    q, r = (k + 1) % 3, (k + 2) % 3
    finer = max(e[q], e[r]) + 1
    copy_corner(lam, k, out, 0)
    exponents[0] = e[k]
    if second:
        halfway(lam, q, r, out, 1)
        copy_corner(lam, r, out, 2)
        exponents[1], exponents[2] = finer, e[r]
    else:
        copy_corner(lam, q, out, 1)
        halfway(lam, q, r, out, 2)
        exponents[1], exponents[2] = e[q], finer


@compiled
def far_of_half(far, k, second):
    """The corners at infinity, a bit each, of one half of a triangle."""
    q, r = (k + 1) % 3, (k + 2) % 3
    middle = (far >> q & 1) & (far >> r & 1)
    if second:
        return far >> k & 1 | middle << 1 | (far >> r & 1) << 2
    return far >> k & 1 | (far >> q & 1) << 1 | middle << 2
