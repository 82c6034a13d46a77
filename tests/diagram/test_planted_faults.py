"""A wrong map must not pass: every planted fault is caught."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from harness.diagram import build
from harness.diagram.checks import InsaneMap
from harness.diagram.planar_map import PlanarMap, Side
from harness.geometry.instance import Instance
from tests.diagram.support import polygon, segments


@pytest.fixture(scope="module")
def plane() -> PlanarMap:
    return build(segments(((0, 0), (4, 1)), ((7, 1), (6, 5)), ((1, 6), (3, 9)), ((-3, 2), (-4, 5))))


@pytest.fixture(scope="module")
def kernel() -> PlanarMap:
    return build(polygon((6, 1), (5, 4), (1, 5), (-4, 6), (-6, 0), (-3, -5), (3, -4)))


def changed(items: tuple[Any, ...], index: int, **changes: Any) -> tuple[Any, ...]:
    return (*items[:index], replace(items[index], **changes), *items[index + 1 :])


def first(diagram: PlanarMap, kind: str) -> int:
    return next(k for k, node in enumerate(diagram.nodes) if node.kind == kind)


def drop_an_edge(d: PlanarMap) -> PlanarMap:
    return replace(d, edges=d.edges[:-1])


def drop_a_vertex(d: PlanarMap) -> PlanarMap:
    """The vertex becomes a boundary-less point: its edges now end nowhere."""
    k = first(d, "triple")
    edges = tuple(
        replace(e, start=None if e.start == k else e.start, end=None if e.end == k else e.end)
        for e in d.edges
    )
    return replace(d, edges=edges)


def merge_two_cells(d: PlanarMap) -> PlanarMap:
    """The two cells of one segment are said to be one."""
    owners = [cell.segment for cell in d.cells]
    b = next(k for k, owner in enumerate(owners) if owner in owners[:k])
    a = owners.index(owners[b])
    edges = tuple(
        replace(e, left=a if e.left == b else e.left, right=a if e.right == b else e.right)
        for e in d.edges
    )
    cells = list(d.cells)
    cells[a] = replace(cells[a], holes=(*cells[a].holes, *cells[b].walks))
    del cells[b]
    shift = {k: k - (k > b) for k in range(len(owners))}
    edges = tuple(replace(e, left=shift[e.left], right=shift[e.right]) for e in edges)
    walls = tuple(replace(w, cell=shift[a if w.cell == b else w.cell]) for w in d.walls)
    witnesses = tuple((p, shift[a if c == b else c] if c >= 0 else c) for p, c in d.witnesses)
    return replace(d, edges=edges, cells=tuple(cells), walls=walls, witnesses=witnesses)


def swap_sides(d: PlanarMap) -> PlanarMap:
    edge = d.edges[0]
    return replace(d, edges=changed(d.edges, 0, left=edge.right, right=edge.left))


def rename_an_edge(d: PlanarMap) -> PlanarMap:
    i, j = d.edges[0].segments
    other = next(k for k in range(d.instance.n) if k not in (i, j))
    return replace(d, edges=changed(d.edges, 0, segments=(i, other)))


def recolour_a_cell(d: PlanarMap) -> PlanarMap:
    """A consistent lie: one cell and all its edges name another segment."""
    cell = d.cells[0]
    other = (cell.segment + 2) % d.instance.n
    edges = tuple(
        replace(
            e,
            segments=(
                other if e.left == 0 else e.segments[0],
                other if e.right == 0 else e.segments[1],
            ),
        )
        for e in d.edges
    )
    nodes = tuple(replace(v, segments=tuple(sorted({*v.segments, other}))) for v in d.nodes)
    return replace(d, cells=changed(d.cells, 0, segment=other), edges=edges, nodes=nodes)


def miscount_a_degree(d: PlanarMap) -> PlanarMap:
    k = first(d, "triple")
    return replace(d, nodes=changed(d.nodes, k, degree=d.nodes[k].degree + 1))


def call_a_triple_a_saddle(d: PlanarMap) -> PlanarMap:
    return replace(d, nodes=changed(d.nodes, first(d, "triple"), kind="saddle"))


def forget_a_walk_step(d: PlanarMap) -> PlanarMap:
    k = next(k for k, cell in enumerate(d.cells) if cell.outer is not None and len(cell.outer) > 2)
    walk = d.cells[k].outer
    assert walk is not None
    return replace(d, cells=changed(d.cells, k, outer=walk[1:]))


def turn_a_walk_step(d: PlanarMap) -> PlanarMap:
    for k, cell in enumerate(d.cells):
        for position, side in enumerate(cell.outer or ()):
            if not side.is_wall:
                assert cell.outer is not None
                turned = Side(side.item, not side.forward)
                walk = (*cell.outer[:position], turned, *cell.outer[position + 1 :])
                return replace(d, cells=changed(d.cells, k, outer=walk))
    raise AssertionError


def open_a_bounded_cell(d: PlanarMap) -> PlanarMap:
    k = next(k for k, cell in enumerate(d.cells) if cell.bounded)
    return replace(d, cells=changed(d.cells, k, bounded=False))


def lose_a_witness(d: PlanarMap) -> PlanarMap:
    return replace(d, witnesses=tuple((p, c) for p, c in d.witnesses if c != 0))


def invent_a_hole(d: PlanarMap) -> PlanarMap:
    walk = d.cells[0].outer or d.cells[0].holes[0]
    return replace(d, cells=changed(d.cells, 0, holes=(*d.cells[0].holes, walk)))


def answer_for_another_instance(d: PlanarMap) -> PlanarMap:
    values = d.instance.floats.copy()
    values[0] = values[1] + (values[0] - values[1]) * 0.25
    return replace(d, instance=Instance.from_arrays(d.instance.kind, values))


FAULTS: list[Callable[[PlanarMap], PlanarMap]] = [
    drop_an_edge,
    drop_a_vertex,
    swap_sides,
    rename_an_edge,
    recolour_a_cell,
    miscount_a_degree,
    call_a_triple_a_saddle,
    forget_a_walk_step,
    turn_a_walk_step,
    open_a_bounded_cell,
    lose_a_witness,
    invent_a_hole,
    answer_for_another_instance,
]


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
@pytest.mark.parametrize("name", ["plane", "kernel"])
def test_faults_are_caught(
    fault: Callable[[PlanarMap], PlanarMap], name: str, request: pytest.FixtureRequest
) -> None:
    diagram: PlanarMap = request.getfixturevalue(name)
    diagram.sanity_check()
    with pytest.raises(InsaneMap):
        fault(diagram).sanity_check()


def test_merged_cells_are_caught(plane: PlanarMap) -> None:
    with pytest.raises(InsaneMap):
        merge_two_cells(plane).sanity_check()


def test_messages_name_the_object(kernel: PlanarMap) -> None:
    k = first(kernel, "triple")
    with pytest.raises(InsaneMap, match=f"node {k} claims degree 4, 3 edges end"):
        miscount_a_degree(kernel).sanity_check()
