"""What a benchmark asks for: targets, comparisons, and instances that exist."""

from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.bench import BENCHMARKS, benchmark_named
from harness.bench.benchmark import Case, Comparison, Measured, Target
from harness.errors import UserError
from tests.bench import fakes

MEASURED = fakes.measured(Case("s", "star", 100, "kernel").task("reference"), repeat=3, workers=1)


@pytest.mark.parametrize("name", BENCHMARKS)
def test_every_instance_can_be_made(name: str) -> None:
    benchmark = benchmark_named(name)
    assert benchmark.name == name
    cases = [*benchmark.cases, *benchmark.quick]
    assert len({case.name for case in cases}) == len(cases)
    keys = {case.task("reference").key for case in cases}  # the parameters are checked here
    assert len(keys) == len(cases)
    compared = {end for one in benchmark.comparisons for end in (one.large, one.small)}
    assert compared <= {case.name for case in cases}


def test_cases_are_chosen_by_name() -> None:
    benchmark = benchmark_named("diagram")
    assert benchmark.chosen(None) == list(benchmark.cases)
    assert benchmark.chosen(None, quick=True) == list(benchmark.quick)
    last_first = [case.name for case in reversed(benchmark.cases)]
    assert benchmark.chosen(last_first) == list(benchmark.cases)
    assert [case.name for case in benchmark.chosen(["grid-1000"])] == ["grid-1000"]
    with pytest.raises(UserError, match=r"no instance 'grid-100'.*did you mean 'grid-1000'"):
        benchmark.chosen(["grid-1000", "grid-100"])
    with pytest.raises(UserError, match="they are zigzag-6, zigzag-8"):
        benchmark.chosen(["§"], quick=True)


def test_the_seconds_are_the_median() -> None:
    timings = (3.0, 1.0, 100.0, 2.0, 2.5)
    measured = dataclasses.replace(MEASURED, timings=timings, amount=10)
    assert (measured.seconds, measured.per_second) == (2.5, 4.0)


@given(st.none() | st.floats(1, 1e4), st.none() | st.floats(1e-3, 1), st.none() | st.floats(1, 1e4))
def test_a_target_is_reached_if_all_of_it_is(rate, seconds, mib) -> None:
    target = Target(rate, seconds, mib)
    asked = [
        (rate, lambda limit: MEASURED.per_second >= limit),
        (seconds, lambda limit: MEASURED.seconds < limit),
        (mib, lambda limit: MEASURED.peak_mib < limit),
    ]
    parts = [holds(limit) for limit, holds in asked if limit is not None]
    assert target.is_reached(MEASURED) is (all(parts) if parts else None)
    assert target.is_reached(None) is (False if parts else None)
    doubtful = dataclasses.replace(MEASURED.counts, certified=False)
    uncertified = dataclasses.replace(MEASURED, counts=doubtful)
    assert target.is_reached(uncertified) is (False if parts else None)


def test_the_limits_themselves() -> None:
    """A rate may be just what is asked, seconds and memory must be less."""
    assert Target(rate=MEASURED.per_second).is_reached(MEASURED) is True
    assert Target(rate=math.nextafter(MEASURED.per_second, math.inf)).is_reached(MEASURED) is False
    assert Target(seconds=MEASURED.seconds).is_reached(MEASURED) is False
    assert Target(mib=MEASURED.peak_mib).is_reached(MEASURED) is False


def with_cost(seconds: float, amount: int) -> Measured:
    return dataclasses.replace(MEASURED, timings=(seconds,), amount=amount)


def test_a_comparison_is_of_seconds_per_unit() -> None:
    comparison = Comparison("large", "small", most=1.5)
    found = {"large": with_cost(12.0, 400), "small": with_cost(1.0, 50)}
    assert comparison.ratio(found) == pytest.approx(1.5)
    assert comparison.is_reached(1.5) is False
    assert comparison.is_reached(1.49) is True
    assert Comparison("large", "small").is_reached(0.1) is None
    assert comparison.ratio({"large": found["large"]}) is None
    assert comparison.ratio({**found, "small": with_cost(1.0, 0)}) is None
