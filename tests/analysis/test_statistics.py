"""Statistics, their bootstrap, and what unseen tasks leave open."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.analysis.powerlaw import local_slopes, power_law
from harness.analysis.statistics import (
    STATISTICS,
    Statistic,
    bounds,
    evaluate,
    interval,
    is_noise_free,
    resample,
)

samples = st.lists(st.integers(0, 10**6), min_size=1, max_size=30)
odd_samples = samples.filter(lambda values: len(values) % 2 == 1)
every_statistic = pytest.mark.parametrize("statistic", STATISTICS)


def array(values: list[int]) -> np.ndarray:
    return np.array(values, dtype=np.float64)


@given(values=odd_samples)
def test_maximum_and_median_commute_with_monotone_maps(values: list[int]) -> None:
    for statistic in ("maximum", "median"):
        before = evaluate(statistic, array(values))
        assert evaluate(statistic, array(values) ** 2 + 3) == before**2 + 3


@every_statistic
@given(values=samples, seed=st.integers(0, 100))
def test_order_of_replicates_does_not_matter(
    statistic: Statistic, values: list[int], seed: int
) -> None:
    shuffled = np.random.default_rng(seed).permutation(array(values))
    assert evaluate(statistic, shuffled) == pytest.approx(evaluate(statistic, array(values)))


@every_statistic
@given(values=samples, hidden=samples)
def test_bounds_hold_whatever_was_not_seen(
    statistic: Statistic, values: list[int], hidden: list[int]
) -> None:
    found = bounds(statistic, array(values), len(hidden))
    truth = float(evaluate(statistic, array(values + hidden)))
    assert found.low <= truth * (1 + 1e-12)
    assert truth <= found.high
    assert bounds(statistic, array(values), 0).low == float(evaluate(statistic, array(values)))


@given(values=samples, seed=st.integers(0, 10**9))
def test_resamples_stay_within_what_was_seen(values: list[int], seed: int) -> None:
    draws = resample([array(values)], seed, 50)
    for statistic in STATISTICS:
        assert draws[statistic].shape == (50, 1)
        assert (draws[statistic] >= min(values)).all()
        assert (draws[statistic] <= max(values)).all()
    assert (draws["maximum"] >= draws["median"]).all()


@given(values=samples, seed=st.integers(0, 10**9))
def test_resampling_is_a_function_of_the_seed(values: list[int], seed: int) -> None:
    once, again = (resample([array(values)], seed, 20) for _ in range(2))
    assert all((once[statistic] == again[statistic]).all() for statistic in STATISTICS)


@given(value=st.integers(0, 1000), count=st.integers(1, 10))
def test_agreeing_replicates_are_noise_free_and_have_intervals_of_length_zero(
    value: int, count: int
) -> None:
    counts = np.full(count, float(value))
    assert is_noise_free([counts])
    assert not is_noise_free([counts, np.array([1.0, 2.0])])
    for draws in resample([counts], 0, 20).values():
        low, high = interval(draws)
        assert low == high == value


def test_bootstrap_interval_covers_the_true_mean() -> None:
    rng = np.random.default_rng(0)
    covered = 0
    for seed in range(200):
        draws = resample([rng.poisson(40, 30).astype(float)], seed, 200)["mean"]
        low, high = interval(draws)
        covered += bool(low[0] <= 40 <= high[0])
    assert 0.88 <= covered / 200 <= 0.99


# --- power law -----------------------------------------------------------------------------------

SIZES = np.array([6.0, 8.0, 12.0, 16.0, 24.0, 32.0])


@given(millionths=st.integers(-1_000_000, 3_000_000), scale=st.floats(1, 1e3))
def test_exact_power_law_is_recovered_to_a_millionth(millionths: int, scale: float) -> None:
    exponent = millionths / 1_000_000
    values = scale * SIZES**exponent
    found = power_law(SIZES, values, np.tile(values, (10, 1)))
    assert (found.exponent, found.low, found.high) == (exponent, exponent, exponent)
    slopes = local_slopes(SIZES, values)
    assert slopes[0] is None
    assert slopes[1:] == pytest.approx([exponent] * 5, abs=1e-9)


@given(values=st.lists(st.integers(1, 10**6), min_size=6, max_size=6), factor=st.integers(1, 99))
def test_exponent_ignores_the_constant_factor(values: list[int], factor: int) -> None:
    counts = array(values)
    once, scaled = power_law(SIZES, counts, None), power_law(SIZES, factor * counts, None)
    assert once.exponent == pytest.approx(scaled.exponent, abs=1e-9)


def test_zeros_shorten_the_fit_or_leave_it_undefined() -> None:
    found = power_law(SIZES, np.array([0.0, 5.0, 12.0, 16.0, 24.0, 32.0]), None)
    assert found.start == 8.0
    assert "after the last count of zero" in found.reason
    undefined = power_law(SIZES, np.array([1.0, 2.0, 3.0, 0.0, 5.0, 6.0]), None)
    assert undefined.exponent is None
    assert "zero" in undefined.reason
    assert local_slopes(SIZES[:3], np.array([0.0, 3.0, 0.0])) == [None, None, None]


def test_no_interval_where_resamples_reach_zero() -> None:
    values = np.full(6, 2.0)
    draws = np.full((100, 6), 2.0)
    draws[:50, 3] = 0.0
    found = power_law(SIZES, values, draws)
    assert found.exponent == pytest.approx(0.0)
    assert found.low is None
    assert "zero" in found.reason
