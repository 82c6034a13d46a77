"""Leaves through which the line of a candidate runs (only in the plane and in interiors)."""

from __future__ import annotations

from harness.diagram.fast.forms import UNKNOWN, cubic
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import (
    ARC,
    CROSSING,
    EMPTY,
    FAILED,
    TWO_ARCS,
    germ,
    meet,
    side_value,
    side_zero,
    sign_changes,
)
from harness.diagram.fast.loops import has_no_loop
from harness.diagram.fast.sides import SIDE_AFTER, rounding


@compiled
def classify_mixed(tables, i, j, la, lb, q, bound, far, known, w):
    """A leaf of two candidates, of which at least one has its line through T.

    Both Q have the sign q on T.  Let F± = Q_a L_b ∓ Q_b L_a.  As F₊F₋ = Q_a²L_b² − Q_b²L_a²,
    candidate a wins where both have one sign and b where they differ (if q = −1, the other way
    round), so the pieces are named by the two signs and every zero of F₊ or F₋ is an edge.  ``la``,
    ``lb``: the sign of L on T, 0 where the line crosses T.  Without loops each zero set is an arc;
    the two meet only where Q_a L_b = Q_b L_a = 0: where both lines cross (angle 0), once at most
    and transversally.  So if their ports alternate there is one crossing, otherwise none.
    """
    values, signs, controls, slots = w[0], w[1], w[3], w[4]
    cubic(tables, i, j, 1.0, 1.0, bound, far, known, values[0, 1], signs[0, 1])
    cubic(tables, i, j, -1.0, 1.0, bound, far, known, values[1, 0], signs[1, 0])
    bound += max(rounding(tables, values[0, 1]), rounding(tables, values[1, 0]))
    for f in range(2):
        a, b = f, 1 - f
        if not has_no_loop(signs[a, b], values[a, b], bound, controls[a, b]):
            return FAILED, 0, 0
    count = 0
    last_plus = germ(signs[0, 1], 1, True)
    last_minus = germ(signs[1, 0], 1, True)
    if last_plus == UNKNOWN or last_minus == UNKNOWN:
        return FAILED, 0, 0
    curves = w[7]
    for position in range(3):
        k = SIDE_AFTER[position]
        plus, minus = germ(signs[0, 1], k, False), germ(signs[1, 0], k, False)
        if plus == UNKNOWN or minus == UNKNOWN:
            return FAILED, 0, 0
        if plus != last_plus and minus != last_minus:
            # An endpoint's wedge, seen from its tip.  If a is mixed, F₊ + F₋ = 2Q_a L_b forbids
            # that both have the sign of −q L_b; if b is mixed, F₋ − F₊ = 2Q_b L_a.
            if la == 0 and lb != 0:
                first_is_plus = last_plus != q * lb
            elif lb == 0 and la != 0:
                first_is_plus = last_plus != -q * la
            else:
                return FAILED, 0, 0
            count = _add(slots, curves, count, 2 * position, 0 if first_is_plus else 1)
            count = _add(slots, curves, count, 2 * position, 1 if first_is_plus else 0)
        elif plus != last_plus:
            count = _add(slots, curves, count, 2 * position, 0)
        elif minus != last_minus:
            count = _add(slots, curves, count, 2 * position, 1)
        zeros_plus = sign_changes(signs[0, 1], values[0, 1], bound, k)
        zeros_minus = sign_changes(signs[1, 0], values[1, 0], bound, k)
        if zeros_plus < 0 or zeros_minus < 0 or count > 7:
            return FAILED, 0, 0
        if zeros_plus == 1 and zeros_minus == 1:
            first = _first_to_change(values, bound, k, plus, minus)
            if first < 0:
                return FAILED, 0, 0
            plus_first = first == 0
            count = _add(slots, curves, count, 2 * position + 1, 0 if plus_first else 1)
            count = _add(slots, curves, count, 2 * position + 1, 1 if plus_first else 0)
        elif zeros_plus == 1:
            count = _add(slots, curves, count, 2 * position + 1, 0)
        elif zeros_minus == 1:
            count = _add(slots, curves, count, 2 * position + 1, 1)
        last_plus = -plus if zeros_plus == 1 else plus
        last_minus = -minus if zeros_minus == 1 else minus
    # Owners of the pieces: the state after each port, from the one before corner 0.
    a, b = germ(signs[0, 1], 1, True), germ(signs[1, 0], 1, True)
    for r in range(count):
        if curves[r] == 0:
            a = -a
        else:
            b = -b
        slots[r, 1] = 0 if (a == b) == (q == 1) else 1
    if count == 0:
        slots[0, 0], slots[0, 1] = 1, 0 if (a == b) == (q == 1) else 1
        return EMPTY, 0, 0
    if count == 2:
        return (ARC, 2, 0) if curves[0] == curves[1] else (FAILED, 0, 0)
    if count != 4:
        return FAILED, 0, 0
    if curves[0] + curves[1] + curves[2] + curves[3] != 2:
        return FAILED, 0, 0
    if curves[0] != curves[1] and curves[1] != curves[2]:
        if la != 0 or lb != 0:
            return FAILED, 0, 0
        meet(values[0, 1], values[1, 0], w[6], w[5])
        return CROSSING, 4, 0
    return TWO_ARCS, 4, (0 if curves[0] == curves[1] else 1)


@compiled
def _first_to_change(values, bound, k, plus, minus):
    """Which of F₊ (0) and F₋ (1) is the first to change its sign on side k; −1 if unsure.

    Both change once.  At any point where just one of them certainly has changed, that is the first.
    """
    one = side_zero(values[0, 1], k, plus < 0)
    two = side_zero(values[1, 0], k, minus < 0)
    t = 0.5 * (one + two)
    at_plus, at_minus = side_value(values[0, 1], k, t), side_value(values[1, 0], k, t)
    if not (abs(at_plus) > 2.0 * bound and abs(at_minus) > 2.0 * bound):
        return -1
    plus_changed, minus_changed = (at_plus > 0.0) != (plus > 0), (at_minus > 0.0) != (minus > 0)
    if plus_changed == minus_changed:
        return -1
    return 0 if plus_changed else 1


@compiled
def _add(slots, curves, count, place, curve):
    slots[count, 0] = place
    curves[count] = curve
    return count + 1
