"""Run a benchmark: one instance after the other, each in a process of its own."""

from __future__ import annotations

import contextlib
import functools
import threading
from collections import Counter
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.bench.rows import bench_row
from harness.bench.store import Store
from harness.bench.timing import first_call
from harness.errors import UserError
from harness.study.engines import run_local
from harness.study.interrupt import interruptible
from harness.study.lock import locked
from harness.study.progress import Progress

if TYPE_CHECKING:
    from harness.bench.benchmark import Benchmark, Case, Measured
    from harness.study.outcome import Outcome
    from harness.study.schema import Record
    from harness.study.task import Task

FAILURES = "failures.log"


@dataclass(frozen=True)
class Settings:
    """How to run.

    ``repeat``: timings of each instance.  ``workers``: of the builder; None leaves it to the
    builder.  ``compile_anew``: also find out how long compiling everything takes.  ``command``:
    what the manifest is to say.
    """

    builder: str
    repeat: int
    workers: int | None
    compile_anew: bool
    command: str


@dataclass(frozen=True)
class Summary:
    """What a run found: rows in the order of the benchmark, and what stands under the table.

    ``ratios``: one for each of the benchmark's comparisons, None if it cannot be told.
    ``compiling`` and ``loading``: seconds before the first diagram in a fresh interpreter, with
    nothing compiled before and with everything compiled; None where not measured.
    """

    rows: list[Record]
    ratios: tuple[float | None, ...]
    compiling: float | None
    loading: float | None
    missing: list[str]

    @property
    def failed(self) -> list[Record]:
        """The rows without timings."""
        return [row for row in self.rows if row["status"] != "ok"]


def run_benchmark(
    benchmark: Benchmark,
    cases: Sequence[Case],
    directory: Path,
    settings: Settings,
    show: Callable[[Record], None],
) -> Summary:
    """Measure the cases one by one; store each row, and ``show`` it, as soon as it is there.

    SIGINT, SIGTERM and SIGHUP end the run early with every row kept; ``missing`` in the summary
    then names the cases without one.

    Raises:
        UserError: the directory holds something else or is in use; see :class:`Store`.
    """
    if directory.exists() and not directory.is_dir():
        raise UserError(f"{directory}: is not a directory")
    directory.mkdir(parents=True, exist_ok=True)
    with locked(directory), interruptible() as stop:
        store = Store(directory, benchmark, _recorded(settings))
        rows: list[Record] = []
        found: dict[str, Measured] = {}
        try:
            compiling, loading = _first_calls(benchmark, cases, settings, stop)
            store.note(compiling_seconds=compiling, loading_seconds=loading)
            with contextlib.closing(_run(benchmark, cases, settings, stop)) as results:
                for case, task, outcome in results:
                    # The engine carries what `measure` returns and never looks into it.
                    measured: Measured | None = outcome.measurement
                    if measured is not None:
                        found[case.name] = measured
                    row = bench_row(benchmark, case, task, outcome, measured, store.run)
                    store.put(row)
                    _log_failure(directory, case, outcome)
                    rows.append(row)
                    show(row)
            ratios = tuple(comparison.ratio(found) for comparison in benchmark.comparisons)
            store.note(comparisons=_told(benchmark, ratios))
        finally:
            store.end(interrupted=len(rows) < len(cases))
    missing = [case.name for case in cases[len(rows) :]]
    return Summary(rows, ratios, compiling, loading, missing)


def _recorded(settings: Settings) -> dict[str, Any]:
    """The settings as the manifest has them."""
    return {
        "command": settings.command,
        "builder": settings.builder,
        "repeat": settings.repeat,
        "workers": settings.workers,
    }


def _first_calls(
    benchmark: Benchmark, cases: Sequence[Case], settings: Settings, stop: threading.Event
) -> tuple[float | None, float | None]:
    """Seconds of compiling (if asked for) and of loading.

    Calling twice makes sure that everything is compiled and kept: the second time, and in the
    processes that are measured, it is only loaded.
    """
    call = functools.partial(
        first_call,
        benchmark.warm_up,
        settings.builder,
        max(case.n for case in cases),
        stop=stop,
    )
    compiling = call(anew=True) if settings.compile_anew else None
    call(anew=False)
    return compiling, call(anew=False)


def _run(
    benchmark: Benchmark, cases: Sequence[Case], settings: Settings, stop: threading.Event
) -> Generator[tuple[Case, Task, Outcome]]:
    """Run the cases in order and tell on standard error how far it is."""
    tasks = [case.task(settings.builder) for case in cases]
    work = functools.partial(benchmark.measure, repeat=settings.repeat, workers=settings.workers)
    results = run_local(tasks, work, benchmark.limits, 1, stop)
    statuses: Counter[str] = Counter()
    with (
        Progress(f"bench {benchmark.name}", len(tasks), statuses) as progress,
        contextlib.closing(results),
    ):
        for case, (task, outcome) in zip(cases, results, strict=False):  # it may end early
            statuses[outcome.status] += 1
            progress.update(statuses)
            yield case, task, outcome


def _told(benchmark: Benchmark, ratios: Sequence[float | None]) -> list[dict[str, Any]]:
    """The comparisons that could be made, as the manifest has them."""
    return [
        {
            "large": comparison.large,
            "small": comparison.small,
            "ratio": round(ratio, 4),
            "to_be_below": comparison.most,
            "reached": comparison.is_reached(ratio),
        }
        for comparison, ratio in zip(benchmark.comparisons, ratios, strict=True)
        if ratio is not None
    ]


def _log_failure(directory: Path, case: Case, outcome: Outcome) -> None:
    """Keep the traceback, or the last words, of a process that failed."""
    if outcome.status != "ok":
        lines = [f"{case.name} {outcome.status}: {outcome.message}", outcome.detail]
        with open(directory / FAILURES, "a", encoding="utf-8") as log:
            log.write("\n".join(lines) + "\n")
