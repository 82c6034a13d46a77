"""Where the reference builder's nodes and edges lie: boxes, polylines, directions at infinity."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cached_property

import numpy as np
from flint import arb, ctx, fmpq
from numpy.typing import NDArray

from harness.diagram.algebra import FIRST_PRECISION, NotGeneric, Point
from harness.diagram.arcs import Arc
from harness.diagram.chords import (
    BisectorChords,
    Position,
    allowed_in,
    default_window,
    refined,
)
from harness.diagram.cotangents import cotangent_values
from harness.diagram.fibres import rational_between
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
        """Rational corners of a box around the point, computed with ``bits`` bits.

        Or with as many more as make the box finite.
        """
        while True:
            with ctx.workprec(bits):
                u, v = self.point.balls(bits)
                x = (u - self.scene.shear * v) / self.scene.scale
                y = v / self.scene.scale
                if x.is_finite() and y.is_finite():
                    low = (_fraction(x.lower()), _fraction(y.lower()))
                    return low, (_fraction(x.upper()), _fraction(y.upper()))
            bits *= 2


def _fraction(value: arb) -> Fraction:
    rational = value.fmpq()
    return Fraction(int(rational.p), int(rational.q))


def direction_at_infinity(scene: Scene, arc: Arc, outwards: bool) -> tuple[float, float]:
    """The unit vector in which an unbounded arc leaves, from a point 2^60 sizes away,
    beyond the last event of its curve."""
    size = 1 + max(abs(c) for s in scene.segments for p in s for c in scene.integers(p))
    events = arc.slabs.events
    if outwards:
        beyond = rational_between(events[-1] if events else None, None)
        u = FAR * max(beyond, fmpq(size * scene.shear))
    else:
        beyond = rational_between(None, events[0] if events else None)
        u = FAR * min(beyond, fmpq(-size * scene.shear))
    x, y = scene.floats(arc.at(u))
    length = math.hypot(x, y)
    return x / length, y / length


class ExactCourse:
    """An edge of the reference builder: a chain of arcs whose points can all be had exactly."""

    def __init__(
        self, scene: Scene, chain: list[tuple[Arc, bool]], segments: tuple[int, int]
    ) -> None:
        """``chain``: arcs from start to end, each with its sense (True: increasing u)."""
        self.scene = scene
        self.chain = chain
        self.segments = segments

    def polyline(self, tolerance: float, window: Window | None) -> NDArray[np.float64]:
        """See :meth:`harness.diagram.planar_map.Edge.polyline`.

        All points lie on the edge exactly, up to rounding.
        """
        if not tolerance > 0:
            raise ValueError("the tolerance must be positive")
        points: list[tuple[float, float]] = []
        corners = np.array(self.scene.segments, dtype=float).reshape(-1, 2)
        view = window or default_window(corners)
        allowed, limit = allowed_in(view, tolerance), _limit(self.scene, view)
        pair = [self.scene.segments[k] for k in self.segments]
        chords = BisectorChords(np.array(pair, dtype=float))
        for arc, forward in self.chain:
            piece = _arc_polyline(self.scene, arc, limit, chords, allowed)
            piece = piece if forward else piece[::-1]
            points += piece[1:] if points else piece
        return np.array(points)

    def cotangent_range(self) -> tuple[float, float]:
        """See :attr:`harness.diagram.planar_map.Edge.cotangent_range`."""
        values = [
            value
            for arc, _ in self.chain
            for value in cotangent_values(self.scene, arc, self.segments)
        ]
        return min(values), max(values)


def _limit(scene: Scene, window: Window) -> fmpq:
    """A bound that |u| does not exceed inside the window."""
    x = max(abs(Fraction(window[0])), abs(Fraction(window[2])))
    y = max(abs(Fraction(window[1])), abs(Fraction(window[3])))
    bound = (x + scene.shear * y) * scene.ratio
    return fmpq(bound.numerator, bound.denominator)


def _open_range(arc: Arc, limit: fmpq) -> tuple[fmpq, fmpq]:
    """Rationals just inside the u-range of an arc; unbounded ends reach beyond ±limit."""
    bits = 4 * FIRST_PRECISION
    with ctx.workprec(bits):
        low = arc.start.number.ball(bits).upper().fmpq() if arc.start else None
        high = arc.end.number.ball(bits).lower().fmpq() if arc.end else None
    events = arc.slabs.events
    if low is None:
        low = min(-limit, rational_between(None, events[0] if events else None)) - 1
    if high is None:
        high = max(limit, rational_between(events[-1] if events else None, None)) + 1
    return low, high


def _at(arc: Arc, u: fmpq) -> Point:
    """The arc's point near u (u itself may belong to an event of another branch of its curve)."""
    while True:
        try:
            return arc.at(u)
        except NotGeneric:
            u += fmpq(1, FAR)


def _between(low: fmpq, high: fmpq, s: float) -> fmpq:
    """A short rational near low + (high − low)·sin²(πs/2), crowded towards both ends.

    It is off by less than 2^-20 of its distance from the nearer end: fibres over short rationals
    are found quickly.
    """
    end, width = (low, high - low) if s <= 0.5 else (high, low - high)
    part = Fraction(math.sin(math.pi * min(s, 1 - s) / 2) ** 2)
    step = width * fmpq(part.numerator, part.denominator)
    shift = 20 + int(step.q).bit_length() - int(abs(step.p)).bit_length()
    grain = fmpq(1, 2**shift) if shift >= 0 else fmpq(2**-shift)
    return fmpq(((end + step) / grain).floor()) * grain


def _arc_polyline(
    scene: Scene,
    arc: Arc,
    limit: fmpq,
    chords: BisectorChords,
    allowed: Callable[[Position, Position], float],
) -> list[Position]:
    low, high = _open_range(arc, limit)

    def point(s: float) -> Position:
        """s ∈ [0, 1], crowded towards the ends, where the arc may be vertical."""
        if s == 0 and arc.start is not None:
            return scene.floats(arc.start)
        if s == 1 and arc.end is not None:
            return scene.floats(arc.end)
        return scene.floats(_at(arc, _between(low, high, s) if 0 < s < 1 else (low, high)[int(s)]))

    return list(refined(point, (0.0, 1.0), chords, allowed))
