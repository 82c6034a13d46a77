"""``avd study``: what is on which stream, the exit statuses, the commands it tells to type."""

from __future__ import annotations

import shlex
import signal
from pathlib import Path

import pytest

import harness.report
from generators import FAMILIES
from harness.cli.main import main
from harness.errors import UserError
from harness.study import find_study, load
from harness.study.outcome import row_of
from harness.study.store import ROWS, read_rows, replace_rows
from harness.study.worker import SanityError, execute
from tests.study import fakes
from tests.study.studies import study

SMALL = """\
name = "tiny"
[[sweep]]
family = "convex-circle"
n = [3, 4]
domain = ["kernel", "plane"]
[[sweep]]
family = "figure-2"
n = 3
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working directory with a small study file, and a report that is quickly written."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.toml").write_text(SMALL)
    monkeypatch.setattr(harness.report, "report_with_lines", _report)
    return tmp_path


def _report(directory: Path) -> tuple[Path, list[str]]:
    return directory / "report.html", [f"{len(load(directory))} rows", "linear"]


def test_a_study_runs_to_its_report(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With the real generators and the real builder."""
    assert main(["study", "tiny.toml", "--jobs", "2"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "report: results/tiny/report.html\n5 rows\nlinear\n"
    assert "5 tasks: 5 ok; rows in results/tiny" in captured.err
    table = load(here / "results" / "tiny")
    assert (table["status"] == "ok").all()
    assert (table["segments"] == table["n"]).all()
    assert table["certified"].all()
    assert (table["seconds"] > 0).all()
    for task in find_study("tiny.toml").tasks:  # the counts are those of a build in this process
        row = table[table["task"] == task.key].iloc[0]
        counts = execute(task).counts
        assert (row["cells"], row["vertices"]) == (counts.cells, counts.vertices)
    assert (here / "results" / "tiny" / "study.toml").read_text() == SMALL

    assert main(["study", "tiny.toml", "--jobs", "2"]) == 0
    assert "all were there already" in capsys.readouterr().err


def test_unfinished_and_failed_studies_say_what_to_type(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["study", "tiny.toml", "--out", "my results", "--jobs", "2", "--no-report"]
    assert main(command) == 0
    rows = here / "my results" / ROWS
    done = read_rows(rows)
    capsys.readouterr()

    replace_rows(rows, done[:3])
    assert main(command) == 1
    errors = capsys.readouterr().err
    assert shlex.join(["avd", *command, "--resume"]) in errors
    assert errors.count("\n") == 1

    # What it says can be typed as it stands.
    said = shlex.split(errors.partition("continue with: ")[2].partition(" (or")[0])
    replace_rows(rows, [{**row, "status": "error"} for row in done[:3]])
    assert main(said[1:]) == 3
    errors = capsys.readouterr().err
    assert "3 error" in errors
    said = shlex.split(errors.partition("repeat them with: ")[2])
    assert said == ["avd", *command, "--retry"]
    assert main(said[1:]) == 0
    assert capsys.readouterr().out == ""


def test_an_interrupted_study_says_how_to_go_on(
    here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt_and_go_on(*arguments: object) -> dict[str, str]:
        signal.raise_signal(signal.SIGINT)
        return row_of(*arguments)  # type: ignore[arg-type]  # handed on as it came

    monkeypatch.setattr("harness.study.runner.row_of", interrupt_and_go_on)
    assert main(["study", "tiny.toml", "--jobs", "1"]) == 130
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "1 of 5 tasks are kept in results/tiny" in captured.err
    assert "continue with: avd study tiny.toml --jobs 1 --resume" in captured.err
    monkeypatch.undo()
    monkeypatch.chdir(here)
    assert main(["study", "tiny.toml", "--resume", "--no-report"]) == 0


def test_an_interrupted_report_says_how_to_get_it(
    here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(_directory: Path) -> tuple[Path, list[str]]:
        raise KeyboardInterrupt

    monkeypatch.setattr(harness.report, "report_with_lines", interrupt)
    assert main(["study", "tiny.toml"]) == 130
    assert "report later with: avd report results/tiny" in capsys.readouterr().err


def test_built_in_studies_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "--list"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    names = [line.partition("\t")[0] for line in captured.out.splitlines()]
    assert {"quick", "conjecture", "conjecture-small"} <= set(names)


def test_a_study_in_two_sizes_is_two_files(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    small = SMALL.replace('"tiny"', '"tiny-small"').replace("[3, 4]", "3")
    (here / "tiny-small.toml").write_text(small)
    assert main(["study", "tiny.toml", "--scale", "small", "--no-report"]) == 0
    assert len(load(here / "results" / "tiny-small")) == 3
    assert (
        '"command": "avd study tiny.toml --scale small --no-report"'
        in (here / "results" / "tiny-small" / "manifest.json").read_text()
    )
    assert find_study("tiny.toml", "full") == find_study("tiny.toml")
    assert find_study("conjecture", "small").name == "conjecture-small"
    for words in (["tiny-small.toml", "--scale", "small"], ["quick", "--scale", "full"]):
        with pytest.raises(SystemExit, match="2"):
            main(["study", *words])
        assert "has no scales" in capsys.readouterr().err


def test_the_small_study_has_the_shape_of_the_full_one() -> None:
    """The same families in the same domains, and every task is one of the full study's kind."""
    small, full = find_study("conjecture", "small").tasks, find_study("conjecture").tasks
    kinds = [{(task.family, task.params, task.domain) for task in tasks} for tasks in (small, full)]
    assert kinds[0] <= kinds[1]
    assert {(f, d) for f, _, d in kinds[0]} == {(f, d) for f, _, d in kinds[1]}
    assert {task.key for task in small} <= {task.key for task in full}
    polygons = {name for name, family in FAMILIES.items() if family.kind == "polygon"}
    assert {(name, d) for name in polygons for d in ("kernel", "interior")} <= {
        (f, d) for f, _, d in kinds[1]
    }


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        ([], 2, "name a study"),
        (["tiny.toml", "--jobs", "0"], 2, "at least 1"),
        (["tiny.toml", "--scheduler", "tcp://x:1"], 2, "--engine dask"),
        (["tiny.toml", "--resume", "--fresh"], 2, "not allowed with"),
        (["quik"], 1, "did you mean 'quick'?"),
        (["missing.toml"], 1, "missing.toml: No such file"),
        (["tiny.toml", "--out", "tiny.toml"], 1, "tiny.toml: is not a directory"),
    ],
)
def test_mistakes_are_said_before_anything_is_written(
    here: Path,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    status: int,
    message: str,
) -> None:
    if status == 2:  # as argparse ends
        with pytest.raises(SystemExit, match="2"):
            main(["study", *arguments])
    else:
        assert main(["study", *arguments]) == status
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err
    assert [path.name for path in here.iterdir()] == ["tiny.toml"]


def test_a_map_that_fails_its_check_is_no_ok_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not even if the check complains in the way in which bad input is complained of."""

    class Wrong:
        counts = fakes.quick(study().tasks[0]).counts

        def sanity_check(self) -> None:
            raise UserError("edge 3 has no twin")

    monkeypatch.setattr("harness.study.worker.build", lambda *_, **__: Wrong())
    with pytest.raises(SanityError, match="edge 3 has no twin"):
        execute(study().tasks[0])
