"""Run the study of meshes: as :mod:`harness.study.runner`, for tasks and rows of its own."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from harness.errors import UserError
from harness.study.engines import Results, check_dask, run_dask, run_local
from harness.study.interrupt import interruptible
from harness.study.lock import locked
from harness.study.manifest import RunRecord, read_manifest, was_killed
from harness.study.mesh_rows import append_row, read_meshes, write_rows
from harness.study.meshes import (
    DESCRIPTION,
    LIMITS,
    NAME,
    SEEDS,
    MeshTask,
    measure,
    row_of,
    tasks,
)
from harness.study.processors import default_jobs
from harness.study.progress import Progress
from harness.study.runner import Engine, Mode, Summary, claim, log_failure, move_to_earlier
from harness.study.store import ROWS

if TYPE_CHECKING:
    from harness.study.limits import Limits


@dataclass(frozen=True)
class MeshStudy:
    """What the manifest tells of this study."""

    tasks: Sequence[MeshTask]
    name: str = NAME
    description: str = DESCRIPTION
    base_seed: int = 0
    limits: Limits = LIMITS


def run_meshes(
    directory: Path,
    *,
    mode: Mode = "new",
    jobs: int | None = None,
    engine: Engine = "local",
    scheduler: str | None = None,
    command: str = "avd study mesh",
    resume_command: str = "--resume",
    todo: Sequence[MeshTask] | None = None,
) -> Summary:
    """Run the tasks without a row, ``jobs`` at a time, and store each row at once.

    The parameters are those of :func:`harness.study.runner.run_study`; ``todo``: the tasks
    (default: all).  The rows do not depend on ``jobs``, but for their order in the file.

    Raises:
        UserError: the directory is in use, unfinished (mode "new"), or not this study's.
    """
    if engine == "dask":
        check_dask()
    chosen = tasks() if todo is None else todo
    claim(directory)
    with locked(directory):
        if mode == "fresh":
            move_to_earlier(directory)
        manifest = read_manifest(directory)  # refuses a newer one before anything is written
        path = directory / ROWS
        rows = read_meshes(directory) if path.exists() else []
        keys = {task.key for task in chosen}
        kept = [
            row
            for row in rows
            if row["task"] in keys and (mode != "retry" or row["status"] == "ok")
        ]
        missing = [task for task in chosen if task.key not in {row["task"] for row in kept}]
        statuses = Counter(row["status"] for row in kept)
        if not missing and not was_killed(manifest):
            return Summary(directory, len(chosen), statuses, 0, False)
        if mode == "new" and rows and missing:
            raise UserError(
                f"{directory} holds {len(kept)} of the {len(chosen)} tasks of this study; "
                f"continue with: {resume_command} (or start anew with --fresh in place of --resume)"
            )
        write_rows(path, kept)
        jobs = jobs or default_jobs()
        study = MeshStudy(chosen)
        record = RunRecord(directory, study, command=command, engine=engine, jobs=jobs, seeds=SEEDS)
        with interruptible() as stop:
            if engine == "dask":
                results = run_dask(missing, measure, LIMITS, jobs, stop, scheduler)
            else:
                results = run_local(missing, measure, LIMITS, jobs, stop)
            added = _store(directory, results, record, statuses, len(chosen))
            return Summary(directory, len(chosen), statuses, added, stop.is_set())


def _store(
    directory: Path,
    results: Results[MeshTask],
    record: RunRecord,
    statuses: Counter[str],
    total: int,
) -> int:
    """Store the results as they come; the manifest is written however it ends."""
    added = 0
    record.start(statuses)
    try:
        with Progress(f"study {NAME}", total, statuses) as progress, contextlib.closing(results):
            for task, outcome in results:
                append_row(directory / ROWS, row_of(task, outcome))
                log_failure(
                    directory, f"{task.key} {task.method} {task.family} n={task.n}", outcome
                )
                added += 1
                statuses[outcome.status] += 1
                progress.update(statuses)
    finally:
        record.end(statuses, tasks=added, interrupted=statuses.total() < total)
    return added
