"""The benchmark ``diagram``: building diagrams, from coordinates in memory to counts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import generators
from harness.bench.benchmark import Benchmark, Case, Comparison, Fact, Measured, Target
from harness.bench.timing import seconds_of, timed
from harness.diagram import build
from harness.diagram.checks import InsaneMap
from harness.diagram.identities import broken_identity
from harness.geometry.compiling import LARGE
from harness.geometry.instance import Instance
from harness.geometry.kernel import kernel
from harness.study.limits import Limits, peak_mib
from harness.study.task import Scalar

if TYPE_CHECKING:
    from harness.diagram.counts import Counts
    from harness.diagram.planar_map import PlanarMap
    from harness.diagram.work import Work
    from harness.study.task import Task

_NOISE: dict[str, Scalar] = {"noise": 1e-3, "noise_power": 3}  # relative, 10⁻³/n³
_ZIGZAG: dict[str, Scalar] = {"tilt": math.pi / 6, **_NOISE}

CASES = (
    Case("zigzag-1024", "zigzag", 1024, "kernel", _ZIGZAG, target=Target(rate=30_000, mib=2048)),
    Case("zigzag-128", "zigzag", 128, "kernel", _ZIGZAG),
    Case("zigzag-2048", "zigzag", 2048, "kernel", _ZIGZAG),
    Case(
        "weave-512",
        "convex-weave",
        512,
        "kernel",
        {"delta": 0.9, **_NOISE},
        target=Target(rate=10_000),
    ),
    Case("star-1e6", "star", 10**6, "kernel", target=Target(seconds=3)),
    Case("near-regular-1e5", "near-regular", 10**5, "kernel", target=Target(seconds=30)),
    Case(
        "grid-1000",
        "grid",
        1000,
        "plane",
        {"variant": "generic"},
        target=Target(seconds=60, mib=4096),
    ),
    Case("square-grid-64", "grid", 64, "plane", {"variant": "regular"}, target=Target(seconds=60)),
    Case(
        "regular-zigzag-128",
        "zigzag",
        128,
        "kernel",
        {**_ZIGZAG, "noise": 0},
        target=Target(seconds=60),
    ),
    Case("segments-1000", "segments", 1000, "plane"),
    Case("star-interior-1024", "star", 1024, "interior"),
)
"""Those without a target are there to be compared with others, or with themselves later."""

QUICK = (
    Case("zigzag-6", "zigzag", 6, "kernel"),
    Case("zigzag-8", "zigzag", 8, "kernel"),
    Case("square-grid-4", "grid", 4, "plane"),
    Case("star-interior-4", "star", 4, "interior"),
)

COMPARISONS = (
    Comparison("zigzag-2048", "zigzag-128", most=1.5),
    Comparison("zigzag-8", "zigzag-6"),
)

FACTS = (
    Fact("triangles", "triangles", "d"),
    Fact("triangles_per_vertex", "per vertex", ".2f"),
    Fact("leaves", "leaves", "d"),
    Fact("share_floats", "floats", ".2%"),
    Fact("share_balls", "balls", ".2%"),
    Fact("share_exact", "exact", ".2%"),
)
"""The triangles that were looked at are the unit of work; the shares are those of the leaves
decided by the float filter, by ball arithmetic and by exact arithmetic."""

_FIRST = (("zigzag", 6, "kernel"), ("star", 4, "interior"), ("grid", 4, "plane"))


def warm_up(builder: str, n: int) -> None:
    """Build one tiny diagram in each domain, so that everything is compiled.

    Kernels of large polygons have compiled loops of their own, so one such kernel is computed
    if n is large.
    """
    for family, size, domain in _FIRST:
        _built(Instance.from_generated(generators.generate(family, size)), domain, builder)
    if n >= LARGE:  # each of the loops sees about half of the edges
        kernel(Instance.from_generated(generators.generate("near-regular", 4 * LARGE)))


def measure(task: Task, *, repeat: int, workers: int | None) -> Measured:
    """Time building the diagram of a task, in the present process, ``repeat`` times.

    ``workers``: how many the builder is to use; None leaves it to the builder.

    Raises:
        InsaneMap: Euler's identity, or another that holds for all counts, fails.
        UnsteadyResult: two repeats counted differently.
    """
    warming = seconds_of(warm_up, task.builder, task.n)
    generated = generators.generate(task.family, task.n, task.seed, **dict(task.params))
    options = {} if workers is None else {"workers": workers}
    timings, (diagram, counts) = timed(
        prepare=lambda: Instance.from_generated(generated),
        run=lambda instance: _built(
            instance, task.domain, task.builder, objective=task.objective, **options
        ),
        essence=lambda built: str(built[1].as_dict()),
        repeat=repeat,
    )
    peak = peak_mib()
    broken = broken_identity(counts)
    if broken is not None:
        raise InsaneMap(f"{task.family}, n = {task.n}: {broken}")
    work: Work | None = getattr(diagram, "work", None)  # the reference builder does not tell
    return Measured(
        timings=timings,
        amount=counts.vertices,
        counts=counts,
        workers=work.workers if work is not None else workers or 1,
        peak_mib=peak,
        warm_up=warming,
        facts=_facts(work, counts.vertices),
    )


def _built(
    instance: Instance, domain: str, builder: str, **options: Any
) -> tuple[PlanarMap, Counts]:
    """The diagram and its counts, which the map makes when first asked."""
    make: Callable[..., PlanarMap] = build  # the options are the builder's to refuse
    diagram = make(instance, domain, builder=builder, **options)
    return diagram, diagram.counts


def _facts(work: Work | None, vertices: int) -> dict[str, float | None]:
    """The columns ``FACTS``."""
    if work is None:
        return {fact.column: None for fact in FACTS}
    return {
        "triangles": work.triangles,
        "triangles_per_vertex": _share(work.triangles, vertices),
        "leaves": work.leaves,
        "share_floats": _share(work.by_floats, work.leaves),
        "share_balls": _share(work.by_balls, work.leaves),
        "share_exact": _share(work.exactly, work.leaves),
    }


def _share(part: int, whole: int) -> float | None:
    return part / whole if whole else None


BENCHMARK = Benchmark(
    name="diagram",
    unit="vertices",
    cases=CASES,
    quick=QUICK,
    comparisons=COMPARISONS,
    facts=FACTS,
    measure=measure,
    warm_up=warm_up,
    limits=Limits(seconds=1800, mib=12288),  # the targets allow 5 × 60 s and 4 GiB
)
