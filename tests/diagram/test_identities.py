"""The identities of counts hold for every diagram, and a count that is changed breaks one."""

from __future__ import annotations

from dataclasses import replace

import pytest

import generators
from harness.diagram import build
from harness.diagram.counts import Counts, Domain
from harness.diagram.identities import broken_identity
from harness.geometry.instance import Instance

DIAGRAMS: list[tuple[str, int, Domain]] = [
    ("zigzag", 12, "kernel"),
    ("convex-circle", 7, "kernel"),
    ("star", 8, "interior"),
    ("segments", 6, "plane"),
    ("grid", 7, "plane"),
    ("star", 6, "plane"),
]


@pytest.fixture(scope="module", params=DIAGRAMS, ids=lambda case: f"{case[0]}-{case[2]}")
def counts(request: pytest.FixtureRequest) -> Counts:
    family, n, domain = request.param
    instance = Instance.from_generated(generators.generate(family, n, seed=3))
    return build(instance, domain, builder="reference").counts


def test_they_hold(counts: Counts) -> None:
    assert broken_identity(counts) is None


@pytest.mark.parametrize("by", [-1, 1])
@pytest.mark.parametrize("key", ["cells", "edges", "vertices", "components"])
def test_no_headline_can_be_changed_alone(counts: Counts, key: str, by: int) -> None:
    broken = broken_identity(replace(counts, **{key: getattr(counts, key) + by}))
    assert broken is not None


@pytest.mark.parametrize("kind", ["triple", "crossing", "saddle", "endpoint"])
def test_no_node_can_be_added(counts: Counts, kind: str) -> None:
    nodes = {**counts.nodes, kind: counts.nodes.get(kind, 0) + 1}
    assert broken_identity(replace(counts, nodes=nodes)) is not None


def test_an_edge_has_two_ends(counts: Counts) -> None:
    """A vertex of a degree that is greater by two per endpoint node leaves ends over."""
    (degree, number), *_ = [*counts.degrees.items(), (3, 0)]
    if number:
        more = degree + 2 * counts.nodes.get("endpoint", 0) + 1
        degrees = {**counts.degrees, degree: number - 1}
        degrees[more] = degrees.get(more, 0) + 1
        broken = broken_identity(replace(counts, degrees=degrees))
        assert broken is not None
        assert broken.key == "edges"


def test_regions_and_unbounded_cells_are_among_the_cells(counts: Counts) -> None:
    for key in ("regions", "unbounded"):
        broken = broken_identity(replace(counts, **{key: counts.cells + counts.n}))
        assert broken is not None
        assert (broken.key, broken.stated) == (key, counts.cells + counts.n)


def test_another_subdivision_is_another_way_to_the_same_counts() -> None:
    """The keyword does something (other triangles), and the diagram does not notice."""
    instance = Instance.from_generated(generators.generate("zigzag", 16, seed=3))
    for domain in ("kernel", "interior"):
        first, second = (
            build(instance, domain, workers=1, subdivision=number)  # type: ignore[arg-type]  # a domain
            for number in (0, 1)
        )
        assert first.counts == second.counts
        assert first.work != second.work
