"""The envelope of half-planes whose boundary lines all run to the right (or all to the left).

Half-planes are those to the left of directed edges.  If all edges run to the right, the half-planes
lie above their lines, their intersection is the region above the upper envelope, and the lines of
that envelope appear from left to right in the order of their slopes.  Half a turn exchanges the
two cases, so the same loops serve both.

The functions are plain loops for :func:`harness.geometry.compiling.compiled`.  Edge i starts at
(x[i], y[i]) and ends at (ex[i], ey[i]); coordinates and ``slack`` are as in
:func:`harness.geometry.sweep.turn`.  Questions to the exact side are triples (i, j, k):

* k ≥ 0: on which side of line k is the point where lines i and j meet?
* k = ``SIDES``: on which side of line i does edge j start?
"""

from __future__ import annotations

from typing import Final

Known = list[tuple[int, int, int, int]]
Outcome = tuple[int, int, int, int, int]

UNSURE: Final = 2
SIDES: Final = -1

_ROUND: Final = 5 * 2.0**-53
_PRODUCT: Final = 3 * 2.0**-53
_TINY: Final = 2.0**-1060


def told(known: Known, i: int, j: int, k: int) -> int:
    """The answer to (i, j, k) if it is known, else UNSURE."""
    for row in range(len(known)):
        if known[row][0] == i and known[row][1] == j and known[row][2] == k:
            return known[row][3]
    return UNSURE


def filtered(a: float, b: float, slack: float) -> int:
    """The sign of A − B, where a and b are computed products of two coordinate differences.

    The bound 5u(|a| + |b|) + 18ε + 2⁻¹⁰⁶⁰ is derived in :func:`harness.geometry.sweep.turn`.
    """
    bound = _ROUND * (abs(a) + abs(b)) + (slack if slack > 0.0 else _TINY)
    if a - b > bound:
        return 1
    if a - b < -bound:
        return -1
    return UNSURE


def side_of_start(
    x: list[float],
    y: list[float],
    ex: list[float],
    ey: list[float],
    slack: float,
    known: Known,
    i: int,
    j: int,
) -> int:
    """The side of line i on which edge j, of the same direction, starts: 1 left, −1 right, 0 on it.

    Zeros that need no arithmetic: a factor zero in each product, or the edges share an end.
    """
    dx, dy = ex[i] - x[i], ey[i] - y[i]
    fx, fy = x[j] - x[i], y[j] - y[i]
    if slack == 0.0:
        if (dx == 0.0 or fy == 0.0) and (dy == 0.0 or fx == 0.0):
            return 0
        if (x[j] == ex[i] and y[j] == ey[i]) or (ex[j] == x[i] and ey[j] == y[i]):
            return 0
    answer = filtered(dx * fy, dy * fx, slack)
    return told(known, i, j, SIDES) if answer == UNSURE else answer


def side_of_corner(
    x: list[float],
    y: list[float],
    ex: list[float],
    ey: list[float],
    slack: float,
    known: Known,
    i: int,
    j: int,
    k: int,
) -> int:
    """The side of line k on which lines i and j meet, where edge j turns left from edge i.

    With starts v and directions d, the lines meet at vᵢ + t dᵢ, t = (vⱼ − vᵢ) × dⱼ / (dᵢ × dⱼ),
    and dᵢ × dⱼ > 0, so the side is the sign of

        D = (dₖ × (vᵢ − vₖ)) (dᵢ × dⱼ) + ((vⱼ − vᵢ) × dⱼ) (dₖ × dᵢ).

    *Error bound.*  Each of the four factors C is a cross product of coordinate differences,
    computed as c = fl(a − b) with |c − C| ≤ e = 5u(|a| + |b|) + 18ε + 2⁻¹⁰⁶⁰ (see
    :func:`harness.geometry.sweep.turn`).  Hence |c₁c₂ − C₁C₂| ≤ |c₁|e₂ + |c₂|e₁ + e₁e₂, the
    computed products q add u|q| + 2⁻¹⁰⁷⁵ each, and their sum adds u(|q₁| + |q₂|)(1 + u).  All
    terms are added up in floating point, which loses less than a factor 1 − 20u and 2⁻¹⁰⁷⁰ by
    underflow; the factor 1 + 2⁻²⁰ and the constant 2⁻¹⁰⁶⁰ make up for that generously.
    """
    constant = slack if slack > 0.0 else _TINY
    dix, diy = ex[i] - x[i], ey[i] - y[i]
    djx, djy = ex[j] - x[j], ey[j] - y[j]
    dkx, dky = ex[k] - x[k], ey[k] - y[k]
    wx, wy = x[i] - x[k], y[i] - y[k]
    zx, zy = x[j] - x[i], y[j] - y[i]
    a, b = dkx * wy, dky * wx
    c1, e1 = a - b, _ROUND * (abs(a) + abs(b)) + constant
    a, b = dix * djy, diy * djx
    c2, e2 = a - b, _ROUND * (abs(a) + abs(b)) + constant
    a, b = zx * djy, zy * djx
    c3, e3 = a - b, _ROUND * (abs(a) + abs(b)) + constant
    a, b = dkx * diy, dky * dix
    c4, e4 = a - b, _ROUND * (abs(a) + abs(b)) + constant
    q1, q2 = c1 * c2, c3 * c4
    bound = abs(c1) * e2 + abs(c2) * e1 + e1 * e2 + abs(c3) * e4 + abs(c4) * e3 + e3 * e4
    bound = (1.0 + 2.0**-20) * (bound + _PRODUCT * (abs(q1) + abs(q2))) + _TINY
    if q1 + q2 > bound:
        return 1
    if q1 + q2 < -bound:
        return -1
    return told(known, i, j, k)


def envelope(
    start: int,
    x: list[float],
    y: list[float],
    ex: list[float],
    ey: list[float],
    slack: float,
    known: Known,
    order: list[int],
    same: list[bool],
    stack: list[int],
    size: list[int],
) -> Outcome:
    """The edges whose lines bound the intersection along some length, in the sorted order.

    ``order`` is sorted by direction; ``same[k]`` says that edges order[k] and order[k − 1] have
    one direction.  The envelope is stack[0], …, stack[size[0] − 1]; of edges on one line the
    least index is kept.  Returns (position, status, i, j, k) as
    :func:`harness.geometry.exact.resolve` wants it.  O(m) for m edges (Graham's scan, dual).
    """
    for position in range(start, len(order)):
        edge, top = order[position], size[0]
        if same[position]:  # the innermost of parallel lines counts, and it is on top
            sign = side_of_start(x, y, ex, ey, slack, known, stack[top - 1], edge)
            if sign == UNSURE:
                return position, UNSURE, stack[top - 1], edge, SIDES
            if sign == 0:
                stack[top - 1] = min(stack[top - 1], edge)
            if sign <= 0:
                continue
            top -= 1
        while top >= 2:
            i, k = stack[top - 2], stack[top - 1]
            sign = side_of_corner(x, y, ex, ey, slack, known, i, edge, k)
            if sign == UNSURE:
                return position, UNSURE, i, edge, k
            if sign < 0:
                break
            top -= 1
        stack[top] = edge
        size[0] = top + 1
    return len(order), 0, 0, 0, 0


#: What the loop calls, for the compiler.
HELPERS = (told, filtered, side_of_start, side_of_corner)
