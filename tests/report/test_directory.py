"""Reports of directories: what is written, what is refused, and that nothing is lost."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from harness.errors import UserError
from harness.report import summary_lines, write_report
from tests.report.studies import MANIFEST, sample, store


def test_report_figures_and_data_are_written_and_the_rows_untouched(tmp_path: Path) -> None:
    directory = store(tmp_path / "sample", sample())
    before = (directory / "rows.csv").read_bytes()
    path = write_report(directory)
    assert path == directory / "report.html"
    assert (directory / "rows.csv").read_bytes() == before
    assert len(list((directory / "figures").glob("*.svg"))) == 11
    assert (directory / "data" / "verdicts.csv").exists()
    assert not list(directory.rglob("*.tmp"))


def test_the_verb_prints_the_path_and_the_verdicts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from harness.cli import report

    directory = store(tmp_path / "sample", sample())
    parser = argparse.ArgumentParser()
    report.register(parser.add_subparsers())
    args = parser.parse_args(["report", str(directory)])
    assert args.run(args) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == str(directory / "report.html")
    assert lines[1:] == summary_lines(directory)
    assert any("control-linear" in line and "called right" in line for line in lines)


def test_a_failure_leaves_the_earlier_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    directory = store(tmp_path / "sample", sample())
    earlier = write_report(directory).read_bytes()

    def fail(*_: object) -> dict[str, str]:
        raise RuntimeError("no")

    monkeypatch.setattr("harness.report.page.outputs", fail)
    with pytest.raises(RuntimeError):
        write_report(directory)
    assert (directory / "report.html").read_bytes() == earlier


def test_refusals_name_the_directory_and_the_reason(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no such directory"):
        write_report(tmp_path / "nowhere")
    (tmp_path / "plain").mkdir()
    with pytest.raises(UserError, match=r"plain: not a study's directory"):
        write_report(tmp_path / "plain")
    empty = store(tmp_path / "empty", sample().iloc[:0])
    with pytest.raises(UserError, match=r"empty: the study has no rows"):
        write_report(empty)
    assert not (empty / "report.html").exists()


def test_a_newer_study_is_refused(tmp_path: Path) -> None:
    rows = sample()
    directory = store(tmp_path / "manifest", rows, {**MANIFEST, "schema": 99})
    with pytest.raises(UserError, match="99"):
        write_report(directory)
    rows["schema"] = 99
    directory = store(tmp_path / "rows", rows)
    with pytest.raises(UserError, match="99"):
        summary_lines(directory)
