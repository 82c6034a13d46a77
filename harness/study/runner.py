"""Run a study: find out what is still to do, do it, keep every row the moment it is there.

A study's directory holds::

    study.toml       the study file, verbatim, as of the last run
    manifest.json    where the rows come from (``manifest``)
    rows.csv         a row for each finished task: in the order of completion while tasks are
                     missing, in that of the study once it is complete (``store``)
    rows-aside.csv   rows of tasks that left the study or were run again
    failures.log     tracebacks and last words of the tasks that failed
    earlier/         what ``--fresh`` moved out of the way
"""

from __future__ import annotations

import contextlib
import os
import threading
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from harness.errors import UserError
from harness.files import replace
from harness.study.engines import Results, check_dask, run_dask, run_local
from harness.study.interrupt import interruptible
from harness.study.isolate import Work
from harness.study.lock import LOCK, locked
from harness.study.manifest import MANIFEST, RunRecord, read_manifest, was_killed
from harness.study.outcome import Outcome, one_line, row_of
from harness.study.processors import default_jobs
from harness.study.progress import Progress
from harness.study.schema import Record
from harness.study.store import ASIDE, ROWS, RowFile, read_rows, replace_rows, set_aside
from harness.study.study_file import Study
from harness.study.task import Task
from harness.study.worker import execute

STUDY = "study.toml"
FAILURES = "failures.log"
EARLIER = "earlier"

Mode = Literal["new", "resume", "retry", "fresh"]
"""``new``: refuse to touch an unfinished study.  ``resume``: run the tasks that have no row.
``retry``: these, and those whose row is not "ok".  ``fresh``: all, moving what is there aside."""

Engine = Literal["local", "dask"]


@dataclass(frozen=True)
class Summary:
    """What a run left: the rows of each status, how many it added, whether it was cut short."""

    directory: Path
    total: int
    statuses: Counter[str]
    added: int
    interrupted: bool

    @property
    def missing(self) -> int:
        """Tasks without a row."""
        return self.total - sum(self.statuses.values())

    @property
    def failed(self) -> int:
        """Rows whose status is not "ok"."""
        return sum(self.statuses.values()) - self.statuses["ok"]


def run_study(
    study: Study,
    directory: Path,
    *,
    mode: Mode = "new",
    jobs: int | None = None,
    engine: Engine = "local",
    scheduler: str | None = None,
    command: str = "",
    resume_command: str = "--resume",
    work: Work[Task] = execute,
) -> Summary:
    """Run what is left of a study and return how it stands.

    ``jobs`` tasks run at a time (default: one for each processor).  ``command`` is recorded in
    the manifest; ``resume_command`` is what an error tells the user to type.  ``work`` is what
    is done for a task.  SIGINT, SIGTERM and SIGHUP end the run early with every row kept.

    Raises UserError if the directory is unfinished (mode "new"), is somebody else's, is being
    written by another run or was written by a newer program; if Dask is not installed.
    """
    if engine == "dask":
        check_dask()
    claim(directory)
    with locked(directory):
        if mode == "fresh":
            move_to_earlier(directory)
        manifest = read_manifest(directory)  # refuses a newer one before anything is written
        plan = _plan(study, directory, retry=mode == "retry")
        if mode == "new" and plan.kept and not plan.is_noop:
            raise UserError(_unfinished(study, directory, plan, resume_command))
        text = study.text.encode()
        same = plan.is_noop and _read(directory / STUDY) == text
        unchanged = same and not was_killed(manifest)
        if not same:
            replace(directory / STUDY, text)
            set_aside(directory, plan.leaving, plan.staying)
        with RowFile(directory / ROWS) as rows:
            for row in plan.returning:
                rows.append(row)
            if unchanged:
                return Summary(directory, len(study.tasks), _statuses(rows.rows), 0, False)
            record = RunRecord(
                directory,
                study,
                command=command,
                engine=engine,
                jobs=jobs or default_jobs(),
            )
            with interruptible() as stop:
                results = _results(engine, plan.pending, work, study, jobs, stop, scheduler)
                return _run(study, directory, rows, record, results, stop)


def _run(
    study: Study,
    directory: Path,
    rows: RowFile,
    record: RunRecord,
    results: Results[Task],
    stop: threading.Event,
) -> Summary:
    """Store the results as they come; the manifest is written however it ends."""
    statuses = _statuses(rows.rows)
    before = len(rows.rows)
    finished = False
    record.start(statuses)
    try:
        # The results are closed at once, so that no task runs when the manifest is written.
        with (
            Progress(study.name, len(study.tasks), statuses) as progress,
            contextlib.closing(results),
        ):
            for task, outcome in results:
                rows.append(row_of(task, outcome))
                log_failure(directory, f"{task.key} {task.family} n={task.n}", outcome)
                statuses[outcome.status] += 1
                progress.update(statuses)
        finished = len(rows.rows) == len(study.tasks)
        if finished:
            _put_in_order(directory, study, rows.rows)
    finally:
        record.end(statuses, tasks=len(rows.rows) - before, interrupted=not finished)
    return Summary(directory, len(study.tasks), statuses, len(rows.rows) - before, stop.is_set())


