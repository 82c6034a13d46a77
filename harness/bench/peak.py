"""The benchmark ``peak``: points of best visual angle, from coordinates in memory to the proof."""

from __future__ import annotations

import math
import os
import statistics
from typing import TYPE_CHECKING, Any

import numpy as np

import generators
from harness.bench.benchmark import Benchmark, Case, Comparison, Fact, Measured, Target
from harness.bench.optimisers import OPTIMISERS
from harness.bench.timing import seconds_of, timed
from harness.geometry.instance import Instance
from harness.geometry.visual_angle import visual_angle
from harness.peak import peak, peaks
from harness.peak.candidates import FEW
from harness.peak.result import METHODS, WIDTH
from harness.study.limits import Limits, peak_mib

if TYPE_CHECKING:
    from harness.peak.batch import Floats
    from harness.peak.result import Peak
    from harness.study.task import Task

BATCH = 10**6
DRAWN = 4096
"""A batch is made of so many cavities, each in many positions."""
_HEXAGONS = 6 * 300_000.0  # sides a second: 300,000 peaks of hexagons

CASES = (
    *(
        Case(f"lp-star-1e{k}", "star", 10**k, "kernel", by="lp", target=target)
        for k, target in (
            *((2, Target()), (3, Target()), (4, Target()), (5, Target())),
            (6, Target(seconds=1)),
        )
    ),
    *(
        Case(f"lp-near-regular-1e{k}", "near-regular", 10**k, "kernel", by="lp", target=target)
        for k, target in ((4, Target()), (5, Target()), (6, Target(seconds=1)))
    ),
    Case("batch-1e6", "cavity", 6, "kernel", by="batch", target=Target(rate=_HEXAGONS)),
    *(
        Case(f"parametric-{family}-1e{k}", family, 10**k, "kernel", by="parametric")
        for family in ("star", "near-regular")
        for k in (2, 3, 4)
    ),
    Case("diagram-near-regular-8", "near-regular", 8, "kernel", by="diagram"),
    Case("diagram-near-regular-100", "near-regular", 100, "kernel", by="diagram"),
    *(
        Case(f"{by}-{family}-{n}", family, n, "kernel", by=by)
        for family, n in (("cavity", 6), ("star", 12), ("near-regular", 100))
        for by in (*OPTIMISERS, "lp")
    ),
)
"""Optimisers of general purpose stand beside ``lp`` on the same instance."""

QUICK = (
    Case("lp-star-6", "star", 6, "kernel", by="lp"),
    Case("lp-star-600", "star", 600, "kernel", by="lp"),
    Case("parametric-star-6", "star", 6, "kernel", by="parametric"),
    Case("diagram-star-5", "star", 5, "kernel", by="diagram"),
    *(Case(f"{by}-star-5", "star", 5, "kernel", by=by) for by in OPTIMISERS),
)

COMPARISONS = (
    Comparison("lp-star-1e6", "lp-star-1e4", most=2.0),
    Comparison("lp-near-regular-1e6", "lp-near-regular-1e4", most=2.0),
    Comparison("lp-star-600", "lp-star-6"),
)

FACTS = (
    Fact("peaks_per_second", "peaks/s", ".0f"),
    Fact("angle", "angle", ".9g"),
    Fact("short_of_optimum", "short of it", ".1e"),
    Fact("rounds", "rounds", "d"),
    Fact("decisions", "decisions", "d"),
    Fact("comparisons", "comparisons", "d"),
    Fact("comparisons_per_nlog2n", "/ n log² n", ".3f"),
    Fact("evaluations", "evaluations", "d"),
)
"""``angle``: the least visual angle reached, the least of a batch; ``short_of_optimum``: by how
much an optimiser misses the proven angle, for the others the width of the enclosure; the rest is
what the methods did."""


def warm_up(builder: str, n: int) -> None:
    """One small polygon by every method, one large, and a batch, so that everything is compiled.

    Diagrams of more than a few edges have a builder of their own, which takes a minute to compile.
    """
    small = Instance.from_generated(generators.generate("star", 6))
    for method in METHODS:
        peak(small, method)
    peak(Instance.from_generated(generators.generate("star", 2000)))
    peaks(small.floats[np.newaxis])
    if builder == "diagram" and n > FEW:
        peak(Instance.from_generated(generators.generate("star", FEW + 1)), "diagram")


