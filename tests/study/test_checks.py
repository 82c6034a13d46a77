"""Rows and manifests that were edited or damaged are named, or can be analysed: nothing between."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.errors import UserError
from harness.report.build import analyse
from harness.report.provenance import entries
from harness.study import load
from harness.study.manifest import MANIFEST, read_manifest, write_manifest
from harness.study.outcome import COLUMNS, Outcome, row_of
from harness.study.schema import SCHEMA
from harness.study.store import ROWS, RowFile, read_rows, replace_rows
from tests.study.fakes import quick
from tests.study.studies import study

TASKS = study().tasks
WEIRD = st.sampled_from(
    ["", "-1", "1.5", "nan", "inf", "1e400", "9" * 30, "٣", "true", "two words", "two\nlines", "\0"]
) | st.sampled_from(["null", "{", "[]", "[1, 2]", '{"a": [1]}', '{"a": NaN}', '{"3": "x"}'])
MANIFESTED: dict[str, Any] = {
    "schema": SCHEMA,
    "study": "sample",
    "description": "",
    "commit": {"hash": "0123abc", "dirty": False},
    "limits": {"time": 60.0, "memory_mib": 2048},
    "tasks": 4,
    "statuses": {"ok": 4},
    "runs": [{"start": "2026-01-01", "end": None, "command": "avd study", "interrupted": False}],
}
VALUES = st.sampled_from([None, True, 1, 1.5, "x", [], [1], [[]], {}, {"a": 1}])


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("edited")


@contextmanager
def works_or_names(path: Path) -> Iterator[None]:
    """Lets pass an error that names the file, and no other."""
    try:
        yield
    except UserError as error:
        if not str(error).startswith(str(path)):
            raise


def write(directory: Path, changes: dict[str, str]) -> Path:
    """Rows of which the first is changed."""
    rows = [row_of(task, Outcome("ok", measurement=quick(task), peak_mib=50)) for task in TASKS]
    replace_rows(directory / ROWS, [{**rows[0], **changes}, *rows[1:]])
    return directory / ROWS


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("status", "okay"),
        ("n", "six"),
        ("n", ""),
        ("replicate", "9" * 30),
        ("vertices", "inf"),
        ("vertices", ""),
        ("certified", "yes"),
        ("params", "[1]"),
        ("params", '{"a": {"b": 1}}'),
        ("params", '{"a": 1e999}'),
        ("degrees", '{"3": -1}'),
        ("seconds", "nan"),
        ("domain", "garden"),
    ],
)
def test_an_edited_cell_is_named(directory: Path, column: str, value: str) -> None:
    path = write(directory, {column: value})
    with pytest.raises(UserError, match=rf"{ROWS} line 2: {column}: .* must be ") as caught:
        load(directory)
    assert str(caught.value).startswith(str(path))


def test_counts_may_be_missing_where_a_task_failed(directory: Path) -> None:
    write(directory, {"status": "timeout", "vertices": "", "certified": ""})
    assert load(directory)["vertices"].isna().sum() == 1


@given(st.sampled_from(COLUMNS), WEIRD)
def test_what_is_read_can_be_analysed(directory: Path, column: str, value: str) -> None:
    write(directory, {column: value})
    with works_or_names(directory / ROWS):
        frame = load(directory)
        assert len(frame) == len(TASKS)
        assert analyse(frame, "edited").lines


@given(st.binary(max_size=300))
def test_any_bytes_are_rows_or_a_clear_error(directory: Path, content: bytes) -> None:
    path = directory / ROWS
    path.write_bytes(content + b"\n")
    with works_or_names(path):
        read_rows(path)


def test_a_byte_order_mark_is_no_part_of_the_rows(directory: Path) -> None:
    path = write(directory, {})
    content, rows = path.read_bytes(), read_rows(path)
    path.write_bytes(b"\xef\xbb\xbf" + content)
    assert read_rows(path) == rows
    assert len(load(directory)) == len(TASKS)
    with RowFile(path) as file:  # before rows are added, the mark goes
        assert file.rows == rows
    assert path.read_bytes() == content
    assert isinstance(pd.read_csv(path), pd.DataFrame)


@pytest.mark.parametrize(
    ("key", "value", "reason"),
    [
        ("study", 7, "study: must be a string"),
        ("tasks", "many", "tasks: must be a whole number"),
        ("commit", "0123abc", "commit: must be an object or null"),
        ("runs", {"start": 1}, "runs: must be a list"),
        ("runs", ["yesterday"], "run 1: must be an object"),
        ("runs", [{"end": None}], "run 1: the key 'interrupted' is missing"),
        ("runs", [{"end": 5, "interrupted": True}], "run 1: end: must be a string or null"),
    ],
)
def test_a_manifest_of_wrong_types_is_named(
    tmp_path: Path, key: str, value: Any, reason: str
) -> None:
    write_manifest(tmp_path, {**MANIFESTED, key: value})
    with pytest.raises(UserError, match=f"{MANIFEST}: {reason}"):
        read_manifest(tmp_path)


@given(st.sampled_from(sorted(MANIFESTED)), VALUES)
def test_a_manifest_that_is_read_can_be_shown(directory: Path, key: str, value: Any) -> None:
    (directory / MANIFEST).write_text("\ufeff" + json.dumps({**MANIFESTED, key: value}), "utf-8")
    with works_or_names(directory / MANIFEST):
        assert entries(read_manifest(directory))
    (directory / MANIFEST).unlink()
