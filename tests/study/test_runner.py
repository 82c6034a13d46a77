"""Running, resuming, retrying, starting afresh: nothing lost, nothing repeated, order no matter."""

from __future__ import annotations

import functools
import json
from importlib.util import find_spec
from pathlib import Path

import pytest

from harness.errors import UserError
from harness.study import load
from harness.study.lock import locked
from harness.study.outcome import VARYING_COLUMNS, Outcome, row_of
from harness.study.runner import Engine, Mode, Summary, run_study
from harness.study.store import ROWS, read_rows, replace_rows
from harness.study.study_file import Study
from tests.study import fakes
from tests.study.studies import invariant_rows, study, sweep

ENGINES: list[Engine] = ["local", "dask"] if find_spec("distributed") else ["local"]


def _run(made: Study, directory: Path, mode: Mode = "new", **options: object) -> Summary:
    settings = {"work": fakes.quick, "jobs": 2, **options}
    return run_study(made, directory, mode=mode, **settings)  # type: ignore[arg-type]  # of tests


def test_rows_depend_neither_on_workers_nor_on_order_nor_on_engine(tmp_path: Path) -> None:
    made = study(sweep([3, 4, 5, 6], 3))
    replace_rows(
        tmp_path / ROWS,
        [row_of(task, Outcome("ok", measurement=fakes.quick(task))) for task in made.tasks],
    )
    expected = invariant_rows(tmp_path)
    for engine in ENGINES:
        for jobs in (1, 2, 5):
            directory = tmp_path / f"{engine}{jobs}"
            summary = _run(made, directory, jobs=jobs, engine=engine)
            assert (summary.added, summary.failed, summary.missing) == (len(made.tasks), 0, 0)
            assert invariant_rows(directory) == expected


