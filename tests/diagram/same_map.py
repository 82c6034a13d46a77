"""Whether two planar maps are one: an isomorphism that keeps labels, places and incidences.

Two builders number their objects, direct their edges and start their walks as they like, and give
places as doubles, so that nearly degenerate input has many nodes at one double.  Objects are
therefore matched by *colour refinement*: every node, side and cell is coloured by what can be
said of it alone, and then again and again by the colours of what it touches, in both maps with
the same colours.  Where several objects share a colour to the end (say, two nodes of the same
three segments within one ulp) one is told apart and the refinement goes on, with backtracking.
What comes out is a candidate only; :func:`_verify` compares the maps under it object by object.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.cluster.hierarchy import DisjointSet
from scipy.spatial import KDTree

from harness.diagram.planar_map import PlanarMap
from tests.diagram.map_view import CELL, NODE, SIDE, Thing, View

Colours = dict[Thing, int]
Point = tuple[float, float]

TOLERANCE = 1e-9
_SHOWN = 12


def differences(
    one: PlanarMap, other: PlanarMap, *, tolerance: float = TOLERANCE, witnesses: bool = True
) -> list[str]:
    """What tells two sane maps of one instance apart, in words; empty if nothing does.

    ``tolerance``: how far a node may be off, relatively to the size of the instance (or, outside
    it, to the distance from it).  ``witnesses``: also locate a witness of each map's cells in
    the other.  O((nodes + edges) log) unless many nodes lie within the tolerance of each other.
    """
    found = list(_different_headers(one, other))
    if found:
        return found
    frame = Frame.around(one, tolerance)
    views = View(one), View(other)
    start = _first_colours(views, frame)
    missing = _without_partner(views, start)
    if missing:
        return missing
    partner = _isomorphism(views, start)
    if partner is None:
        return _without_partner(views, _refined(views, start)) or [
            "the same objects in the same surroundings, but no way to match them all"
        ]
    found = list(_verify(views, partner, frame))
    if witnesses and not found:
        found += _cells_elsewhere(one, other, {k: partner[CELL, k][1] for k in _numbers(one)})
        back = {partner[CELL, k][1]: k for k in _numbers(one)}
        found += _cells_elsewhere(other, one, back)
    return found


def _numbers(diagram: PlanarMap) -> range:
    return range(len(diagram.cells))


def _different_headers(one: PlanarMap, other: PlanarMap) -> Iterator[str]:
    if one.instance.to_json() != other.instance.to_json():
        yield "the maps are of different instances"
    for name in ("domain", "objective", "certified"):
        if getattr(one, name) != getattr(other, name):
            yield f"{name}: {getattr(one, name)} against {getattr(other, name)}"
    if one.corners is None or other.corners is None:
        if one.corners is not other.corners:
            yield "only one of the maps has corners"
    elif not np.array_equal(one.corners, other.corners):
        yield f"corners: {one.corners} against {other.corners}"


# --- places --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Frame:
    """Centre, size and resolution of an instance: what it means for two doubles to be near."""

    centre: tuple[float, float]
    size: float
    tolerance: float

    @classmethod
    def around(cls, diagram: PlanarMap, tolerance: float) -> Frame:
        points = diagram.instance.segments.reshape(-1, 2)
        low, high = points.min(axis=0), points.max(axis=0)
        size = float(np.hypot(*(high - low)))
        ulp = float(np.spacing(np.abs(points).max()))
        centre = tuple((0.5 * low + 0.5 * high).tolist())
        return cls(centre, size, tolerance + 4 * ulp / size)

    def near(self, p: Point, q: Point) -> bool:
        away = np.hypot(p[0] - self.centre[0], p[1] - self.centre[1])
        apart = np.hypot(p[0] - q[0], p[1] - q[1])
        return bool(apart <= self.tolerance * (self.size + away))

    def clusters(self, points: Sequence[Point]) -> list[int]:
        """A number for every point; near points, and those linked by near ones, have the same.

        The plane is drawn together into a disc first, so that far points are near more easily.
        """
        if not points:
            return []
        relative = (np.asarray(points, dtype=float) - self.centre) / self.size
        disc = relative / (1.0 + np.hypot(relative[:, :1], relative[:, 1:]))
        linked = DisjointSet(range(len(points)))
        for i, j in KDTree(disc).query_pairs(4 * self.tolerance):
            linked.merge(i, j)
        return [int(linked[k]) for k in range(len(points))]


Views = tuple[View, View]
Pair = tuple[Colours, Colours]


# --- colours -------------------------------------------------------------------------------------


def _named(pair: tuple[dict[Thing, Hashable], dict[Thing, Hashable]]) -> Pair:
    """Small numbers in place of descriptions, the same in both maps."""
    numbers: dict[Hashable, int] = {}
    one, other = (
        {thing: numbers.setdefault(text, len(numbers)) for thing, text in part.items()}
        for part in pair
    )
    return one, other


def _first_colours(views: Views, frame: Frame) -> Pair:
    """What can be said of every object without the others."""
    nodes = [node for view in views for node in view.diagram.nodes]
    finite = frame.clusters([node.point for node in nodes if node.kind != "infinity"])
    unit = Frame((0.0, 0.0), 1.0, frame.tolerance)
    infinite = unit.clusters([node.point for node in nodes if node.kind == "infinity"])
    walls = [wall for view in views for wall in view.diagram.walls]
    ends = iter(frame.clusters([end for wall in walls for end in wall.ends]))
    sources = {False: iter(finite), True: iter(infinite)}
    parts: list[dict[Thing, Hashable]] = []
    for view in views:
        part: dict[Thing, Hashable] = {}
        for k, node in enumerate(view.diagram.nodes):
            place = next(sources[node.kind == "infinity"])
            which = _nearest_endpoint(view.diagram, node.point) if node.endpoint else None
            part[NODE, k] = (node.kind, node.degree, node.segments, which, place)
        for k, side in enumerate(view.sides):
            if side.is_wall:
                part[SIDE, k] = ("wall", next(ends), next(ends))
            else:
                edge = view.diagram.edges[side.item]
                pair = edge.segments if side.forward else edge.segments[::-1]
                part[SIDE, k] = ("edge", pair, edge.is_loop)
        for k, cell in enumerate(view.diagram.cells):
            lengths = tuple(sorted(map(len, cell.holes)))
            outer = None if cell.outer is None else len(cell.outer)
            part[CELL, k] = (cell.segment, cell.bounded, outer, lengths)
        parts.append(part)
    return _named((parts[0], parts[1]))


def _nearest_endpoint(diagram: PlanarMap, point: Point) -> Point:
    """The endpoint of a segment that is nearest to a node at one."""
    ends = diagram.instance.segments.reshape(-1, 2)
    x, y = ends[np.hypot(*(ends - point).T).argmin()].tolist()
    return x, y


def _recoloured(view: View, colours: Colours) -> dict[Thing, Hashable]:
    """Every object by its colour and the colours of what it touches."""
    result: dict[Thing, Hashable] = {}
    for k, leaving in enumerate(view.leaving):
        result[NODE, k] = (colours[NODE, k], *sorted(colours[SIDE, s] for s in leaving))
    for k, side in enumerate(view.sides):
        is_outer, before, after = view.place_on_walk[k]
        nodes = (-1 if node is None else colours[NODE, node] for node in view.ends(side))
        near = (colours[SIDE, s] for s in (k, view.twin(side), before, after))
        result[SIDE, k] = (is_outer, *near, *nodes, colours[CELL, view.cell(side)])
    for k in range(len(view.diagram.cells)):
        walks = [(o, tuple(sorted(colours[SIDE, s] for s in walk))) for o, walk in view.walks(k)]
        result[CELL, k] = (colours[CELL, k], *sorted(walks))
    return result


def _refined(views: Views, colours: Pair) -> Pair:
    """Recolour until no colour splits any more, or the maps differ."""
    while True:
        one, other = zip(views, colours, strict=True)
        finer = _named((_recoloured(*one), _recoloured(*other)))
        if len(set(finer[0].values())) == len(set(colours[0].values())):
            return finer
        colours = finer
        if Counter(colours[0].values()) != Counter(colours[1].values()):
            return colours


def _without_partner(views: Views, colours: Pair) -> list[str]:
    """The objects of either map of whose colour the other has fewer."""
    amounts = [Counter(part.values()) for part in colours]
    found: list[str] = []
    for view, part, mine, others in zip(views, colours, amounts, amounts[::-1], strict=True):
        rest = {thing for thing, colour in part.items() if mine[colour] > others[colour]}
        listed = [f"only {view.diagram.builder}: {view.describe(thing)}" for thing in sorted(rest)]
        found += listed[:_SHOWN]
        if len(listed) > _SHOWN:
            found.append(f"only {view.diagram.builder}: {len(listed) - _SHOWN} more")
    return found


def _isomorphism(views: Views, colours: Pair) -> dict[Thing, Thing] | None:
    """A partner in the second map for everything in the first, by refinement and trial."""
    colours = _refined(views, colours)
    if Counter(colours[0].values()) != Counter(colours[1].values()):
        return None
    members: dict[int, tuple[list[Thing], list[Thing]]] = {}
    for which, part in enumerate(colours):
        for thing, colour in part.items():
            members.setdefault(colour, ([], []))[which].append(thing)
    ambiguous = [pair for pair in members.values() if len(pair[0]) > 1]
    if not ambiguous:
        return {pair[0][0]: pair[1][0] for pair in members.values()}
    ones, others = min(ambiguous, key=lambda pair: (len(pair[0]), pair[0]))
    new = len(members)
    for candidate in others:
        told_apart = {**colours[0], ones[0]: new}, {**colours[1], candidate: new}
        found = _isomorphism(views, told_apart)
        if found is not None:
            return found
    return None


# --- the proof -----------------------------------------------------------------------------------


def _turned(walk: Iterable[int]) -> tuple[int, ...]:
    """A cyclic sequence without repetitions, from its least item on."""
    items = list(walk)
    start = items.index(min(items))
    return tuple(items[start:] + items[:start])


def _verify(views: Views, partner: dict[Thing, Thing], frame: Frame) -> Iterator[str]:
    """Whatever contradicts that ``partner`` is an isomorphism."""
    one, other = views
    if sorted(partner) != sorted(one.things()) or sorted(partner.values()) != sorted(
        other.things()
    ):
        yield "the matching leaves objects out"
        return
    nodes: dict[int | None, int | None] = {None: None}
    nodes |= {k: m for (kind, k), (_, m) in partner.items() if kind == NODE}
    sides = {k: m for (kind, k), (_, m) in partner.items() if kind == SIDE}
    cells = {k: m for (kind, k), (_, m) in partner.items() if kind == CELL}
    unit = Frame((0.0, 0.0), 1.0, frame.tolerance)
    for k, node in enumerate(one.diagram.nodes):
        number = partner[NODE, k][1]
        twin = other.diagram.nodes[number]
        names = ("kind", "segments", "degree", "endpoint")
        same = all(getattr(node, name) == getattr(twin, name) for name in names)
        near = (unit if node.kind == "infinity" else frame).near(node.point, twin.point)
        if not (same and near):
            yield f"{one.describe((NODE, k))} against {other.describe((NODE, number))}"
    for k, side in enumerate(one.sides):
        image = other.sides[sides[k]]
        ends = tuple(nodes[node] for node in one.ends(side))
        if (
            side.is_wall != image.is_wall
            or ends != other.ends(image)
            or cells[one.cell(side)] != other.cell(image)
            or sides[one.twin(side)] != other.twin(image)
        ):
            yield f"{one.describe((SIDE, k))} against {other.describe((SIDE, sides[k]))}"
    for k, cell in enumerate(one.diagram.cells):
        likeness = other.diagram.cells[cells[k]]
        walks = sorted((o, _turned(sides[s] for s in walk)) for o, walk in one.walks(k))
        images = sorted((o, _turned(walk)) for o, walk in other.walks(cells[k]))
        if (cell.segment, cell.bounded, walks) != (likeness.segment, likeness.bounded, images):
            yield f"{one.describe((CELL, k))} against {other.describe((CELL, cells[k]))}"


def _cells_elsewhere(one: PlanarMap, other: PlanarMap, cells: dict[int, int]) -> list[str]:
    """The cells of one map with a witness point that the other locates in no partner of theirs."""
    point_in = {cell: point for point, cell in one.witnesses}
    found = other.locate(list(point_in.values()))
    return [
        f"{one.builder} has ({float(x):g}, {float(y):g}) in cell {cell}, {other.builder} in {place}"
        for (cell, (x, y)), place in zip(point_in.items(), found, strict=True)
        if place is not None and place != cells.get(cell, -1)
    ][:_SHOWN]
