"""Stored rows survive what happens to files: torn ends, damage, other versions, other writers."""

from __future__ import annotations

import io
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.errors import UserError
from harness.study import load, lock, schema
from harness.study.lock import LOCK, locked
from harness.study.manifest import read_manifest, write_manifest
from harness.study.outcome import COLUMNS, Outcome, row_of
from harness.study.schema import SCHEMA, Record
from harness.study.store import ASIDE, ROWS, RowFile, as_lines, read_rows, replace_rows, set_aside
from tests.study.fakes import quick
from tests.study.studies import study

TASKS = study().tasks
MESSAGES = st.text(
    st.characters(exclude_categories=["Cs"]) | st.sampled_from(',"\n\r\x0b\x85\u2028'), max_size=20
)


def _ok_rows() -> list[Record]:
    return [row_of(task, Outcome("ok", measurement=quick(task), peak_mib=50)) for task in TASKS]


def _write(path: Path, rows: list[Record]) -> bytes:
    replace_rows(path, rows)
    return path.read_bytes()


@given(st.lists(MESSAGES, min_size=1, max_size=4), st.data())
def test_a_torn_end_costs_that_row_and_no_other(
    tmp_path_factory: pytest.TempPathFactory, messages: list[str], data: st.DataObject
) -> None:
    """Cut anywhere, the file gives the whole rows before the cut; appending heals it."""
    path = tmp_path_factory.mktemp("torn") / ROWS
    pairs = zip(TASKS, messages, strict=False)
    rows = [row_of(task, Outcome("error", message)) for task, message in pairs]
    whole = _write(path, rows)
    cut = data.draw(st.integers(0, len(whole)))
    path.write_bytes(whole[:cut])
    survivors = read_rows(path)
    assert survivors == rows[: max(whole[:cut].count(b"\n") - 1, 0)]
    with RowFile(path) as file:
        assert file.rows == survivors
        for row in rows[len(survivors) :]:
            file.append(row)
    assert path.read_bytes() == whole


@given(MESSAGES)
def test_any_message_is_one_line_and_read_back_by_pandas(message: str) -> None:
    row = row_of(TASKS[0], Outcome("error", message))
    text = as_lines([dict(zip(COLUMNS, COLUMNS, strict=True)), row]).decode()
    assert text.count("\n") == 2
    table = pd.read_csv(io.StringIO(text), dtype=str, keep_default_na=False)
    assert table.to_dict("records") == [row]
    assert len(row["message"].splitlines()) <= 1


def test_reading_does_not_touch_a_file_being_written(tmp_path: Path) -> None:
    whole = _write(tmp_path / ROWS, _ok_rows())
    torn = whole + b"0123,1,sta"
    (tmp_path / ROWS).write_bytes(torn)
    assert len(load(tmp_path)) == len(TASKS)
    assert (tmp_path / ROWS).read_bytes() == torn


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda lines: [*lines[:3], b"abc\n", *lines[4:]], "line 4: 1 cells"),
        (lambda lines: [*lines[:3], b"\0" * 30 + b"\n", *lines[3:]], "line 4"),
        (lambda lines: [*lines[:2], lines[2].replace(b",1,", b",x,", 1), *lines[3:]], "line 3"),
        (lambda lines: [lines[0].replace(b"cells", b"faces"), *lines[1:]], "no column 'cells'"),
    ],
)
def test_damage_inside_the_file_is_named_and_nothing_written(
    tmp_path: Path, damage: object, reason: str
) -> None:
    path = tmp_path / ROWS
    lines = _write(path, _ok_rows()).splitlines(keepends=True)
    assert callable(damage)
    path.write_bytes(b"".join(damage(lines)))
    before = path.read_bytes()
    for attempt in (lambda: load(tmp_path), lambda: RowFile(path)):
        with pytest.raises(UserError, match=reason) as error:
            attempt()
        assert str(path) in str(error.value)
    assert path.read_bytes() == before


def test_load_is_sorted_and_typed(tmp_path: Path) -> None:
    rows = _ok_rows()
    rows[5] = row_of(TASKS[5], Outcome("timeout", "time limit of 1 s reached"))
    replace_rows(tmp_path / ROWS, reversed(rows))
    table = load(tmp_path)
    assert list(table.columns) == list(COLUMNS)
    assert list(zip(table["n"], table["replicate"], strict=True)) == [
        (task.n, task.replicate) for task in TASKS
    ]
    assert table["seed"].tolist() == [task.seed for task in TASKS]
    assert str(table["cells"].dtype) == "Int64"
    assert table["seconds"].dtype == float
    failed = table[table["status"] == "timeout"]
    assert failed[["cells", "certified", "seconds"]].isna().all(axis=None)
    assert table.loc[table["status"] == "ok", "certified"].notna().all()


