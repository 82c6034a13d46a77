"""Meshes in files: every format of meshio, in and out, with cell and point data kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.files import replace
from harness.mesh.formats import SETS, TRIANGLES, read_contents, triangles_in, written
from harness.mesh.interfaces import are_edges
from harness.mesh.mesh import Mesh
from harness.mesh.rewriting import Renewed, with_points, with_triangles
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats

FLAT = ("vertex", "line", TRIANGLES)
"""Kinds of cells that a triangulation of the plane may have; lines and vertices are kept."""


@dataclass(frozen=True, eq=False)
class Stored:
    """A mesh and the file's contents around it; the triangles are those of the blocks in turn."""

    mesh: Mesh
    contents: Any


def read_mesh(
    path: Path | str,
    fixed: str | None = None,
    *,
    regions: Sequence[str] | None = None,
    interfaces: bool = True,
) -> Stored:
    """Read and check a triangulation.

    ``fixed``: the name of point data; vertices where it is not zero stay.  ``regions``: the names
    of cell data, or of sets of cells, that tell regions apart; edges between two regions stay, and
    so do their vertices.  By default that is every set of cells, and all cell data of one whole
    number a cell, unless they number the triangles.  Lines and single vertices that the file has
    as cells stay as well.  Without ``interfaces``, nothing of this stays.

    Raises:
        UserError: names the file, and the triangle or the data that is wrong.
    """
    contents = read_contents(Path(path))
    try:
        return _stored(contents, fixed, regions, interfaces)
    except UserError as error:
        raise UserError(f"{path}: {error}") from None


def _stored(
    contents: Any, fixed: str | None, regions: Sequence[str] | None, interfaces: bool
) -> Stored:
    for block in contents.cells:
        if block.type not in FLAT:
            raise UserError(f"has cells of kind {block.type!r}; only triangles can be improved")
    corners = triangles_in(contents)
    if not len(corners):
        raise UserError("has no triangles")
    marks = np.zeros(len(contents.points), dtype=np.bool_)
    if fixed is not None:
        marks |= _marks(contents, fixed)
    if not interfaces:
        return Stored(Mesh.of(contents.points, corners, marks), contents)
    labels, lines = _regions(contents, regions), _cells(contents, "line", 2)
    ends = np.concatenate([lines.ravel(), _cells(contents, "vertex", 1).ravel()])
    if ((ends < 0) | (ends >= len(marks))).any():
        raise UserError("a line or a vertex cell has a vertex that is not among the points")
    marks[ends] = True
    lines = lines[are_edges(corners, lines)]
    return Stored(Mesh.of(contents.points, corners, marks, regions=labels, edges=lines), contents)


def _cells(contents: Any, kind: str, size: int) -> Ints:
    """The cells of one kind, (k, size)."""
    found = [np.asarray(block.data) for block in contents.cells if block.type == kind]
    parts = [data.reshape(-1, size).astype(np.int64) for data in found]
    return np.concatenate([np.empty((0, size), dtype=np.int64), *parts])


def _marks(contents: Any, name: str) -> Any:
    if name not in contents.point_data:
        known = ", ".join(sorted(contents.point_data)) or "none"
        raise UserError(f"has no point data {name!r} (there are: {known})")
    values = np.asarray(contents.point_data[name])
    return (values.reshape(len(values), -1) != 0).any(axis=1)


def _regions(contents: Any, names: Sequence[str] | None) -> npt.NDArray[Any]:
    """What tells the regions of the m triangles apart, (m, j)."""
    places = [k for k, block in enumerate(contents.cells) if block.type == TRIANGLES]
    data = {
        name: np.concatenate([np.asarray(parts[k]) for k in places])
        for name, parts in contents.cell_data.items()
    }
    sets = {
        name: np.concatenate([_members(parts[k], len(contents.cells[k].data)) for k in places])
        for name, parts in contents.cell_sets.items()
        if name != SETS
    }
    if names is None:
        names = [*(name for name, values in data.items() if _are_tags(values)), *sets]
    columns = [np.empty((sum(len(contents.cells[k].data) for k in places), 0), dtype=np.int64)]
    for name in names:
        if name not in data and name not in sets:
            known = ", ".join(sorted({*data, *sets})) or "none"
            raise UserError(f"has no cell data {name!r} (there are: {known})")
        values = data[name] if name in data else sets[name]
        columns.append(np.unique(values, axis=0, return_inverse=True)[1].reshape(-1, 1))
    return np.concatenate(columns, axis=1)


def _members(chosen: Any, size: int) -> npt.NDArray[np.bool_]:
    """Indices of cells of a block as truth values."""
    marks = np.zeros(size, dtype=np.bool_)
    if chosen is not None:
        marks[np.asarray(chosen, dtype=np.int64)] = True
    return marks


def _are_tags(values: npt.NDArray[Any]) -> bool:
    """Whether these are one whole number a triangle, and not a different one for each."""
    if values.size != len(values) or not np.issubdtype(values.dtype, np.number):
        return False
    flat = values.ravel()
    with np.errstate(invalid="ignore"):
        whole = bool((flat == np.round(flat)).all())
    return whole and len(np.unique(flat)) < len(flat)


def write_mesh(
    path: Path | str,
    stored: Stored,
    points: Floats,
    triangles: Ints | None = None,
    *,
    vertices: Ints | None = None,
    cells: Ints | None = None,
    made: int = 0,
) -> list[str]:
    """Write a mesh in the format that the suffix of ``path`` names, wholly or not at all.

    ``points``: (n, 2), in place of those of ``stored``; z, cells, point and cell data stay as
    they were.  With ``triangles``, the connectivity is new; then ``vertices``, ``cells`` and
    ``made`` say what data they take, as in :class:`harness.mesh.door.Improved`; they are written
    clockwise if those of the file are.  Returns what the format does not hold.

    Raises:
        UserError: the format is unknown or cannot hold the mesh.
    """
    if triangles is None or vertices is None or cells is None:
        contents = with_points(stored.contents, points)
    else:
        turned = triangles[:, ::-1] if _is_clockwise(stored) else triangles
        contents = with_triangles(stored.contents, Renewed(points, turned, vertices, cells, made))
    content, lost = written(contents, Path(path))
    replace(Path(path), content)
    return lost


def _is_clockwise(stored: Stored) -> bool:
    """Whether the triangles had to be turned round when they were checked."""
    return bool((triangles_in(stored.contents)[0] != stored.mesh.triangles[0]).any())
