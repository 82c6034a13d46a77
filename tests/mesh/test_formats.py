"""Formats and what they hold: Gmsh's entities, regions, sets, and what is lost is said."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

from harness.errors import UserError
from harness.mesh import read_mesh, write_mesh
from harness.mesh.door import improve_mesh
from harness.mesh.options import Options
from tests.mesh.meshes import random_mesh


def two_regions(left: int = 11, right: int = 12) -> meshio.Mesh:
    """A square in two regions, as Gmsh stores it: a block for every entity, lines included."""
    points, triangles = random_mesh(60, 2)
    space = np.column_stack([points, np.zeros(len(points))])
    here = points[triangles].mean(axis=1)[:, 0] < 0.5
    side = np.flatnonzero(points[:, 1] == 0)
    side = side[np.argsort(points[side, 0])]
    lines = np.column_stack([side[:-1], side[1:]])
    entities = np.full((len(points), 2), (2, 1))
    entities[triangles[~here].ravel()] = (2, 2)
    entities[side] = (1, 5)
    blocks = [("line", lines), ("triangle", triangles[here]), ("triangle", triangles[~here])]
    return meshio.Mesh(
        space,
        blocks,
        point_data={"gmsh:dim_tags": entities},
        cell_data={
            "gmsh:physical": [
                np.full(len(cells), tag)
                for (_, cells), tag in zip(blocks, (21, left, right), strict=True)
            ],
            "gmsh:geometrical": [
                np.full(len(cells), tag) for (_, cells), tag in zip(blocks, (5, 1, 2), strict=True)
            ],
        },
        field_data={"left": np.array([left, 2]), "right": np.array([right, 2])},
    )


def improved(source, target, topology: str, **options) -> list[str]:
    stored = read_mesh(source, **options)
    better = improve_mesh(stored.mesh, Options(topology=topology))
    if not better.is_reconnected:
        return write_mesh(target, stored, better.points)
    return write_mesh(
        target,
        stored,
        better.points,
        better.triangles,
        vertices=better.vertices,
        cells=better.cells,
        made=better.made,
    )


@pytest.mark.parametrize("topology", ["fixed", "flip", "full"])
@pytest.mark.parametrize("version", ["gmsh", "gmsh22"])
def test_gmsh_keeps_its_entities_and_groups(tmp_path, topology, version) -> None:
    meshio.write(tmp_path / "in.msh", two_regions(), file_format=version)
    assert improved(tmp_path / "in.msh", tmp_path / "out.msh", topology) == []
    first, again = (meshio.gmsh.read(tmp_path / name) for name in ("in.msh", "out.msh"))
    assert sorted(again.field_data) == ["left", "right"]
    assert [block.type for block in again.cells] == [block.type for block in first.cells]
    lines = [mesh.points[mesh.cells_dict["line"]] for mesh in (first, again)]
    assert (lines[0] == lines[1]).all()
    areas = [
        {
            tag: area_of(mesh, np.concatenate(mesh.cell_data["gmsh:physical"]) == tag)
            for tag in (11, 12)
        }
        for mesh in (first, again)
    ]
    assert areas[0] == pytest.approx(areas[1])


def area_of(mesh: meshio.Mesh, chosen: np.ndarray) -> float:
    """The area of the chosen cells; lines have none."""
    total, start = 0.0, 0
    for block in mesh.cells:
        here = chosen[start : start + len(block.data)]
        start += len(block.data)
        if block.type == "triangle":
            a, b, c = (mesh.points[block.data[here][:, k], :2] for k in range(3))
            (x, y), (u, v) = (b - a).T, (c - a).T
            total += float(np.abs(x * v - y * u).sum() / 2)
    return total


def test_tags_of_single_cells_survive_in_gmsh_files(tmp_path) -> None:
    points, triangles = random_mesh(30, 1)
    tags = (np.arange(len(triangles)) % 3 == 0).astype(int)
    space = np.column_stack([points, np.zeros(len(points))])
    mesh = meshio.Mesh(
        space, [("triangle", triangles)], cell_data={"gmsh:physical": [tags], "heat": [tags / 7]}
    )
    meshio.write(tmp_path / "in.vtk", mesh)  # whose numbers are of another byte order
    assert improved(tmp_path / "in.vtk", tmp_path / "out.msh", "fixed") == []
    again = meshio.gmsh.read(tmp_path / "out.msh")
    assert (again.cell_data["gmsh:physical"][0] == tags).all()
    assert again.cell_data["heat"][0] == pytest.approx(tags / 7)


@pytest.mark.parametrize(
    ("suffix", "lost"),
    [
        ("vtu", []),
        ("obj", ["cells of kind line", "cell data gmsh:physical", "point data gmsh:dim_tags"]),
        ("mesh", ["cells of kind line"]),
        ("svg", ["anything but a picture"]),
    ],
)
def test_what_a_format_does_not_hold_is_said(tmp_path, suffix, lost) -> None:
    meshio.write(tmp_path / "in.msh", two_regions(), file_format="gmsh")
    said = improved(tmp_path / "in.msh", tmp_path / f"out.{suffix}", "full")
    assert set(lost) - {"point data gmsh:dim_tags"} <= set(said)
    assert bool(said) == bool(lost)


def test_files_beside_the_file_are_not_taken_for_it(tmp_path) -> None:
    points, triangles = random_mesh(10)
    space = np.column_stack([points, np.zeros(len(points))])
    heat = {"heat": np.arange(len(points)) * 0.5}
    meshio.write(tmp_path / "in.vtk", meshio.Mesh(space, [("triangle", triangles)], heat))
    assert improved(tmp_path / "in.vtk", tmp_path / "out.xml", "fixed") == ["point data heat"]


def test_rounding_that_inverts_a_triangle_is_refused(tmp_path) -> None:
    points, triangles = random_mesh(40)
    space = np.column_stack([points * 2.0**-26 + 4096, np.zeros(len(points))])
    meshio.write(tmp_path / "in.vtk", meshio.Mesh(space, [("triangle", triangles)]))
    with pytest.raises(UserError, match=r"out\.bdf: .* triangle \d+"):
        improved(tmp_path / "in.vtk", tmp_path / "out.bdf", "fixed")
    assert not (tmp_path / "out.bdf").exists()


@pytest.mark.parametrize("suffix", ["node", "ele"])
def test_formats_of_solids_are_refused(tmp_path, suffix) -> None:
    (tmp_path / f"in.{suffix}").write_text("# nothing")  # whose reader would wait for ever
    with pytest.raises(UserError, match="tetrahedra"):
        read_mesh(tmp_path / f"in.{suffix}")


def test_whole_numbers_tell_regions_apart_unless_they_count_the_triangles(tmp_path) -> None:
    points, triangles = random_mesh(40)
    space = np.column_stack([points, np.zeros(len(points))])
    m = len(triangles)
    halves = (points[triangles].mean(axis=1)[:, 0] > 0.5) * 1.0
    data = {"number": [np.arange(m)], "heat": [np.arange(m) / 7], "part": [halves]}
    meshio.write(tmp_path / "in.vtu", meshio.Mesh(space, [("triangle", triangles)], None, data))
    kept = read_mesh(tmp_path / "in.vtu").mesh.kept
    assert len(kept)
    assert (np.abs(points[kept][:, :, 0] - 0.5) < 0.4).all()
    assert len(read_mesh(tmp_path / "in.vtu", regions=["part"]).mesh.kept) == len(kept)
    numbers = read_mesh(tmp_path / "in.vtu", regions=["number"]).mesh
    assert not len(numbers.free)
    assert not len(read_mesh(tmp_path / "in.vtu", interfaces=False).mesh.kept)
    with pytest.raises(UserError, match=r"no cell data 'parts' .*part"):
        read_mesh(tmp_path / "in.vtu", regions=["parts"])


def test_sets_of_cells_and_points_are_kept(tmp_path) -> None:
    points, triangles = random_mesh(60, 5)
    space = np.column_stack([points, np.zeros(len(points))])
    left = np.flatnonzero(points[triangles].mean(axis=1)[:, 0] < 0.5)
    mesh = meshio.Mesh(
        space,
        [("triangle", triangles)],
        point_sets={"corner": np.array([0])},
        cell_sets={"left": [left]},
    )
    meshio.write(tmp_path / "in.inp", mesh)
    assert improved(tmp_path / "in.inp", tmp_path / "out.inp", "full") == []
    first, again = (meshio.read(tmp_path / name) for name in ("in.inp", "out.inp"))
    assert (
        first.points[first.point_sets["corner"]] == again.points[again.point_sets["corner"]]
    ).all()
    chosen = [
        np.isin(np.arange(len(m.cells[0].data)), m.cell_sets["left"][0]) for m in (first, again)
    ]
    assert area_of(first, chosen[0]) == pytest.approx(area_of(again, chosen[1]))


def test_lines_inside_stay_and_their_ends_too(tmp_path) -> None:
    points, triangles = random_mesh(60, 5)
    space = np.column_stack([points, np.zeros(len(points))])
    inner = [t for t in triangles.tolist() if min(t) >= len(points) - 60][:3]
    lines = np.array([t[:2] for t in inner])
    mesh = meshio.Mesh(space, [("triangle", triangles), ("line", lines), ("vertex", [[70]])])
    meshio.write(tmp_path / "in.vtu", mesh)
    assert improved(tmp_path / "in.vtu", tmp_path / "out.vtu", "full") == []
    again = meshio.read(tmp_path / "out.vtu")
    assert (again.points[again.cells_dict["line"]] == space[lines]).all()
    assert (again.points[again.cells_dict["vertex"]] == space[70]).all()
    edges = {
        frozenset(pair)
        for t in again.cells_dict["triangle"].tolist()
        for pair in zip(t, t[1:] + t[:1], strict=True)
    }
    assert {frozenset(line) for line in again.cells_dict["line"].tolist()} <= edges
