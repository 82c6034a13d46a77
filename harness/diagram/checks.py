"""What every angular Voronoi diagram satisfies, checked object by object.

The checks need nothing of the builder but the finished map.  The winners at the map's witness
points are found anew from the input with rational arithmetic of another room, so an error of the
builder's own algebra shows as well.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from harness.diagram.planar_map import VERTEX_KINDS, Cell, Node, PlanarMap, RationalPoint, Side
from harness.geometry.coordinates import Floats
from harness.geometry.predicates import compare_visual_angles

_UNIT = 2.0**-53
#: So many contests are decided at once.
_AT_ONCE = 1 << 17


class InsaneMap(ArithmeticError):
    """A planar map contradicts itself or its instance; the message names the object."""


def check(diagram: PlanarMap) -> None:
    """Run every check; O(edges + witnesses · n).

    Raises:
        InsaneMap: for the first object found wrong.
    """
    for test in CHECKS:
        test(diagram)


def _require(condition: bool, message: str) -> None:
    if not condition:
        raise InsaneMap(message)


def counts_are_those_of_the_objects(diagram: PlanarMap) -> None:
    """Counts that a builder made in another way are those of the finished map."""
    if diagram.tally is None:
        return
    again = diagram.recounted().as_dict()
    for name, value in diagram.tally.as_dict().items():
        _require(value == again[name], f"the tally says {name}: {value}, the objects {again[name]}")


def degrees_are_edge_ends(diagram: PlanarMap) -> None:
    """Every node's degree is the number of edge ends at it; so their sum is 2E without loops."""
    ends: Counter[int] = Counter()
    for k, edge in enumerate(diagram.edges):
        _require((edge.start is None) == (edge.end is None), f"edge {k} has only one end")
        ends.update(node for node in (edge.start, edge.end) if node is not None)
    for k, node in enumerate(diagram.nodes):
        _require(
            ends[k] == node.degree, f"node {k} claims degree {node.degree}, {ends[k]} edges end"
        )


def kinds_are_deserved(diagram: PlanarMap) -> None:
    """A node's degree and segments allow its kind; only kinds of this domain occur."""
    for k, node in enumerate(diagram.nodes):
        _require(_kind_fits(diagram, node), f"node {k} is no {node.kind} node: {node}")


def _kind_fits(diagram: PlanarMap, node: Node) -> bool:
    in_plane = diagram.domain == "plane"
    rules: dict[str, bool] = {
        "triple": node.degree >= 3 and len(node.segments) >= 3,
        "crossing": node.degree >= 3 and len(node.segments) >= 2,
        "saddle": node.degree >= 4 and len(node.segments) == 2,
        "endpoint": 1 <= node.degree <= 2 and node.endpoint and in_plane,
        "boundary": node.degree >= 1 and not in_plane,
        "infinity": node.degree == 1 and in_plane,
    }
    return rules[node.kind]


def edges_separate_their_cells(diagram: PlanarMap) -> None:
    """The cells on the two sides of an edge belong to its two segments, and these differ."""
    for k, edge in enumerate(diagram.edges):
        owners = (diagram.cells[edge.left].segment, diagram.cells[edge.right].segment)
        _require(owners == edge.segments, f"edge {k} of {edge.segments} lies between {owners}")
        _require(owners[0] != owners[1], f"edge {k} has segment {owners[0]} on both sides")


def walks_close_and_cover(diagram: PlanarMap) -> None:
    """Boundary walks are closed, keep their cell to the left, and use every side once."""
    seen: Counter[Side] = Counter()
    for c, cell in enumerate(diagram.cells):
        for walk in cell.walks:
            _require(len(walk) > 0, f"cell {c} has an empty boundary walk")
            for side, following in zip(walk, (*walk[1:], walk[0]), strict=True):
                seen[side] += 1
                _require(_left_cell(diagram, side) == c, f"{side} of cell {c} borders another cell")
                _require(
                    _continues(diagram, side, following),
                    f"in the boundary of cell {c}, {following} does not continue {side}",
                )
    for k in range(len(diagram.edges)):
        for forward in (True, False):
            count = seen[Side(k, forward)]
            _require(count == 1, f"edge {k} appears {count} times in the walks to one of its sides")
    for k in range(len(diagram.walls)):
        count = seen[Side(k, True, is_wall=True)]
        _require(count == 1, f"wall {k} appears {count} times in boundary walks")


