"""``avd bench``: a table for people, JSON for programs, rows for both, and honest statuses."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
from pathlib import Path

import pandas as pd
import pytest

from harness.bench.benchmark import Target
from harness.bench.diagram import QUICK
from harness.cli import bench
from harness.cli.main import build_parser, main
from tests.bench import fakes


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def use(monkeypatch: pytest.MonkeyPatch, *sizes: int, **options) -> None:
    monkeypatch.setattr(bench, "benchmark_named", lambda _name: fakes.benchmark(*sizes, **options))


def test_the_quick_instances_really_run(here: Path, capsys) -> None:
    """With the real generators, builder and processes."""
    command = ["bench", "diagram", "--quick", "--builder", "reference", "--repeat", "2"]
    assert main([*command, "--json"]) == 0
    told = capsys.readouterr()
    records = [json.loads(line) for line in told.out.splitlines()]
    assert [record["instance"] for record in records] == [case.name for case in QUICK]
    for record, case in zip(records, QUICK, strict=True):
        assert (record["family"], record["n"], record["domain"]) == (
            case.family,
            case.n,
            case.domain,
        )
        assert record["objective"] == "smallest"
        assert (record["status"], record["certified"]) == ("ok", True)
        assert min(record["timings"]) <= record["seconds"] <= max(record["timings"])
        rate = record["vertices"] / record["seconds"]
        assert record["vertices_per_second"] == pytest.approx(rate, rel=0.01)
        assert record["peak_mib"] > 1
        assert record["warm_up_seconds"] > 0
    table = pd.read_csv(here / "results" / "bench" / "diagram-quick" / "rows.csv")
    assert table["vertices"].tolist() == [record["vertices"] for record in records]


def test_the_table_agrees_with_the_rows(monkeypatch, capsys, here: Path) -> None:
    use(monkeypatch, 3, 4, target=Target(rate=3000, mib=35))
    assert main(["bench", "diagram", "--workers", "2"]) == 0
    told = capsys.readouterr()
    header, *rows = (re.split(r" {2,}", line) for line in told.out.split("\n\n")[0].splitlines())
    shown = [dict(zip(header, row, strict=True)) for row in rows]
    table = pd.read_csv(here / "results" / "bench" / "diagram" / "rows.csv")
    assert [row["instance"] for row in shown] == table["instance"].tolist() == ["s3", "s4"]
    assert [int(row["vertices"]) for row in shown] == table["vertices"].tolist()
    assert [float(row["seconds"]) for row in shown] == pytest.approx(table["seconds"].tolist())
    assert [row["verdict"] for row in shown] == ["reached", "not reached"]
    assert shown[0]["to reach"] == "≥ 3000 vertices/s, < 35 MiB"
    assert (shown[0]["floats"], shown[0]["balls"], shown[0]["exact"]) == (
        "75.00%",
        "25.00%",
        "0.00%",
    )
    assert (shown[0]["workers"], shown[0]["certified"]) == ("2", "yes")
    footer = told.out.split("\n\n")[1]
    assert "seconds per vertex, s4 against s3: 1 times (to reach: < 2): reached" in footer
    assert re.search(r"warm-up, in a fresh interpreter: \S+ s \(\S+ s with everything", footer)
    assert "rows of 2 instances are in results/bench/diagram" in told.err


def test_a_part_is_measured_and_stored_elsewhere(monkeypatch, capsys, here: Path) -> None:
    use(monkeypatch, 3, 4, 5)
    command = [
        "bench",
        "diagram",
        "--only",
        "s5",
        "--only",
        "s3",
        "--repeat",
        "1",
        "-o",
        str(here / "mine"),
    ]
    assert main(command) == 0
    table = pd.read_csv(here / "mine" / "rows.csv")
    assert table["instance"].tolist() == ["s3", "s5"]
    assert [len(json.loads(cell)) for cell in table["timings"]] == [1, 1]
    told = capsys.readouterr().out
    assert "with everything to compile" not in told  # that is for whole runs
    manifest = json.loads((here / "mine" / "manifest.json").read_text())
    assert shlex.split(manifest["command"])[:3] == ["avd", "bench", "diagram"]
    assert str(here) not in manifest["command"]
    assert not (here / "results").exists()


def test_a_failed_instance_is_status_3(monkeypatch, capsys) -> None:
    use(monkeypatch, 3, 13, 4)
    assert main(["bench", "diagram"]) == 3
    told = capsys.readouterr()
    assert [line.split()[-1] for line in told.out.splitlines()[1:4]] == ["–", "error", "–"]
    assert "avd: s13: error: ValueError: planned failure" in told.err


def test_an_interrupt_is_status_130_and_says_how_to_go_on(monkeypatch, capsys) -> None:
    use(monkeypatch, 3, 4, 5, 6)
    shown: list[str] = []

    def interrupt(row) -> None:
        shown.append(row["instance"])
        if len(shown) == 2:
            os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(bench, "_show_json", interrupt)
    assert main(["bench", "diagram", "--json", "--repeat", "2", "-o", "kept here"]) == 130
    told = capsys.readouterr().err
    assert "rows of 2 instances are kept in kept here" in told
    again = shlex.split(told.rpartition("continue with: ")[2])
    args = build_parser().parse_args(again[1:])
    assert (again[0], args.only, args.repeat, args.out) == (
        "avd",
        ["s5", "s6"],
        2,
        Path("kept here"),
    )
    assert main(again[1:]) == 0
    assert pd.read_csv("kept here/rows.csv")["instance"].tolist() == ["s3", "s4", "s5", "s6"]


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        ([], "WHAT"),
        (["diagrams"], "diagram"),
        (["diagram", "--repeat", "0"], "at least 1"),
        (["diagram", "--workers", "many"], "whole number"),
        (["diagram", "--builder", "quick"], "reference"),
    ],
)
def test_wrong_usage_is_status_2(arguments, hint, capsys) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["bench", *arguments])
    assert stop.value.code == 2
    assert hint in capsys.readouterr().err


def test_an_unknown_instance_is_status_1(capsys, here: Path) -> None:
    assert main(["bench", "diagram", "--only", "zigzag-1023"]) == 1
    told = capsys.readouterr()
    assert "did you mean 'zigzag-1024'?" in told.err
    assert told.err.count("\n") == 1
    assert list(here.iterdir()) == []
