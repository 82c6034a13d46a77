"""The study of meshes: rows one by one, going on where it stopped, and a report that is theirs."""

from __future__ import annotations

import json
import re
from collections import Counter

import pytest

from harness.analysis.meshes import answer, findings
from harness.errors import UserError
from harness.mesh import improve, quality_of
from harness.report.mesh_report import write_mesh_report
from harness.study import load, mesh_runner
from harness.study.interrupt import interruptible
from harness.study.manifest import read_manifest
from harness.study.mesh_rows import append_row, is_mesh_study, read_meshes, write_rows
from harness.study.mesh_runner import run_meshes
from harness.study.meshes import COLUMNS, METHODS, MeshTask, measure, row_of, tasks
from harness.study.outcome import Outcome

FEW = [MeshTask("random-mesh", 30, seed, method) for seed in (0, 1) for method in METHODS]
VARYING = ("seconds", "peak_mib", "iterations", "iterations_before")


def same(rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """The rows without what may differ from run to run."""
    return [{name: row[name] for name in row if name not in VARYING} for row in rows]


@pytest.fixture(scope="module")
def rows() -> list[dict[str, str]]:
    """The rows of FEW, made in this process."""
    return [row_of(task, Outcome("ok", measurement=measure(task))) for task in FEW]


def test_rows_are_what_the_methods_do(rows) -> None:
    from generators.triangulations import random_mesh

    assert [row["method"] for row in rows] == 2 * list(METHODS)
    for row in rows:
        assert tuple(row) == COLUMNS
        points, triangles = random_mesh(30, int(row["seed"]))
        assert float(row["smallest_before"]) == pytest.approx(
            quality_of(points, triangles).smallest
        )
        assert sum(json.loads(row["angles_before"])) == 3 * len(triangles)
        if row["method"] == "all":
            better = improve(points, triangles)
            assert float(row["smallest"]) == pytest.approx(better.after.smallest)
            assert len(json.loads(row["history"])) == len(better.history)


def test_the_number_of_jobs_does_not_matter(tmp_path, rows) -> None:
    some = FEW[3:8]
    for jobs in (1, 3):
        summary = run_meshes(tmp_path / str(jobs), jobs=jobs, todo=some)
        assert (summary.added, summary.statuses) == (len(some), Counter(ok=len(some)))
        assert same(read_meshes(tmp_path / str(jobs))) == same(rows[3:8])


def test_a_study_goes_on_where_it_stopped(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(mesh_runner, "run_local", at_once)
    assert run_meshes(tmp_path, todo=FEW[:3]).added == 3
    with pytest.raises(UserError, match=r"3 of the 20 tasks .* avd --resume"):
        run_meshes(tmp_path, todo=FEW, resume_command="avd --resume")
    with open(tmp_path / "rows.csv", "a", encoding="utf-8") as file:
        file.write("random-mesh,30,0,cut o")  # killed while writing
    assert run_meshes(tmp_path, mode="resume", todo=FEW[:5]).added == 2
    assert run_meshes(tmp_path, mode="resume", todo=FEW[:5]).added == 0
    assert len(read_meshes(tmp_path)) == 5
    assert run_meshes(tmp_path, mode="fresh", todo=FEW[:1]).added == 1
    assert len(list((tmp_path / "earlier").rglob("rows.csv"))) == 1
    manifest = read_manifest(tmp_path)
    assert manifest is not None
    assert (manifest["study"], len(manifest["runs"])) == ("mesh", 1)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "letter.txt").write_text("dear")
    with pytest.raises(UserError, match="holds no study"):
        run_meshes(tmp_path / "other", todo=FEW[:1])


def at_once(todo, work, limits, jobs, stop):
    """Every task in this process: an engine for tests."""
    for task in todo:
        yield task, Outcome("ok", measurement=work(task))


def test_failures_are_rows_and_can_be_tried_again(tmp_path, monkeypatch) -> None:
    def failing(todo, work, limits, jobs, stop):
        for k, task in enumerate(todo):
            yield (
                task,
                Outcome("timeout", "too late") if k == 1 else Outcome("ok", measurement=work(task)),
            )

    monkeypatch.setattr(mesh_runner, "run_local", failing)
    assert run_meshes(tmp_path, todo=FEW[:4]).failed == 1
    assert "too late" in (tmp_path / "failures.log").read_text()
    page, _ = write_mesh_report(tmp_path)
    assert "1 timeout" in page.read_text()
    monkeypatch.setattr(mesh_runner, "run_local", at_once)
    assert run_meshes(tmp_path, mode="resume", todo=FEW[:4]).added == 0
    summary = run_meshes(tmp_path, mode="retry", todo=FEW[:4])
    assert (summary.added, summary.failed) == (1, 0)


def test_an_interrupted_study_keeps_its_rows(tmp_path, monkeypatch, capsys) -> None:
    import os
    import signal

    from harness.cli.main import main

    def interrupted(todo, work, limits, jobs, stop):
        yield todo[0], Outcome("ok", measurement=work(todo[0]))
        os.kill(os.getpid(), signal.SIGINT)
        assert stop.is_set()

    monkeypatch.setattr(mesh_runner, "run_local", interrupted)
    monkeypatch.setattr(mesh_runner, "tasks", lambda: FEW[:4])
    where = str(tmp_path / "here")
    assert main(["study", "mesh", "--out", where, "--jobs", "2"]) == 130
    said = capsys.readouterr().err
    assert f"continue with: avd study mesh --out {where} --jobs 2 --resume" in said
    assert len(read_meshes(tmp_path / "here")) == 1
    with interruptible():  # signals act as before
        pass


def test_the_report_is_the_same_for_the_same_rows(tmp_path, rows) -> None:
    write_rows(tmp_path / "rows.csv", [])
    for row in reversed(rows):
        append_row(tmp_path / "rows.csv", row)
    page, lines = write_mesh_report(tmp_path)
    first = page.read_bytes()
    write_rows(tmp_path / "rows.csv", rows)
    assert write_mesh_report(tmp_path)[0].read_bytes() == first
    text = first.decode()
    links = set(re.findall(r"https?://[^\s\"<>]*", text))
    assert {link for link in links if not link.startswith("http://www.w3.org/")} == set()
    assert len(lines) == 1 + len(METHODS)
    names = {path.stem for path in (tmp_path / "figures").iterdir()}
    assert {"figure-5", "figure-6", "meshes", "angles-random-mesh", "sweeps-random-mesh"} <= names


def made(method: str, seed: int, before: str, after: str, **more: str) -> dict[str, str]:
    blank = dict.fromkeys(COLUMNS, "")
    return blank | {
        **{"family": "random-mesh", "n": "9", "seed": str(seed), "method": method, "status": "ok"},
        **{"smallest_before": before, "smallest": after, "inverted": "0", "seconds": "2"},
        **{"iterations_before": "10", "iterations": "5", "error_before": "2", "error": "1"},
        **more,
    }


def test_findings_count_what_rose_and_fell() -> None:
    changes = [("1", "2"), ("1", "0"), ("1", "1"), ("1", "5")]
    (found,) = findings([made("apex", k, *change) for k, change in enumerate(changes)])
    assert (found.rose, found.fell, found.meshes, found.compared) == (2, 1, 4, 0)
    assert (found.iterations, found.error) == (0.5, 0.5)
    assert "these rows do not tell" in answer([found]).lower()


def test_what_pays_is_what_is_better_on_most_meshes() -> None:
    plain = [made("smart-laplacian", k, "1", "20") for k in range(5)]
    greedy = [made("apex", k, "1", "20", seconds="6", error="1.5") for k in range(5)]
    best = [made("all", k, "1", "30" if k < 3 else "20", iterations="4") for k in range(5)]
    best[0]["error"] = ""  # what cannot be solved is not better
    found = {each.method: each for each in findings([*plain, *greedy, *best])}
    assert found["apex"].pays_for == []
    assert found["apex"].slower == 3
    assert found["all"].pays_for == ["the smallest angle", "the solver's iterations"]
    said = answer(list(found.values()))
    assert "For nothing: apex." in said
    assert "For the smallest angle and the solver's iterations: all." in said


def test_strange_rows_are_refused(tmp_path, rows) -> None:
    with pytest.raises(UserError, match="missing"):
        read_meshes(tmp_path)
    (tmp_path / "rows.csv").write_text("a,b\n1,2\n")
    assert not is_mesh_study(tmp_path)
    with pytest.raises(UserError, match="not the rows"):
        read_meshes(tmp_path)
    for column, value in (("n", "many"), ("method", "magic"), ("status", "fine")):
        write_rows(tmp_path / "rows.csv", [rows[0], rows[1] | {column: value}])
        assert is_mesh_study(tmp_path)
        with pytest.raises(UserError, match=f"line 3: {column}: '{value}'"):
            read_meshes(tmp_path)
    write_rows(tmp_path / "rows.csv", [])
    with pytest.raises(UserError, match="read_meshes reads its rows"):
        load(tmp_path)
    with pytest.raises(UserError, match="no finished rows"):
        write_mesh_report(tmp_path)


def test_the_whole_study_has_every_method_on_every_mesh() -> None:
    found = tasks()
    assert len({task.key for task in found}) == len(found)
    meshes = {(task.family, task.n, task.seed) for task in found}
    assert len(found) == len(meshes) * len(METHODS)


def test_the_command_runs_it_and_reports_again(tmp_path, monkeypatch, capsys) -> None:
    from harness.cli.main import main

    monkeypatch.setattr(mesh_runner, "run_local", at_once)
    monkeypatch.setattr(mesh_runner, "tasks", lambda: FEW[:10])
    where = str(tmp_path / "here")
    assert main(["study", "mesh", "--out", where]) == 0
    shown = capsys.readouterr()
    assert "10 tasks: 10 ok; rows in" in shown.err
    assert "Does it pay" in shown.out
    assert main(["study", "mesh", "--out", where, "--no-report"]) == 0
    assert "all were there already" in capsys.readouterr().err
    assert main(["report", where]) == 0
    assert "apex: smallest angle up on" in capsys.readouterr().out
