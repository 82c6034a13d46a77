"""What the diagram looks like inside a triangle, proved from Bernstein coefficients.

A triangle with candidates 1 … m is a *leaf* if its part of the diagram follows from what is seen on
its sides.  The proofs use three facts about the cubics F (positive where one candidate beats
another) on a convex triangle T:

* **Side.**  If the four coefficients of F on a side change sign once, F has exactly one zero
  there, if they do not change sign, none (Descartes' rule in Bernstein form).
* **Cone.**  If the six control vectors of ∇F have a positive inner product with one direction, F
  increases along it: F has no critical point in T, so its zero set has no loop in T and consists
  of arcs from side to side.
* **Hull.**  If det(f, g) > 0 for all control vectors f of ∇F and g of ∇G, then (F, G) is injective
  on T: between two points p, p', F(p') − F(p) = f̄·(p' − p) with f̄ in the convex hull of the f,
  likewise for G, and det(f̄, ḡ) > 0.  So three segments tie in at most one point of T.

The *ports* are the points where an edge meets ∂T, and the *pieces* the parts of ∂T between them.

arc       m = 2, cone, two ports: one arc.  No port: nothing.
triple    m = 3, cones, hull, three ports between three different pieces: the arc from the port
          (u, v) ends neither at the other ports (wrong pairs) nor in T alone, so it ends at a
          point where all three tie, and there is only one.
two arcs  m = 3, cones, hull, pieces u, v, u, w: a vertex would need a port (v, w), or a second
          vertex.  So the arcs cut off v and w.
quad      m = 4, cones, all four hulls, four different pieces a, b, c, d: every triple ties at most
          once, so either a and c share an edge, or b and d do, or all four tie.  Which is decided
          where three of them tie.
saddle    m = 2, pieces u, v, u, v and hull for (∂₁F, ∂₂F) with negative determinant: at most one
          critical point, and that a saddle, no loop.  The sign of F there decides.
mixed     m = 2, in the plane, where the line of a candidate crosses T and both Q ≥ 0: see
          :func:`classify_mixed`.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.forms import (
    SIDES,
    UNKNOWN,
    gradient_controls,
    value_and_gradient,
)
from harness.diagram.fast.jit import compiled

# Kinds of leaves.
FAILED, EMPTY, ARC, TRIPLE, TWO_ARCS, QUAD, SADDLE, CROSSING, HARD = range(-1, 8)
#: For QUAD: 0 and 1 say which pair of pieces shares an edge; for SADDLE which pieces are one.
OPEN, TIED = -1, 2
MOST_PORTS = 12
#: How closely the zero of a cubic on a side is looked for.
NEAR = 1e-14


@compiled
def sign_changes(signs, values, bound, k):
    """The number of zeros of a cubic on side k if that is certainly 0 or 1, and otherwise −1.

    Structural zeros at the ends of the side are not counted.
    """
    previous, count, unknown = 0, 0, False
    for r in range(4):
        sign = signs[SIDES[k, r]]
        if sign == UNKNOWN:
            unknown = True
        elif sign != 0:
            if previous != 0 and sign != previous:
                count += 1
            previous = sign
    if not unknown and previous != 0 and count <= 1:
        return count
    first, last = signs[SIDES[k, 0]], signs[SIDES[k, 3]]
    if first == UNKNOWN or last == UNKNOWN or first * last != -1:
        return -1
    # A monotone function that changes sign has one zero.
    for r in range(3):
        if not first * (values[SIDES[k, r]] - values[SIDES[k, r + 1]]) > 2.0 * bound:
            return -1
    return 1


@compiled
def has_two_zeros(values, bound, k):
    """Whether a cubic that is positive at both ends of side k certainly has two zeros there.

    The side is cut where the cubic is certainly negative; on both parts its coefficients must
    then change sign once.
    """
    a, b, c, d = values[SIDES[k, 0]], values[SIDES[k, 1]], values[SIDES[k, 2]], values[SIDES[k, 3]]
    if not (a > bound and d > bound):
        return False
    best, lowest = 0.0, np.inf
    for r in range(1, 16):
        value = side_value(values, k, r / 16.0)
        if value < lowest:
            best, lowest = r / 16.0, value
    slack = 4.0 * bound
    t = best
    ab, bc, cd = a + t * (b - a), b + t * (c - b), c + t * (d - c)
    abc, bcd = ab + t * (bc - ab), bc + t * (cd - bc)
    middle = abc + t * (bcd - abc)
    if not middle < -slack:
        return False
    # Once negative, the controls of the left part must stay negative, and likewise from the right.
    return abs(ab) > slack and abc < -slack and bcd < -slack and abs(cd) > slack


@compiled
def germ(signs, k, at_end):
    """The sign of a cubic near one end of side k; UNKNOWN if not certain."""
    for r in range(4):
        sign = signs[SIDES[k, 3 - r if at_end else r]]
        if sign != 0:
            return sign
    return UNKNOWN


@compiled
def side_value(values, k, t):
    """The cubic at parameter t of side k."""
    a, b, c, d = values[SIDES[k, 0]], values[SIDES[k, 1]], values[SIDES[k, 2]], values[SIDES[k, 3]]
    s = 1.0 - t
    return s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d


@compiled
def side_zero(values, k, rising):
    """A parameter near the only zero of the cubic on side k (``rising``: it grows through it)."""
    # Regula falsi in the Illinois variant: a good guess is enough, nothing depends on it.
    low, high = 0.0, 1.0
    at_low, at_high = values[SIDES[k, 0]], values[SIDES[k, 3]]
    if not rising:
        at_low, at_high = -at_low, -at_high
    middle, last = 0.5, 0
    for _ in range(60):
        # An end may be a structural zero: leave it by bisection.
        if at_low < 0.0 < at_high:
            middle = (low * at_high - high * at_low) / (at_high - at_low)
        if not (at_low < 0.0 < at_high and low < middle < high):
            middle = 0.5 * (low + high)
        # Not closer to either end: near the zero that brings the other end here at once.
        middle = min(max(middle, low + NEAR), high - NEAR)
        value = side_value(values, k, middle)
        if not rising:
            value = -value
        if value > 0.0:
            high, at_high = middle, value
            if last == 1:
                at_low *= 0.5
            last = 1
        elif value < 0.0:
            low, at_low = middle, value
            if last == -1:
                at_high *= 0.5
            last = -1
        else:
            break
        if high - low < 2.5 * NEAR:
            break
    return middle


@compiled
def has_cone(b, bound, controls):
    """Whether the gradients lie in an open half-plane; leaves them in ``controls`` (6, 2)."""
    gradient_controls(b, controls)
    gx = gy = 0.0
    for r in range(6):
        gx += controls[r, 0]
        gy += controls[r, 1]
    slack = 6.0 * bound * (abs(gx) + abs(gy))
    for r in range(6):
        if not controls[r, 0] * gx + controls[r, 1] * gy > 2.0 * slack:
            return False
    return True


@compiled
def hull_determinant(f, g, ef, eg):
    """The least |det| over all pairs of control vectors if its sign is constant, else 0; signed.

    ``ef``, ``eg``: error bounds of the coefficients (those of the control vectors are 6 times).
    """
    least, sign = np.inf, 0
    for r in range(6):
        for s in range(6):
            det = f[r, 0] * g[s, 1] - f[r, 1] * g[s, 0]
            slack = 6.0 * ef * (abs(g[s, 0]) + abs(g[s, 1]) + 12.0 * eg)
            slack += 6.0 * eg * (abs(f[r, 0]) + abs(f[r, 1]))
            slack *= 1.1
            if not abs(det) > slack:
                return 0.0
            here = 1 if det > 0.0 else -1
            if sign == 0:
                sign = here
            elif sign != here:
                return 0.0
            least = min(least, abs(det) - slack)
    return sign * least


@compiled
def longest(control, bound):
    """The squared length that a control vector of a gradient may have, with coefficients off by
    ``bound``."""
    x, y = abs(control[0]) + 6.0 * bound, abs(control[1]) + 6.0 * bound
    return 1.001 * (x * x + y * y)


#: Coefficients of the terms in s² and in s of a cubic in the distance s from a corner: those with
#: which F = s²(α + s β) begins, counter-clockwise, and those that must be zero for that.
_NEAR = np.array([[5, 9, 7], [8, 9, 3], [4, 9, 6]])
_FIRST = np.array([[0, 3, 4], [1, 6, 5], [2, 7, 8]])


@compiled
def has_double_zero(signs, corner):
    """Whether a cubic vanishes at a corner with its gradient, by construction."""
    for r in range(3):
        if signs[_FIRST[corner, r]] != 0:
            return False
    return True


@compiled
def has_one_branch(signs, corner):
    """Whether the zero set near a double zero at a corner is certainly at most one arc in T."""
    near = _NEAR[corner]
    return _changes_once(signs, near[0], near[1], near[2])


@compiled
def is_radial(signs, corner):
    """Whether a cubic with a double zero at a corner has at most one zero on every ray from it
    and the signs near the corner and on the far side change at most once with the direction.

    On a ray F = s²(α + s β): one zero if the sign near the corner and at the far end differ.
    """
    return (
        has_double_zero(signs, corner)
        and has_one_branch(signs, corner)
        and _far_side_changes_once(signs, corner)
    )


@compiled
def _changes_once(signs, a, b, c):
    first, second, third = signs[a], signs[b], signs[c]
    if first == UNKNOWN or second == UNKNOWN or third == UNKNOWN:
        return False
    return not (second != 0 and first * second < 0 and second * third < 0)


@compiled
def _far_side_changes_once(signs, corner):
    """Whether the signs on the side opposite to the corner are certain and change at most once."""
    previous, count = 0, 0
    for r in range(4):
        sign = signs[SIDES[corner, r]]
        if sign == UNKNOWN:
            return False
        if sign != 0:
            if previous != 0 and sign != previous:
                count += 1
            previous = sign
    return count <= 1


@compiled
def meet(b, c, point, out):
    """Newton's method for b = c = 0, from the centroid; the result in ``point`` (x, y)."""
    x = y = 1.0 / 3.0
    for _ in range(12):
        value_and_gradient(b, x, y, out)
        f, fx, fy = out[0], out[1], out[2]
        value_and_gradient(c, x, y, out)
        g, gx, gy = out[0], out[1], out[2]
        det = fx * gy - fy * gx
        if det == 0.0:
            break
        dx, dy = (f * gy - g * fy) / det, (g * fx - f * gx) / det
        x, y = x - dx, y - dy
        if not (abs(x) < 4.0 and abs(y) < 4.0):
            break
        if abs(dx) + abs(dy) < 1e-15:
            break
    point[0], point[1] = x, y
