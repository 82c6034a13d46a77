"""Components cut at their events into u-monotone arcs, and the arcs that are Voronoi edges.

Between two consecutive events of a curve the vertical line u = const meets it in a constant number
of points, ordered by v: its *branches*.  At an event p all branches but those that run into p go
straight on; how many pass below and above p is decided exactly, so the branches on both sides of p
are matched by counting.  No branch is followed numerically.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from flint import ctx, fmpq

from harness.diagram.algebra import FIRST_PRECISION, NotGeneric, Point, Polynomial, compare_numbers
from harness.diagram.bisectors import Component
from harness.diagram.domain import Region
from harness.diagram.fibres import (
    Strip,
    branches_around,
    compare_with_rational,
    fibre_points,
    rational_between,
    sort_by_u,
)
from harness.diagram.scene import Scene


class Slabs:
    """A curve's events in order of u, and the slabs between them.

    Slab k lies between ``bounds[k]`` and ``bounds[k + 1]``; the first and last bound are the ends
    of the strip (None: no bound).
    """

    def __init__(self, polynomial: Polynomial, events: list[Point], strip: Strip) -> None:
        """``events``: points of the curve in the strip, in any order."""
        self.polynomial = polynomial
        self.events = sort_by_u(events)
        self.bounds: list[Point | None] = [strip[0], *self.events, strip[1]]
        self._samples: dict[int, fmpq] = {}

    def is_empty(self, slab: int) -> bool:
        """Whether an event lies on the strip's border, so that the slab beyond has no width."""
        low, high = self.bounds[slab], self.bounds[slab + 1]
        return low is not None and high is not None and low.number.key == high.number.key

    def sample(self, slab: int) -> fmpq:
        """A rational u inside the slab."""
        if slab not in self._samples:
            self._samples[slab] = rational_between(self.bounds[slab], self.bounds[slab + 1])
        return self._samples[slab]

    def slab_of(self, u: fmpq) -> int:
        """The slab that contains a rational u, which must not be that of an event."""
        low, high = 0, len(self.events)
        while low < high:
            middle = (low + high) // 2
            order = compare_with_rational(self.events[middle].number, u)
            if order == 0:
                raise NotGeneric("a sample on an event")
            low, high = (middle + 1, high) if order < 0 else (low, middle)
        return low

    def has_event_at(self, u: fmpq) -> bool:
        """Whether an event lies on the line u = const."""
        return any(compare_with_rational(event.number, u) == 0 for event in self.events)

    def slab_ending_at(self, p: Point) -> int:
        """The slab in whose interior or on whose right border p's vertical line runs."""
        return sum(compare_numbers(event.number, p.number) < 0 for event in self.events)

    def is_event(self, p: Point) -> bool:
        """Whether p is one of the curve's events."""
        return any(e.number.key == p.number.key and e.is_same_place(p) for e in self.events)

    def branch_of(self, p: Point, slab: int) -> int:
        """The position in ``slab``, which ends at or after p, of the branch that runs through p.

        p is a point of the curve but no event; yet an event e may share its u.  Then f on that
        line is a(v − e)^m (v − v(p)) or has one further zero q, and a·(p − e)^m·(p − q) is the
        derivative at p.
        """
        f = self.polynomial
        beside = [e for e in self.events if e.number.key == p.number.key]
        if not beside:
            return branches_around(f, p, on_curve=True)[0]
        side = p.compare_v(beside[0])
        multiplicity = beside[0].multiplicity_on(f)
        lead = 1 if f.rows[-1](0) > 0 else -1
        other = 0
        if f.degree_v - multiplicity == 2:
            other = p.sign(f.derivative) * lead * (side if multiplicity % 2 else 1)
        if side < 0:
            return int(other > 0)
        return f.roots_on_fibre(self.sample(slab)) - 1 - int(other < 0)