def test_a_finished_study_is_left_as_it_is(tmp_path: Path) -> None:
    _run(study(), tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    for mode in ("new", "resume", "retry"):
        summary = _run(study(), tmp_path, mode, work=fakes.misbehave)
        assert (summary.added, summary.missing, summary.interrupted) == (0, 0, False)
        after = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
        assert after == before


def test_an_unfinished_study_is_refused_with_the_command_that_continues(tmp_path: Path) -> None:
    made = study()
    _run(made, tmp_path)
    rows = read_rows(tmp_path / ROWS)
    replace_rows(tmp_path / ROWS, rows[:5])
    before = (tmp_path / ROWS).read_bytes()
    with pytest.raises(UserError, match=r"5 of the 12 tasks.*avd study x --resume.*--fresh"):
        _run(made, tmp_path, resume_command="avd study x --resume")
    assert (tmp_path / ROWS).read_bytes() == before
    summary = _run(made, tmp_path, "resume")
    assert summary.added == 7
    after = read_rows(tmp_path / ROWS)
    assert [row for row in after if row in rows[:5]] == rows[:5]  # nothing was counted again
    assert [row["task"] for row in after] == [task.key for task in made.tasks]


def test_a_complete_study_is_the_same_file_whoever_ran_it(tmp_path: Path) -> None:
    """But for the two columns that vary, which come last."""
    made, files = study(sweep([3, 4, 5, 6], 3)), []
    for jobs in (1, 5):
        _run(made, tmp_path / str(jobs), jobs=jobs, work=fakes.delayed_by_seed)
        lines = (tmp_path / str(jobs) / ROWS).read_text().splitlines()
        assert lines[0].endswith(",".join(("", *VARYING_COLUMNS)))
        files.append([line.rsplit(",", len(VARYING_COLUMNS))[0] for line in lines])
    assert files[0] == files[1]


def test_fresh_repeats_all_and_deletes_nothing(tmp_path: Path) -> None:
    _run(study(), tmp_path)
    old = (tmp_path / ROWS).read_bytes()
    for times in (1, 2):
        assert _run(study(), tmp_path, "fresh").added == 12
        kept = sorted((tmp_path / "earlier").glob("*/rows.csv"))
        assert len(kept) == times
        assert kept[0].read_bytes() == old
    assert len(json.loads((tmp_path / "manifest.json").read_text())["runs"]) == 1


def test_failures_are_kept_and_repeated_only_on_request(tmp_path: Path) -> None:
    mended = tmp_path / "mended"
    work = functools.partial(fakes.fail_until_mended, mended)
    directory = tmp_path / "results"
    first = _run(study(), directory, work=work)
    assert first.statuses == {"ok": 8, "error": 4}
    assert first.failed == 4
    log = (directory / "failures.log").read_text()
    assert log.count("not mended (fakes.py:") == 4
    assert log.count("Traceback") == 4

    assert _run(study(), directory, "resume", work=fakes.quick).added == 0
    again = _run(study(), directory, "retry", work=work)
    assert (again.added, again.statuses) == (4, {"ok": 8, "error": 4})
    mended.touch()
    last = _run(study(), directory, "retry", work=work)
    assert (last.added, last.statuses) == (4, {"ok": 12})
    assert len(read_rows(directory / "rows-aside.csv")) == 8  # both failed rounds
    assert (load(directory)["status"] == "ok").all()


def test_rows_follow_the_study_file(tmp_path: Path) -> None:
    """A task that leaves takes its row out of rows.csv; when it returns, nothing is repeated."""
    wide, narrow = study(sweep([3, 4, 5], 2)), study(sweep([4, 6], 2))
    _run(wide, tmp_path)
    with pytest.raises(UserError, match="4 rows of tasks no longer in it"):
        _run(narrow, tmp_path)
    assert _run(narrow, tmp_path, "resume").added == 2
    assert {row["task"] for row in read_rows(tmp_path / ROWS)} == {t.key for t in narrow.tasks}
    assert (tmp_path / "study.toml").read_text() == narrow.text
    back = _run(wide, tmp_path, "resume", work=fakes.misbehave)
    assert back.added == 0
    assert {row["task"] for row in read_rows(tmp_path / ROWS)} == {t.key for t in wide.tasks}


def test_a_run_killed_before_its_first_row_starts_without_ado(tmp_path: Path) -> None:
    made = study()
    (tmp_path / "study.toml").write_text(made.text)
    (tmp_path / ROWS).write_bytes(b"task,sche")
    assert _run(made, tmp_path).added == 12
    assert len(load(tmp_path)) == 12


def test_a_run_killed_after_its_last_row_is_brought_to_its_end(tmp_path: Path) -> None:
    """All rows are there, but neither in order nor is it written that the run is over."""
    made = study()
    _run(made, tmp_path)
    ordered = read_rows(tmp_path / ROWS)
    replace_rows(tmp_path / ROWS, ordered[::-1])
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    manifest["runs"][-1].update(end=None, tasks=0)
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    summary = _run(made, tmp_path, "resume", work=fakes.misbehave)
    assert (summary.added, summary.missing, summary.interrupted) == (0, 0, False)
    assert read_rows(tmp_path / ROWS) == ordered
    killed, last = json.loads((tmp_path / "manifest.json").read_text())["runs"]
    assert (killed["interrupted"], killed["end"]) == (True, None)
    assert (last["interrupted"], last["tasks"]) == (False, 0)
    assert last["end"] is not None
    before = (tmp_path / "manifest.json").read_bytes()
    _run(made, tmp_path, "resume", work=fakes.misbehave)
    assert (tmp_path / "manifest.json").read_bytes() == before


def test_other_peoples_directories_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(UserError, match="not empty and holds no study"):
        _run(study(), tmp_path)
    with pytest.raises(UserError, match="not a directory"):
        _run(study(), tmp_path / "thesis.tex")
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_two_runs_cannot_write_one_study(tmp_path: Path) -> None:
    _run(study(), tmp_path)
    with locked(tmp_path), pytest.raises(UserError, match="another run"):
        _run(study(), tmp_path, "fresh")
    assert len(load(tmp_path)) == 12


def test_a_newer_manifest_stops_the_run_before_it_writes(tmp_path: Path) -> None:
    _run(study(), tmp_path)
    (tmp_path / "manifest.json").write_text('{"schema": 99}')
    before = (tmp_path / ROWS).read_bytes()
    with pytest.raises(UserError, match="newer"):
        _run(study(sweep([7])), tmp_path, "resume")
    assert (tmp_path / ROWS).read_bytes() == before
    assert (tmp_path / "study.toml").read_text() == study().text


def test_the_manifest_says_where_the_rows_come_from(tmp_path: Path) -> None:
    made = study(head="time_limit = 9\nmemory_limit = 777\nbase_seed = 5")
    _run(made, tmp_path, command="avd study small.toml", jobs=2)
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    assert manifest["schema"] == 1
    assert manifest["study"] == "small"
    assert manifest["command"] == "avd study small.toml"
    assert manifest["limits"] == {"time": 9.0, "memory_mib": 777}
    assert manifest["base_seed"] == 5
    assert manifest["tasks"] == 12
    assert manifest["statuses"] == {"ok": 12}
    assert {"python", "numpy", "python-flint", "pebble"} <= set(manifest["versions"])
    assert {"cpu", "cores", "threads", "memory_gib", "system"} == set(manifest["machine"])
    (run,) = manifest["runs"]
    assert (run["tasks"], run["jobs"], run["interrupted"]) == (12, 2, False)
    assert run["start"] <= run["end"]


def test_a_crash_of_the_runner_leaves_a_true_manifest(tmp_path: Path) -> None:
    """Here the third row cannot be written (as when the disk is full)."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("harness.study.runner.row_of", _fail_on_third())
        with pytest.raises(OSError, match="disk full"):
            _run(study(), tmp_path, jobs=1)
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    assert manifest["statuses"] == {"ok": 2}
    assert manifest["runs"][0]["interrupted"] is True
    assert _run(study(), tmp_path, "resume").added == 10
    assert [
        run["tasks"] for run in json.loads((tmp_path / "manifest.json").read_text())["runs"]
    ] == [
        2,
        10,
    ]


def _fail_on_third() -> object:
    calls = iter(range(100))

    def fail(*arguments: object) -> dict[str, str]:
        if next(calls) == 2:
            raise OSError("disk full")
        return row_of(*arguments)  # type: ignore[arg-type]  # handed on as it came

    return fail


def test_in_a_log_progress_is_plain_lines(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("harness.study.progress.INTERVAL", 0.0)
    _run(study(), tmp_path)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "\r" not in captured.err
    lines = captured.err.splitlines()
    assert lines[-1].startswith("small: 12/12 tasks, 12 ok")
    assert len(lines) == 13


def test_on_a_terminal_progress_is_a_bar_with_the_statuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    _run(study(), tmp_path)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "12/12" in captured.err
    assert "12 ok" in captured.err


def test_repeated_rows_are_put_aside(tmp_path: Path) -> None:
    """As when somebody has joined two files."""
    _run(study(), tmp_path)
    rows = read_rows(tmp_path / ROWS)
    replace_rows(tmp_path / ROWS, [*rows, *rows[:3]])
    summary = _run(study(), tmp_path, "resume")
    assert (summary.added, summary.statuses) == (0, {"ok": 12})
    assert read_rows(tmp_path / ROWS) == rows
    assert read_rows(tmp_path / "rows-aside.csv") == rows[:3]
