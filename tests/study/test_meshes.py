"""The study of meshes: rows one by one, going on where it stopped, and a report that is theirs."""

from __future__ import annotations

import json

import pytest

from harness.errors import UserError
from harness.mesh import improve, quality_of
from harness.report.mesh_report import conclusions, write_mesh_report
from harness.study.meshes import METHODS, MeshTask, read_meshes, run_meshes, tasks

FEW = [MeshTask("random-mesh", 30, seed, method) for seed in (0, 1) for method in METHODS]


def test_rows_are_what_the_methods_do(tmp_path) -> None:
    from generators.triangulations import random_mesh

    assert run_meshes(tmp_path, todo=FEW) == len(FEW)
    rows = read_meshes(tmp_path)
    assert [row["method"] for row in rows] == 2 * list(METHODS)
    for row in rows:
        points, triangles = random_mesh(30, int(row["seed"]))
        assert float(row["smallest_before"]) == pytest.approx(
            quality_of(points, triangles).smallest
        )
        assert sum(json.loads(row["angles_before"])) == 3 * len(triangles)
        if row["method"] == "all":
            better = improve(points, triangles)
            assert float(row["smallest"]) == pytest.approx(better.after.smallest)
            assert len(json.loads(row["history"])) == len(better.history)


def test_a_study_goes_on_where_it_stopped(tmp_path) -> None:
    assert run_meshes(tmp_path, todo=FEW[:3]) == 3
    with pytest.raises(UserError, match="--resume"):
        run_meshes(tmp_path, todo=FEW)
    with open(tmp_path / "rows.csv", "a", encoding="utf-8") as file:
        file.write("random-mesh,30,0,cut o")  # killed while writing
    assert run_meshes(tmp_path, mode="resume", todo=FEW[:5]) == 2
    assert run_meshes(tmp_path, mode="resume", todo=FEW[:5]) == 0
    assert len(read_meshes(tmp_path)) == 5
    assert run_meshes(tmp_path, mode="fresh", todo=FEW[:1]) == 1
    assert json.loads((tmp_path / "manifest.json").read_text())["kind"] == "meshes"


def test_the_report_is_the_same_for_the_same_rows(tmp_path) -> None:
    run_meshes(tmp_path, todo=FEW)
    page, lines = write_mesh_report(tmp_path)
    first = page.read_bytes()
    assert write_mesh_report(tmp_path)[0].read_bytes() == first
    text = first.decode()
    assert "http" not in text.replace("http://www.w3.org", "")
    assert len(lines) == 1 + len(METHODS)
    names = {path.stem for path in (tmp_path / "figures").iterdir()}
    assert {"figure-5", "figure-6", "angles-random-mesh", "sweeps-random-mesh"} <= names


def test_conclusions_count_what_rose_and_fell() -> None:
    row = dict.fromkeys(("mean", "mean_before"), "1") | {"method": "apex", "inverted": "0"}
    rows = [
        row | {"smallest_before": before, "smallest": after}
        for before, after in (("1", "2"), ("1", "0"), ("1", "1"), ("1", "5"))
    ]
    (line,) = conclusions(rows)[1:]
    assert "rose in 2 of 4 meshes, fell in 1" in line


def test_strange_rows_are_refused(tmp_path) -> None:
    with pytest.raises(UserError, match="missing"):
        read_meshes(tmp_path)
    (tmp_path / "rows.csv").write_text("a,b\n1,2\n")
    with pytest.raises(UserError, match="not the rows"):
        read_meshes(tmp_path)


def test_the_whole_study_has_every_method_on_every_mesh() -> None:
    found = tasks()
    assert len({task.key for task in found}) == len(found)
    meshes = {(task.family, task.n, task.seed) for task in found}
    assert len(found) == len(meshes) * len(METHODS)


def test_the_command_runs_it_and_reports_again(tmp_path, monkeypatch, capsys) -> None:
    from harness.cli.main import main
    from harness.study import meshes

    monkeypatch.setattr(meshes, "tasks", lambda: FEW[:10])
    where = str(tmp_path / "here")
    assert main(["study", "mesh", "--out", where]) == 0
    assert "10 rows added" in capsys.readouterr().err
    assert main(["study", "mesh", "--out", where]) == 1
    assert main(["study", "mesh", "--out", where, "--resume", "--no-report"]) == 0
    capsys.readouterr()
    assert main(["report", where]) == 0
    assert "apex: the smallest angle rose in" in capsys.readouterr().out