@dataclass(eq=False)
class Arc:
    """A u-monotone piece of a curve between two events (None: it comes from or goes to the border).

    ``branch[k]`` is its position, from 0 by increasing v, among the curve's branches in slab k.
    ``below`` and ``above`` are the segments that win on either side (None outside the domain).
    """

    slabs: Slabs
    start: Point | None
    end: Point | None = None
    branch: dict[int, int] = field(default_factory=dict)
    below: int | None = None
    above: int | None = None
    is_wall: bool = False

    def sample_slab(self) -> int:
        """A slab of positive width through which the arc runs: the middle one."""
        slabs = sorted(self.branch)
        return slabs[len(slabs) // 2]

    def at(self, u: fmpq) -> Point:
        """The arc's point with this rational u."""
        slab = self.slabs.slab_of(u)
        return fibre_points(self.slabs.polynomial, u)[self.branch[slab]]

    def contains(self, p: Point) -> bool:
        """Whether p, a point of the arc's curve, is an inner point of the arc."""
        if self.slabs.is_event(p):
            return False  # arcs are cut at the events that lie on them
        slab = self.slabs.slab_ending_at(p)
        return self.branch.get(slab) == self.slabs.branch_of(p, slab)

    def is_below(self, p: Point) -> bool:
        """Whether the arc passes strictly below p, a point with u within the arc but not on it."""
        below, _ = branches_around(self.slabs.polynomial, p)
        # At an event of the curve the branches that pass below p keep their position from the left.
        return self.branch[self.slabs.slab_ending_at(p)] < below


def trace(polynomial: Polynomial, events: list[Point], strip: Strip) -> list[Arc]:
    """All u-monotone arcs of a curve inside the strip, cut at its events."""
    slabs = Slabs(polynomial, events, strip)
    arcs: list[Arc] = []

    def begin(start: Point | None, count: int) -> list[Arc]:
        new = [Arc(slabs, start) for _ in range(count)]
        arcs.extend(new)
        return new

    active = [] if slabs.is_empty(0) else begin(None, _branches(slabs, 0))
    _note(active, 0)
    for k, event in enumerate(slabs.events):
        below, above = branches_around(polynomial, event, on_curve=True)
        if k == 0 and slabs.is_empty(0):
            active = begin(None, below + above)
        ending = active[below : len(active) - above]
        for arc in ending:
            arc.end = event
        starting = 0 if slabs.is_empty(k + 1) else _branches(slabs, k + 1) - below - above
        active = active[:below] + begin(event, starting) + active[len(active) - above :]
        if not slabs.is_empty(k + 1):
            _note(active, k + 1)
    return [arc for arc in arcs if arc.branch]


def _branches(slabs: Slabs, slab: int) -> int:
    return slabs.polynomial.roots_on_fibre(slabs.sample(slab))


def _note(active: list[Arc], slab: int) -> None:
    for position, arc in enumerate(active):
        arc.branch[slab] = position


def bisector_arcs(scene: Scene, region: Region, curve: Component) -> list[Arc]:
    """The arcs of a component on which two different segments win on the two sides."""
    found = []
    for arc in trace(curve.polynomial, list(curve.events.values()), region.strip):
        slab = arc.sample_slab()
        p = arc.at(arc.slabs.sample(slab))
        tied = _tie_at(scene, region, curve, p)
        if not tied:
            continue
        arc.below = scene.side_winner(tied, p, above=False)
        arc.above = scene.side_winner(tied, p, above=True)
        if arc.below != arc.above:
            found.append(arc)
    return found


def _tie_at(scene: Scene, region: Region, curve: Component, p: Point) -> tuple[int, ...]:
    """All winners at p if it is inside the domain and the curve is a tie of two; otherwise none.

    Outside, p may be an endpoint of a segment; inside, those are events and never samples.
    """
    u, v = p.balls(FIRST_PRECISION)
    for i, j, sign in curve.ties:
        with ctx.workprec(FIRST_PRECISION):
            hopeless = not scene.may_win(i, u, v)
        if not hopeless and scene.side(i, p) * scene.side(j, p) == sign:
            if region.side(p) <= 0:
                return ()
            winners = scene.winners(p, tied=frozenset((i, j)))
            if i in winners and j in winners:
                return winners
    return ()


def wall_arcs(region: Region, events: list[Point]) -> list[Arc]:
    """The boundary of the domain cut at all events on it; winners are filled in by the caller."""
    found = []
    for k, wall in enumerate(region.walls):
        on_wall = [p for p in events if region.wall_contains(k, p) and p.sign(wall) == 0]
        for arc in trace(wall, on_wall, region.strip):
            if region.wall_contains(k, arc.at(arc.slabs.sample(arc.sample_slab()))):
                arc.is_wall = True
                found.append(arc)
    return found
