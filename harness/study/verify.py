"""Stored rows checked: against their own arithmetic, their recipe, and a count made anew.

Every row is checked for the identities of its counts, its task's key and its seed; a sample of
the rows (or all) is counted again from family, parameters, n and seed in another way
(:mod:`harness.study.recount`), and every stored count compared.  Nothing is written.
"""

from __future__ import annotations

import contextlib
import functools
import json
import random
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from harness.diagram.counts import NODE_KINDS, Counts
from harness.diagram.identities import broken_identity
from harness.errors import UserError
from harness.study.engines import run_local
from harness.study.interrupt import interruptible
from harness.study.isolate import Work
from harness.study.limits import Limits
from harness.study.manifest import read_manifest
from harness.study.mesh_rows import is_mesh_study
from harness.study.outcome import COUNT_COLUMNS, Outcome, row_of
from harness.study.processors import default_jobs
from harness.study.recount import Choice, recount
from harness.study.schema import Record
from harness.study.store import ROWS, read_rows
from harness.study.study_file import (
    DEFAULT_MEMORY_LIMIT,
    DEFAULT_TIME_LIMIT,
    LEAST_MEMORY_LIMIT,
    MOST_MEMORY_LIMIT,
    MOST_SECONDS,
)
from harness.study.task import Task, seed_of

COMPARED = ("segments", *COUNT_COLUMNS, "degrees", "certified")
"""The columns in which a row and its recount have to agree."""
PATIENCE = 4
"""A recount may take so many times what the study allowed a task, in time and in memory."""


@dataclass(frozen=True)
class Place:
    """A row: the line of ``rows.csv`` it is on, and what it is a row of."""

    line: int
    task: str
    family: str
    n: int
    domain: str
    seed: int

    def __str__(self) -> str:
        """For people."""
        return f"{ROWS} line {self.line} ({self.family}, n = {self.n}, {self.domain})"


@dataclass(frozen=True)
class Disagreement:
    """A stored value that is not what it must be; ``found_by``: what says so."""

    place: Place
    key: str
    stored: str
    found: str
    found_by: str

    def __str__(self) -> str:
        """One line."""
        stored, found = f"stored {self.stored}", f"{self.found} by {self.found_by}"
        return f"{self.place}: {self.key}: {stored}, but {found}"


@dataclass(frozen=True)
class Unseen:
    """A row that could not be counted again, and why."""

    place: Place
    status: str
    message: str

    def __str__(self) -> str:
        """One line."""
        return f"{self.place}: not recounted: {self.status}: {self.message}"


@dataclass(frozen=True)
class Verification:
    """What is to be done, and what has become of it so far.

    ``places``: all rows.  ``chosen``: rows to be counted again.  ``without_count``: rows of tasks
    that failed in the study, of which only key and seed can be checked.  ``missing``: tasks of the
    study without a row, None if there is no manifest to tell.  ``recounts``: rows counted again, by
    (family, domain, builder that counted).
    """

    places: tuple[Place, ...]
    chosen: tuple[tuple[Place, Record], ...]
    without_count: int
    missing: int | None
    limits: Limits
    recounts: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    disagreements: list[Disagreement] = field(default_factory=list)
    unseen: list[Unseen] = field(default_factory=list)

    @property
    def recounted(self) -> int:
        """Rows that were counted again."""
        return self.recounts.total()

    @property
    def statuses(self) -> dict[str, int]:
        """How many recounts there are, and how many failed."""
        return {"ok": self.recounted, "error": len(self.unseen)}

    @property
    def interrupted(self) -> bool:
        """Whether not every chosen row has had its turn."""
        return self.recounted + len(self.unseen) < len(self.chosen)


def examine(directory: Path, sample: int | None, seed: int = 0) -> Verification:
    """Check every row by itself, and choose those to be counted again.

    ``sample`` of the rows with counts (None: all of them), uniformly, by ``seed``.

    Raises UserError if there is no study of diagrams, a row or the manifest is damaged, or a newer
    program wrote it.
    """
    if not (directory / ROWS).exists():
        raise UserError(f"{directory}: no study here ({ROWS} is missing)")
    if is_mesh_study(directory):
        raise UserError(f"{directory}: a study of meshes: its rows hold no counts of diagrams")
    manifest = read_manifest(directory) or {}
    rows = [(_place(row, line), row) for line, row in enumerate(read_rows(directory / ROWS), 2)]
    counted = [pair for pair in rows if pair[1]["status"] == "ok"]
    chosen = counted
    if sample is not None and sample < len(counted):
        picked = random.Random(seed).sample(range(len(counted)), sample)
        chosen = [counted[k] for k in sorted(picked)]
    tasks = manifest.get("tasks")
    return Verification(
        places=tuple(place for place, _ in rows),
        chosen=tuple(chosen),
        without_count=len(rows) - len(counted),
        missing=None if tasks is None else max(0, tasks - len({row["task"] for _, row in rows})),
        limits=_limits(manifest),
        disagreements=list(_without_recount(rows, manifest.get("base_seed"))),
    )