def measure(task: Task, *, repeat: int, workers: int | None) -> Measured:
    """Time the case of a task, in the present process, ``repeat`` times.

    ``workers``: threads of a batch; everything else uses one.

    Raises:
        UnsteadyResult: two repeats reached different angles.
    """
    warming = seconds_of(warm_up, task.builder, task.n)
    if task.builder == "batch":
        return _measured_batch(task, repeat, workers, warming)
    generated = generators.generate(task.family, task.n, task.seed, **dict(task.params))
    solve = OPTIMISERS.get(task.builder)

    def run(instance: Instance) -> Any:
        return peak(instance, task.builder) if solve is None else solve(instance)

    timings, found = timed(
        prepare=lambda: Instance.from_generated(generated),
        run=run,
        essence=lambda result: (result.x, result.y),
        repeat=repeat,
    )
    facts = dict.fromkeys([fact.column for fact in FACTS])
    memory = peak_mib()  # now: what follows needs some of its own
    told = _told(task.n, found) if solve is None else _missed(generated, found)
    return Measured(
        timings=timings,
        amount=task.n,
        counts=None,
        workers=1,
        peak_mib=memory,
        warm_up=warming,
        facts={**facts, "peaks_per_second": 1 / statistics.median(timings), **told},
        proven=solve is None,
    )


def _told(n: int, found: Peak) -> dict[str, float | None]:
    """What a method says of itself."""
    facts: dict[str, float | None] = {
        "angle": found.angle,
        "short_of_optimum": found.upper - found.lower,
        **{key: found.facts.get(key) for key in ("rounds", "decisions", "comparisons")},
    }
    if "comparisons" in found.facts:
        facts["comparisons_per_nlog2n"] = found.facts["comparisons"] / (n * math.log2(n) ** 2)
    return facts


def _missed(generated: Any, found: Any) -> dict[str, float | None]:
    """How far an optimiser has come."""
    instance = Instance.from_generated(generated)
    angle = float(visual_angle((found.x, found.y), instance.segments).min())
    return {
        "angle": angle,
        "short_of_optimum": peak(instance).angle - angle,
        "evaluations": found.evaluations,
    }


def _measured_batch(task: Task, repeat: int, workers: int | None, warming: float) -> Measured:
    """The case of many small polygons; amounts are sides."""
    polygons = cavities(task.family, task.n, BATCH)
    timings, found = timed(
        prepare=lambda: polygons,
        run=lambda vertices: peaks(vertices, workers=workers),
        essence=lambda result: float(np.nansum(result.angles)),
        repeat=repeat,
    )
    widths = found.bounds - found.angles
    facts = dict.fromkeys([fact.column for fact in FACTS])
    return Measured(
        timings=timings,
        amount=task.n * len(polygons),
        counts=None,
        workers=workers or len(os.sched_getaffinity(0)),
        peak_mib=peak_mib(),
        warm_up=warming,
        facts={
            **facts,
            "peaks_per_second": len(polygons) / statistics.median(timings),
            "angle": float(found.angles.min()),
            "short_of_optimum": float(widths.max()),
        },
        proven=bool((widths <= WIDTH).all()),
    )


def cavities(family: str, n: int, count: int) -> Floats:
    """Polygons (count, n, 2): some of a family, each turned, scaled and moved at random.

    ``DRAWN`` different ones at most, as drawing a million takes ten minutes.  The positions are
    different for every polygon, so no two problems are the same in doubles.
    """
    drawn = np.array(
        [generators.generate(family, n, seed).coordinates for seed in range(min(count, DRAWN))]
    )
    rng = np.random.default_rng(0)
    turn, size = rng.uniform(0, 2 * np.pi, count), rng.uniform(0.5, 2.0, count)
    a, b = (size * np.cos(turn))[:, np.newaxis], (size * np.sin(turn))[:, np.newaxis]
    shapes = drawn[np.arange(count) % len(drawn)]
    x, y = shapes[..., 0], shapes[..., 1]
    moved = rng.uniform(-1, 1, (count, 1, 2))
    return np.asarray(np.stack([a * x - b * y, b * x + a * y], axis=-1) + moved)


BENCHMARK = Benchmark(
    name="peak",
    unit="sides",
    cases=CASES,
    quick=QUICK,
    comparisons=COMPARISONS,
    facts=FACTS,
    measure=measure,
    warm_up=warm_up,
    limits=Limits(seconds=600, mib=8192),
)
