"""Verdicts: planted growth is recovered, errors are rare, censoring withholds, words are modest."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from harness.analysis.challenge import Challenge, Series, challenge, fit_sizes
from harness.analysis.models import GREATEST_SHARE, LEAST_SHARE, MODELS, Model
from harness.analysis.planted import Design, check, plant
from harness.analysis.statistics import evaluate, is_noise_free, resample
from harness.analysis.verdict import judge

QUICK = (6, 8, 12, 16, 24, 32)
DOUBLING = (10, 20, 40, 80, 160, 320)
every_model = pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)


def exact(n: tuple[int, ...], values: np.ndarray, censored: set[int] | None = None) -> Challenge:
    marks = tuple(index in (censored or set()) for index in range(len(n)))
    sizes = np.array(n, dtype=np.float64)
    return challenge(Series(sizes, values.astype(np.float64), None, marks), seed=1, rounds=300)


def curve(model: Model, n: tuple[int, ...], level: float, correction: float = 0.0) -> np.ndarray:
    """level·(m + correction·l), both terms 1 at the largest size that is fitted."""
    sizes = np.array(n, dtype=np.float64)
    at = sizes[fit_sizes(len(n)) - 1 :][:1]
    leading = model.leading(sizes) / model.leading(at)
    return level * (leading + correction * model.lower(sizes) / model.lower(at))


# --- families without noise ----------------------------------------------------------------------


@every_model
@pytest.mark.parametrize("n", [QUICK, DOUBLING], ids=["quick", "doubling"])
@given(level=st.floats(1e4, 1e9), correction=st.floats(-0.2, 0.6))
def test_exact_growth_with_a_lower_order_term_is_called_right(
    model: Model, n: tuple[int, ...], level: float, correction: float
) -> None:
    assert 1 / GREATEST_SHARE - 1 < correction < 1 / LEAST_SHARE - 1
    values = curve(model, n, level, correction)
    assume(values.min() >= 1)  # counts: a negative lower-order term may not exceed the leading one
    verdict = judge(exact(n, values))
    assert verdict.kept == (model,)
    assert verdict.call(model.name) == "right"
    assert verdict.too_slow + verdict.too_fast == tuple(m for m in MODELS if m is not model)


@pytest.mark.parametrize(
    ("growth", "expected"),
    [
        (lambda n: n * n // 4, "n^2"),  # crossings of the grid
        (lambda n: n * (n - 1) // 2, "n^2"),
        (lambda n: n * (n - 3) // 2, "n^2"),
        (lambda n: n * n // 4 + 3 * n + 4, "n^2"),
        (lambda n: n // 2 - 2, "n"),  # the linear control
        (lambda n: 2 * n + 7, "n"),
        (lambda n: 3, "1"),
        (lambda n: 1, "1"),
    ],
)
def test_formulas_that_diagrams_show_are_called_right_at_small_sizes(growth, expected) -> None:
    verdict = judge(exact(QUICK, np.array([growth(n) for n in QUICK])))
    assert [model.name for model in verdict.kept] == [expected]


def test_zero_at_every_size_is_constant() -> None:
    verdict = judge(exact(QUICK, np.zeros(6)))
    assert "1" in [model.name for model in verdict.kept]
    assert not verdict.too_slow


@given(values=st.lists(st.integers(0, 10**5), min_size=6, max_size=6), power=st.integers(0, 12))
def test_verdict_ignores_the_scale_of_large_counts(values: list[int], power: int) -> None:
    # Powers of two scale floats exactly; large counts, so that rounding to whole ones is no matter.
    counts = 10.0**6 * (1 + np.array(values, dtype=np.float64))
    assert judge(exact(QUICK, counts)) == judge(exact(QUICK, 2.0**power * counts))


@given(values=st.lists(st.integers(1, 10**4), min_size=6, max_size=6), factor=st.integers(2, 10**3))
def test_larger_counts_at_the_challenged_sizes_speak_for_faster_growth(
    values: list[int], factor: int
) -> None:
    counts = np.array(values, dtype=np.float64)
    raised = counts.copy()
    raised[fit_sizes(6) :] *= factor
    for before, after in zip(exact(QUICK, counts).trials, exact(QUICK, raised).trials, strict=True):
        assert after.miss >= before.miss


def test_the_challenge_is_out_of_sample() -> None:
    one = exact(QUICK, np.array([6, 8, 12, 16, 24, 32]))
    other = exact(QUICK, np.array([6, 8, 12, 1, 2, 3]))
    for a, b in zip(one.trials, other.trials, strict=True):
        assert a.predicted == pytest.approx(b.predicted)


# --- families with noise -------------------------------------------------------------------------


def planted_verdict(model: Model, spread: float, replicates: int, seed: int, n=QUICK):
    sizes = np.array(n, dtype=np.float64)
    samples = plant(curve(model, n, 40.0), (replicates,) * len(n), spread, seed)
    values = np.array([float(evaluate("median", counts)) for counts in samples])
    draws = None if is_noise_free(samples) else resample(samples, seed, 300)["median"]
    return judge(challenge(Series(sizes, values, draws, (False,) * len(n)), seed, 300))


@every_model
@pytest.mark.parametrize(("spread", "replicates"), [(0.1, 1), (0.1, 10), (0.3, 30)])
def test_planted_growth_is_seldom_rejected(model: Model, spread: float, replicates: int) -> None:
    rounds = 40
    wrong = sum(
        planted_verdict(model, spread, replicates, seed).call(model.name) == "wrong"
        for seed in range(rounds)
    )
    assert wrong <= 3  # nominal: 1 % of 40


@settings(max_examples=30)
@given(
    model=st.sampled_from(MODELS),
    spread=st.floats(0.01, 0.05),
    seed=st.integers(0, 10**9),
)
def test_growth_two_steps_away_is_always_rejected_with_little_noise(
    model: Model, spread: float, seed: int
) -> None:
    verdict = planted_verdict(model, spread, 30, seed, DOUBLING)
    rank = MODELS.index(model)
    for other in MODELS[: max(0, rank - 1)]:
        assert other in verdict.too_slow
    for other in MODELS[rank + 2 :]:
        assert other in verdict.too_fast


def test_heavy_noise_leaves_the_question_open() -> None:
    undecided = [
        judge_of
        for seed in range(20)
        if len((judge_of := planted_verdict(MODELS[2], 0.8, 3, seed)).kept) > 1
    ]
    assert len(undecided) >= 18


def test_growth_between_the_candidates_is_not_called_one_of_the_outer_ones() -> None:
    n = np.array(DOUBLING, dtype=np.float64)
    verdict = judge(exact(DOUBLING, np.rint(n**1.5)))
    assert {model.name for model in verdict.kept} != {"n"}
    assert {model.name for model in verdict.kept} != {"n^2"}


# --- censoring -----------------------------------------------------------------------------------


def test_a_lower_bound_at_a_challenged_size_cannot_make_a_model_too_fast() -> None:
    values = np.array([6, 8, 12, 16, 24, 32])
    clear = judge(exact(QUICK, values))
    assert [model.name for model in clear.too_fast] == ["n log n", "n^2"]
    censored = judge(exact(QUICK, values, {5}))
    assert not censored.too_fast
    assert [model.name for model in censored.withheld] == ["n log n", "n^2"]
    assert censored.too_slow == clear.too_slow
    assert censored.call("n") == "possible"
    assert "withheld" in censored.sentence


def test_a_lower_bound_at_a_fitted_size_cannot_make_a_model_too_slow() -> None:
    censored = judge(exact(QUICK, np.array([6, 8, 12, 16, 24, 32]), {1}))
    assert not censored.too_slow
    assert [model.name for model in censored.withheld] == ["1", "log n"]
    assert [model.name for model in censored.too_fast] == ["n log n", "n^2"]
    assert censored.linear_claim == "possible"


# --- too little to say ---------------------------------------------------------------------------


@pytest.mark.parametrize("n", [(), (6,), (6, 8, 12, 16), (10, 11, 12, 13, 14), (1, 2, 4, 8, 16)])
def test_too_few_or_too_narrow_sizes_give_no_verdict(n: tuple[int, ...]) -> None:
    verdict = judge(exact(n, np.array(n, dtype=np.float64)))
    assert verdict.kind == "undecided"
    assert verdict.label == "not decided"
    assert verdict.linear_claim == "undecided"
    assert all(verdict.call(model.name) == "undecided" for model in MODELS)


@given(values=st.lists(st.integers(0, 10**4), min_size=6, max_size=6))
def test_every_verdict_is_consistent_and_modest(values: list[int]) -> None:
    verdict = judge(exact(QUICK, np.array(values)))
    groups = [verdict.kept, verdict.too_slow, verdict.too_fast, verdict.withheld]
    assert sorted(MODELS.index(m) for group in groups for m in group) == list(range(5))
    for word in ("prove", "proof", "certain", "theorem"):
        assert word not in verdict.sentence.lower()
    for model in (*verdict.too_slow, *verdict.too_fast):
        assert verdict.call(model.name) == "wrong"
        assert model.symbol in verdict.sentence
    if verdict.linear_claim == "faster":
        assert MODELS[2] in verdict.too_slow


# --- the planted controls ------------------------------------------------------------------------


def test_power_check_sees_what_a_good_design_sees_and_admits_what_a_poor_one_misses() -> None:
    good, *_ = check(Design(tuple(map(float, DOUBLING)), (30,) * 6, 0.05, 16.0))
    poor, *_ = check(Design((6.0, 7.0, 8.0, 10.0, 12.0), (3,) * 5, 0.5, 2.0))
    for model in MODELS:
        assert good.rejected[model.name, model.name] <= 0.1
        assert poor.rejected[model.name, model.name] <= 0.1
    assert good.rejected["n^2", "n"] == good.rejected["n", "n^2"] == 1.0
    assert poor.rejected["n", "n log n"] < 0.3


def test_power_check_is_a_function_of_the_design() -> None:
    design = Design((6.0, 8.0, 12.0, 16.0, 24.0), (1,) * 5, 0.0, 8.0)
    assert check(design) == check(design)
    assert len(check(design)) == 1  # no scatter: maximum and median are one


@given(values=st.lists(st.integers(0, 10**4), min_size=6, max_size=6), marked=st.integers(0, 6))
def test_survivors_are_a_run_of_neighbouring_models(values: list[int], marked: int) -> None:
    verdict = judge(exact(QUICK, np.array(values), {marked}))
    alive = [rank for rank, m in enumerate(MODELS) if m in verdict.kept + verdict.withheld]
    assert all(after == before + 1 for before, after in pairwise(alive))
    assert verdict.too_slow == MODELS[: len(verdict.too_slow)]
    assert verdict.too_fast == MODELS[len(MODELS) - len(verdict.too_fast) :]


def test_no_rejection_rests_on_the_smallest_size_alone() -> None:
    # A grid of n/2 + n/2 lines: a single pair (n = 2) is not yet like the others.
    n = (2, 4, 6, 8, 10)
    values = np.array([3, 18, 36, 60, 85])
    verdict = judge(exact(n, values))
    assert "n^2" in [model.name for model in verdict.kept]
    findings = {trial.model.name: trial.finding for trial in exact(n, values).trials}
    assert findings["n^2"] == "fragile"
    larger = (4, 6, 8, 10, 12, 14, 16, 20)
    values = np.array([18, 36, 60, 85, 123, 161, 207, 319])
    assert judge(exact(larger, values)).kept == (MODELS[-1],)
