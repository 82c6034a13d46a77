"""Which side of a triangle to halve."""

from __future__ import annotations

import numpy as np

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
def push_halves(frames, corners, exponents, top, start, m, depth, patience, far, k, finer, lam, e):
    """Put both halves of a triangle on the stack, the first on top; see ``subdivide``.

    The side opposite to corner k is halved; ``finer``: the number of halvings behind its middle.
    """
    q, r = (k + 1) % 3, (k + 2) % 3
    middle_far = (far >> q & 1) & (far >> r & 1)
    # Second half (P, M, R) below, first half (P, Q, M) on top of the stack.
    for half in range(2):
        f = top + half
        frames[f, 0] = start + half * m
        frames[f, 1] = m
        frames[f, 2] = depth + 1
        frames[f, 3] = patience
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
