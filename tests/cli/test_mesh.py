"""``avd mesh``: a file in, a better file out, and nothing in between."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys

import meshio
import numpy as np
import pytest

from harness.cli.main import main
from harness.mesh import quality_of, read_mesh
from tests.mesh.meshes import random_mesh


@pytest.fixture
def source(tmp_path):
    points, triangles = random_mesh(80)
    space = np.column_stack([points, np.zeros(len(points))])
    heat = np.arange(len(points)) * 1.0
    mesh = meshio.Mesh(space, [("triangle", triangles)], point_data={"heat": heat})
    meshio.write(tmp_path / "in.vtk", mesh)
    return tmp_path / "in.vtk"


def test_improve_writes_a_better_mesh_and_says_so(source, tmp_path, capsys) -> None:
    out = tmp_path / "out.vtu"
    assert main(["mesh", "improve", str(source), str(out), "--json"]) == 0
    shown = capsys.readouterr()
    record = json.loads(shown.out)
    mesh = read_mesh(out).mesh
    assert record["after"] == pytest.approx(quality_of(mesh.points, mesh.triangles).as_dict())
    assert record["after"]["smallest"] > record["before"]["smallest"]
    assert (record["complete"], record["inverted"]) == (True, 0)
    assert "smallest" in shown.err
    assert (meshio.read(out).point_data["heat"] == np.arange(mesh.points.shape[0])).all()


def test_the_table_is_for_people(source, tmp_path, capsys) -> None:
    arguments = ["mesh", "improve", str(source), str(tmp_path / "out.vtk"), "--quiet"]
    assert main([*arguments, "--objective", "apex", "--remedy", "both"]) == 0
    shown = capsys.readouterr()
    for word in ("smallest angle", "1st percentile", "5th percentile", "mean", "moves", "seconds"):
        assert word in shown.out
    assert shown.err == ""


def test_a_time_limit_of_nothing_keeps_the_mesh(source, tmp_path, capsys) -> None:
    out = tmp_path / "out.vtk"
    assert main(["mesh", "improve", str(source), str(out), "--time-limit", "0"]) == 0
    assert "best mesh so far" in capsys.readouterr().err
    before, after = read_mesh(source).mesh, read_mesh(out).mesh
    assert quality_of(after.points, after.triangles).smallest >= (
        quality_of(before.points, before.triangles).smallest - 1e-9
    )


def test_mistakes_end_with_one_line(source, tmp_path, capsys) -> None:
    out = str(tmp_path / "out.vtk")
    assert main(["mesh", "improve", str(tmp_path / "none.vtk"), out]) == 1
    assert main(["mesh", "improve", str(source), str(tmp_path / "out.strange"), "--quiet"]) == 1
    assert main(["mesh", "improve", str(source), out, "--remedy", "chord"]) == 1
    assert main(["mesh", "improve", str(source), out, "--fixed", "cold"]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 4
    assert all(line.startswith("avd: ") for line in lines)
    assert not (tmp_path / "out.vtk").exists()
    for wrong in (["--sweeps", "-1"], ["--time-limit", "soon"], ["--workers", "0"]):
        with pytest.raises(SystemExit) as exit_:
            main(["mesh", "improve", str(source), out, *wrong])
        assert exit_.value.code == 2


def test_regions_are_chosen_on_the_command_line(tmp_path, capsys) -> None:
    points, triangles = random_mesh(80)
    space = np.column_stack([points, np.zeros(len(points))])
    here = points[triangles].mean(axis=1)[:, 0] > 0.5
    mesh = meshio.Mesh(space, [("triangle", triangles)], cell_data={"part": [here * 1]})
    meshio.write(tmp_path / "in.vtu", mesh)
    arguments = ["mesh", "improve", str(tmp_path / "in.vtu"), str(tmp_path / "out.vtu"), "--json"]
    arguments += ["--quiet", "--topology", "flip"]
    found = {}
    for name, more in {
        "default": [],
        "named": ["--regions", "part"],
        "none": ["--ignore-interfaces"],
    }.items():
        assert main([*arguments, *more]) == 0
        found[name] = json.loads(capsys.readouterr().out)
    assert found["default"]["interface_edges"] == found["named"]["interface_edges"] > 0
    assert found["none"]["interface_edges"] == 0
    assert main([*arguments, "--regions", "part,parts"]) == 1
    assert "no cell data 'parts'" in capsys.readouterr().err


def test_what_cannot_be_written_is_said_before_the_work(source, tmp_path, capsys) -> None:
    for target in (tmp_path / "none" / "out.vtk", tmp_path / "out.strange", tmp_path):
        assert main(["mesh", "improve", str(tmp_path / "unread.vtk"), str(target)]) == 1
        assert str(target) in capsys.readouterr().err
    assert main(["mesh", "improve", str(source), str(tmp_path / "out.off"), "--quiet"]) == 0
    assert "not in the file: point data heat" in capsys.readouterr().err


def test_an_interrupted_run_leaves_the_old_file(tmp_path) -> None:
    points, triangles = random_mesh(20_000)
    space = np.column_stack([points, np.zeros(len(points))])
    meshio.write(tmp_path / "in.vtk", meshio.Mesh(space, [("triangle", triangles)]))
    out = tmp_path / "out.vtk"
    out.write_text("old")
    command = [sys.executable, "-m", "harness.cli.main", "mesh", "improve"]
    process = subprocess.Popen(
        [*command, str(tmp_path / "in.vtk"), str(out), "--sweeps", "100000"],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
    )
    assert process.stderr is not None
    while "smallest" not in process.stderr.readline():  # it has begun
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    process.communicate()
    assert process.returncode == 130
    assert out.read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.vtk", "out.vtk"]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_an_end_while_writing_leaves_no_scratch_files(
    source, tmp_path, capsys, monkeypatch, number
) -> None:
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    write = meshio.write

    def ended(*arguments, **settings) -> None:
        write(*arguments, **settings)
        assert any(scratch.iterdir())
        signal.raise_signal(number)

    def reached(*_) -> None:
        raise AssertionError("this would have ended the program at once")

    monkeypatch.setattr("tempfile.tempdir", str(scratch))
    monkeypatch.setattr(meshio, "write", ended)
    before = signal.signal(number, reached)
    try:
        assert main(["mesh", "improve", str(source), str(source), "--quiet"]) == 130
        assert signal.getsignal(number) is reached
    finally:
        signal.signal(number, before)
    assert capsys.readouterr().err == "avd: interrupted\n"
    assert not any(scratch.iterdir())
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.vtk", "scratch"]


@pytest.mark.parametrize("suffix", ["svg", "png", "pdf"])
def test_draw_writes_a_picture(source, tmp_path, suffix) -> None:
    picture = tmp_path / f"mesh.{suffix}"
    assert main(["mesh", "draw", str(source), "-o", str(picture)]) == 0
    start = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}[suffix]
    assert picture.read_bytes().startswith(start)
    again = tmp_path / f"again.{suffix}"
    assert main(["mesh", "draw", str(source), "-o", str(again)]) == 0
    assert again.read_bytes() == picture.read_bytes()


def test_the_colours_are_the_smallest_angles(source) -> None:
    import matplotlib.pyplot as plt

    from harness.mesh.quality import least_angles
    from harness.report.mesh_drawing import draw_mesh

    mesh = read_mesh(source).mesh
    figure, axes = plt.subplots()
    shown = draw_mesh(axes, mesh.points, mesh.triangles)
    plt.close(figure)
    assert (np.asarray(shown.get_array()) == least_angles(mesh.points, mesh.triangles)).all()