def _put_in_order(directory: Path, study: Study, rows: Sequence[Record]) -> None:
    """Rows in the order of the tasks: a complete study is the same file whoever ran it."""
    place = {task.key: number for number, task in enumerate(study.tasks)}
    ordered = sorted(rows, key=lambda row: place[row["task"]])
    if ordered != list(rows):
        replace_rows(directory / ROWS, ordered)


def _results(
    engine: Engine,
    tasks: Sequence[Task],
    work: Work[Task],
    study: Study,
    jobs: int | None,
    stop: threading.Event,
    scheduler: str | None,
) -> Results[Task]:
    jobs = jobs or default_jobs()
    if engine == "dask":
        return run_dask(tasks, work, study.limits, jobs, stop, scheduler)
    return run_local(tasks, work, study.limits, jobs, stop)


@dataclass(frozen=True)
class _Plan:
    """What to do with the rows that are there, and the tasks still to run.

    ``staying`` and ``leaving`` are the rows of ``rows.csv``; ``returning`` come back from
    ``rows-aside.csv``, their task being in the study again.
    """

    staying: list[Record]
    leaving: list[Record]
    returning: list[Record]
    pending: list[Task]

    @property
    def kept(self) -> int:
        return len(self.staying) + len(self.leaving)

    @property
    def is_noop(self) -> bool:
        return not (self.pending or self.leaving or self.returning)


def _plan(study: Study, directory: Path, *, retry: bool) -> _Plan:
    """Compare the study with the rows.  Raises UserError (see ``read_rows``)."""
    wanted = {task.key for task in study.tasks}
    done: set[str] = set()
    staying: list[Record] = []
    leaving: list[Record] = []
    for row in read_rows(directory / ROWS):
        again = row["task"] in done or (retry and row["status"] != "ok")
        if row["task"] in wanted and not again:
            done.add(row["task"])
            staying.append(row)
        else:
            leaving.append(row)
    returning = {
        row["task"]: row
        for row in read_rows(directory / ASIDE)
        if row["status"] == "ok" and row["task"] in wanted - done
    }
    pending = [task for task in study.tasks if task.key not in done | returning.keys()]
    return _Plan(staying, leaving, list(returning.values()), pending)


def _unfinished(study: Study, directory: Path, plan: _Plan, resume_command: str) -> str:
    done = len(study.tasks) - len(plan.pending)
    changed = f" and {len(plan.leaving)} rows of tasks no longer in it" if plan.leaving else ""
    return (
        f"{directory} holds {done} of the {len(study.tasks)} tasks of this study{changed}; "
        f"continue with: {resume_command} (or start anew with --fresh in place of --resume)"
    )


def claim(directory: Path) -> None:
    """Make the directory, or make sure that it is a study's.  Raises UserError."""
    if directory.exists() and not directory.is_dir():
        raise UserError(f"{directory}: is not a directory")
    directory.mkdir(parents=True, exist_ok=True)
    names = {entry.name for entry in directory.iterdir()}
    if names and not names & {LOCK, ROWS, MANIFEST, STUDY}:
        raise UserError(f"{directory}: the directory is not empty and holds no study")


def move_to_earlier(directory: Path) -> None:
    """Move the study that is there into a directory of its own; nothing is deleted."""
    files = [directory / name for name in (ROWS, ASIDE, MANIFEST, STUDY, FAILURES)]
    stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S.%fZ")
    # The rows leave last: a move that is cut short leaves a directory whose rows are intact.
    for file in reversed([file for file in files if file.exists()]):
        target = directory / EARLIER / stamp
        target.mkdir(parents=True, exist_ok=True)
        os.replace(file, target / file.name)


def log_failure(directory: Path, name: str, outcome: Outcome) -> None:
    """Add to the failure log what a task that failed has left behind."""
    if outcome.status == "ok":
        return
    lines = [f"{name} {outcome.status}: {one_line(outcome.message)}"]
    lines += [f"    {line}" for line in outcome.detail.splitlines()]
    with open(directory / FAILURES, "a", encoding="utf-8") as log:
        log.write("\n".join(lines) + "\n")


def _statuses(rows: Sequence[Record]) -> Counter[str]:
    return Counter(row["status"] for row in rows)


def _read(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None
