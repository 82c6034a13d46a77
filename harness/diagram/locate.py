"""Point location in a swept map, exactly."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq, fmpq_poly

from harness.diagram.algebra import Point, compare_numbers, real_numbers
from harness.diagram.arcs import Arc
from harness.diagram.fibres import rational_between, sort_by_u
from harness.diagram.planar_map import RationalPoint
from harness.diagram.scene import Scene
from harness.diagram.sweep import Sweep, sorted_on_line


def unsheared(scene: Scene, u: fmpq, v: fmpq) -> RationalPoint:
    """The input coordinates (x, y) of a rational point (u, v)."""
    x, y = (u - scene.shear * v) / scene.scale, v / scene.scale
    return Fraction(int(x.p), int(x.q)), Fraction(int(y.p), int(y.q))


class Locator:
    """Finds the cell of a rational point; O(A) exact comparisons for A arcs."""

    def __init__(self, scene: Scene, swept: Sweep, cell_of: dict[int, int]) -> None:
        """``cell_of``: the cell of every face inside the domain."""
        self.scene = scene
        self.arcs = list(swept.faces)
        self.faces = swept.faces
        self.only_face = swept.samples[0][2]
        self.cell_of = cell_of

    def __call__(self, point: RationalPoint) -> int | None:
        """The cell's index, −1 outside the domain, None on an edge, a node or the boundary."""
        p = self.scene.sheared(point)
        if any(_passes_through(arc, p) for arc in self.arcs):
            return None
        beside = self._beside(p)
        under = [arc for arc in self.arcs if _spans(arc, beside) and arc.is_below(beside)]
        if under:
            face = self.faces[sorted_on_line(under, beside.coordinates[0])[-1]][1]
        else:
            face = self._lowest_face(beside)
        return self.cell_of.get(face, -1)

    def _beside(self, p: Point) -> Point:
        """A point (u', v) with u' > u that no arc and no event separates from p = (u, v).

        Between u and u' no curve meets the horizontal line v, and no curve has an event.
        """
        _, v = p.coordinates
        obstacles = [p]
        for slabs in {id(arc.slabs): arc.slabs for arc in self.arcs}.values():
            obstacles += [e for e in slabs.events if compare_numbers(e.number, p.number) > 0]
            crossing = slabs.polynomial.on_horizontal(v)
            if crossing.degree() > 0:
                obstacles += [
                    Point(number, fmpq_poly([0, 1]), fmpq_poly([v]))
                    for number in real_numbers(crossing)
                    if compare_numbers(number, p.number) > 0
                ]
        right = sort_by_u(obstacles)
        nearest = right[1] if len(right) > 1 else None
        return Point.rational(rational_between(p, nearest), v)

    def _lowest_face(self, p: Point) -> int:
        """The face below all arcs that cross p's vertical line, or the face left of all arcs."""
        over = [arc for arc in self.arcs if _spans(arc, p)]
        if not over:
            return self.only_face
        return self.faces[sorted_on_line(over, p.coordinates[0])[0]][0]


def _spans(arc: Arc, p: Point) -> bool:
    return (arc.start is None or compare_numbers(arc.start.number, p.number) < 0) and (
        arc.end is None or compare_numbers(p.number, arc.end.number) < 0
    )


def _passes_through(arc: Arc, p: Point) -> bool:
    """Whether p lies on the closed arc."""
    if p.sign(arc.slabs.polynomial):
        return False
    for end in (arc.start, arc.end):
        if end is not None and end.number.key == p.number.key:
            return end.is_same_place(p)
    return arc.contains(p)
