"""Wrong maps of the fast builder must not pass: planted faults are caught, wherever they are."""

from __future__ import annotations

import contextlib
import random
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from typing import Any

import numpy as np
import pytest

from harness.diagram.checks import InsaneMap
from harness.diagram.counts import Domain
from harness.diagram.fast import counting, search
from harness.diagram.fast.build import find_leaves
from harness.diagram.fast.leaves import ARC, EMPTY, TRIPLE
from harness.diagram.fast.map import build_fast
from harness.diagram.fast.prepare import prepare
from harness.diagram.planar_map import PlanarMap
from harness.diagram.work import Contradiction
from harness.geometry.instance import Instance
from tests.diagram.fast import test_classify
from tests.diagram.fast.agreement import Case, disagreements
from tests.diagram.fast.triangles import cuts, diagrams
from tests.diagram.support import SQUARE, polygon, segments
from tests.diagram.test_planted_faults import FAULTS, merge_two_cells

HEPTAGON = polygon((6, 1), (5, 4), (1, 5), (-4, 6), (-6, 0), (-3, -5), (3, -4))
FOUR = segments(((0, 0), (4, 1)), ((7, 1), (6, 5)), ((1, 6), (3, 9)), ((-3, 2), (-4, 5)))
CASES: dict[str, tuple[Instance, Domain]] = {
    "plane": (FOUR, "plane"),
    "kernel": (HEPTAGON, "kernel"),
}


def fast(name: str) -> PlanarMap:
    from harness.diagram import domain_corners

    instance, domain = CASES[name]
    return build_fast(instance, domain, "smallest", domain_corners(instance, domain), workers=1)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
@pytest.mark.parametrize("name", CASES)
def test_faults_in_the_map_are_caught(fault: Callable[[PlanarMap], PlanarMap], name: str) -> None:
    diagram = fast(name)
    diagram.sanity_check()
    with pytest.raises(InsaneMap):
        fault(diagram).sanity_check()


def test_merged_cells_are_caught() -> None:
    with pytest.raises(InsaneMap):
        merge_two_cells(fast("plane")).sanity_check()


@pytest.mark.parametrize(
    "key", ["cells", "edges", "vertices", "components", "regions", "unbounded"]
)
@pytest.mark.parametrize("name", CASES)
def test_a_wrong_tally_is_caught(name: str, key: str) -> None:
    """The counts were made from arrays, the objects later."""
    diagram = fast(name)
    tally = replace(diagram.counts, **{key: getattr(diagram.counts, key) + 1})
    with pytest.raises(InsaneMap):
        replace(diagram, tally=tally).sanity_check()


# --- faults in leaves ----------------------------------------------------------------------------


def altered(monkeypatch: pytest.MonkeyPatch, change: Callable[[Any], None]) -> None:
    """Let ``change`` alter the leaves before they are glued."""

    def faulty(*arguments: Any) -> Any:
        leaves = find_leaves(*arguments)
        change(leaves)
        return leaves

    monkeypatch.setattr(search, "find_leaves", faulty)


def first_leaf(leaves: Any, kind: int) -> int:
    return int(np.flatnonzero(leaves.kinds == kind)[0])


def give_an_empty_leaf_away(leaves: Any) -> None:
    """A piece is said to belong to another segment."""
    slot = leaves.first_slot[first_leaf(leaves, EMPTY)]
    leaves.slots[slot, 1] = (leaves.slots[slot, 1] + 1) % 4


def exchange_owners_of_an_arc(leaves: Any) -> None:
    slot = leaves.first_slot[first_leaf(leaves, ARC)]
    leaves.slots[[slot, slot + 1], 1] = leaves.slots[[slot + 1, slot], 1]


def move_a_port_to_another_side(leaves: Any) -> None:
    slot = leaves.first_slot[first_leaf(leaves, ARC)]
    leaves.slots[slot, 0] = (leaves.slots[slot, 0] + 2) % 6


def lose_an_arc(leaves: Any) -> None:
    leaves.kinds[first_leaf(leaves, ARC)] = EMPTY


def turn_a_triple(leaves: Any) -> None:
    slot = leaves.first_slot[first_leaf(leaves, TRIPLE)]
    owners = leaves.slots[slot : slot + 3, 1].copy()
    leaves.slots[slot : slot + 3, 1] = np.roll(owners, 1)


LEAF_FAULTS = [
    give_an_empty_leaf_away,
    exchange_owners_of_an_arc,
    move_a_port_to_another_side,
    lose_an_arc,
    turn_a_triple,
]


@pytest.mark.parametrize("fault", LEAF_FAULTS, ids=lambda fault: fault.__name__)
@pytest.mark.parametrize("name", CASES)
def test_faults_in_leaves_are_caught(
    fault: Callable[[Any], None], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neighbours disagree about a common side, a place has no point, or the map is insane."""
    altered(monkeypatch, fault)
    with pytest.raises((Contradiction, ArithmeticError)):
        fast(name).sanity_check()


# --- coefficients off by more than their bounds --------------------------------------------------


def test_coefficients_beyond_their_bounds_are_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """The comparison of leaves finds wrong ones as soon as errors exceed what they may be."""
    monkeypatch.setattr(test_classify, "SHARE", Fraction(12))
    rng = random.Random(1)
    found: Counter[str] = Counter()
    every = diagrams(rng, ["star", "segments"], 5)
    wrong = (
        text
        for made in islice(every, 10)
        for cut in cuts(made, rng, 30)
        for text in test_classify.examined(cut, rng, found)
    )
    assert next(wrong, None) is not None


@pytest.mark.parametrize("shift", [1e-9, 1e-12])
def test_a_shifted_coordinate_is_noticed(shift: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The builder's doubles lie about one coordinate, by more than its bounds allow for.

    In the square all four segments tie in one point; not so if one is moved.
    """
    square = Case(polygon(*SQUARE), "kernel", "smallest")
    assert disagreements(square) == []

    def shifted(instance: Instance, parallels: bool) -> Any:
        prepared = prepare(instance, parallels)
        prepared.segments[0, 0] += shift
        return prepared

    monkeypatch.setattr(counting, "prepare", shifted)
    with contextlib.suppress(ArithmeticError, Contradiction):
        assert counting.fast_diagram(polygon(*SQUARE), "kernel", "smallest").counts().vertices != 1
