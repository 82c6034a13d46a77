"""Rows and manifest: complete, readable, kept, and never taken for something else."""

from __future__ import annotations

import getpass
import json
import os
import signal
import socket
from pathlib import Path

import pandas as pd
import pytest

from harness.bench import runner
from harness.bench.benchmark import Benchmark, Target
from harness.bench.rows import columns_of, values_of
from harness.bench.runner import Settings, Summary, run_benchmark
from harness.errors import UserError
from harness.study import load
from harness.study.lock import locked
from harness.study.schema import Record
from tests.bench import fakes


@pytest.fixture(autouse=True)
def first_calls(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Whether the first calls are to be made anew; none of them takes the time to be made."""
    asked: list[bool] = []

    def ask(*_arguments, anew: bool, stop) -> float:
        assert not stop.is_set()
        asked.append(anew)
        return 40.0 if anew else 1.0 / len(asked)

    monkeypatch.setattr(runner, "first_call", ask)
    return asked


def run(
    benchmark: Benchmark, directory: Path, names=None, show=lambda _row: None, **settings
) -> Summary:
    given = {"builder": "reference", "repeat": 3, "workers": None, "compile_anew": False}
    chosen = Settings(**{**given, "command": "avd bench", **settings})
    return run_benchmark(benchmark, benchmark.chosen(names), directory, chosen, show)


def manifest(directory: Path) -> dict:
    return json.loads((directory / "manifest.json").read_text())


def test_rows_are_those_of_a_study_and_more(tmp_path: Path) -> None:
    target = Target(rate=4000.0, seconds=0.5, mib=35)
    summary = run(fakes.benchmark(3, 4, target=target), tmp_path, workers=2, repeat=3)
    table = pd.read_csv(tmp_path / "rows.csv")
    assert tuple(table.columns) == columns_of(fakes.benchmark(3))
    assert table["instance"].tolist() == ["s3", "s4"]
    assert table["family"].tolist() == ["star", "star"]
    assert table["seconds"].tolist() == pytest.approx([0.006, 0.008])
    assert [json.loads(cell) for cell in table["timings"]] == [
        pytest.approx([0.009, 0.006, 0.003]),
        pytest.approx([0.012, 0.008, 0.004]),
    ]
    assert table["vertices_per_second"].tolist() == pytest.approx([5000, 5000])
    assert table["peak_mib"].tolist() == [30, 40]
    assert table["reached"].tolist() == [True, False]
    assert table["workers"].tolist() == [2, 2]
    assert table["target_rate"].tolist() == [4000, 4000]
    assert (table["share_floats"] + table["share_balls"] + table["share_exact"] == 1).all()
    assert load(tmp_path)["vertices"].tolist() == table["vertices"].tolist() == [30, 40]
    assert summary.missing == summary.failed == []
    assert summary.ratios == (pytest.approx(1.0),)
    for row, told in zip(summary.rows, table.to_dict("records"), strict=True):
        values = values_of(row)
        assert values["params"] == json.loads(told["params"])
        assert (values["reached"], values["n"]) == (told["reached"], told["n"])


def test_everything_is_compiled_before_anything_is_measured(tmp_path, first_calls) -> None:
    """And what is told of loading is what it takes then."""
    summary = run(fakes.benchmark(3), tmp_path, compile_anew=True)
    assert first_calls == [True, False, False]
    assert (summary.compiling, summary.loading) == (40.0, pytest.approx(1 / 3))
    summary = run(fakes.benchmark(3), tmp_path)
    assert first_calls[3:] == [False, False]
    assert summary.compiling is None


def test_the_manifest_says_where_rows_are_from(tmp_path: Path) -> None:
    run(fakes.benchmark(3, 4), tmp_path, command="avd bench diagram", compile_anew=True)
    text = (tmp_path / "manifest.json").read_text()
    told = json.loads(text)
    assert {"cpu", "cores", "memory_gib"} <= set(told["machine"])
    assert {"python", "numpy", "numba"} <= set(told["versions"])
    assert (told["schema"], told["bench_schema"], told["benchmark"]) == (1, 1, "diagram")
    assert {"commit", "avd"} <= set(told)
    (entry,) = told["runs"]
    assert entry["command"] == told["command"] == "avd bench diagram"
    assert entry["start"] <= entry["end"]
    assert entry["interrupted"] is False
    assert entry["compiling_seconds"] == 40.0
    assert entry["loading_seconds"] == pytest.approx(1 / 3)
    assert [(one["large"], one["reached"]) for one in entry["comparisons"]] == [("s4", True)]
    for private in (socket.gethostname(), str(Path.home()), str(tmp_path)):
        assert private not in text
    assert f"/{getpass.getuser()}/" not in text
    assert sorted(path.name for path in tmp_path.iterdir()) == ["manifest.json", "rows.csv"]


def test_a_row_stays_until_its_instance_is_measured_again(tmp_path: Path) -> None:
    benchmark = fakes.benchmark(3, 4, 5)

    def state() -> dict[str, tuple[int, int]]:
        table = pd.read_csv(tmp_path / "rows.csv")
        return {row.instance: (row.run, row.workers) for row in table.itertuples()}

    def runs() -> list[int]:
        return [entry["run"] for entry in manifest(tmp_path)["runs"]]

    run(benchmark, tmp_path, ["s4"], workers=1)
    assert (state(), runs()) == ({"s4": (1, 1)}, [1])
    run(benchmark, tmp_path, ["s3"], workers=2)
    assert (state(), runs()) == ({"s3": (2, 2), "s4": (1, 1)}, [1, 2])
    assert list(state()) == ["s3", "s4"]  # in the benchmark's order
    run(benchmark, tmp_path, ["s4", "s5"], workers=3)
    assert (state(), runs()) == ({"s3": (2, 2), "s4": (3, 3), "s5": (3, 3)}, [2, 3])
    run(benchmark, tmp_path, workers=4)
    assert (state(), runs()) == (dict.fromkeys(["s3", "s4", "s5"], (4, 4)), [4])


def test_a_failure_is_a_row_and_takes_nothing_with_it(tmp_path: Path) -> None:
    summary = run(fakes.benchmark(3, 13, 4, target=Target(seconds=9)), tmp_path)
    table = pd.read_csv(tmp_path / "rows.csv")
    assert table["status"].tolist() == ["ok", "error", "ok"]
    assert table["reached"].tolist() == [True, False, True]
    assert "planned failure" in table["message"][1]
    assert pd.isna(table["seconds"][1])
    assert [row["instance"] for row in summary.failed] == ["s13"]
    assert "in measured" in (tmp_path / "failures.log").read_text()


def test_an_interrupt_keeps_what_is_done(tmp_path: Path) -> None:
    def interrupt(row: Record) -> None:
        if row["instance"] == "s4":
            os.kill(os.getpid(), signal.SIGINT)

    summary = run(fakes.benchmark(3, 4, 5, 6), tmp_path, show=interrupt)
    assert [row["instance"] for row in summary.rows] == ["s3", "s4"]
    assert summary.missing == ["s5", "s6"]
    assert manifest(tmp_path)["runs"][0]["interrupted"] is True
    assert pd.read_csv(tmp_path / "rows.csv")["instance"].tolist() == ["s3", "s4"]
    run(fakes.benchmark(3, 4, 5, 6), tmp_path, summary.missing)
    assert len(pd.read_csv(tmp_path / "rows.csv")) == 4


def test_a_killed_run_is_told_as_interrupted(tmp_path: Path) -> None:
    run(fakes.benchmark(3, 4), tmp_path, ["s3"])
    told = manifest(tmp_path)
    told["runs"][0]["end"] = None
    (tmp_path / "manifest.json").write_text(json.dumps(told))
    run(fakes.benchmark(3, 4), tmp_path, ["s4"])
    assert [entry["interrupted"] for entry in manifest(tmp_path)["runs"]] == [True, False]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"benchmark": "other"}, "no rows of the benchmark diagram"),
        ({"bench_schema": 2}, "benchmark schema 2"),
        ({"schema": 99}, "schema 99"),
    ],
)
def test_what_others_wrote_is_left_alone(tmp_path: Path, change: dict, reason: str) -> None:
    run(fakes.benchmark(3), tmp_path)
    (tmp_path / "manifest.json").write_text(json.dumps({**manifest(tmp_path), **change}))
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(UserError, match=reason):
        run(fakes.benchmark(3), tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_other_directories_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(UserError, match="holds no benchmark"):
        run(fakes.benchmark(3), tmp_path)
    with pytest.raises(UserError, match="is not a directory"):
        run(fakes.benchmark(3), tmp_path / "file")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    with locked(tmp_path), pytest.raises(UserError, match="another run"):
        run(fakes.benchmark(3), tmp_path)


def test_rows_with_other_columns_are_left_alone(tmp_path: Path) -> None:
    run(fakes.benchmark(3), tmp_path)
    (tmp_path / "rows.csv").write_text("instance,n\ns3,3\n")
    with pytest.raises(UserError, match="other columns"):
        run(fakes.benchmark(3), tmp_path)
    assert (tmp_path / "rows.csv").read_text() == "instance,n\ns3,3\n"
