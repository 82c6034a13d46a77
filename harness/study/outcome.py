"""What became of a task, and its row."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from harness.diagram.counts import NODE_KINDS
from harness.study.schema import SCHEMA, Record

if TYPE_CHECKING:
    from harness.diagram.counts import Counts
    from harness.study.task import Task

Status = Literal["ok", "timeout", "memory", "error", "invalid"]

STATUSES: tuple[Status, ...] = ("ok", "timeout", "memory", "error", "invalid")
"""``timeout`` and ``memory``: stopped at the study's limit.  ``invalid``: the input was refused
(by the generator, the validation or the builder).  ``error``: anything else went wrong."""

COUNT_COLUMNS = (
    "cells",
    "edges",
    "vertices",
    "regions",
    "loops",
    "components",
    "unbounded",
    "boundary_points",
    *NODE_KINDS,
)

COLUMNS = (
    "task",
    "schema",
    "family",
    "n",
    "segments",
    "params",
    "replicate",
    "seed",
    "domain",
    "objective",
    "builder",
    "status",
    "message",
    *COUNT_COLUMNS,
    "degrees",
    "certified",
    "seconds",
    "peak_mib",
)

VARYING_COLUMNS = ("seconds", "peak_mib")
"""The columns that differ between two runs of one study; all others are the same, always."""

_ADDRESS = re.compile(r"0x[0-9a-fA-F]{6,}")


@dataclass(frozen=True)
class Measurement:
    """A finished diagram: its counts and the seconds that building alone took."""

    counts: Counts
    seconds: float


@dataclass(frozen=True)
class Outcome:
    """How a task ended.

    ``measurement``: what the task's work has returned, a ``Measurement`` in studies of diagrams;
    there exactly if ``status`` is "ok".  ``peak_mib``: the greatest resident
    memory of the task's process, if it is known.  ``detail``: a traceback or what the process
    wrote before it died, for the failure log.
    """

    status: Status
    message: str = ""
    measurement: Any = None
    peak_mib: float | None = None
    detail: str = ""


def row_of(task: Task, outcome: Outcome) -> Record:
    """The row of a task, as text, with every column."""
    record = dict.fromkeys(COLUMNS, "")
    record.update(
        task=task.key,
        schema=str(SCHEMA),
        family=task.family,
        n=str(task.n),
        params=task.params_json,
        replicate=str(task.replicate),
        seed=str(task.seed),
        domain=task.domain,
        objective=task.objective,
        builder=task.builder,
        status=outcome.status,
        message=one_line(outcome.message),
    )
    if outcome.measurement is not None:
        record.update(_measured(outcome.measurement))
    if outcome.peak_mib is not None:
        record["peak_mib"] = f"{outcome.peak_mib:.1f}"
    return record


def _measured(measurement: Measurement) -> Record:
    values = measurement.counts.as_dict()
    values.update(values["nodes"])
    return {
        "segments": str(values["n"]),
        **{column: str(values[column]) for column in COUNT_COLUMNS},
        "degrees": json.dumps(values["degrees"], separators=(",", ":")),
        "certified": "true" if values["certified"] else "false",
        "seconds": f"{measurement.seconds:.6f}",
    }


def one_line(message: str) -> str:
    """The message on one line, without the memory addresses that differ from run to run."""
    return _ADDRESS.sub("0x…", " ".join(message.split()))
