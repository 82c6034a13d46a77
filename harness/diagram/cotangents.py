"""cot θ along the reference builder's edges: its values at points, its limits at endpoints."""

from __future__ import annotations

import math

from flint import arb, ctx, fmpq

from harness.diagram.algebra import NotGeneric, Point, precisions
from harness.diagram.arcs import Arc
from harness.diagram.fibres import intersect
from harness.diagram.planar_map import RationalPoint
from harness.diagram.scene import TINY, Scene

Vector = tuple[fmpq, fmpq]


def cotangent_values(scene: Scene, arc: Arc, segments: tuple[int, int]) -> list[float]:
    """The limits of cot θ of the two tied segments at both ends of an arc, and its turning values.

    cot θ is monotone between the points of the arc where the level circles of the two segments are
    tangent, that is, where the gradients of their cotangents are parallel.  So the least and the
    greatest of these numbers are the infimum and the supremum over the arc.
    """
    return [*_end_values(scene, arc, segments), *_turning_values(scene, arc, segments)]


def _turning_values(scene: Scene, arc: Arc, segments: tuple[int, int]) -> list[float]:
    curve = arc.slabs.polynomial
    jacobian = scene.jacobian(*segments)
    if curve.mpoly.gcd(jacobian.mpoly).total_degree() > 0:
        return []  # cot θ is constant: the curve is a circle through all four endpoints
    return [cotangent(scene, segments, p) for p in intersect(curve, jacobian) if arc.contains(p)]


def _end_values(scene: Scene, arc: Arc, segments: tuple[int, int]) -> list[float]:
    values = []
    for end, outwards in ((arc.start, 1), (arc.end, -1)):
        if end is None:
            values.append(math.inf)
        elif all(scene.level(k, end) is None for k in segments):
            values.append(limit_at_endpoint(scene, segments, end, outwards))
        else:
            values.append(cotangent(scene, segments, end))
    return values


def cotangent(scene: Scene, segments: tuple[int, int], p: Point) -> float:
    """cot θ of the two tied segments at p, rounded; ±inf where θ is 0 or π.

    p must not be an endpoint of both.
    """
    for k in segments:
        level = scene.level(k, p)
        if level:
            return level * math.inf
        if level == 0:
            return _cotangent_of(scene, k, p)
    raise ArithmeticError("the visual angles have no value at a common endpoint")


def _cotangent_of(scene: Scene, k: int, p: Point) -> float:
    """cot θ of segment k, whose line p is not on, within a relative error of 2^-52."""
    if p.sign(scene.q[k]) == 0:
        return 0.0
    for bits in precisions():
        u, v = p.balls(bits)
        with ctx.workprec(bits):
            value = scene.cotangent(k, u, v)
            if _is_tight(value):
                return float(value.mid())
    raise AssertionError  # precisions() raises first


def _is_tight(value: arb) -> bool:
    return bool(value.is_finite()) and bool(value.rad() <= abs(value).lower() * TINY)


def limit_at_endpoint(scene: Scene, segments: tuple[int, int], end: Point, outwards: int) -> float:
    """The limit of cot θ along a tie of two segments into their common endpoint ``end``, rounded.

    With w and w′ the vectors from there to the other endpoints, at end + r·d both angles tend to π
    less the angle between d and w or w′.  They tie only if d halves the angle φ between w and w′ or
    points the other way, and cot θ tends to −cot(φ/2) or +cot(φ/2).  Which of the two, is told by
    ``outwards``: +1 if u grows from ``end`` on, −1 if it falls.
    """
    w, other = (_vector_from(scene, k, end) for k in segments)
    cross = w[0] * other[1] - w[1] * other[0]
    if cross == 0:
        return 0.0  # two segments on one line: φ = π
    heading = _heading_of_halving(scene, w, other)
    assert heading, "check_common_endpoints sees to that"
    dot = w[0] * other[0] + w[1] * other[1]
    squares = _square(w) * _square(other)
    for bits in precisions():
        with ctx.workprec(bits):
            value = (arb(squares).sqrt() + arb(dot)) / abs(arb(cross))
            if _is_tight(value):
                return -outwards * heading * float(value.mid())
    raise AssertionError  # precisions() raises first


def check_common_endpoints(scene: Scene) -> None:
    """Raise NotGeneric if an edge would begin vertically at a common endpoint of two segments.

    :func:`limit_at_endpoint` relies on that.
    """
    points: dict[RationalPoint, list[Vector]] = {}
    for a, b in scene.segments:
        points.setdefault(a, []).append(_vector(a, b))
        points.setdefault(b, []).append(_vector(b, a))
    for vectors in points.values():
        for k, w in enumerate(vectors):
            for other in vectors[:k]:
                opposite = w[0] * other[1] == w[1] * other[0]
                if not opposite and _heading_of_halving(scene, w, other) == 0:
                    raise NotGeneric("an edge begins vertically")


def _vector_from(scene: Scene, k: int, end: Point) -> Vector:
    a, b = scene.segments[k]
    return _vector(a, b) if scene.sheared(a).coordinates == end.coordinates else _vector(b, a)


def _vector(a: RationalPoint, b: RationalPoint) -> Vector:
    x, y = b[0] - a[0], b[1] - a[1]
    return fmpq(x.numerator, x.denominator), fmpq(y.numerator, y.denominator)


def _square(w: Vector) -> fmpq:
    return w[0] * w[0] + w[1] * w[1]


def _heading_of_halving(scene: Scene, w: Vector, other: Vector) -> int:
    """The sign of u along w/|w| + other/|other|, exactly."""
    steps = [vector[0] + scene.shear * vector[1] for vector in (w, other)]
    # A step over its vector's length, squared, with its sign kept.
    first, second = (
        step * abs(step) / _square(vector) for step, vector in zip(steps, (w, other), strict=True)
    )
    total = first + second
    return int(total > 0) - int(total < 0)
