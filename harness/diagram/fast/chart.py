"""A leaf's triangle as a chart: its corners and forms exactly, ports and vertices in it.

Points of the triangle are given by barycentric weights λ (summing to 1) of its homogeneous corners
(x, y, w), so that corners at infinity (w = 0) are nothing special.  Everything is computed exactly
and rounded once, which makes the charts of thin or tiny triangles as good as others.  All is scaled
to integers first: rationals spend their time on common divisors.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from flint import fmpz

from harness.diagram.fast import side_ports
from harness.diagram.fast.common_zeros import common_zero, independence
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.forms import SIDES, STEPS
from harness.diagram.fast.leaves import CROSSING
from harness.diagram.fast.prepare import Floats
from harness.diagram.fast.side_ports import PortOnSide
from harness.diagram.fast.univariate import rounded
from harness.diagram.planar_map import RationalPoint
from harness.geometry.exact import sign

#: Barycentric weights.
Weights = tuple[float, float, float]
CORNERS: tuple[Weights, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

#: The products q·L, with weights in thirds, in the coefficients of Q·L (order and positions: see
#: :mod:`harness.diagram.fast.forms`).
_PRODUCTS = (
    ((3, 3, 0),),
    ((3, 4, 1),),
    ((3, 5, 2),),
    ((2, 6, 0), (1, 3, 1)),
    ((2, 7, 0), (1, 3, 2)),
    ((2, 6, 1), (1, 4, 0)),
    ((2, 8, 1), (1, 4, 2)),
    ((2, 7, 2), (1, 5, 0)),
    ((2, 8, 2), (1, 5, 1)),
    ((1, 6, 2), (1, 7, 1), (1, 8, 0)),
)
#: Pairs of corners in the order 200, 020, 002, 110, 101, 011.
_SQUARES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def _integers(points: Sequence[RationalPoint]) -> tuple[list[tuple[Any, Any]], Any]:
    """Points times the least number that makes all coordinates integers, and that number."""
    unit = math.lcm(*(c.denominator for p in points for c in p))
    return [
        (fmpz(x.numerator * (unit // x.denominator)), fmpz(y.numerator * (unit // y.denominator)))
        for x, y in points
    ], fmpz(unit)


class Chart:
    """The chart of one leaf that is not empty and was not handed over as hard."""

    def __init__(self, diagram: FastDiagram, leaf: int) -> None:
        """O(1), after the first chart of a diagram."""
        self.diagram = diagram
        self.leaf = leaf
        self.row = int(diagram.rows_of_leaves[leaf])
        roots, leaves = diagram.roots, diagram.leaves
        triangle = roots.triangles[leaves.shape_roots[self.row]].tolist()
        ends, unit = _integers([roots.corners.exact[c] for c in triangle])
        of_root = [
            (*end, unit if roots.corners.weights[c] else fmpz(0))
            for end, c in zip(ends, triangle, strict=True)
        ]
        # Weights are multiples of a power of two.
        weights = leaves.weights(self.row)
        finest = max(x.denominator for line in weights for x in line)
        shape = [[fmpz(x.numerator * (finest // x.denominator)) for x in line] for line in weights]
        #: The corners (x, y, w), times ``unit``: integers.
        self.corners = [
            tuple(
                sum((f * c[axis] for f, c in zip(line, of_root, strict=True)), fmpz(0))
                for axis in range(3)
            )
            for line in shape
        ]
        self.unit = int(unit) * finest
        self._forms: dict[int, tuple[list[Any], int]] = {}

    @cached_property
    def rounded_corners(self) -> Floats:
        """The corners (x, y, w) as doubles, (3, 3)."""
        return np.array([[int(c) / self.unit for c in corner] for corner in self.corners])

    def plane(self, weights: Weights) -> tuple[float, float]:
        """The point of the plane with given weights; at infinity its direction, of length 1."""
        x, y, w = (np.array(weights) @ self.rounded_corners).tolist()
        if w == 0:
            w = float(np.hypot(x, y))
        return x / w, y / w

    # -- forms ----------------------------------------------------------------------------------

    def forms(self, segment: int) -> list[Any]:
        """L₀ L₁ L₂ q₀₀ q₁₁ q₂₂ q₀₁ q₀₂ q₁₂ of a segment, exactly, times positive integers.

        Those are 2·scale²·unit for L and 2·scale²·unit² for q, where the segment times scale has
        integer coordinates.
        """
        return self._scaled_forms(segment)[0]

    def rounded_forms(self, segment: int) -> list[float]:
        """The same as doubles, not scaled."""
        table, scale = self._scaled_forms(segment)
        one = 2 * scale**2 * self.unit
        return [int(x) / (one if k < 3 else one * self.unit) for k, x in enumerate(table)]

    def _scaled_forms(self, segment: int) -> tuple[list[Any], int]:
        if segment not in self._forms:
            (a, b), scale = _integers(self.diagram.instance.rational_segment(segment))
            d = b[0] - a[0], b[1] - a[1]
            to_a = [(a[0] * w - scale * x, a[1] * w - scale * y) for x, y, w in self.corners]
            to_b = [(b[0] * w - scale * x, b[1] * w - scale * y) for x, y, w in self.corners]
            table = [2 * (p[0] * d[1] - p[1] * d[0]) for p in to_a]
            for k, m in _SQUARES:
                one = to_a[k][0] * to_b[m][0] + to_a[k][1] * to_b[m][1]
                two = to_a[m][0] * to_b[k][0] + to_a[m][1] * to_b[k][1]
                table.append(one + two)
            self._forms[segment] = table, int(scale)
        return self._forms[segment]

    def side_of_line(self, segment: int) -> int:
        """The sign of L in the interior of the triangle, 0 if it changes."""
        signs = {sign(value) for value in self.forms(segment)[:3]} - {0}
        return signs.pop() if len(signs) == 1 else 0

    def signs(self, i: int, j: int) -> tuple[int, ...]:
        """The curves F^± on which the visual angles of two segments can be equal.

        (0,) if both are on one line: there F is the difference of Q_i/|b_i − a_i| and
        Q_j/|b_j − a_j|.
        """
        lines = self.diagram.prepared.lines
        if lines[i] >= 0 and lines[i] == lines[j]:
            return (0,)
        both = self.side_of_line(i) * self.side_of_line(j)
        return (both,) if both else (1, -1)

    def cubic(self, i: int, j: int, which: int) -> list[Any]:
        """The ten Bernstein coefficients of F^± of two segments; see :meth:`signs`.

        Exactly, times one positive number that makes them integers.

        If it vanishes at infinity, which is a side of the triangle, then of what is left of it
        divided by w, raised to degree three.
        """
        t, s = self.forms(i), self.forms(j)
        if which == 0:
            one, two = self._length(i), self._length(j)
            form = [x * two - y * one for x, y in zip(t[3:], s[3:], strict=True)]
            return _raised(self._without_distance(form))
        result = [
            sum(
                (weight * (t[q] * s[line] - which * s[q] * t[line]) for weight, q, line in terms),
                fmpz(0),
            )
            for terms in _PRODUCTS
        ]
        for k in range(3):
            far = all(self.corners[c][2] == 0 for c in range(3) if c != k)
            if far and all(result[c] == 0 for c in SIDES[k]):
                quadratic = [
                    result[STEPS[r, k]] * (6 // (1 + corners.count(k)))
                    for r, corners in enumerate(_SQUARES)
                ]
                return _raised(quadratic)
        return result

    def _without_distance(self, form: list[Any]) -> list[Any]:
        """A quadratic form, or if it vanishes at infinity, which is a side of the triangle, then
        what is left of it divided by w, raised to degree two and doubled."""
        for k in range(3):
            far = [c for c in range(3) if c != k]
            if any(self.corners[c][2] != 0 for c in far):
                continue
            if all(value == 0 for value, pair in zip(form, _SQUARES, strict=True) if k not in pair):
                line = [
                    form[k] if c == k else 2 * form[_SQUARES.index((min(c, k), max(c, k)))]
                    for c in range(3)
                ]
                return [line[c] + line[d] for c, d in _SQUARES]
        return form

    def _length(self, segment: int) -> Any:
        """The length of a segment in units that all segments on its line share, times the square of
        its scale."""
        (a, b), scale = _integers(self.diagram.instance.rational_segment(segment))
        return scale * (abs(b[0] - a[0]) or abs(b[1] - a[1]))

    # -- ports ----------------------------------------------------------------------------------

    def pair(self, port: int) -> tuple[int, int]:
        """The owners of the pieces before and after a port."""
        arrays = self.diagram.arrays
        base, count = int(arrays.start[self.leaf]), int(arrays.ports[self.leaf])
        before = base + (port - base - 1) % count
        return int(arrays.owner[before]), int(arrays.owner[port])

    def port_on_side(self, port: int) -> PortOnSide:
        """Where a port with an odd place is on its side."""
        return side_ports.port_on_side(self, port)

    # -- vertices and ends of arcs --------------------------------------------------------------

    def tied_at(self, vertex: int) -> tuple[int, ...]:
        """The owners of the pieces around a vertex of the leaf."""
        arrays = self.diagram.arrays
        halves = arrays.out[arrays.out_first[vertex] : arrays.out_first[vertex + 1]]
        return tuple(sorted({int(k) for k in arrays.owner[arrays.arcs[halves >> 1, 2:]].ravel()}))

    def contests_at(self, vertex: int) -> list[list[Any]]:
        """The contests F of one of three tied segments with the two others, exactly.

        Of the three choices the one whose gradients are farthest from parallel on the whole
        triangle: a leaf is accepted only if for one of them there is no second common zero.
        """
        tied = self.tied_at(vertex)

        def contests(one: int) -> list[list[Any]]:
            return [
                self.cubic(one, other, self.signs(one, other)[0]) for other in tied if other != one
            ]

        return max(
            (contests(one) for one in tied),
            key=lambda pair: independence(np.array([rounded(cubic) for cubic in pair])),
        )

    @property
    def is_crossing(self) -> bool:
        """Whether the leaf holds the common point of two segments' lines."""
        return bool(self.diagram.leaves.kinds[self.leaf] == CROSSING)

    def _crossing(self) -> Weights:
        """The weights of the common point of the lines of a crossing leaf."""
        arrays = self.diagram.arrays
        base = int(arrays.start[self.leaf])
        f, g = (self.forms(int(arrays.owner[base + k]))[:3] for k in range(2))
        common = [int(f[k - 2] * g[k - 1] - f[k - 1] * g[k - 2]) for k in range(3)]
        total = sum(common)
        return common[0] / total, common[1] / total, common[2] / total

    def vertex(self, vertex: int) -> Weights:
        """The weights of a vertex of the leaf, as doubles."""
        if self.is_crossing:
            return self._crossing()
        f, g = (np.array(rounded(cubic)) for cubic in self.contests_at(vertex))
        found = common_zero(f, g, self.diagram.leaves.points[self.row].tolist())
        if found is None:
            raise ArithmeticError(f"no vertex was found in leaf {self.leaf}")
        return found

    def end(self, arc: int, half: int) -> Weights:
        """The weights of an end of an arc."""
        end = int(self.diagram.arrays.arcs[arc, half])
        if end < 0:
            return self.vertex(-1 - end)
        place = int(self.diagram.arrays.place[end])
        if place % 2 == 0:
            return CORNERS[place // 2]
        at = self.port_on_side(end)
        weights = [0.0, 0.0, 0.0]
        weights[at.position], weights[(at.position + 1) % 3] = 1.0 - at.along, at.along
        return weights[0], weights[1], weights[2]


def _raised(g: list[Any]) -> list[Any]:
    """Thrice the cubic Bernstein coefficients of a quadratic form 200, 020, 002, 110, 101, 011."""
    return [
        3 * g[0], 3 * g[1], 3 * g[2],
        g[0] + 2 * g[3], g[0] + 2 * g[4], g[1] + 2 * g[3],
        g[1] + 2 * g[5], g[2] + 2 * g[4], g[2] + 2 * g[5],
        g[3] + g[4] + g[5],
    ]  # fmt: skip
