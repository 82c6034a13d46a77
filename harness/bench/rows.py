"""The row of one instance: a row of a study with the benchmark's columns added."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING, Any

from harness.study.outcome import COLUMNS, Measurement, row_of
from harness.study.schema import Record

if TYPE_CHECKING:
    from harness.bench.benchmark import Benchmark, Case, Measured
    from harness.study.outcome import Outcome
    from harness.study.task import Task

NAME = "instance"
"""The column of the instance's name; one row for each."""

_TEXTS = frozenset(
    {NAME, "task", "family", "domain", "objective", "builder", "status", "message"},
)
"""The columns that hold text; the cells of all others are JSON, or empty."""


def columns_of(benchmark: Benchmark) -> tuple[str, ...]:
    """The columns of a benchmark's rows, in order."""
    return (
        NAME,
        *COLUMNS,
        *([] if benchmark.unit in COLUMNS else [benchmark.unit]),
        "timings",
        benchmark.rate_column,
        *(fact.column for fact in benchmark.facts),
        "workers",
        "warm_up_seconds",
        "target_rate",
        "target_seconds",
        "target_mib",
        "reached",
        "run",
    )


def bench_row(
    benchmark: Benchmark,
    case: Case,
    task: Task,
    outcome: Outcome,
    measured: Measured | None,
    run: int,
) -> Record:
    """The row of a case, as text, with every column.

    ``outcome``: how the task's process ended; the counts, the median of the seconds and the peak
    memory come from ``measured``.  ``run``: the number of the run in the manifest.
    """
    values: dict[str, Any] = {
        "target_rate": case.target.rate,
        "target_seconds": case.target.seconds,
        "target_mib": case.target.mib,
        "reached": case.target.is_reached(measured),
        "run": run,
    }
    study_outcome = dataclasses.replace(outcome, measurement=None)
    if measured is not None:
        values |= {
            "timings": list(measured.timings),
            benchmark.rate_column: measured.per_second,
            **measured.facts,
            "workers": measured.workers,
            "warm_up_seconds": measured.warm_up,
        }
        if measured.counts is None:
            values |= {
                benchmark.unit: measured.amount,
                "certified": measured.is_certified,
                "seconds": measured.seconds,
            }
            measurement = None
        else:
            measurement = Measurement(measured.counts, measured.seconds)
        study_outcome = dataclasses.replace(
            outcome, measurement=measurement, peak_mib=measured.peak_mib
        )
    return {
        **dict.fromkeys(columns_of(benchmark), ""),
        NAME: case.name,
        **row_of(task, study_outcome),
        **{column: _cell(value) for column, value in values.items()},
    }


def values_of(record: Record) -> dict[str, Any]:
    """The row with typed values: None where a cell is empty, JSON decoded, text elsewhere."""
    return {
        column: cell if column in _TEXTS else json.loads(cell) if cell else None
        for column, cell in record.items()
    }


def _cell(value: Any) -> str:
    """A number, a list of numbers, a truth value or nothing as a cell."""
    return "" if value is None else json.dumps(_rounded(value))


def _rounded(value: Any) -> Any:
    """Microseconds, and no digits beyond that anybody could mean; nine digits of small numbers."""
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    if isinstance(value, float):
        return round(value, 6) if abs(value) >= 1 else float(f"{value:.9g}")
    return value
