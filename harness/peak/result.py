"""What every method returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from harness.geometry.coordinates import Point
    from harness.peak.algebra import ExactPeak

Objective = Literal["max-min", "min-max"]
METHODS = ("lp", "diagram", "parametric")
OBJECTIVES = ("max-min", "min-max")
WIDTH = 1e-12
"""The greatest width of the enclosure of an angle, in radians."""


@dataclass(frozen=True, eq=False)
class Peak:
    """A point of best visual angle in the closed kernel of a polygon, and the proof.

    ``x``, ``y``: the point as doubles; ``point``: the exact point that the enclosure speaks of.
    ``lower`` ≤ optimal angle ≤ ``upper`` (radians, proven, at most 1e-12 apart), and the point
    itself comes as near as that; ``angle``, between them, is the best guess.  ``basis``: the edges
    (segments, as the instance numbers them) that determine the optimum, increasing.  ``walls``:
    those among them on whose own line the point lies.  ``vertex``: the polygon's vertex that the
    point is, or None; its two edges are seen from there under every pair of angles that a
    direction gives, and the optimum is a limit along the best one, not a value.  ``facts``: what
    the method did.  ``exact``: the algebraic number behind it, if that was asked for.
    """

    x: float
    y: float
    angle: float
    basis: tuple[int, ...]
    lower: float
    upper: float
    point: Point
    method: str
    objective: Objective
    walls: tuple[int, ...] = ()
    vertex: int | None = None
    facts: Mapping[str, int] = field(default_factory=dict)
    exact: ExactPeak | None = None

    def as_dict(self) -> dict[str, Any]:
        """What ``avd peak --json`` prints of it."""
        record: dict[str, Any] = {
            "objective": self.objective,
            "method": self.method,
            "x": self.x,
            "y": self.y,
            "angle": self.angle,
            "basis": list(self.basis),
            "lower": self.lower,
            "upper": self.upper,
            "walls": list(self.walls),
            "vertex": self.vertex,
            **self.facts,
        }
        if self.exact is not None:
            record["exact"] = self.exact.as_dict()
        return record
