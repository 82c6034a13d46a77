"""Verification: sound rows pass, every planted fault is found, what cannot be seen is said."""

from __future__ import annotations

import functools
import json
import shutil
import signal
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import generators
from harness.cli.main import main
from harness.diagram import build
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.study.manifest import MANIFEST
from harness.study.recount import FEASIBLE, another_view, recount, recounter
from harness.study.runner import run_study
from harness.study.schema import Record
from harness.study.store import ROWS, read_rows, replace_rows
from harness.study.task import Task
from harness.study.verify import COMPARED, count_again, examine, task_of
from harness.study.worker import execute
from tests.study import fakes
from tests.study.studies import study

TEXT = """
[[sweep]]
family = "zigzag"
n = [6, 8]
domain = ["kernel", "interior"]
[[sweep]]
family = "star"
n = 16
replicates = 2
[[sweep]]
family = "segments"
n = 4
"""
Edit = Callable[[Record], Record]


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study with rows of every domain; the recounts of some are by each builder."""
    directory = tmp_path_factory.mktemp("sound")
    run_study(study(TEXT), directory, jobs=2)
    return directory


@pytest.fixture
def copy(sound: Path, tmp_path: Path) -> Path:
    """A copy of it that may be damaged."""
    return Path(shutil.copytree(sound, tmp_path / "results" / "copy"))


def edit(directory: Path, line: int, change: Edit) -> None:
    rows = read_rows(directory / ROWS)
    rows[line - 2] = change(rows[line - 2])
    replace_rows(directory / ROWS, rows)


def with_key(row: Record) -> Record:
    """The row with the key that its content has: a forger knows how to do that."""
    return {**row, "task": task_of(row).key}


def test_sound_rows_agree(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (sound / ROWS).read_bytes()
    assert main(["verify", str(sound), "--all", "--json", "--jobs", "2"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["agrees"] is True
    assert (record["rows"], record["recounted"], record["missing"]) == (7, 7, 0)
    assert {each["builder"] for each in record["recounts"]} == {"fast", "reference"}
    assert main(["verify", str(sound), "--sample", "2", "--builder", "fast"]) == 0
    captured = capsys.readouterr()
    assert "7 rows checked, 2 counted again, no disagreement." in captured.out
    assert "2 ok" in captured.err or "0/2" in captured.err
    assert (sound / ROWS).read_bytes() == before


def _more(text: str) -> str:
    """Another value of the same kind."""
    if text in ("true", "false"):
        return "false" if text == "true" else "true"
    return json.dumps({"3": 77}) if text[:1] == "{" else str(int(text) + 1)


@pytest.mark.parametrize("column", COMPARED)
def test_a_count_that_was_edited_is_found(copy: Path, column: str) -> None:
    edit(copy, 3, lambda row: {**row, column: _more(row[column])})
    verification = examine(copy, None)
    count_again(verification, work=execute)
    found = [each for each in verification.disagreements if each.found_by.endswith("builder")]
    assert [(each.place.line, each.key) for each in found] == [(3, column)]
    rows = read_rows(copy / ROWS)
    assert found[0].stored == rows[1][column]
    assert not verification.unseen


def test_the_line_says_what_is_wrong(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    original = read_rows(copy / ROWS)[1]["regions"]
    edit(copy, 3, lambda row: {**row, "regions": "1"})
    assert main(["verify", str(copy), "--all", "--jobs", "2"]) == 1
    captured = capsys.readouterr()
    lines = [line for line in captured.err.splitlines() if line.startswith("avd:")]
    assert len(lines) == 1
    assert lines[0].startswith(f"avd: {copy}/rows.csv line 3 (zigzag, n = 6, kernel): regions: ")
    assert f"stored 1, but {original} by the reference builder" in lines[0]
    assert "7 counted again, 1 wrong." in captured.out


def test_what_contradicts_itself_is_found_without_a_recount(copy: Path) -> None:
    edit(copy, 2, lambda row: {**row, "vertices": _more(row["vertices"])})
    edit(copy, 4, lambda row: {**row, "seed": _more(row["seed"])})
    edit(copy, 5, lambda row: with_key({**row, "seed": _more(row["seed"])}))
    edit(copy, 6, lambda row: {**row, "family": "star-fat"})
    rows = read_rows(copy / ROWS)
    replace_rows(copy / ROWS, [*rows, rows[-1]])
    wrong = [(each.place.line, each.key) for each in examine(copy, 1).disagreements]
    assert wrong == [
        *[(2, "vertices"), (4, "task"), (4, "seed"), (5, "seed")],
        *[(6, "task"), (6, "seed"), (9, "task")],
    ]


def test_rows_that_cannot_be_recounted_are_said(
    copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / MANIFEST).unlink()
    edit(copy, 2, lambda row: with_key({**row, "family": "zagzig"}))
    edit(copy, 3, lambda row: {**row, "status": "timeout"})
    assert main(["verify", str(copy), "--all", "--jobs", "2"]) == 3
    captured = capsys.readouterr()
    assert "unknown family 'zagzig' (did you mean 'zigzag'?)" in captured.err
    for words in ("1 could not be counted again", "1 hold no count", "no manifest"):
        assert words in captured.out
    assert captured.err.count("avd:") == 1


def test_a_recount_that_fails_is_no_agreement(copy: Path) -> None:
    verification = examine(copy, 2)
    work = functools.partial(fakes.fail_until_mended, copy / "never")
    count_again(verification, work=work)
    assert verification.unseen or verification.disagreements
    assert not verification.interrupted


def test_an_interrupted_verification_says_so(
    copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("harness.study.progress.Progress.update", interrupt)
    assert main(["verify", str(copy), "--all", "--jobs", "1", "--builder", "reference"]) == 130
    errors = capsys.readouterr().err
    assert "interrupted after 1 of 7 rows; begin again with: avd verify" in errors


def test_what_is_no_study_is_refused(tmp_path: Path, copy: Path) -> None:
    with pytest.raises(UserError, match="no study here"):
        examine(tmp_path, None)
    edit(copy, 2, lambda row: {**row, "cells": "many"})
    with pytest.raises(UserError, match=r"rows.csv line 2: cells: 'many' must be a whole number"):
        examine(copy, None)
    assert main(["verify", str(tmp_path)]) == 1


def test_samples_are_uniform_and_repeatable(sound: Path) -> None:
    def lines(seed: int) -> tuple[int, ...]:
        return tuple(place.line for place, _ in examine(sound, 3, seed).chosen)

    drawn = [lines(seed) for seed in range(60)]
    assert drawn[:5] == [lines(seed) for seed in range(5)]
    assert {line for sample in drawn for line in sample} == set(range(2, 9))
    assert all(len(set(sample)) == 3 and list(sample) == sorted(sample) for sample in drawn)


def test_another_builder_counts_where_that_is_feasible() -> None:
    def task(n: int, builder: str) -> Task:
        return Task("star", n, (), 0, 0, "kernel", "smallest", builder)

    most = FEASIBLE["kernel"]
    assert recounter(task(most, "fast"), "auto") == "reference"
    assert recounter(task(most + 1, "fast"), "auto") == "fast"
    assert recounter(task(5, "reference"), "auto") == "fast"
    assert recounter(task(most + 1, "fast"), "reference") == "reference"


@given(st.sampled_from(["star", "convex-valtr", "segments"]), st.integers(3, 40), st.integers(0))
def test_another_view_is_an_exact_quarter_turn(family: str, n: int, seed: int) -> None:
    """Its fourth power only relabels, and no two points move to one place."""
    instance = Instance.from_generated(generators.generate(family, n, seed=seed))
    turned = another_view(instance)
    for _ in range(3):
        turned = another_view(turned)
    back = np.roll(turned.floats, -4 * (n // 2), axis=0)
    assert np.array_equal(back, instance.floats)
    assert another_view(instance).orientation == instance.orientation


def test_a_way_that_fails_is_followed_by_another(monkeypatch: pytest.MonkeyPatch) -> None:
    """Very symmetric input defeats one subdivision and not the next."""
    tried = []

    def fail_at_first(*arguments: object) -> object:
        tried.append(arguments[-1])
        if len(tried) < 3:
            raise UserError("halving does not end")
        return build(*arguments)  # type: ignore[arg-type]  # handed on as they came

    monkeypatch.setattr("harness.study.recount.build", fail_at_first)
    (task,) = study('[[sweep]]\nfamily = "star"\nn = 16\n').tasks
    assert recount("fast", task).counts == execute(task).counts
    assert tried == [1, 2, 3]
    monkeypatch.setattr("harness.study.recount.WAYS", ((True, 1),))
    tried.clear()
    with pytest.raises(UserError, match="halving does not end"):
        recount("fast", task)


def test_a_recount_finds_what_a_count_found() -> None:
    """Large enough for the fast builder, in every domain."""
    body = """
[[sweep]]
family = "convex-weave"
n = 20
domain = ["kernel", "interior", "plane"]
[[sweep]]
family = "segments"
n = 12
objective = ["smallest", "largest"]
"""
    for task in study(body).tasks:
        assert recount("auto", task).counts == execute(task).counts
