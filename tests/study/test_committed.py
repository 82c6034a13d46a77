"""The committed small study: complete, sound, and made again the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from harness.study import find_study
from harness.study.outcome import VARYING_COLUMNS, Outcome, row_of
from harness.study.store import ROWS, read_rows
from harness.study.task import Task
from harness.study.verify import examine
from harness.study.worker import execute

DIRECTORY = Path(__file__).resolve().parents[2] / "results" / "conjecture-small"
STUDY = find_study("conjecture", "small")


def test_it_is_complete_and_in_order() -> None:
    assert (DIRECTORY / "study.toml").read_text(encoding="utf-8") == STUDY.text
    rows = read_rows(DIRECTORY / ROWS)
    assert [row["task"] for row in rows] == [task.key for task in STUDY.tasks]
    assert {(row["status"], row["certified"]) for row in rows} == {("ok", "true")}
    assert not (DIRECTORY / "failures.log").exists()


def test_no_row_contradicts_itself_or_its_recipe() -> None:
    verification = examine(DIRECTORY, 1)
    assert (verification.missing, verification.disagreements) == (0, [])


def test_an_interior_of_a_convex_polygon_is_its_kernel() -> None:
    """Two subdivisions of one polygon, the fan and the chords: the rows agree in every count."""
    rows = {
        (row["family"], row["n"], row["seed"], row["domain"]): row
        for row in read_rows(DIRECTORY / ROWS)
        if row["family"].startswith("convex")
    }
    pairs = [(row, rows[(*key[:3], "kernel")]) for key, row in rows.items() if key[3] == "interior"]
    own = {"task", "domain", *VARYING_COLUMNS}
    for one, other in pairs:
        assert {k: v for k, v in one.items() if k not in own} == {
            k: v for k, v in other.items() if k not in own
        }
    assert len(pairs) > 100


@pytest.mark.parametrize(
    "task",
    [task for task in STUDY.tasks if task.n == 16 and task.replicate == 0],
    ids=lambda task: f"{task.family}-{task.domain}",
)
def test_a_row_is_made_again_the_same(task: Task) -> None:
    stored = next(row for row in read_rows(DIRECTORY / ROWS) if row["task"] == task.key)
    again = row_of(task, Outcome("ok", measurement=execute(task)))
    for row in (stored, again):
        for column in VARYING_COLUMNS:
            row.pop(column)
    assert again == stored
