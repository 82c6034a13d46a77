"""Witnesses in rational arithmetic: what an exact point reaches, told by nothing of the room."""

from collections.abc import Sequence
from fractions import Fraction

from flint import arb, ctx, fmpq

from harness.geometry.instance import Instance
from harness.peak.polygon import Polygon
from harness.peak.rational import rational_ascent, rational_start

BITS = 400

Exact = tuple[fmpq, fmpq]


def exactly(vertices: Sequence) -> list[Exact]:
    """The vertices as rationals of flint, counter-clockwise."""
    fractions = [(Fraction(x), Fraction(y)) for x, y in vertices]
    points = [tuple(fmpq(v.numerator, v.denominator) for v in p) for p in fractions]
    area = sum(
        a[0] * b[1] - a[1] * b[0] for a, b in zip(points, [*points[1:], points[0]], strict=True)
    )
    return points if area > 0 else points[::-1]


def angles_of(vertices: Sequence, p: Sequence) -> list[arb] | None:
    """The visual angles of all edges from p in balls; None outside the closed kernel.

    At a vertex its two edges count with half of 2π − γ each, their limit along the bisector.
    """
    points = exactly(vertices)
    (here,) = exactly([p])
    n = len(points)
    found = []
    with ctx.workprec(BITS):
        for i in range(n):
            a, b = points[i], points[(i + 1) % n]
            if here in (a, b):
                k = i if here == a else (i + 1) % n
                before, after = points[k - 1], points[(k + 1) % n]
                ux, uy = here[0] - before[0], here[1] - before[1]
                vx, vy = after[0] - here[0], after[1] - here[1]
                turn = arb.atan2(arb(ux * vy - uy * vx), arb(ux * vx + uy * vy))
                found.append((arb.pi() + turn) / 2)
                continue
            ux, uy, vx, vy = a[0] - here[0], a[1] - here[1], b[0] - here[0], b[1] - here[1]
            area = ux * vy - uy * vx
            if area < 0:
                return None
            found.append(arb.atan2(arb(area), arb(ux * vx + uy * vy)))
    return found


def broken(vertices: Sequence, lower: float, upper: float, point: Sequence) -> str | None:
    """What is wrong with a certificate of the greatest least angle; None if nothing is.

    Its point must reach ``lower``, and neither that nor the point of a rational ascent may exceed
    ``upper``.
    """
    if not 0 <= upper - lower <= 1e-12:
        return f"[{lower!r}, {upper!r}] is no enclosure of 1e-12"
    polygon = Polygon(Instance.from_arrays("polygon", vertices))
    start = rational_start(polygon.exact_edges, 90)
    other = rational_ascent(polygon.exact_edges, start, 90).point
    for name, p in (("the point", point), ("a better point", [fraction(v) for v in other])):
        angles = angles_of(vertices, p)
        if angles is None:
            return f"{name} is outside"
        if any(angle < lower for angle in angles):
            return f"{name} does not reach {lower!r}"
        if all(angle > upper for angle in angles):
            return f"{name} exceeds {upper!r}"
    return None


def fraction(value: fmpq) -> Fraction:
    """The same rational."""
    return Fraction(int(value.p), int(value.q))
