"""Identities and invariances over generated instances, the degenerate ones above all."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.counts import DOMAINS, OBJECTIVES, Counts, Domain, Objective
from harness.geometry.instance import Instance
from tests import strategies
from tests.diagram.support import instance_of

objectives = st.sampled_from(OBJECTIVES)


def check_identities(counts: Counts) -> None:
    """What the counts alone must satisfy (the map itself is checked object by object)."""
    nodes, plain = counts.nodes, counts.edges - counts.loops
    inner = counts.vertices + nodes.get("endpoint", 0)
    infinite = nodes.get("infinity", 0)
    if counts.domain == "plane":
        assert counts.cells == plain - inner - (infinite > 0) + 1 + counts.components
    else:
        assert counts.cells == plain - inner + counts.components
    ends = sum(degree * count for degree, count in counts.degrees.items())
    assert ends + 2 * nodes.get("endpoint", 0) + nodes["boundary"] + infinite == 2 * plain
    assert counts.vertices == sum(nodes.get(kind, 0) for kind in ("triple", "crossing", "saddle"))
    assert counts.vertices == sum(counts.degrees.values())
    assert 1 <= counts.regions <= min(counts.n, counts.cells)


@pytest.mark.parametrize("domain", DOMAINS)
@settings(max_examples=200)
@given(data=st.data(), objective=objectives)
def test_identities(domain: Domain, data: st.DataObject, objective: Objective) -> None:
    source = strategies.instances() if domain == "plane" else strategies.polygons()
    diagram = build(instance_of(data.draw(source)), domain, objective)
    diagram.sanity_check()
    check_identities(diagram.counts)
    assert diagram.counts.certified


@settings(max_examples=60)
@given(
    strategies.instances(max_segments=4, max_vertices=6),
    strategies.similarities(),
    objectives,
    st.sampled_from(DOMAINS),
    st.randoms(use_true_random=False),
)
def test_counts_survive_similarities_relabelling_and_reversal(
    plain: Any, similarity: Any, objective: Objective, domain: Domain, random: Any
) -> None:
    kind, coordinates = strategies.moved(plain, similarity)
    moved = list(coordinates)
    if kind == "segments":
        domain = "plane"
        random.shuffle(moved)
        moved = [segment if random.random() < 0.5 else segment[::-1] for segment in moved]
    else:
        start = random.randrange(len(moved))
        moved = moved[start:] + moved[:start]
        if random.random() < 0.5:
            moved.reverse()
    before = build(instance_of(plain), domain, objective).counts
    after = build(instance_of((kind, moved)), domain, objective).counts
    assert before == after


@given(strategies.convex_polygons(max_size=6), objectives)
def test_a_convex_polygon_is_its_own_kernel(plain: Any, objective: Objective) -> None:
    instance = instance_of(plain)
    kernel = build(instance, "kernel", objective).counts.as_dict()
    interior = build(instance, "interior", objective).counts.as_dict()
    assert {**kernel, "domain": ""} == {**interior, "domain": ""}


@settings(max_examples=40)
@given(strategies.polygons(max_size=6), objectives)
def test_kernel_cells_are_met_in_the_interior_too(plain: Any, objective: Objective) -> None:
    """The kernel's diagram is the interior's, cut: same winner at every witness point."""
    instance = instance_of(plain)
    kernel, interior = build(instance, "kernel", objective), build(instance, "interior", objective)
    inside = [(point, cell) for point, cell in kernel.witnesses if cell >= 0]
    for (_, cell), place in zip(inside, interior.locate([p for p, _ in inside]), strict=True):
        if place is not None:
            assert interior.cells[place].segment == kernel.cells[cell].segment


def test_two_segments_give_the_same_diagram_for_both_objectives() -> None:
    """With two segments the least and the greatest angle only swap roles (end of Section 2)."""
    instance = Instance.from_arrays("segments", [((0, 0), (2, 1)), ((5, 1), (4, 4))])
    smallest, largest = build(instance).counts, build(instance, objective="largest").counts
    assert smallest.cells == largest.cells
    assert smallest.edges == largest.edges
    # The one tie at angle 0 is a crossing either way.
    assert dict(smallest.nodes) == dict(largest.nodes)
