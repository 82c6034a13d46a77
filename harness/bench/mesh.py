"""The benchmark ``mesh``: smallest angles reached, and the time from a checked mesh to a better.

Beside what this project does stand the fixed-connectivity smoothers of others that are installed.
"""

from __future__ import annotations

import os
import statistics
from dataclasses import dataclass
from typing import Any

import numpy as np

from generators.triangulations import TRIANGULATIONS
from harness.bench.benchmark import Benchmark, Case, Fact, Measured, Target
from harness.bench.smoothers import SMOOTHERS
from harness.bench.timing import seconds_of, timed
from harness.geometry.predicates import orientations
from harness.mesh.bound import upper_bound
from harness.mesh.door import improve_mesh
from harness.mesh.mesh import Mesh
from harness.mesh.options import Options
from harness.mesh.quality import quality_of
from harness.study.limits import Limits, peak_mib
from harness.study.task import Task

METHODS = {
    "all": Options(),
    "all-10-sweeps": Options(sweeps=10),
    "apex": Options("apex", sweeps=1000),
    "apex-both": Options("apex", remedy="both", sweeps=1000),
    "laplacian": Options("laplacian"),
    "smart-laplacian": Options("smart-laplacian"),
    "combined": Options("combined"),
    "flip": Options(topology="flip"),
    "full": Options(topology="full"),
}
"""What is timed, by the name of the case."""


@dataclass(frozen=True)
class AngleTarget(Target):
    """Also: degrees that the smallest angle and the 1st percentile are to reach."""

    smallest: float = 0.0
    percentile_1: float = 0.0

    def is_reached(self, measured: Measured | None) -> bool | None:
        """Whether all that is asked is there, and no triangle is inverted."""
        if measured is None:
            return False
        rest = Target(self.rate, self.seconds, self.mib).is_reached(measured)
        facts = measured.facts
        angles = (facts["smallest"] or 0) >= self.smallest and (
            facts["percentile_1"] or 0
        ) >= self.percentile_1
        return rest is not False and angles and measured.is_certified


@dataclass(frozen=True)
class MeshCase(Case):
    """A mesh of :mod:`generators.triangulations`, and what is done to it (``by``)."""

    seed: int = 0

    def task(self, builder: str) -> Task:
        """The case as a task."""
        return Task(
            family=self.family,
            n=self.n,
            params=(),
            replicate=self.seed,
            seed=self.seed,
            domain=self.domain,
            objective=self.objective,
            builder=self.by or builder,
        )


def _case(mesh: str, by: str, target: Target | None = None) -> MeshCase:
    family, n, seed = MESHES[mesh]
    return MeshCase(f"{by}-{mesh}", family, n, "plane", by=by, seed=seed, target=target or Target())


SEEDS = 5
"""Random meshes of each size, of which the medians are meant."""
MESHES = {
    **{
        f"{size}-{seed}" if seed else size: ("random-mesh", n, seed)
        for size, n in (("1e3", 1000), ("1e4", 10_000), ("1e5", 100_000))
        for seed in range(SEEDS)
    },
    "1e4-free": ("random-mesh", 10_000, 13),
    "grid": ("distorted-grid", 100, 0),
    "small": ("random-mesh", 40, 0),
}
"""Family, n and seed.  The seeds come as they are.  What a connectivity permits is bounded (see
``bound``), mostly by vertices that lie nested in a triangle of others: one vertex of degree three
splits its three angles into six, so 180°/6 = 30° is the most; another in one of the parts makes
eight (22.5°), a third ten (18°).  Random points have such nests, near the boundary and away from
it; ``1e4-free`` is the first mesh of 10⁴ vertices that permits what is asked."""

_ASKED = {"1e3": 29.5, "1e4": 24.0, "1e5": 20.0}
_RATE = 100_000.0