def _left_cell(diagram: PlanarMap, side: Side) -> int | None:
    if side.is_wall:
        return diagram.walls[side.item].cell if side.forward else None
    edge = diagram.edges[side.item]
    return edge.left if side.forward else edge.right


def _continues(diagram: PlanarMap, side: Side, following: Side) -> bool:
    """Whether the walk may go from one side to the next: same node, or both at infinity."""
    here, there = _terminal(diagram, side, last=True), _terminal(diagram, following, last=False)
    if here is None and there is None:
        # A loop closes on itself; two walls meet at a plain corner.
        return side == following or (side.is_wall and following.is_wall)
    if here is None or there is None:
        return False
    nodes = diagram.nodes
    return here == there or nodes[here].kind == nodes[there].kind == "infinity"


def _terminal(diagram: PlanarMap, side: Side, last: bool) -> int | None:
    if side.is_wall:
        return diagram.walls[side.item].nodes[1 if last else 0]
    edge = diagram.edges[side.item]
    return edge.end if side.forward == last else edge.start


def cells_have_outer_boundaries(diagram: PlanarMap) -> None:
    """A bounded cell has an outer boundary without infinite ends; no cell of a polygon is open."""
    for c, cell in enumerate(diagram.cells):
        if cell.bounded:
            _require(cell.outer is not None, f"bounded cell {c} has no outer boundary")
        else:
            _require(diagram.domain == "plane", f"cell {c} of a bounded domain is unbounded")
        _require(
            cell.outer is None or _touches_infinity(diagram, cell) != cell.bounded,
            f"cell {c} is {'bounded' if cell.bounded else 'unbounded'} against its outer boundary",
        )


def _touches_infinity(diagram: PlanarMap, cell: Cell) -> bool:
    return any(
        (node := _terminal(diagram, side, last=last)) is not None
        and diagram.nodes[node].kind == "infinity"
        for side in cell.outer or ()
        for last in (True, False)
    )


def euler_holds(diagram: PlanarMap) -> None:
    """cells = E − N + 1 + components, all loops aside in E (see the README for the bookkeeping).

    N counts all nodes but the infinite ends, and one point at infinity if there are any.  In a
    bounded domain its boundary contributes as many nodes as arcs, and the outside is no cell:
    cells = E − N + components, N without the boundary's nodes.
    """
    counts = diagram.counts
    inner = sum(node.kind not in ("boundary", "infinity") for node in diagram.nodes)
    plain = counts.edges - counts.loops
    if diagram.domain == "plane":
        at_infinity = any(node.kind == "infinity" for node in diagram.nodes)
        expected = plain - inner - at_infinity + 1 + counts.components
    else:
        expected = plain - inner + counts.components
    _require(
        counts.cells == expected,
        f"Euler's identity fails: {counts.cells} cells, expected {expected}",
    )


def boundary_splits_into_components(diagram: PlanarMap) -> None:
    """A planar map with C components has C − 1 holes in all (Euler's formula, face by face)."""
    holes = sum(len(cell.holes) for cell in diagram.cells)
    no_outer = sum(cell.outer is None for cell in diagram.cells)
    expected = diagram.counts.components - (0 if no_outer else 1)
    _require(holes == expected, f"{holes} holes, but {expected} expected from the components")


def witnesses_are_won(diagram: PlanarMap) -> None:
    """At every witness point the segment of its cell is the winner; every cell has a witness."""
    inside = [(point, c) for point, c in diagram.witnesses if c >= 0]
    exact = diagram.instance.rational_segments()
    sense = 1 if diagram.objective == "smallest" else -1
    owners = [cell.segment for cell in diagram.cells]
    for row, k in _open_contests(diagram, [p for p, _ in inside], [owners[c] for _, c in inside]):
        point, c = inside[row]
        order = compare_visual_angles(point, exact[owners[c]], exact[k])
        _require(
            order is not None and order * sense <= 0,
            f"segment {k} beats segment {owners[c]} at a witness of the latter's cell {c}",
        )
    unseen = set(range(len(diagram.cells))) - {c for _, c in inside}
    _require(not unseen, f"cells {sorted(unseen)} have no witness")