def test_one_call_of_pandas_reads_the_rows(tmp_path: Path) -> None:
    replace_rows(tmp_path / ROWS, _ok_rows())
    table = pd.read_csv(tmp_path / ROWS)
    assert table["cells"].tolist() == [quick(task).counts.cells for task in TASKS]
    assert table["certified"].tolist() == [quick(task).counts.certified for task in TASKS]


def test_no_study_is_said_so(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no study here"):
        load(tmp_path)


def test_rows_set_aside_are_never_lost(tmp_path: Path) -> None:
    rows = _ok_rows()
    replace_rows(tmp_path / ROWS, rows)
    set_aside(tmp_path, rows[:2], rows[2:])
    set_aside(tmp_path, rows[2:3], rows[3:])
    assert read_rows(tmp_path / ROWS) == rows[3:]
    assert read_rows(tmp_path / ASIDE) == rows[:3]


def test_one_writer_at_a_time(tmp_path: Path) -> None:
    with (
        locked(tmp_path),
        pytest.raises(UserError, match="another run is writing"),
        locked(tmp_path),
    ):
        pass
    (tmp_path / LOCK).write_text("12345\n")  # left behind by a killed run: held by nobody
    with locked(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_lock_file_removed_meanwhile_is_no_lock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Opened before its holder removed it, locked after: whoever made the new file would differ."""
    acquire = lock._acquire

    def lose_the_first(path: Path) -> int:
        monkeypatch.setattr(lock, "_acquire", acquire)
        descriptor = acquire(path)
        path.unlink()
        return descriptor

    monkeypatch.setattr(lock, "_acquire", lose_the_first)
    with locked(tmp_path), pytest.raises(UserError, match="another run"), locked(tmp_path):
        pass


def test_what_a_newer_program_wrote_is_refused(tmp_path: Path) -> None:
    row = _ok_rows()[0]
    replace_rows(tmp_path / ROWS, [{**row, "schema": str(SCHEMA + 1)}])
    with pytest.raises(UserError, match=f"schema {SCHEMA + 1}.*newer angular-voronoi"):
        load(tmp_path)
    replace_rows(tmp_path / ROWS, [row])
    write_manifest(tmp_path, {"schema": SCHEMA + 1})
    with pytest.raises(UserError, match=r"manifest\.json.*newer angular-voronoi"):
        load(tmp_path)


def test_what_an_older_program_wrote_is_migrated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As if schema 1 had called the cells "faces" and kept no list of runs."""

    def rename(record: Record) -> Record:
        return {("cells" if name == "faces" else name): text for name, text in record.items()}

    rows = _ok_rows()
    old = as_lines([dict(zip(COLUMNS, COLUMNS, strict=True)), *rows]).replace(b"cells", b"faces", 1)
    (tmp_path / ROWS).write_bytes(old)
    write_manifest(tmp_path, {"schema": 1, "study": "small"})
    monkeypatch.setattr(schema, "SCHEMA", 2)
    monkeypatch.setitem(schema.ROW_STEPS, 1, rename)
    monkeypatch.setitem(schema.MANIFEST_STEPS, 1, lambda manifest: {**manifest, "runs": []})

    assert load(tmp_path)["cells"].tolist() == [int(row["cells"]) for row in rows]
    assert read_manifest(tmp_path) == {"schema": 2, "study": "small", "runs": []}
    assert (tmp_path / ROWS).read_bytes() == old  # reading changes nothing
    with RowFile(tmp_path / ROWS):
        pass
    assert (tmp_path / "rows.csv.old").read_bytes() == old
    assert read_rows(tmp_path / ROWS) == [{**row, "schema": "2"} for row in rows]


def test_a_damaged_manifest_is_named(tmp_path: Path) -> None:
    for text in ("{", "[]", '{"schema": "x"}', "{}"):
        (tmp_path / "manifest.json").write_text(text)
        with pytest.raises(UserError, match=r"manifest\.json"):
            read_manifest(tmp_path)
