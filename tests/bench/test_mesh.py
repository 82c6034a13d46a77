"""Measuring meshes: what is told of them is true, for every method and every smoother."""

from __future__ import annotations

import numpy as np
import pytest

from generators.triangulations import TRIANGULATIONS
from harness.bench import mesh as bench
from harness.bench.benchmark import Target
from harness.bench.mesh import CASES, FACTS, QUICK, AngleTarget, measure
from harness.bench.rows import bench_row, columns_of
from harness.bench.smoothers import SMOOTHERS
from harness.mesh import improve, quality_of
from harness.study.outcome import Outcome


@pytest.fixture(autouse=True)
def no_warm_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "warm_up", lambda _builder, _n: None)


@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
def test_what_is_told_is_true(case) -> None:
    measured = measure(case.task("reference"), repeat=1, workers=None)
    assert set(measured.facts) == {fact.column for fact in FACTS}
    points, triangles = TRIANGULATIONS[case.family](case.n, case.seed)
    assert measured.facts["smallest_before"] == quality_of(points, triangles).smallest
    if case.by in SMOOTHERS:
        done = SMOOTHERS[case.by](points, triangles)
        assert np.isfinite(done).all()
        assert done.shape == points.shape
        assert not (done == points).all()
    assert measured.is_certified == (measured.facts["inverted"] == 0)
    if measured.facts["bound"] is not None:
        assert measured.facts["smallest"] <= measured.facts["bound"] + 1e-6


def test_a_row_has_the_columns_of_the_benchmark() -> None:
    case = QUICK[0]
    task = case.task("reference")
    measured = measure(task, repeat=2, workers=1)
    row = bench_row(bench.BENCHMARK, case, task, Outcome("ok"), measured, 1)
    assert tuple(row) == columns_of(bench.BENCHMARK)
    assert (row["builder"], row["seed"]) == ("all", "0")


def test_what_is_asked_of_angles_is_judged() -> None:
    measured = measure(QUICK[0].task("reference"), repeat=1, workers=None)
    reached = measured.facts["smallest"]
    assert AngleTarget(smallest=reached).is_reached(measured) is True
    assert AngleTarget(smallest=reached + 0.01).is_reached(measured) is False
    assert AngleTarget(percentile_1=61.0).is_reached(measured) is False
    assert AngleTarget(1e12, smallest=reached).is_reached(measured) is False
    assert AngleTarget(smallest=reached).is_reached(None) is False
    assert Target().is_reached(measured) is None


def test_names_are_unique() -> None:
    assert len({case.name for case in CASES}) == len(CASES)


def test_the_bound_holds_for_every_placement() -> None:
    from harness.mesh.bound import upper_bound

    points, triangles = TRIANGULATIONS["random-mesh"](200, 0)
    here = upper_bound(points, triangles, reach=30)  # the whole mesh
    better = improve(points, triangles)
    assert upper_bound(better.points, triangles, reach=30) == pytest.approx(here, abs=1e-5)
    assert better.after.smallest <= here + 1e-6
    # Less of the mesh, fewer conditions.
    assert upper_bound(better.points, triangles, reach=2) >= here - 1e-5


@pytest.mark.parametrize("nested", [1, 2, 3])
def test_nested_vertices_bound_the_smallest_angle(nested) -> None:
    from harness.mesh.bound import upper_bound

    # The best outer triangle: its angles are as the numbers of parts that they fall into.
    height = 0.5 * np.tan(np.pi * (1 + nested) / (4 + 2 * nested))
    points = [(0.0, 0.0), (1.0, 0.0), (0.5, height)]
    triangles = [(0, 1, 2)]
    for v in range(3, 3 + nested):  # into the last triangle, which has two vertices of the first
        a, b, c = triangles.pop()
        points.append(tuple(np.mean([points[a], points[b], points[c]], axis=0)))
        triangles += [(b, c, v), (c, a, v), (a, b, v)]
    bound = upper_bound(np.array(points), np.array(triangles), reach=9)
    assert bound == pytest.approx(180 / (4 + 2 * nested), abs=1e-6)
    assert improve(points, triangles).after.smallest <= bound + 1e-6


@pytest.mark.parametrize("name", TRIANGULATIONS)
def test_the_meshes_are_meshes_and_the_same_every_time(name) -> None:
    from harness.mesh import Mesh

    points, triangles = TRIANGULATIONS[name](30, 7)
    again = TRIANGULATIONS[name](30, 7)
    assert (points == again[0]).all()
    assert (triangles == again[1]).all()
    mesh = Mesh.of(points, triangles)
    assert len(mesh.free) == {"random-mesh": 30, "distorted-grid": 29 * 29}[name]
    assert not (points == TRIANGULATIONS[name](30, 8)[0]).all()
