"""Point location in a swept map, exactly."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq

from harness.diagram.planar_map import RationalPoint
from harness.diagram.scene import Scene
from harness.diagram.sweep import Sweep


def unsheared(scene: Scene, u: fmpq, v: fmpq) -> RationalPoint:
    """The input coordinates (x, y) of a rational point (u, v)."""
    x, y = (u - scene.shear * v) / scene.scale, v / scene.scale
    return Fraction(int(x.p), int(x.q)), Fraction(int(y.p), int(y.q))


class Locator:
    """Finds the cell of a rational point."""

    def __init__(self, scene: Scene, swept: Sweep, cell_of: dict[int, int]) -> None:
        """``cell_of``: the cell of every face inside the domain."""
        self.scene = scene
        self.swept = swept
        self.cell_of = cell_of

    def __call__(self, point: RationalPoint) -> int | None:
        """To do."""
        raise AssertionError
