"""From disjoint u-monotone arcs to the faces they bound: one sweep over the plane.

The status is the list of arcs that cross the moving vertical line, bottom to top, with the face of
every gap between them.  In generic position one point p is passed at a time: the arcs that end in p
are neighbours in the status (this is checked), they leave, the arcs that start in p take their
place.  A gap that opens is a new face; where p has no arc to its right the gaps below and above it
turn out to be one face, and the two are joined.

No order is taken from floating-point coordinates, and none is assumed: arcs that start together
are ordered exactly on a vertical line to their right that all of them reach.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from functools import cmp_to_key

from flint import fmpq
from scipy.cluster.hierarchy import DisjointSet

from harness.diagram.algebra import Point, compare_numbers
from harness.diagram.arcs import Arc
from harness.diagram.fibres import rational_between, sort_by_u


@dataclass(eq=False)
class Junction:
    """A point where arcs start or end: ``left`` end here, ``right`` start here, bottom to top."""

    point: Point
    left: list[Arc] = field(default_factory=list)
    right: list[Arc] = field(default_factory=list)


@dataclass
class Sweep:
    """The outcome.

    ``faces[arc]`` are the faces just below and just above an arc, ``unbounded`` the faces that
    reach infinity, ``samples`` a rational point (u, v) inside every gap that ever opened with its
    face, ``first`` and ``last`` the arcs that come from u = −∞ and go to u = +∞, bottom to top.
    """

    junctions: list[Junction]
    faces: dict[Arc, tuple[int, int]]
    unbounded: set[int]
    samples: list[tuple[fmpq, fmpq, int]]
    first: list[Arc]
    last: list[Arc]


class SweepError(ArithmeticError):
    """The arcs do not form a subdivision of the plane: a defect of the builder."""


def sweep(arcs: list[Arc], avoid: frozenset[tuple[fmpq, fmpq]] = frozenset()) -> Sweep:
    """Sweep over interior-disjoint arcs; O((N + A) log A) exact comparisons.

    ``avoid``: points (u, v) that must not be taken as samples.
    """
    junctions = _junctions(arcs)
    faces, numbering = DisjointSet([0]), itertools.count(1)
    status = [arc for arc in arcs if arc.start is None]
    u = _line_between(None, junctions[0].point if junctions else None, status)
    status = sorted_on_line(status, u)
    gaps = [0]
    sides: dict[Arc, tuple[int, int]] = {}
    samples: list[tuple[fmpq, fmpq, int]] = []

    def fresh() -> int:
        face = next(numbering)
        faces.add(face)
        return face

    def open_gaps(new: list[Arc], below: int, above: int) -> list[int]:
        bounds = [below, *(fresh() for _ in new[1:]), above]
        for k, arc in enumerate(new):
            sides[arc] = (bounds[k], bounds[k + 1])
        return bounds

    if status:
        gaps = open_gaps(status, 0, fresh())
    first = list(status)
    unbounded = set(gaps)
    samples += _gap_samples(status, gaps, u, range(len(gaps)), avoid)
    for k, junction in enumerate(junctions):
        low = _position(status, junction)
        high = low + len(junction.left)
        if set(status[low:high]) != set(junction.left):
            raise SweepError("the arcs that end in a point are not neighbours")
        junction.left = status[low:high]
        following = junctions[k + 1].point if k + 1 < len(junctions) else None
        u = _line_between(junction.point, following, [*status, *junction.right])
        junction.right = sorted_on_line(junction.right, u)
        below, above = gaps[low], gaps[high]
        if junction.right:
            bounds = open_gaps(junction.right, below, above)
        else:
            faces.merge(below, above)
            bounds = [below]
        status[low:high] = junction.right
        gaps[low : high + 1] = bounds
        samples += _gap_samples(status, gaps, u, range(low, low + len(bounds)), avoid)
    unbounded |= set(gaps)
    return Sweep(
        junctions,
        {arc: (faces[below], faces[above]) for arc, (below, above) in sides.items()},
        {faces[face] for face in unbounded},
        [(u, v, faces[face]) for u, v, face in samples],
        first,
        status,
    )


def _junctions(arcs: list[Arc]) -> list[Junction]:
    found: dict[object, Junction] = {}
    for arc in arcs:
        if arc.start is not None:
            found.setdefault(arc.start.number.key, Junction(arc.start)).right.append(arc)
        if arc.end is not None:
            found.setdefault(arc.end.number.key, Junction(arc.end)).left.append(arc)
    by_point = {junction.point: junction for junction in found.values()}
    return [by_point[p] for p in sort_by_u(list(by_point))]


def _line_between(low: Point | None, high: Point | None, arcs: list[Arc]) -> fmpq:
    """A rational u strictly between two points at which none of the arcs' curves has an event."""
    u = rational_between(low, high)
    while any(arc.slabs.has_event_at(u) for arc in arcs):
        # The shortest rationals are the likeliest to be special: go on towards the left.
        u = rational_between(low, Point.rational(u, u))
    return u


def sorted_on_line(arcs: list[Arc], u: fmpq) -> list[Arc]:
    """The arcs from bottom to top on u = const, which all of them cross."""
    numbers = {arc: arc.at(u).number for arc in arcs}

    def compare(a: Arc, b: Arc) -> int:
        return compare_numbers(numbers[a], numbers[b])

    return sorted(arcs, key=cmp_to_key(compare))


def _position(status: list[Arc], junction: Junction) -> int:
    """Where the junction's left arcs begin in the status, or where it lies if it has none."""
    if junction.left:
        return min(status.index(arc) for arc in junction.left)
    low, high = 0, len(status)
    while low < high:
        middle = (low + high) // 2
        if status[middle].is_below(junction.point):
            low = middle + 1
        else:
            high = middle
    return low


def _gap_samples(
    status: list[Arc],
    gaps: list[int],
    u: fmpq,
    which: range,
    avoid: frozenset[tuple[fmpq, fmpq]],
) -> list[tuple[fmpq, fmpq, int]]:
    """A rational point on u = const inside each of the given gaps."""
    samples = []
    for k in which:
        below = status[k - 1].at(u) if k > 0 else None
        above = status[k].at(u) if k < len(status) else None
        v = rational_between(below, above)
        while (u, v) in avoid:
            v = rational_between(below, Point.rational(v, v))
        samples.append((u, v, gaps[k]))
    return samples
