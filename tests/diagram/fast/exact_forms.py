"""Q, L and F in rational arithmetic, straight from their definitions, to judge the doubles by.

Nothing here is taken over from the fast builder: coefficients come from the definition of Bernstein
polynomials, and the table of a halved triangle from its corners.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast.examine import NORMS
from harness.diagram.fast.forms import error_factor, halve
from harness.diagram.fast.prune import localise
from harness.diagram.fast.tables import root_table

Point = tuple[Fraction, Fraction]
#: x, y, w
Corner = tuple[Fraction, Fraction, Fraction]
Floats = NDArray[np.float64]

#: Multi-indices of the ten coefficients and of the six entries of Q, in the builder's order.
CUBIC = [(3, 0, 0), (0, 3, 0), (0, 0, 3), (2, 1, 0), (2, 0, 1), (1, 2, 0), (0, 2, 1), (1, 0, 2)]
CUBIC += [(0, 1, 2), (1, 1, 1)]
QUADRATIC = [(2, 0, 0), (0, 2, 0), (0, 0, 2), (1, 1, 0), (1, 0, 1), (0, 1, 1)]
LINEAR = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]


def multinomial(index: Sequence[int]) -> int:
    return math.factorial(sum(index)) // math.prod(math.factorial(k) for k in index)


def bernstein(values: Sequence[Any], order: Sequence[tuple[int, ...]], point: Sequence[Any]) -> Any:
    """Σ multinomial · coefficient · λ^index."""
    return sum(
        multinomial(index) * value * math.prod(x**k for x, k in zip(point, index, strict=True))
        for value, index in zip(values, order, strict=True)
    )


def derivative(values: Sequence[Fraction], direction: int, point: Sequence[Fraction]) -> Fraction:
    """The derivative of a cubic from corner 0 towards corner ``direction``."""
    at = dict(zip(CUBIC, values, strict=True))

    def step(index: tuple[int, ...], corner: int) -> Fraction:
        return at[tuple(k + (c == corner) for c, k in enumerate(index))]  # type: ignore[index]  # three long

    quadratic = [3 * (step(index, direction) - step(index, 0)) for index in QUADRATIC]
    return Fraction(bernstein(quadratic, QUADRATIC, point))


def exact_table(
    segment: tuple[Point, Point], corners: Sequence[Corner], sense: int
) -> list[Fraction]:
    """L at the corners and the polar form of Q between them; see the docstring of ``forms``."""
    (ax, ay), (bx, by) = segment
    far = [((ax * w - x, ay * w - y), (bx * w - x, by * w - y)) for x, y, w in corners]

    def dot(p: Point, q: Point) -> Fraction:
        return p[0] * q[0] + p[1] * q[1]

    lines = [a[0] * (by - ay) - a[1] * (bx - ax) for a, _ in far]
    pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    forms = [sense * (dot(far[k][0], far[m][1]) + dot(far[m][0], far[k][1])) / 2 for k, m in pairs]
    return [*lines, *forms]


def exact_cubic(t: Sequence[Fraction], s: Sequence[Fraction], si: int, sj: int) -> list[Fraction]:
    """The Bernstein coefficients of Q_t sj L_s − Q_s si L_t."""
    return [
        sj * one - si * two
        for one, two in zip(exact_product(t[3:], s[:3]), exact_product(s[3:], t[:3]), strict=True)
    ]


def exact_product(q: Sequence[Fraction], line: Sequence[Fraction]) -> list[Fraction]:
    sums = dict.fromkeys(CUBIC, Fraction(0))
    for (i, x), (j, y) in itertools.product(
        zip(QUADRATIC, q, strict=True), zip(LINEAR, line, strict=True)
    ):
        index = tuple(a + b for a, b in zip(i, j, strict=True))
        weight = Fraction(multinomial(i) * multinomial(j), multinomial(index))
        sums[index] += weight * x * y  # type: ignore[index]  # three long
    return [sums[index] for index in CUBIC]


def exact_collinear(
    t: Sequence[Fraction], s: Sequence[Fraction], ratio: Fraction
) -> list[Fraction]:
    """Q_t − ratio · Q_s raised to degree three; ``ratio`` is |b − a| of t over that of s."""
    difference = [x - ratio * y for x, y in zip(t[3:], s[3:], strict=True)]
    return exact_product(difference, [Fraction(1)] * 3)


def halved(corners: Sequence[Corner], k: int) -> tuple[list[Corner], list[Corner]]:
    """(P, Q, M) and (P, M, R) for corner number k = P and the middle M of QR."""
    p, q, r = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
    middle = tuple((x + y) / 2 for x, y in zip(q, r, strict=True))
    return [p, q, middle], [p, middle, r]  # type: ignore[list-item]  # three long


def double_double(value: Fraction) -> tuple[float, float]:
    high = float(value)
    return high, float(value - Fraction(high))


@dataclass(frozen=True)
class Scene:
    """Two segments over a triangle.

    ``corners``: (x, y, w) with w = 1 or 0.  ``zeros``, ``ends``: for each segment the corners
    (a bit each) that are said to lie on its line and at its endpoints.
    """

    segments: tuple[tuple[Point, Point], ...]
    corners: tuple[Corner, ...]
    zeros: tuple[int, ...] = (0, 0)
    ends: tuple[int, ...] = (0, 0)
    sense: int = 1

    def scaled(self) -> Scene:
        """The same times the power of two that brings all coordinates of segments below 1."""
        largest = max(abs(x) for segment in self.segments for point in segment for x in point)
        exponent = math.frexp(float(largest))[1]
        scale = Fraction(2) ** -exponent
        segments = tuple(
            ((a[0] * scale, a[1] * scale), (b[0] * scale, b[1] * scale)) for a, b in self.segments
        )
        corners = tuple((x * scale, y * scale, w) if w else (x, y, w) for x, y, w in self.corners)
        return Scene(segments, corners, self.zeros, self.ends, self.sense)

    @property
    def far(self) -> int:
        """The corners at infinity, a bit each."""
        return sum(1 << k for k, corner in enumerate(self.corners) if corner[2] == 0)

    def tables(self) -> tuple[list[Floats], list[Floats]]:
        """The tables of both segments in doubles, and their (ML, MQ)."""
        corners = np.array([[*double_double(x), *double_double(y)] for x, y, _ in self.corners])
        weights = np.array([float(w) for _, _, w in self.corners])
        rows = [
            np.array([part for point in segment for x in point for part in double_double(x)])
            for segment in self.segments
        ]
        size = max(float(np.abs(row).max()) for row in rows)
        tables, norms = [], []
        for row, zeros, ends in zip(rows, self.zeros, self.ends, strict=True):
            table, norm = np.empty(9), np.empty(2)
            root_table(row, corners, weights, zeros, ends, size, float(self.sense), table, norm)
            tables.append(table)
            norms.append(norm)
        return tables, norms


@dataclass
class Descent:
    """A scene after some halvings: tables in doubles, corners exactly.

    ``norms``: ML and MQ of both segments over the root.  ``weights``: the corners in terms of those
    of the root.
    """

    scene: Scene
    tables: list[Floats]
    norms: list[Floats]
    corners: Sequence[Corner]
    far: int
    weights: Floats
    depth: int = 0

    @classmethod
    def into(cls, scene: Scene, steps: Iterable[tuple[int, int]]) -> Descent:
        """Halve at each step (corner opposite to the side, which half)."""
        tables, norms = scene.tables()
        here = cls(scene, tables, norms, scene.corners, scene.far, np.eye(3))
        for k, half in steps:
            here._halve(k, half)
        return here

    def _halve(self, k: int, half: int) -> None:
        for number, table in enumerate(self.tables):
            rows = np.stack([table, np.empty(9)])
            halve(rows, 0, k, 1)
            self.tables[number] = rows[1 - half]
        self.corners = halved(self.corners, k)[half]
        self.far = sum(1 << c for c, corner in enumerate(self.corners) if corner[2] == 0)
        p, q, r = (self.weights[(k + turn) % 3] for turn in range(3))
        middle = 0.5 * (q + r)
        self.weights = np.array([p, q, middle] if half == 0 else [p, middle, r])
        self.depth += 1

    def exact(self) -> tuple[list[Fraction], list[Fraction]]:
        one, two = self.scene.segments
        sense = self.scene.sense
        return exact_table(one, self.corners, sense), exact_table(two, self.corners, sense)

    def local_norms(self) -> Floats:
        """ML and MQ of both segments over this triangle, (2, 2)."""
        rows = np.zeros((2, NORMS))
        for row, norm, zeros, ends in zip(
            rows, self.norms, self.scene.zeros, self.scene.ends, strict=True
        ):
            row[2:4], row[4] = norm, zeros + 8 * ends
        localise(rows, 0, 2, self.weights.ravel(), np.ones(8), 2)
        return rows[:, :2]

    @property
    def rows(self) -> Floats:
        """The tables of both segments, (2, 9)."""
        return np.stack(self.tables)

    @property
    def bound(self) -> float:
        """As in the subdivision."""
        (lt, qt), (ls, qs) = self.local_norms().tolist()
        return float(error_factor(self.depth) * (qt * ls + qs * lt))


def sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)
