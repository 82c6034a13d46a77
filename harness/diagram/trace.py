"""Where the reference builder's nodes and edges lie: exact boxes, polylines, ranges of cot θ."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cached_property

import numpy as np
from flint import arb, ctx, fmpq
from numpy.typing import NDArray

from harness.diagram.algebra import Point
from harness.diagram.arcs import Arc
from harness.diagram.planar_map import RationalPoint, Window
from harness.diagram.scene import Scene

FAR = 2**60


class ExactPlace:
    """A node of the reference builder: an exact algebraic point."""

    def __init__(self, scene: Scene, point: Point) -> None:
        """``point`` in sheared coordinates."""
        self.scene = scene
        self.point = point

    @cached_property
    def floats(self) -> tuple[float, float]:
        """(x, y) rounded to doubles."""
        return self.scene.floats(self.point)

    def enclosure(self, bits: int) -> tuple[RationalPoint, RationalPoint]:
        """Rational corners of a box around the point, computed with ``bits`` bits."""
        with ctx.workprec(bits):
            u, v = self.point.balls(bits)
            x = (u - self.scene.shear * v) / self.scene.scale
            y = v / self.scene.scale
            low = (_fraction(x.lower()), _fraction(y.lower()))
            return low, (_fraction(x.upper()), _fraction(y.upper()))


def _fraction(value: arb) -> Fraction:
    rational = value.fmpq()
    return Fraction(int(rational.p), int(rational.q))


def direction_at_infinity(scene: Scene, arc: Arc, outwards: bool) -> tuple[float, float]:
    """The unit vector in which an unbounded arc leaves, from a point 2^60 sizes away."""
    size = 1 + max(abs(c) for s in scene.segments for p in s for c in scene.integers(p))
    u = fmpq((1 if outwards else -1) * FAR * size * scene.shear)
    x, y = scene.floats(arc.at(u))
    length = math.hypot(x, y)
    return x / length, y / length


class ExactCourse:
    """An edge of the reference builder: a chain of arcs."""

    def __init__(
        self, scene: Scene, chain: list[tuple[Arc, bool]], segments: tuple[int, int]
    ) -> None:
        """``chain``: arcs from start to end, each with its sense (True: increasing u)."""
        self.scene = scene
        self.chain = chain
        self.segments = segments

    def polyline(self, tolerance: float, window: Window | None) -> NDArray[np.float64]:
        """To do."""
        raise AssertionError

    def cotangent_range(self) -> tuple[float, float]:
        """To do."""
        raise AssertionError
