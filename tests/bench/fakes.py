"""A benchmark whose instances cost nothing, and measurements that go wrong, for tests."""

from __future__ import annotations

import dataclasses
import os
import time
from pathlib import Path

from harness.bench.benchmark import Benchmark, Case, Comparison, Measured, Target
from harness.bench.diagram import BENCHMARK
from harness.study.limits import Limits
from harness.study.task import Task
from tests.study import fakes


def measured(task: Task, *, repeat: int, workers: int | None) -> Measured:
    """Numbers that depend on the arguments and on nothing else; n = 13 fails."""
    if task.n == 13:
        raise ValueError("planned failure")
    counts = dataclasses.replace(fakes.quick(task).counts, vertices=10 * task.n, certified=True)
    return Measured(
        timings=tuple(0.001 * task.n * (1 + k) for k in reversed(range(repeat))),
        amount=counts.vertices,
        counts=counts,
        workers=workers or 7,
        peak_mib=10.0 * task.n,
        warm_up=0.25,
        facts={
            "triangles": 30 * task.n,
            "triangles_per_vertex": 3.0,
            "leaves": 20 * task.n,
            "share_floats": 0.75,
            "share_balls": 0.25,
            "share_exact": 0.0,
        },
    )


def nothing(_builder: str, _n: int) -> None:
    """A warm-up for which there is nothing to do."""


NO_TARGET = Target()


def benchmark(*sizes: int, target: Target = NO_TARGET) -> Benchmark:
    """The benchmark ``diagram`` with stars of these sizes, called s3, s4, … and fake numbers."""
    return dataclasses.replace(
        BENCHMARK,
        cases=tuple(Case(f"s{n}", "star", n, "kernel", target=target) for n in sizes),
        quick=(),
        comparisons=(Comparison(f"s{sizes[-1]}", f"s{sizes[0]}", most=2.0),),
        measure=measured,
        warm_up=nothing,
        limits=Limits(seconds=60, mib=1024),
    )


def report_cache(path: str) -> None:
    """Write into the file ``path`` where Numba is to keep code, and what is there already."""
    directory = os.environ.get("NUMBA_CACHE_DIR", "")
    there = os.listdir(directory) if directory else []
    Path(path).write_text(f"{directory}\n{there}")


def fail() -> None:
    """Goes wrong."""
    raise ValueError("planned failure")


def die() -> None:
    """Ends the process without a word."""
    os._exit(7)


def rest() -> None:
    """Takes an hour."""
    time.sleep(3600)