def count_again(
    verification: Verification,
    builder: Choice = "auto",
    jobs: int | None = None,
    tell: Callable[[dict[str, int]], None] | None = None,
    work: Work[Task] | None = None,
) -> None:
    """Count the chosen rows again, ``jobs`` at a time, and note how they agree.

    ``tell`` hears of every recount.  ``work`` takes the place of the recount, in tests.  The first
    SIGINT, SIGTERM or SIGHUP ends it early.  Rows of one recipe are counted once.
    """
    by_task: defaultdict[Task, list[tuple[Place, Record]]] = defaultdict(list)
    for place, row in verification.chosen:
        by_task[task_of(row)].append((place, row))
    work = work or functools.partial(recount, builder)
    jobs = jobs or default_jobs()
    with (
        interruptible() as stop,
        contextlib.closing(
            run_local(list(by_task), work, verification.limits, jobs, stop)
        ) as results,
    ):
        for task, outcome in results:
            for place, row in by_task[task]:
                _compare(verification, place, row, task, outcome)
            if tell is not None:
                tell(verification.statuses)
    verification.disagreements.sort(key=lambda each: each.place.line)  # stable
    verification.unseen.sort(key=lambda each: each.place.line)


def _place(row: Record, line: int) -> Place:
    return Place(line, row["task"], row["family"], int(row["n"]), row["domain"], int(row["seed"]))


def _limits(manifest: dict[str, Any]) -> Limits:
    """Those of the study, and patience: a recount must not hang, but it may take longer."""
    stored = manifest.get("limits", {})
    seconds, mib = stored.get("time"), stored.get("memory_mib")
    if not isinstance(seconds, int | float) or not 0 < seconds <= MOST_SECONDS:
        seconds = DEFAULT_TIME_LIMIT
    if type(mib) is not int or not LEAST_MEMORY_LIMIT <= mib <= MOST_MEMORY_LIMIT:
        mib = DEFAULT_MEMORY_LIMIT
    return Limits(PATIENCE * float(seconds), PATIENCE * mib)


def _without_recount(
    rows: Sequence[tuple[Place, Record]], base_seed: int | None
) -> Iterator[Disagreement]:
    """What is wrong in any row by itself: key, seed and, if it has counts, their identities."""
    lines: dict[str, int] = {}
    for place, row in rows:
        task = task_of(row)
        first = lines.setdefault(place.task, place.line)
        if first != place.line:
            yield Disagreement(place, "task", place.task, f"line {first} has it too", "the file")
        if task.key != place.task:
            yield Disagreement(place, "task", place.task, task.key, "the content of the row")
        if base_seed is not None:
            seed = seed_of(base_seed, task.family, dict(task.params), task.n, task.replicate)
            if seed != task.seed:
                yield Disagreement(place, "seed", str(task.seed), str(seed), "the rule for seeds")
        if row["status"] == "ok" and (broken := broken_identity(counts_of(row))) is not None:
            others = "the other counts of the row"
            yield Disagreement(place, broken.key, str(broken.stated), broken.implied, others)


def _compare(
    verification: Verification, place: Place, row: Record, task: Task, outcome: Outcome
) -> None:
    """Note how a row and its recount agree."""
    if outcome.measurement is None:
        verification.unseen.append(Unseen(place, outcome.status, outcome.message))
        return
    builder = outcome.measurement.counts.builder
    verification.recounts[place.family, place.domain, builder] += 1
    found = row_of(task, outcome)
    verification.disagreements.extend(
        Disagreement(place, key, row[key], found[key], f"the {builder} builder")
        for key in COMPARED
        if _value(row[key]) != _value(found[key])
    )


def _value(text: str) -> Any:
    """A cell's value: 007 is 7, and the order of a histogram's entries means nothing."""
    return json.loads(text) if text[:1] == "{" else int(text) if text.isdecimal() else text


def task_of(row: Record) -> Task:
    """The task that a row says it is of."""
    return Task(
        family=row["family"],
        n=int(row["n"]),
        params=tuple(sorted(json.loads(row["params"]).items())),
        replicate=int(row["replicate"]),
        seed=int(row["seed"]),
        domain=row["domain"],  # type: ignore[arg-type]  # read_rows has checked it
        objective=row["objective"],  # type: ignore[arg-type]  # likewise
        builder=row["builder"],
    )


def counts_of(row: Record) -> Counts:
    """The counts that a row of status "ok" holds."""
    whole = {name: int(row[name]) for name in COUNT_COLUMNS if name not in NODE_KINDS}
    return Counts(
        domain=row["domain"],  # type: ignore[arg-type]  # read_rows has checked it
        objective=row["objective"],  # type: ignore[arg-type]  # likewise
        builder=row["builder"],
        n=int(row["segments"]),
        nodes={kind: int(row[kind]) for kind in NODE_KINDS},
        degrees={int(degree): count for degree, count in json.loads(row["degrees"]).items()},
        certified=row["certified"] == "true",
        **whole,
    )
