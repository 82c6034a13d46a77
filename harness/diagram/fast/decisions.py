"""Quads and saddles that doubles leave open, decided with balls.

The leaf is proved: all that is missing is one sign, that of a cubic where two others vanish (a
fourth segment where three tie) or at a critical point.  The triangle's corners and the cubics'
coefficients are rational; Newton's method in balls finds the point, Krawczyk's test encloses it.
If the ball of the sign contains zero at every precision the sign may be zero: then the leaf goes to
the algebra of :mod:`harness.diagram.fast.hard`.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq, fmpz

from harness.diagram.fast.build import Leaves
from harness.diagram.fast.forms import STEPS, TERMS, value_and_gradient
from harness.diagram.fast.leaves import EMPTY, OPEN, QUAD, SADDLE, meet
from harness.diagram.fast.roots import Roots
from harness.geometry.instance import Instance

#: Bits, one after the other.
PRECISIONS = (128, 384, 1152)
#: Weights of the products in each coefficient, in thirds.
_WEIGHTS = ((3,), (3,), (3,), (2, 1), (2, 1), (2, 1), (2, 1), (2, 1), (2, 1), (1, 1, 1))
_TERMS = TERMS.tolist()
_SQUARES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def decide_open(instance: Instance, roots: Roots, leaves: Leaves, sense: float) -> int:
    """Decide what can be decided of the open quads and saddles, in ``leaves.choices``; how many."""
    shaped = np.flatnonzero(leaves.kinds != EMPTY)
    rows = np.flatnonzero(leaves.choices[shaped] == OPEN)
    decided = 0
    for row in rows.tolist():
        leaf = int(shaped[row])
        owners = leaves.slots[leaves.first_slot[leaf] : leaves.first_slot[leaf + 1], 1].tolist()
        corners = homogeneous_corners(roots, leaves, row)
        forms = {k: exact_forms(instance, k, corners, sense) for k in set(owners)}
        kind = leaves.kinds[leaf]
        choice = _quad(owners, forms) if kind == QUAD else OPEN
        if kind == SADDLE:
            choice = _saddle(owners, forms, leaves.points[row].tolist())
        if choice != OPEN:
            leaves.choices[leaf] = choice
            decided += 1
    return decided


def _rational(value: float | Fraction) -> Any:
    exact = value if isinstance(value, Fraction) else Fraction(value)
    return fmpq(exact.numerator, exact.denominator)


def homogeneous_corners(roots: Roots, leaves: Leaves, row: int) -> list[tuple[Any, Any, Any]]:
    """The exact corners (x, y, w) of a leaf that is not empty, by its row among these."""
    of_root = [
        (*map(_rational, roots.corners.exact[c]), _rational(roots.corners.weights[c]))
        for c in roots.triangles[leaves.shape_roots[row]].tolist()
    ]
    result = []
    for line in leaves.weights(row):
        weights = [_rational(x) for x in line]
        x, y, w = (
            sum((f * c[axis] for f, c in zip(weights, of_root, strict=True)), fmpq(0))
            for axis in range(3)
        )
        result.append((x, y, w))
    return result


def exact_forms(
    instance: Instance, segment: int, corners: list[tuple[Any, Any, Any]], sense: float
) -> list[Any]:
    """A positive multiple of a segment's table, in whole numbers, L made positive in the triangle.

    Every F with this segment then is a positive multiple too, which changes no sign.
    """
    (ax, ay), (bx, by) = (tuple(map(_rational, end)) for end in instance.rational_segment(segment))
    dx, dy = bx - ax, by - ay
    to_a = [(ax * w - x, ay * w - y) for x, y, w in corners]
    to_b = [(bx * w - x, by * w - y) for x, y, w in corners]
    lines = [px * dy - py * dx for px, py in to_a]
    side = 1 if sum(lines, fmpq(0)) > 0 else -1
    table = [side * value for value in lines]
    for k, m in _SQUARES:
        polar = to_a[k][0] * to_b[m][0] + to_a[k][1] * to_b[m][1]
        polar += to_a[m][0] * to_b[k][0] + to_a[m][1] * to_b[k][1]
        table.append(int(sense) * polar / 2)
    common = fmpz(1)
    for value in table:
        common = common.lcm(value.q)
    return [value.p * (common // value.q) for value in table]


def exact_cubic(t: list[Any], s: list[Any]) -> list[Any]:
    """Three times the ten coefficients of Q_t L_s − Q_s L_t, positive where the first wins."""
    return [
        sum(
            (
                weight * (t[q] * s[line] - s[q] * t[line])
                for weight, (q, line) in zip(weights, terms, strict=False)
            ),
            fmpz(0),
        )
        for weights, terms in zip(_WEIGHTS, _TERMS, strict=True)
    ]


def _quad(owners: list[int], forms: dict[int, list[Any]]) -> int:
    """The choice of a quad: see :func:`harness.diagram.fast.classify.classify_definite`."""
    out, point = np.empty(3), np.empty(2)
    for x in range(4):
        a, b, c, d = (owners[(x + r) % 4] for r in range(4))
        f, g, h = (exact_cubic(forms[a], forms[k]) for k in (b, c, d))
        meet(_doubles(f), _doubles(g), point, out)
        px, py = point.tolist()
        if not (px > 0 and py > 0 and px + py < 1):
            continue
        sign = _sign_where_both_vanish(f, g, h, px, py)
        if sign:
            return (x & 1) if sign > 0 else 1 - (x & 1)
    return OPEN


def _saddle(owners: list[int], forms: dict[int, list[Any]], start: list[float]) -> int:
    """The choice of a saddle: 1 if the owner of slots 0 and 2 wins at the critical point."""
    f = exact_cubic(forms[owners[0]], forms[owners[1]])
    first = [f[STEPS[r, 1]] - f[STEPS[r, 0]] for r in range(6)]
    second = [f[STEPS[r, 2]] - f[STEPS[r, 0]] for r in range(6)]
    sign = _sign_where_both_vanish(_raised(first), _raised(second), f, start[0], start[1])
    return OPEN if not sign else (1 if sign > 0 else 0)


def _raised(g: list[Any]) -> list[Any]:
    """Three times the coefficients of a quadratic form 200, 020, 002, 110, 101, 011 as a cubic."""
    return [
        3 * g[0],
        3 * g[1],
        3 * g[2],
        g[0] + 2 * g[3],
        g[0] + 2 * g[4],
        g[1] + 2 * g[3],
        g[1] + 2 * g[5],
        g[2] + 2 * g[4],
        g[2] + 2 * g[5],
        g[3] + g[4] + g[5],
    ]


def _doubles(cubic: list[Any]) -> Any:
    """Coefficients as doubles, relatively to the greatest."""
    whole = [int(c) for c in cubic]
    largest = max(map(abs, whole)) or 1
    return np.array([c / largest for c in whole])


def _sign_where_both_vanish(f: list[Any], g: list[Any], h: list[Any], x: float, y: float) -> int:
    """The sign of h at the common zero of f and g near (x, y), inside the triangle; 0 if unsure.

    The leaf guarantees that f and g have no other common zero in the triangle.
    """
    for bits in PRECISIONS:
        with ctx.workprec(2 * bits):
            box = enclosed(f, g, x, y, bits)
            if box is None:
                continue
            px, py = box
            if not (px > 0 and py > 0 and 1 - px - py > 0):
                continue
            value = _jet([arb(c) for c in h], px, py)[0]
            if value > 0:
                return 1
            if value < 0:
                return -1
    return 0


def _jet(cubic: list[Any], x: Any, y: Any) -> list[Any]:
    """Value and derivatives along both sides from corner 0, as balls."""
    out: list[Any] = [None] * 3
    value_and_gradient.py_func(cubic, x, y, out)
    return out


def enclosed(f: list[Any], g: list[Any], x: float, y: float, bits: int) -> tuple[Any, Any] | None:
    """A box about a common zero of f and g (Krawczyk's test), or None."""
    fb, gb = [arb(c) for c in f], [arb(c) for c in g]
    px, py = arb(x), arb(y)
    for _ in range(bits.bit_length() + 3):
        u, ux, uy = _jet(fb, px, py)
        v, vx, vy = _jet(gb, px, py)
        det = ux * vy - uy * vx
        if det.contains(0):
            return None
        px, py = (px - (u * vy - v * uy) / det).mid(), (py - (v * ux - u * vx) / det).mid()
    u, ux, uy = _jet(fb, px, py)
    v, vx, vy = _jet(gb, px, py)
    det = (ux * vy - uy * vx).mid()
    a, b, c, d = ((z / det).mid() for z in (vy, -uy, -vx, ux))
    radius = arb(2) ** -bits
    bx, by = px + arb(0, 1) * radius, py + arb(0, 1) * radius
    _, ux, uy = _jet(fb, bx, by)
    _, vx, vy = _jet(gb, bx, by)
    ex, ey = bx - px, by - py
    nx = px - (a * u + b * v) + (1 - (a * ux + b * vx)) * ex - (a * uy + b * vy) * ey
    ny = py - (c * u + d * v) - (c * ux + d * vx) * ex + (1 - (c * uy + d * vy)) * ey
    return (nx, ny) if bx.contains_interior(nx) and by.contains_interior(ny) else None
