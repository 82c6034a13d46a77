"""Which side of a triangle to halve."""

from __future__ import annotations

from harness.diagram.fast.double import sum_of
from harness.diagram.fast.forms import coefficients
from harness.diagram.fast.jit import compiled

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
def _steepest(s0, s1, s2, s3, m0, m1, m2, t0, t1):
    """The greatest difference of neighbours in the rows of coefficients along one direction."""
    side = max(max(abs(s0 - s1), abs(s1 - s2)), abs(s2 - s3))
    return max(max(side, abs(t0 - t1)), max(abs(m0 - m1), abs(m1 - m2)))


@compiled
def side_to_halve(tables, norms, start, m, depth, lsign, factor):
    """The corner opposite to the side along which the contest varies most, and whether rounding
    blurs the contest.

    The variation of F between the first candidate and some others, along each side, relative to
    its size.  Blurred: some F is near its error bound in the whole triangle.
    """
    along_0 = along_1 = along_2 = 0.0
    # Corners, a bit each: where all F vanish, and where some F changes sign with the direction.
    zeros, turning = 7, 0
    blurred, some = False, False
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
            some = True
            if size < WORN * factor * (
                norms[start, 1] * norms[start + a, 0] + norms[start + a, 1] * norms[start, 0]
            ):
                blurred = True
            for r in range(3):
                if abs(c[r]) > 1e-13 * size:
                    zeros &= ~(1 << r)
                elif _turns(c, r, 1e-13 * size):
                    turning |= 1 << r
            along_0 += _steepest(c[1], c[6], c[8], c[2], c[5], c[9], c[7], c[3], c[4]) / size
            along_1 += _steepest(c[2], c[7], c[4], c[0], c[8], c[9], c[3], c[6], c[5]) / size
            along_2 += _steepest(c[0], c[3], c[5], c[1], c[4], c[9], c[6], c[7], c[8]) / size
    # Where all tie at a corner and some F changes sign with the direction, its far side is halved
    # every second time: cutting across would repeat the same picture, smaller and smaller.
    if depth & 1 and some:
        for k in range(3):
            if zeros & turning & 1 << k:
                return k, blurred
    if along_2 > along_0 and along_2 > along_1:
        return 2, blurred
    return (1 if along_1 > along_0 else 0), blurred


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
