"""Measuring peaks: what is measured is the peak, and optimisers are judged by it."""

from __future__ import annotations

import numpy as np
import pytest

import generators
from harness.bench import peak as bench
from harness.bench.benchmark import Target
from harness.bench.optimisers import OPTIMISERS
from harness.bench.peak import FACTS, QUICK, cavities, measure
from harness.bench.rows import bench_row, columns_of, values_of
from harness.geometry.instance import Instance
from harness.peak import peak
from harness.peak.batch import peaks
from harness.study.outcome import Outcome


@pytest.fixture(autouse=True)
def no_warm_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "warm_up", lambda _builder, _n: None)


@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
def test_the_angle_is_that_of_the_peak_and_only_methods_prove_it(case) -> None:
    measured = measure(case.task("reference"), repeat=1, workers=None)
    best = peak(Instance.from_generated(generators.generate(case.family, case.n)))
    assert set(measured.facts) == {fact.column for fact in FACTS}
    # SLSQP and its like come near, as a rule.
    assert measured.facts["angle"] == pytest.approx(
        best.angle, abs=1e-3 if case.by in OPTIMISERS else 1e-9
    )
    assert measured.is_certified == (case.by not in OPTIMISERS)
    assert measured.amount == case.n


def test_a_row_has_the_sides_and_no_counts_of_a_diagram() -> None:
    case = QUICK[0]
    task = case.task("reference")
    measured = measure(task, repeat=1, workers=None)
    row = bench_row(bench.BENCHMARK, case, task, Outcome("ok"), measured, 1)
    assert tuple(row) == columns_of(bench.BENCHMARK)
    values = values_of(row)
    assert (values["builder"], values["sides"], values["certified"]) == ("lp", case.n, True)
    assert values["vertices"] is None
    assert values["seconds"] > 0


def test_what_is_not_proven_reaches_nothing() -> None:
    measured = measure(QUICK[-1].task("reference"), repeat=1, workers=None)
    assert Target(seconds=1e9).is_reached(measured) is False


def test_a_batch_is_made_of_different_cavities(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "DRAWN", 5)
    made = cavities("cavity", 6, 12)
    found = peaks(made)
    assert (found.status == 0).all()
    angles = found.angles.reshape(-1, 1)
    same = np.abs(angles - angles.T) < 1e-12
    assert (same == (np.arange(12)[:, None] % 5 == np.arange(12) % 5)).all()
    assert len(np.unique(made[:, 0], axis=0)) == 12


def test_the_gradients_given_to_the_smooth_form_are_gradients() -> None:
    from harness.bench.optimisers import _Problem

    problem = _Problem(Instance.from_generated(generators.generate("star", 7)), 0)
    p, step = problem.starts[0], 1e-7
    for k in (0, 1):
        move = step * np.eye(2)[k]
        slopes = (problem.angles(p + move) - problem.angles(p - move)) / (2 * step)
        assert problem.gradients(p)[:, k] == pytest.approx(slopes, rel=1e-4, abs=1e-5)
