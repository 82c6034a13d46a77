"""The irreducible components of all bisectors, and the points at which anything happens on them.

Every Voronoi edge lies on a component of some F^±_ij.  Along a component the answer to "which
segments win here, and who wins on either side?" can change only at its **events**:

* its own critical points: vertical tangents and singular points (needed for the order of its
  branches, and they are where a bisector crosses itself);
* endpoints of segments and meeting points of the lines of two segments (both rational): there a
  visual angle is undefined, or the sign of L_i L_j changes, or two angles are 0 together (for
  collinear segments: all meeting points with their common line);
* points where it meets another component that shares a segment with it: a third segment ties, or
  the other component of a reducible bisector crosses.  Such a point matters only where the tie is
  the best of all segments, so all others are dropped after an exact test;
* the boundary of the domain.

Why meetings of F_ij with F_ik, i < j < k, and of the components of one F_ij are enough: from
L_k F_ij − L_j F_ik = −L_i F_jk, a point where i, j, k tie lies on all three.  If only one component
h passes there for all pairs with the least segment i of the tie, and another component g of F_jk
does too, then h divides L_i F_jk, so g and h are two components of one bisector.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterable, Iterator

from flint import arb, fmpq, fmpz_mpoly

from harness.diagram.algebra import Key, NotGeneric, Point, Polynomial, irreducible_factors
from harness.diagram.domain import Region
from harness.diagram.fibres import intersect
from harness.diagram.scene import Scene

Tie = tuple[int, int, int]


class Component:
    """An irreducible curve; the ties (i, j, sign) whose F^sign_ij it divides; its events."""

    def __init__(self, polynomial: Polynomial) -> None:
        """Raises NotGeneric where the curve could have a vertical asymptote or be vertical."""
        if polynomial.degree_v != polynomial.mpoly.total_degree():
            raise NotGeneric("a vertical asymptote")
        self.polynomial = polynomial
        self.ties: list[Tie] = []
        self.events: dict[Key, Point] = {}

    def add_event(self, p: Point) -> None:
        """Remember p, a point of the curve, as one of its events."""
        self.events[p.number.key] = p


class Register:
    """One Point object for each place, and proof that no two places share u."""

    def __init__(self) -> None:
        """Start empty."""
        self.points: dict[Key, Point] = {}

    def canonical(self, p: Point) -> Point:
        """The first registered point equal to p.

        Raises:
            NotGeneric: another point has the same u.
        """
        known = self.points.setdefault(p.number.key, p)
        if not known.is_same_place(p):
            raise NotGeneric("two events share u")
        return known


def components(scene: Scene, signs: Iterable[int]) -> list[Component]:
    """All components of all F^sign_ij, each once, with the ties it stands for.

    A component on the common line of two collinear segments is no bisector: their order does not
    change across that line, on which both angles are 0 or π (O(n²) factorisations).
    """
    found: dict[object, Component] = {}
    signs = tuple(signs)
    for i, j in itertools.combinations(range(scene.n), 2):
        line = _normal_form(scene.line[i].mpoly)
        for sign in signs:
            for factor in irreducible_factors(scene.tie(i, j, sign).mpoly):
                form = _normal_form(factor)
                if form == line:
                    continue
                if form not in found:
                    found[form] = Component(Polynomial(factor))
                found[form].ties.append((i, j, sign))
    return list(found.values())


def _normal_form(mpoly: fmpz_mpoly) -> object:
    """A hashable form that is the same for all constant multiples of a polynomial."""
    _, primitive = mpoly.primitive()
    terms = sorted((tuple(int(e) for e in m), int(c)) for m, c in primitive.to_dict().items())
    orientation = 1 if terms[-1][1] > 0 else -1
    return tuple((m, c * orientation) for m, c in terms)


def find_events(scene: Scene, region: Region, curves: list[Component], register: Register) -> None:
    """Fill in the events of all components (see the module's text)."""
    for curve in curves:
        if curve.polynomial.degree_v > 1:
            for p in intersect(curve.polynomial, curve.polynomial.derivative, region.strip):
                curve.add_event(register.canonical(p))
        for line in _common_lines(scene, curve):
            for p in intersect(curve.polynomial, line, region.strip):
                curve.add_event(register.canonical(p))
    special = _rational_points(scene, region, register)
    for curve in curves:
        for p in special:
            if _vanishes(curve.polynomial, p):
                curve.add_event(p)
    known = {p.number.key: p for p in special}
    meetings = itertools.chain(
        _meetings(scene, region, curves, known), _wall_events(scene, region, curves, known)
    )
    for p in meetings:
        place = register.canonical(p)
        for curve in curves:
            if place.number.key not in curve.events and place.sign(curve.polynomial) == 0:
                curve.add_event(place)


def _common_lines(scene: Scene, curve: Component) -> list[Polynomial]:
    """The lines that carry both segments of one of the curve's ties: both angles are 0 or π there.

    (Where the two lines differ, the curve meets them in endpoints and in their common point only.)
    """
    return [
        scene.line[i]
        for i, j, _ in curve.ties
        if _normal_form(scene.line[i].mpoly) == _normal_form(scene.line[j].mpoly)
    ]


def _rational_points(scene: Scene, region: Region, register: Register) -> list[Point]:
    """Endpoints and meeting points of lines in the closed domain, and the domain's corners."""
    candidates = [scene.sheared(point) for segment in scene.segments for point in segment]
    for a, b in itertools.combinations(scene.line, 2):
        meeting = _meeting_of_lines(a, b)
        if meeting is not None:
            candidates.append(meeting)
    inside = [p for p in candidates if region.side(p) >= 0]
    places = [register.canonical(p) for p in [*region.corners, *inside]]
    return list({p.number.key: p for p in places}.values())


def _meeting_of_lines(a: Polynomial, b: Polynomial) -> Point | None:
    """The common point of two lines; None if they are parallel or equal."""
    (a0, a1, a2), (b0, b1, b2) = _coefficients(a), _coefficients(b)
    determinant = a1 * b2 - a2 * b1
    if determinant == 0:
        return None
    return Point.rational((a2 * b0 - a0 * b2) / determinant, (a0 * b1 - a1 * b0) / determinant)


def _coefficients(line: Polynomial) -> tuple[fmpq, fmpq, fmpq]:
    """(c, a, b) of c + a·u + b·v."""
    terms = {tuple(int(e) for e in m): fmpq(int(c)) for m, c in line.mpoly.to_dict().items()}
    return terms.get((0, 0), fmpq(0)), terms.get((1, 0), fmpq(0)), terms.get((0, 1), fmpq(0))


def _vanishes(polynomial: Polynomial, p: Point) -> bool:
    """Whether the polynomial is zero at a rational point."""
    u, v = p.coordinates
    value = fmpq(0)
    for row in reversed(polynomial.rows):
        value = value * v + row(u)
    return bool(value == 0)


def _is_among(known: dict[Key, Point], p: Point) -> bool:
    """Whether p is one of the known points (and does not merely share u with one)."""
    return p.number.key in known and known[p.number.key].is_same_place(p)


def _meetings(
    scene: Scene, region: Region, curves: list[Component], known: dict[Key, Point]
) -> Iterator[Point]:
    """The points where two components with a common segment meet and their tie is the best."""
    for (f, g), shared in _related(scene, curves).items():

        def plausible(u: arb, v: arb, shared: frozenset[int] = frozenset(shared)) -> bool:
            return not region.surely_outside(u, v) and any(scene.may_win(i, u, v) for i in shared)

        for p in intersect(f.polynomial, g.polynomial, region.strip, plausible):
            if _is_among(known, p) or region.side(p) < 0:
                continue
            if len(scene.winners(p)) > 1:
                yield p


def _related(scene: Scene, curves: list[Component]) -> dict[tuple[Component, Component], set[int]]:
    """The pairs of components to be intersected, with the segments whose tie may be there.

    In symmetric input one component is a bisector of several pairs of segments, so one pair of
    components can be where several triples tie: another one may win at each of their points.
    """
    by_pair: dict[tuple[int, int], list[tuple[int, Component]]] = defaultdict(list)
    for curve in curves:
        for i, j, sign in curve.ties:
            by_pair[i, j].append((sign, curve))
    rank = {curve: k for k, curve in enumerate(curves)}
    found: dict[tuple[Component, Component], set[int]] = defaultdict(set)

    def relate(f: Component, g: Component, segment: int) -> None:
        if f is not g:
            found[(f, g) if rank[f] < rank[g] else (g, f)].add(segment)

    for (i, _), related in by_pair.items():
        for (sign, f), (other, g) in itertools.combinations(related, 2):
            if sign == other:
                relate(f, g, i)
    for i, j, k in itertools.combinations(range(scene.n), 3):
        for (_, f), (_, g) in itertools.product(by_pair[i, j], by_pair[i, k]):
            relate(f, g, i)
    return found


def _wall_events(
    scene: Scene, region: Region, curves: list[Component], known: dict[Key, Point]
) -> Iterator[Point]:
    """The points of the domain's boundary at which a component's tie is the best of all."""
    for (k, wall), curve in itertools.product(enumerate(region.walls), curves):
        if _normal_form(wall.mpoly) == _normal_form(curve.polynomial.mpoly):
            continue

        def plausible(u: arb, v: arb, curve: Component = curve) -> bool:
            return any(scene.may_win(i, u, v) for i, _, _ in curve.ties)

        for p in intersect(curve.polynomial, wall, region.strip, plausible):
            if _is_among(known, p) or not region.wall_contains(k, p):
                continue
            winners = scene.winners(p)
            if any(i in winners and j in winners for i, j, _ in curve.ties):
                yield p
