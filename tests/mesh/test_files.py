"""Meshes from files and back: every format, all data, and mistakes that are named."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

from harness.errors import UserError
from harness.geometry.predicates import orientations
from harness.mesh import read_mesh, write_mesh
from harness.mesh.door import improve_mesh
from harness.mesh.options import Options
from tests.mesh.meshes import random_mesh


def written(path, points, triangles, **data):
    space = np.column_stack([points, np.zeros(len(points))])
    meshio.write(path, meshio.Mesh(space, [("triangle", triangles)], **data))
    return path


@pytest.mark.parametrize("suffix", ["vtk", "vtu", "msh", "obj", "off", "ply", "mesh", "stl"])
def test_formats_go_in_and_out(tmp_path, suffix) -> None:
    points, triangles = random_mesh(12)
    path = written(tmp_path / f"in.{suffix}", points, triangles)
    stored = read_mesh(path)
    better = improve_mesh(stored.mesh, Options(sweeps=3))
    write_mesh(tmp_path / "out.vtk", stored, better.points)
    again = read_mesh(tmp_path / "out.vtk").mesh
    assert again.points == pytest.approx(better.points)
    assert len(again.triangles) == len(triangles)  # STL numbers the vertices anew


def test_data_lines_and_z_are_kept(tmp_path) -> None:
    points, triangles = random_mesh(12)
    space = np.column_stack([points, np.full(len(points), 7.0)])
    lines = np.array([[0, 1], [1, 2]])
    heat, region = np.arange(len(points)) * 1.0, np.arange(len(triangles)) % 3
    meshio.write(
        tmp_path / "in.vtu",
        meshio.Mesh(
            space,
            [("triangle", triangles[:4]), ("line", lines), ("triangle", triangles[4:])],
            point_data={"heat": heat},
            cell_data={"region": [region[:4], np.array([8, 9]), region[4:]]},
        ),
    )
    stored = read_mesh(tmp_path / "in.vtu")
    better = improve_mesh(stored.mesh, Options(sweeps=3))
    write_mesh(tmp_path / "out.vtu", stored, better.points)
    out = meshio.read(tmp_path / "out.vtu")
    assert out.points[:, :2] == pytest.approx(better.points)
    assert (out.points[:, 2] == 7).all()
    assert (out.point_data["heat"] == heat).all()
    assert {"line", "triangle"} == {block.type for block in out.cells}
    values = np.concatenate([np.asarray(part) for part in out.cell_data["region"]])
    assert sorted(values.tolist()) == sorted([*region.tolist(), 8, 9])


@pytest.mark.parametrize("topology", ["fixed", "flip", "full"])
@pytest.mark.parametrize("step", [1, -1])
def test_triangles_stay_clockwise_or_not(tmp_path, topology, step) -> None:
    points, triangles = random_mesh(40)
    stored = read_mesh(written(tmp_path / "in.vtk", points, triangles[:, ::step]))
    better = improve_mesh(stored.mesh, Options(topology=topology))
    changed = {"vertices": better.vertices, "cells": better.cells, "made": better.made}
    write_mesh(tmp_path / "out.vtk", stored, better.points, better.triangles, **changed)
    out = meshio.read(tmp_path / "out.vtk")
    corners = (out.points[out.cells[0].data[:, k], :2] for k in range(3))
    assert (orientations(*corners) == step).all()


def test_point_data_can_mark_fixed_vertices(tmp_path) -> None:
    points, triangles = random_mesh(12)
    marks = np.zeros(len(points))
    marks[-3:] = 1
    path = written(tmp_path / "in.vtk", points, triangles, point_data={"stay": marks})
    assert len(read_mesh(path).mesh.free) == 12
    assert len(read_mesh(path, "stay").mesh.free) == 9
    with pytest.raises(UserError, match=r"no point data 'go' .*stay"):
        read_mesh(path, "go")


def test_mistakes_name_the_file(tmp_path) -> None:
    with pytest.raises(UserError, match=r"gone\.vtk: no such file"):
        read_mesh(tmp_path / "gone.vtk")
    with pytest.raises(UserError, match="is no file"):
        read_mesh(tmp_path)
    (tmp_path / "bad.vtk").write_text("hello")
    with pytest.raises(UserError, match=r"bad\.vtk: not a mesh"):
        read_mesh(tmp_path / "bad.vtk")
    (tmp_path / "bad.xyz").write_text("hello")
    with pytest.raises(UserError, match=r"bad\.xyz: no format .* '\.xyz'"):
        read_mesh(tmp_path / "bad.xyz")
    points, triangles = random_mesh(3)
    triangles[2] = triangles[2, ::-1]
    path = written(tmp_path / "in.vtk", points, triangles)
    with pytest.raises(UserError, match=r"in\.vtk: triangle 2 .* inverted"):
        read_mesh(path)
    square = meshio.Mesh(np.eye(4, 3), [("quad", [[0, 1, 2, 3]])])
    meshio.write(tmp_path / "quad.vtk", square)
    with pytest.raises(UserError, match="kind 'quad'"):
        read_mesh(tmp_path / "quad.vtk")
    meshio.write(tmp_path / "line.vtk", meshio.Mesh(np.eye(3), [("line", [[0, 1]])]))
    with pytest.raises(UserError, match="no triangles"):
        read_mesh(tmp_path / "line.vtk")


def test_what_cannot_be_written_leaves_the_old_file(tmp_path) -> None:
    stored = read_mesh(written(tmp_path / "in.vtk", *random_mesh(3)))
    (tmp_path / "out.strange").write_text("old")
    with pytest.raises(UserError, match=r"out\.strange"):
        write_mesh(tmp_path / "out.strange", stored, stored.mesh.points)
    assert (tmp_path / "out.strange").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.vtk", "out.strange"]