CASES = (
    *(
        _case(mesh, "all", AngleTarget(_RATE, smallest=asked, percentile_1=29.0))
        for size, asked in _ASKED.items()
        for mesh in MESHES
        if mesh.split("-")[0] == size
    ),
    _case("grid", "all", AngleTarget(smallest=44.5)),
    _case("1e5", "all-10-sweeps", Target(rate=_RATE, seconds=15)),
    *(
        _case(mesh, by, AngleTarget(smallest=34.0))
        for by in ("flip", "full")
        for mesh in ("1e3", "1e4", "1e5", "grid")
    ),
    _case("1e5", "apex", Target(seconds=60)),
    *(_case(mesh, by) for by in ("apex", "apex-both") for mesh in ("1e3", "1e4", "grid")),
    *(
        _case(mesh, by)
        for mesh in ("1e3", "1e4", "1e5", "grid")
        for by in ("laplacian", "smart-laplacian", "combined", *SMOOTHERS)
    ),
)

QUICK = tuple(_case("small", by) for by in (*METHODS, *SMOOTHERS))

FACTS = (
    Fact("smallest_before", "before", ".3f"),
    Fact("smallest", "smallest", ".3f"),
    Fact("bound", "bound", ".3f"),
    Fact("percentile_1", "1%", ".2f"),
    Fact("percentile_5", "5%", ".2f"),
    Fact("mean", "mean", ".2f"),
    Fact("inverted", "inverted", "d"),
    Fact("visits_per_second", "visits/s", ".0f"),
    Fact("target_smallest", "angle to reach", ".1f"),
)
"""Angles in degrees.  ``bound``: no mesh of this connectivity has a greater smallest angle, where
a linear program tells (:mod:`harness.mesh.bound`)."""


def warm_up(builder: str, _n: int) -> None:
    """A small mesh, by the same method, so that everything is compiled."""
    points, triangles = TRIANGULATIONS["random-mesh"](60, 0)
    if builder in METHODS:
        improve_mesh(Mesh.of(points, triangles), METHODS[builder])


def measure(task: Task, *, repeat: int, workers: int | None) -> Measured:
    """Time the case of a task, in the present process, ``repeat`` times.

    Raises:
        UnsteadyResult: two repeats gave different meshes.
    """
    warming = seconds_of(warm_up, task.builder, task.n)
    points, triangles = TRIANGULATIONS[task.family](task.n, task.seed)
    mesh = Mesh.of(points, triangles)
    smooth = SMOOTHERS.get(task.builder)

    def run(given: Mesh) -> Any:
        if smooth is None:
            return improve_mesh(given, METHODS[task.builder], workers=workers)
        return smooth(given.points, given.triangles)

    timings, found = timed(
        prepare=lambda: mesh,
        run=run,
        essence=lambda result: (
            result.points.tobytes() if smooth is None else len(result)  # theirs may vary
        ),
        repeat=repeat,
    )
    memory = peak_mib()  # now: what follows needs some of its own
    after, corners = (found.points, found.triangles) if smooth is None else (found, mesh.triangles)
    inverted = int((orientations(*(after[corners[:, k]] for k in range(3))) <= 0).sum())
    if smooth is not None and not np.allclose(after[mesh.fixed], points[mesh.fixed], atol=1e-6):
        inverted = len(corners)  # it has moved the boundary: that is another task
    seconds = statistics.median(timings)
    fixed = smooth is not None or METHODS[task.builder].topology == "fixed"
    return Measured(
        timings=timings,
        amount=found.moves if smooth is None else len(mesh.free),
        counts=None,
        workers=workers or len(os.sched_getaffinity(0)),
        peak_mib=memory,
        warm_up=warming,
        facts={
            "smallest_before": quality_of(points, mesh.triangles).smallest,
            **quality_of(after, corners).as_dict(),
            "bound": upper_bound(after, corners) if fixed and not inverted else None,
            "inverted": inverted,
            "visits_per_second": found.visits / seconds if smooth is None else None,
            "target_smallest": _ANGLES.get((task.builder, task.family, task.n, task.seed)),
        },
        proven=inverted == 0,
    )


_ANGLES = {
    (case.by, case.family, case.n, case.seed): case.target.smallest
    for case in CASES
    if isinstance(case.target, AngleTarget)
}


BENCHMARK = Benchmark(
    name="mesh",
    unit="moves",
    cases=CASES,
    quick=QUICK,
    comparisons=(),
    facts=FACTS,
    measure=measure,
    warm_up=warm_up,
    limits=Limits(seconds=600, mib=8192),
)
