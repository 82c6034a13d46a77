"""The comparison of maps: blind to numbering, direction and start, and to nothing else."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.counts import DOMAINS, OBJECTIVES
from harness.diagram.planar_map import PlanarMap, Side, Walk
from harness.geometry.instance import Instance
from tests import strategies
from tests.diagram.same_map import differences
from tests.diagram.support import SQUARE, instance_of, polygon, segments

NEARLY = 2.0**-52


def scrambled(diagram: PlanarMap, seed: int) -> PlanarMap:
    """The same map with everything numbered, directed and started otherwise."""
    rng = random.Random(seed)

    def shuffle(items: tuple[Any, ...]) -> tuple[list[int], dict[Any, Any]]:
        order = list(range(len(items)))
        rng.shuffle(order)
        places: dict[Any, Any] = {None: None}
        return order, places | {old: new for new, old in enumerate(order)}

    nodes, node_at = shuffle(diagram.nodes)
    edges, edge_at = shuffle(diagram.edges)
    walls, wall_at = shuffle(diagram.walls)
    cells, cell_at = shuffle(diagram.cells)
    reversed_ = [rng.random() < 0.5 for _ in diagram.edges]

    def turned(edge: Any, back: bool) -> Any:
        edge = replace(
            edge,
            start=node_at[edge.start],
            end=node_at[edge.end],
            left=cell_at[edge.left],
            right=cell_at[edge.right],
        )
        if not back:
            return edge
        return replace(
            edge,
            segments=edge.segments[::-1],
            start=edge.end,
            end=edge.start,
            left=edge.right,
            right=edge.left,
        )

    def walked(walk: Walk) -> Walk:
        sides = [
            side._replace(item=wall_at[side.item])
            if side.is_wall
            else Side(edge_at[side.item], side.forward != reversed_[side.item])
            for side in walk
        ]
        start = rng.randrange(len(sides))
        return (*sides[start:], *sides[:start])

    def moved(cell: Any) -> Any:
        holes = [walked(hole) for hole in cell.holes]
        rng.shuffle(holes)
        outer = None if cell.outer is None else walked(cell.outer)
        return replace(cell, outer=outer, holes=tuple(holes))

    to_new = {-1: -1} | cell_at
    return replace(
        diagram,
        nodes=tuple(diagram.nodes[k] for k in nodes),
        edges=tuple(turned(diagram.edges[k], reversed_[k]) for k in edges),
        walls=tuple(
            replace(
                diagram.walls[k],
                nodes=(node_at[diagram.walls[k].nodes[0]], node_at[diagram.walls[k].nodes[1]]),
                cell=cell_at[diagram.walls[k].cell],
            )
            for k in walls
        ),
        cells=tuple(moved(diagram.cells[k]) for k in cells),
        witnesses=tuple((point, to_new[cell]) for point, cell in diagram.witnesses),
        locator=lambda point: to_new[diagram.locator(point)],
    )


@settings(max_examples=80)
@given(
    strategies.instances(max_segments=4, max_vertices=6),
    st.sampled_from(OBJECTIVES),
    st.sampled_from(DOMAINS),
    st.integers(0, 2**32),
)
def test_a_map_is_itself_however_it_is_numbered(
    plain: Any, objective: Any, domain: Any, seed: int
) -> None:
    instance = instance_of(plain)
    diagram = build(instance, "plane" if plain[0] == "segments" else domain, objective)
    other = scrambled(diagram, seed)
    other.sanity_check()
    assert differences(diagram, other) == []
    assert differences(other, diagram) == []


def near_square() -> Instance:
    """Two triple points within an ulp of each other, where a square has one vertex of degree 4."""
    return polygon((0, 0), (4, 0), (4, 4 + 4 * NEARLY), (0, 4))


@pytest.mark.parametrize("seed", range(8))
def test_nodes_at_one_double_are_matched_by_what_they_touch(seed: int) -> None:
    diagram = build(near_square(), "plane")
    points = [node.point for node in diagram.nodes]
    assert any(
        p != q and abs(p[0] - q[0]) + abs(p[1] - q[1]) < 1e-12 for p in points for q in points
    )
    # Places that say nothing at all: what the nodes touch must do.
    blind = replace(diagram, nodes=tuple(replace(node, point=(0.0, 0.0)) for node in diagram.nodes))
    assert differences(blind, scrambled(blind, seed), witnesses=False) == []


# --- planted differences -------------------------------------------------------------------------


@pytest.fixture(scope="module")
def plane() -> PlanarMap:
    return build(segments(((0, 0), (4, 1)), ((7, 1), (6, 5)), ((1, 6), (3, 9)), ((-3, 2), (-4, 5))))


@pytest.fixture(scope="module")
def kernel() -> PlanarMap:
    return build(polygon((6, 1), (5, 4), (1, 5), (-4, 6), (-6, 0), (-3, -5), (3, -4)))


def changed(items: tuple[Any, ...], index: int, **changes: Any) -> tuple[Any, ...]:
    return (*items[:index], replace(items[index], **changes), *items[index + 1 :])


def triples(d: PlanarMap) -> list[int]:
    return [k for k, node in enumerate(d.nodes) if node.kind == "triple"]


def exchange_ends(d: PlanarMap) -> PlanarMap:
    """An edge ends where another one starts, which starts where it ended; all else stays."""
    e, edge = next((k, edge) for k, edge in enumerate(d.edges) if edge.end in triples(d))
    f, other = next((k, o) for k, o in enumerate(d.edges) if o.start not in (edge.end, edge.start))
    edges = changed(d.edges, e, end=other.start)
    return replace(d, edges=changed(edges, f, start=edge.end))


def exchange_places(d: PlanarMap) -> PlanarMap:
    """Two nodes exchange their places."""
    i, j = triples(d)[:2]
    nodes = changed(d.nodes, i, point=d.nodes[j].point)
    return replace(d, nodes=changed(nodes, j, point=d.nodes[i].point))


def exchange_cells(d: PlanarMap) -> PlanarMap:
    """An edge is said to border another cell of the same segment."""
    for k, edge in enumerate(d.edges):
        for c, cell in enumerate(d.cells):
            if c != edge.left and cell.segment == edge.segments[0]:
                return replace(d, edges=changed(d.edges, k, left=c))
    raise AssertionError


def shift_a_node(d: PlanarMap) -> PlanarMap:
    k = triples(d)[0]
    x, y = d.nodes[k].point
    return replace(d, nodes=changed(d.nodes, k, point=(x * (1 + 1e-6), y)))


def change_a_degree(d: PlanarMap) -> PlanarMap:
    k = triples(d)[0]
    return replace(d, nodes=changed(d.nodes, k, degree=d.nodes[k].degree + 1))


def add_a_segment_to_a_node(d: PlanarMap) -> PlanarMap:
    k = triples(d)[0]
    every = tuple(range(d.instance.n))
    return replace(d, nodes=changed(d.nodes, k, segments=every))


def deny_an_endpoint(d: PlanarMap) -> PlanarMap:
    k = next(k for k, node in enumerate(d.nodes) if node.endpoint)
    return replace(d, nodes=changed(d.nodes, k, endpoint=False))


def drop_a_vertex(d: PlanarMap) -> PlanarMap:
    """A vertex without its edges."""
    k = triples(d)[0]
    lost = {e for e, edge in enumerate(d.edges) if k in (edge.start, edge.end)}
    number = {old: new for new, old in enumerate(e for e in range(len(d.edges)) if e not in lost)}

    def rest(walk: Walk) -> Walk:
        return tuple(
            side if side.is_wall else side._replace(item=number[side.item])
            for side in walk
            if side.is_wall or side.item in number
        )

    def down(node: int | None) -> int | None:
        return node if node is None or node < k else node - 1

    edges = (
        replace(edge, start=down(edge.start), end=down(edge.end))
        for e, edge in enumerate(d.edges)
        if e not in lost
    )
    walls = (replace(w, nodes=(down(w.nodes[0]), down(w.nodes[1]))) for w in d.walls)
    cells = (
        replace(
            cell,
            outer=None if cell.outer is None else rest(cell.outer),
            holes=tuple(rest(hole) for hole in cell.holes),
        )
        for cell in d.cells
    )
    return replace(
        d,
        nodes=(*d.nodes[:k], *d.nodes[k + 1 :]),
        edges=tuple(edges),
        walls=tuple(walls),
        cells=tuple(cells),
    )


def merge_two_cells(d: PlanarMap) -> PlanarMap:
    """Two cells of one segment become one with both walks."""
    owners = [cell.segment for cell in d.cells]
    b = next(k for k, owner in enumerate(owners) if owner in owners[:k])
    a = owners.index(owners[b])
    new = {k: (a if k == b else k) - (k > b) for k in range(len(owners))}
    cells = list(d.cells)
    cells[a] = replace(cells[a], holes=(*cells[a].holes, *cells[b].walks))
    del cells[b]
    return replace(
        d,
        edges=tuple(replace(e, left=new[e.left], right=new[e.right]) for e in d.edges),
        cells=tuple(cells),
        walls=tuple(replace(w, cell=new[w.cell]) for w in d.walls),
        witnesses=tuple((p, new.get(c, c)) for p, c in d.witnesses),
    )


def mirror_a_walk(d: PlanarMap) -> PlanarMap:
    """One cell is walked around the other way."""
    k = next(k for k, cell in enumerate(d.cells) if cell.outer is not None and len(cell.outer) > 2)
    walk = d.cells[k].outer
    assert walk is not None
    return replace(d, cells=changed(d.cells, k, outer=walk[::-1]))


def swap_sides(d: PlanarMap) -> PlanarMap:
    edge = d.edges[0]
    swapped = {"left": edge.right, "right": edge.left, "segments": edge.segments[::-1]}
    return replace(d, edges=changed(d.edges, 0, **swapped))


def open_a_cell(d: PlanarMap) -> PlanarMap:
    k = next(k for k, cell in enumerate(d.cells) if cell.bounded)
    return replace(d, cells=changed(d.cells, k, bounded=False))


def doubt(d: PlanarMap) -> PlanarMap:
    return replace(d, certified=False)


def locate_elsewhere(d: PlanarMap) -> PlanarMap:
    return replace(d, locator=lambda point: 0)


EVERYWHERE: list[Callable[[PlanarMap], PlanarMap]] = [
    exchange_ends,
    exchange_places,
    shift_a_node,
    change_a_degree,
    add_a_segment_to_a_node,
    drop_a_vertex,
    mirror_a_walk,
    swap_sides,
    open_a_cell,
    doubt,
    locate_elsewhere,
]
IN_THE_PLANE = [exchange_cells, merge_two_cells, deny_an_endpoint]
PLANTED = [("kernel", fault) for fault in EVERYWHERE]
PLANTED += [("plane", fault) for fault in (*EVERYWHERE, *IN_THE_PLANE)]


@pytest.mark.parametrize(("name", "fault"), PLANTED, ids=lambda x: getattr(x, "__name__", x))
def test_planted_differences_are_found(
    name: str, fault: Callable[[PlanarMap], PlanarMap], request: pytest.FixtureRequest
) -> None:
    diagram: PlanarMap = request.getfixturevalue(name)
    other = fault(scrambled(diagram, 7))
    assert differences(diagram, other) != []
    assert differences(other, diagram) != []


def test_the_mirror_image_is_another_map() -> None:
    """Mirrored, a symmetric polygon has the same nodes and degrees, but not the same walks."""
    square = build(polygon(*SQUARE), "interior")

    def back(walk: Walk) -> Walk:
        return tuple(s if s.is_wall else Side(s.item, not s.forward) for s in walk[::-1])

    mirrored = replace(
        square,
        edges=tuple(
            replace(e, left=e.right, right=e.left, segments=e.segments[::-1]) for e in square.edges
        ),
        cells=tuple(
            replace(c, outer=None if c.outer is None else back(c.outer)) for c in square.cells
        ),
    )
    assert differences(square, mirrored) != []


def test_nearly_equal_instances_differ() -> None:
    exact, near = build(polygon(*SQUARE)), build(near_square())
    assert differences(exact, near)[0] == "the maps are of different instances"
    posing = replace(near, instance=exact.instance, corners=exact.corners)
    assert any("degree 4" in line for line in differences(exact, posing))


def test_messages_name_the_objects(kernel: PlanarMap) -> None:
    k = triples(kernel)[0]
    found = differences(kernel, change_a_degree(kernel))
    assert any(f"only {kernel.counts.builder}: node {k}: triple" in line for line in found)
