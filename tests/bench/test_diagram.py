"""Measuring a diagram: the counts are those of a build, and what is planted shows."""

from __future__ import annotations

import dataclasses

import pytest

import generators
from harness.bench import diagram
from harness.bench.diagram import FACTS, QUICK, measure
from harness.bench.timing import UnsteadyResult
from harness.diagram import build
from harness.diagram.checks import InsaneMap
from harness.diagram.work import Work
from harness.geometry.instance import Instance
from harness.study.task import Task

TASK = QUICK[-1].task("reference")


@pytest.fixture(autouse=True)
def no_warm_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(diagram, "warm_up", lambda _builder, _n: None)


def built(task: Task):
    instance = Instance.from_generated(
        generators.generate(task.family, task.n, task.seed, **dict(task.params))
    )
    return build(instance, task.domain, task.objective, task.builder)


@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
@pytest.mark.parametrize("objective", ["smallest", "largest"])
def test_what_is_measured_is_what_is_built(case, objective) -> None:
    task = dataclasses.replace(case, objective=objective).task("reference")
    measured = measure(task, repeat=2, workers=None)
    assert measured.counts == built(task).counts
    assert measured.amount == measured.counts.vertices
    assert len(measured.timings) == 2
    assert min(measured.timings) > 0
    assert measured.peak_mib > 1
    assert measured.facts == dict.fromkeys([fact.column for fact in FACTS])


def planted(monkeypatch: pytest.MonkeyPatch, changes) -> list[dict]:
    """Let the builder return a map of which ``changes`` gives the attributes that are wrong."""
    calls: list[dict] = []

    def make(*arguments, **options):
        calls.append(options)
        made = build(*arguments, **{k: v for k, v in options.items() if k != "workers"})
        for name, value in changes(made, len(calls)).items():
            object.__setattr__(made, name, value)
        return made

    monkeypatch.setattr(diagram, "build", make)
    return calls


def test_the_work_is_told_as_shares(monkeypatch: pytest.MonkeyPatch) -> None:
    work = Work(triangles=60, tests=100, leaves=40, by_floats=30, by_balls=8, exactly=2, workers=2)
    calls = planted(monkeypatch, lambda _map, _call: {"work": work})
    measured = measure(TASK, repeat=2, workers=2)
    assert [options["workers"] for options in calls] == [2, 2]
    assert measured.workers == 2
    vertices = measured.counts.vertices
    assert measured.facts == {
        "triangles": 60,
        "triangles_per_vertex": pytest.approx(60 / vertices),
        "leaves": 40,
        "share_floats": 0.75,
        "share_balls": 0.2,
        "share_exact": 0.05,
    }


def test_a_builder_that_is_not_told_of_workers_is_not_asked(monkeypatch) -> None:
    calls = planted(monkeypatch, lambda _map, _call: {})
    measure(TASK, repeat=1, workers=None)
    assert "workers" not in calls[0]


def test_a_map_against_euler_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    planted(monkeypatch, lambda made, _call: {"cells": made.cells[:-1]})
    with pytest.raises(InsaneMap, match="Euler"):
        measure(TASK, repeat=2, workers=None)


def test_a_builder_that_changes_its_mind_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    planted(monkeypatch, lambda made, call: {"certified": call != 2})
    with pytest.raises(UnsteadyResult):
        measure(TASK, repeat=3, workers=None)
