"""Certified boxes of any precision around the nodes of a fast diagram."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from flint import arb, ctx

from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.forms import value_and_gradient
from harness.diagram.fast.side_ports import port_ball
from harness.diagram.planar_map import RationalPoint
from harness.geometry.exact import fraction

#: Working bits beyond those asked for.
_EXTRA = 64
#: Where Newton's method must have arrived; beyond, something is wrong.
_LAST_PRECISION = 1 << 20


class ExactPoint:
    """The place of a rational point."""

    def __init__(self, point: RationalPoint) -> None:
        """``point``: exact."""
        self._point = point

    def enclosure(self, bits: int) -> tuple[RationalPoint, RationalPoint]:
        """The point twice, whatever ``bits``."""
        return self._point, self._point


class PortPlace:
    """The place of a port on the boundary of the domain."""

    def __init__(self, diagram: FastDiagram, port: int) -> None:
        """``port``: inside a side of a leaf that is not hard."""
        leaf = int(diagram.arrays.leaf_of_arc[diagram.arrays.inward[port] >> 1])
        self._chart = Chart(diagram, leaf)
        self._port = port
        self._place = int(diagram.arrays.place[port])

    def enclosure(self, bits: int) -> tuple[RationalPoint, RationalPoint]:
        """A box around the isolated root that is the port's parameter on its side."""
        k = self._place // 2
        with ctx.workprec(bits + _EXTRA):
            t = port_ball(self._chart, self._port, bits + _EXTRA)
            weights = [arb(0)] * 3
            weights[k], weights[(k + 1) % 3] = 1 - t, t
            return _box(self._chart, weights)


class TiePlace:
    """The place of a vertex at which three (or four) segments tie."""

    def __init__(self, chart: Chart, vertex: int) -> None:
        """``chart``: of the leaf of ``vertex``."""
        self._chart = chart
        self._vertex = vertex
        self._cubics = chart.contests_at(vertex)

    def enclosure(self, bits: int) -> tuple[RationalPoint, RationalPoint]:
        """A box that certainly contains the vertex.

        Krawczyk's test proves that two of the cubics have a common zero in a box inside the
        triangle; they have no other in the whole triangle, for the leaf was accepted for that.

        Raises ArithmeticError if no precision below a megabit suffices.
        """
        precision = bits + _EXTRA
        _, x, y = self._chart.vertex(self._vertex)
        while precision <= _LAST_PRECISION:
            with ctx.workprec(2 * precision):
                found = _krawczyk(self._cubics, x, y, precision)
                if found is not None:
                    z = 1 - found[0] - found[1]
                    if all(value > 0 for value in (*found, z)):
                        return _box(self._chart, [z, *found])
            precision *= 2
        raise ArithmeticError("Krawczyk's test failed at every precision")


def _krawczyk(cubics: list[Any], x: Any, y: Any, bits: int) -> tuple[Any, Any] | None:
    """A box around (x, y) that certainly contains a common zero, of radius about 2^−bits.

    None if Newton's method from (x, y) does not lead to a point where the test succeeds.
    """
    f, g = ([arb(c) for c in cubic] for cubic in cubics)
    x, y = arb(x), arb(y)
    inverse: tuple[Any, ...] | None = None
    for _ in range(4 + bits.bit_length()):
        inverse = _inverse_jacobian(f, g, x, y)
        if inverse is None:
            return None
        x, y = (z.mid() for z in _newton_step(f, g, x, y, inverse))
    radius = arb(2) ** -bits
    box = x + arb(0, 1) * radius, y + arb(0, 1) * radius
    assert inverse is not None
    p, q, r, s = inverse
    _, fx, fy = _jet(f, *box)
    _, gx, gy = _jet(g, *box)
    middle = _newton_step(f, g, x, y, inverse)
    dx, dy = box[0] - x, box[1] - y
    image = (
        middle[0] + (1 - (p * fx + q * gx)) * dx - (p * fy + q * gy) * dy,
        middle[1] - (r * fx + s * gx) * dx + (1 - (r * fy + s * gy)) * dy,
    )
    inside = all(b.contains_interior(z) for b, z in zip(box, image, strict=True))
    return image if inside else None


def _jet(cubic: list[Any], x: Any, y: Any) -> list[Any]:
    """Value and both derivatives of a cubic, as balls."""
    out: list[Any] = [None] * 3
    value_and_gradient.py_func(cubic, x, y, out)
    return out


def _inverse_jacobian(f: list[Any], g: list[Any], x: Any, y: Any) -> tuple[Any, ...] | None:
    """An approximate inverse of the Jacobian, row by row; None if it is singular."""
    _, fx, fy = _jet(f, x, y)
    _, gx, gy = _jet(g, x, y)
    det = fx * gy - fy * gx
    if det.contains(0):
        return None
    return tuple((z / det).mid() for z in (gy, -fy, -gx, fx))


def _newton_step(f: list[Any], g: list[Any], x: Any, y: Any, inverse: Any) -> tuple[Any, Any]:
    p, q, r, s = inverse
    u, v = _jet(f, x, y)[0], _jet(g, x, y)[0]
    return x - (p * u + q * v), y - (r * u + s * v)


def _combined(chart: Chart, weights: Any) -> list[Any]:
    """The homogeneous point with given weights (any exact type)."""
    return [
        sum((f * corner[axis] for f, corner in zip(weights, chart.corners, strict=True)), 0)
        for axis in range(3)
    ]


def _box(chart: Chart, weights: list[Any]) -> tuple[RationalPoint, RationalPoint]:
    """A rational box around a point given by balls of its weights."""
    x, y, w = _combined(chart, weights)
    rows = [(_bound(z.lower()), _bound(z.upper())) for z in (x / w, y / w)]
    return (rows[0][0], rows[1][0]), (rows[0][1], rows[1][1])


def _bound(value: arb) -> Fraction:
    return fraction(value.fmpq())
