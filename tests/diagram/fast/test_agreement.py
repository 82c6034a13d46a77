"""The fast builder's maps are the reference builder's, object by object.

A sample; ``python -m tests.diagram.fast.agreement`` runs the same comparison for as long as wanted.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from generators.registry import generate
from harness.diagram import build
from harness.diagram.counts import DOMAINS, OBJECTIVES, Domain, Objective
from harness.diagram.fast import arrays
from harness.diagram.fast.counting import fast_diagram
from harness.geometry.instance import Instance
from tests import strategies
from tests.diagram.fast import agreement
from tests.diagram.fast.agreement import Case, cases, disagreements, domains, shrunk
from tests.diagram.fast.sources import SOURCES, instance
from tests.diagram.same_map import differences
from tests.diagram.support import SQUARE, corpus, corpus_instance, instance_of, polygon

SEED = 2


@pytest.mark.parametrize("source", [source for source in SOURCES if source != "corpus"])
def test_builders_agree(source: str) -> None:
    for case in cases(source, SEED, 1):
        assert disagreements(case) == [], case.to_json()


@pytest.mark.parametrize("name", corpus())
def test_builders_agree_on_the_corpus(name: str) -> None:
    known = corpus()[name]
    case = Case(corpus_instance(known), known["domain"], known["objective"])
    assert disagreements(case) == []


#: Where builders once disagreed: lines of two segments each through a crossing or along a wall.
ONCE = {
    "three lines, one twice": polygon((-2, 3), (1, 3), (-2, 1), (3, 3), (1, -4), (0, -3), (-3, 0)),
    "a wall on a line of two": polygon((0, 0), (2, 0), (2, 1), (4, 1), (4, 0), (6, 0), (3, 6)),
    "a plus": polygon(
        *[(-1, 3), (-1, 1), (-3, 1), (-3, -1), (-1, -1), (-1, -3)],
        *[(1, -3), (1, -1), (3, -1), (3, 1), (1, 1), (1, 3)],
    ),
}


@pytest.mark.parametrize("domain", DOMAINS)
@pytest.mark.parametrize("name", ONCE)
def test_builders_agree_where_they_did_not(name: str, domain: Domain) -> None:
    assert disagreements(Case(ONCE[name], domain, "smallest")) == []


@settings(max_examples=20)
@given(
    strategies.instances(max_segments=4, max_vertices=6),
    st.sampled_from(OBJECTIVES),
    st.sampled_from(DOMAINS),
)
def test_builders_agree_on_degenerate_input(plain: Any, objective: Objective, domain: Any) -> None:
    made = instance_of(plain)
    case = Case(made, domain if made.kind == "polygon" else "plane", objective)
    assert disagreements(case) == []


FAMILIES: list[tuple[str, int, Domain, Objective]] = [
    ("zigzag", 20, "kernel", "smallest"),
    ("convex-weave", 16, "kernel", "smallest"),
    ("convex-circle", 20, "interior", "largest"),
    ("star", 14, "interior", "smallest"),
    ("cavity", 12, "plane", "smallest"),
    ("segments", 14, "plane", "smallest"),
    ("segments", 14, "plane", "largest"),
]


@pytest.mark.parametrize(("family", "n", "domain", "objective"), FAMILIES)
def test_other_triangles_and_workers_give_the_same_counts(
    family: str, n: int, domain: Domain, objective: Objective
) -> None:
    """Every seed makes other triangles, so that a wrong leaf would hardly be wrong twice."""
    made = Instance.from_generated(generate(family, n, 7))
    counts = [
        fast_diagram(made, domain, objective, workers, seed).counts()
        for workers, seed in [(1, 0), (2, 0), (1, 1), (2, 5)]
    ]
    assert counts == [counts[0]] * len(counts)
    map_of = build(made, domain, objective, "fast")
    map_of.sanity_check()
    assert map_of.counts == counts[0]


def test_numbers_of_64_bits_give_the_same_diagram(monkeypatch: pytest.MonkeyPatch) -> None:
    """Slots are numbered in 32 bits where these are enough: nearly always, so here they are not."""
    made = Instance.from_generated(generate("star", 12, 7))
    narrow = build(made, "interior", "smallest", "fast")
    monkeypatch.setattr(arrays, "LARGE", 0)
    wide = build(made, "interior", "smallest", "fast")
    kinds = {fast_diagram(made, "interior", "smallest").arrays.parent.dtype.itemsize}
    assert kinds == {8}
    wide.sanity_check()
    assert differences(narrow, wide) == []


# --- the comparison itself -----------------------------------------------------------------------


def test_every_source_makes_the_same_instance_again() -> None:
    for source in SOURCES:
        one, two = (instance(source, 3, 5) for _ in range(2))
        assert one.to_json() == two.to_json()
        assert domains(one) == (DOMAINS if one.kind == "polygon" else ("plane",))


def _forgetful(monkeypatch: pytest.MonkeyPatch) -> None:
    """A builder called fast that takes every triple point for one of all segments."""

    def wrong(made: Any, domain: Any, objective: Any, builder: str) -> Any:
        made = build(made, domain, objective, builder="reference")
        if builder == "reference":
            return made
        nodes = (
            replace(node, segments=tuple(range(made.instance.n))) if node.kind == "triple" else node
            for node in made.nodes
        )
        return replace(made, builder="fast", nodes=tuple(nodes))

    monkeypatch.setattr(agreement, "build", wrong)


def test_disagreements_are_found_and_shrunk(monkeypatch: pytest.MonkeyPatch) -> None:
    _forgetful(monkeypatch)
    square = Case(polygon(*SQUARE), "kernel", "smallest")
    assert disagreements(square) == []  # there all four do tie
    star = polygon((6, 1), (5, 4), (1, 5), (-4, 6), (-6, 0), (-3, -5), (3, -4))
    case = Case(star, "kernel", "smallest")
    assert disagreements(case) != []
    small = shrunk(case)
    assert disagreements(small) != []
    assert 4 <= small.instance.n < star.n


def test_failures_are_files_that_can_be_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    _forgetful(monkeypatch)
    options = ["--count", "1", "--family", "zigzag", "--domain", "kernel", "--out", str(tmp_path)]
    assert agreement.main(options) == 1
    written = sorted(tmp_path.glob("fail-zigzag-1-*.json"))
    assert written != []
    assert "failed" in capsys.readouterr().out
    again = Case.from_json(written[0].read_text())
    assert again.instance.to_json() == instance("zigzag", 1, 0).to_json()
    assert agreement.main([str(path) for path in written]) == 1
    monkeypatch.undo()
    assert agreement.main(["--builder", "reference", *map(str, written)]) == 0
