"""Shrinking: what comes out still shows it, is simpler, and no single move makes it simpler."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.audit import regions
from harness.audit.cases import generic, is_valid, lattice_segments, lattice_stars
from harness.audit.shrink import moves, shrink, simplicity
from harness.geometry.instance import Instance
from tests.audit.instances import SQUARE, segments


def longest(instance: Instance) -> float:
    ends = instance.segments
    return float(max(math.dist(*s) for s in ends.tolist()))


@settings(max_examples=15)
@given(st.integers(0, 10**6), st.sampled_from([lattice_segments(3, 4), lattice_stars(4, 6)]))
def test_the_result_is_simpler_and_locally_simplest(seed, source) -> None:
    (start,) = source(1, seed)

    def shows(instance):
        return longest(instance) >= 2

    if not shows(start):
        return
    found = shrink(start, shows, budget=2000)
    assert shows(found.instance)
    assert is_valid(found.instance)
    assert simplicity(found.instance) <= simplicity(start)
    for candidate in moves(found.instance):
        if simplicity(candidate) < simplicity(found.instance) and is_valid(candidate):
            assert not shows(candidate)


def test_a_large_counterexample_becomes_a_small_one() -> None:
    def shows(instance):
        return regions.check_every_region(instance).outcome == "fails"

    large = next(filter(shows, lattice_segments(4, size=40, admits=generic)(200, 0)))
    found = shrink(large, shows, 400)
    assert found.instance.n == 2
    assert simplicity(found.instance)[1] <= 3
    assert found.checks <= 400


def test_doubles_are_rounded_to_a_lattice() -> None:
    odd = Instance.from_arrays("polygon", [(0.13, 0.2), (7.77, 0.1), (8.3, 6.9), (0.4, 7.7)])
    found = shrink(odd, lambda i: i.n == 4, budget=500)
    assert (found.instance.floats == found.instance.floats.round()).all()
    assert simplicity(found.instance)[1] == 1


def test_the_budget_is_kept() -> None:
    asked = []
    shrink(SQUARE, lambda i: bool(asked.append(i)), budget=3)
    assert len(asked) <= 3
    asked.clear()
    start = segments(((0, 0), (90, 1)), ((50, 70), (51, 99)))
    assert shrink(start, lambda i: not asked.append(i), budget=0).instance is start
    assert asked == []


@pytest.mark.parametrize("better", [((0, 0), (1, 0)), ((5, 5), (6, 5))])
def test_place_does_not_matter_for_simplicity(better) -> None:
    assert simplicity(segments(better)) == simplicity(segments(((0, 0), (1, 0))))
    assert simplicity(segments(better)) < simplicity(segments(((0, 0), (2, 0))))
    assert simplicity(segments(better)) < simplicity(segments(((0, 0), (0.5, 0))))