def _open_contests(
    diagram: PlanarMap, points: list[RationalPoint], owners: list[int]
) -> Iterator[tuple[int, int]]:
    """(r, k) for all points r and segments k of which doubles do not tell that owner r beats k.

    The bound: with coordinates exact or rounded once, a difference of two is off by u|d| + e, where
    e = 4u times the greatest of both (0 if all are doubles).  So Q and L, sums of two products, are
    off by 5u Σ|products| + e Σ|factors| + 2e²; the rest is that of
    :func:`harness.geometry.predicates.filter_visual_angles`.  Without underflow, that is; where
    numbers may be so small, everything is left open.
    """
    segments = diagram.instance.segments
    at = np.array([[float(x), float(y)] for x, y in points]).reshape(-1, 2)
    rounded = np.array(
        [(Fraction(x), Fraction(y)) != p for (x, y), p in zip(at, points, strict=True)]
    )
    if diagram.instance.exact is not None:
        rounded[:] = True
    largest = float(np.abs(segments).max())
    sense = 1 if diagram.objective == "smallest" else -1
    rows = max(1, _AT_ONCE // len(segments))
    for low in range(0, len(points), rows):
        p = at[low : low + rows, None]
        size = np.maximum(np.abs(p).max(axis=2), largest)
        error = np.where(rounded[low : low + rows, None], 4 * _UNIT * size, 0.0)
        mine = np.array(owners[low : low + rows])
        won = np.zeros((len(p), len(segments)), dtype=bool)
        if largest > 1e-60 and size.max() < 1e60:
            theirs = _forms(p, segments[None], error)
            own = _forms(p, segments[mine][:, None], error)
            won = _certainly_less(own, theirs, sense)
        won[np.arange(len(p)), mine] = True
        yield from ((low + int(r), int(k)) for r, k in np.argwhere(~won))


Forms = tuple[Floats, Floats, Floats, Floats]


def _forms(p: Floats, segments: Floats, e: Floats) -> Forms:
    """Q and |L| of segments (…, 2, 2) at points (…, 2), and bounds of their errors."""
    ax, ay = segments[..., 0, 0] - p[..., 0], segments[..., 0, 1] - p[..., 1]
    bx, by = segments[..., 1, 0] - p[..., 0], segments[..., 1, 1] - p[..., 1]
    reach = e * (np.abs(ax) + np.abs(ay) + np.abs(bx) + np.abs(by) + 2 * e)
    one, two, three, four = ax * bx, ay * by, ax * by, ay * bx
    q_error = 5 * _UNIT * (np.abs(one) + np.abs(two)) + reach
    line_error = 5 * _UNIT * (np.abs(three) + np.abs(four)) + reach
    return one + two, q_error, np.abs(three - four), line_error


def _certainly_less(own: Forms, theirs: Forms, sense: int) -> NDArray[np.bool_]:
    """Whether the first visual angle is certainly less (``sense`` 1) or greater (−1)."""
    (q, q_error, line, line_error), (r, r_error, other, other_error) = own, theirs
    first, second = q * other, r * line
    bound = np.abs(q) * other_error + other * q_error + q_error * other_error
    bound += np.abs(r) * line_error + line * r_error + r_error * line_error
    bound += 3 * _UNIT * (np.abs(first) + np.abs(second))
    certain: NDArray[np.bool_] = sense * (first - second) > 1.01 * bound + 1e-290
    return certain


def vertices_are_ties(diagram: PlanarMap) -> None:
    """The segments that meet at a vertex are those of the cells around it, and perhaps more."""
    around: defaultdict[int, set[int]] = defaultdict(set)
    for edge in diagram.edges:
        for end in (edge.start, edge.end):
            if end is not None:
                around[end].update(edge.segments)
    for k, node in enumerate(diagram.nodes):
        if node.kind in VERTEX_KINDS:
            _require(
                around[k] <= set(node.segments),
                f"node {k} of {node.segments} touches cells of {sorted(around[k])}",
            )


CHECKS: tuple[Callable[[PlanarMap], None], ...] = (
    degrees_are_edge_ends,
    kinds_are_deserved,
    edges_separate_their_cells,
    walks_close_and_cover,
    cells_have_outer_boundaries,
    euler_holds,
    boundary_splits_into_components,
    counts_are_those_of_the_objects,
    vertices_are_ties,
    witnesses_are_won,
)
