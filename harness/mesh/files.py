"""Meshes in files: every format of meshio, in and out, with cell and point data kept."""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from harness.errors import UserError
from harness.files import replace
from harness.mesh.mesh import Mesh
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats

TRIANGLES = "triangle"
FLAT = ("vertex", "line", TRIANGLES)
"""Kinds of cells that a triangulation of the plane may have; lines and vertices are kept."""


@dataclass(frozen=True, eq=False)
class Stored:
    """A mesh and the file's contents around it.

    ``cells``: for each block of triangles its place among the blocks and its rows in the mesh.
    """

    mesh: Mesh
    contents: Any
    blocks: tuple[tuple[int, slice], ...]


def read_mesh(path: Path | str, fixed: str | None = None) -> Stored:
    """Read and check a triangulation.

    ``fixed``: the name of point data; vertices where it is not zero stay.

    Raises:
        UserError: names the file, and the triangle or the data that is wrong.
    """
    contents = _read(Path(path))
    try:
        return _stored(contents, fixed)
    except UserError as error:
        raise UserError(f"{path}: {error}") from None


def _stored(contents: Any, fixed: str | None) -> Stored:
    blocks, rows, start = [], [], 0
    for place, block in enumerate(contents.cells):
        if block.type == TRIANGLES:
            blocks.append((place, slice(start, start + len(block.data))))
            rows.append(np.asarray(block.data, dtype=np.int64).reshape(-1, 3))
            start += len(block.data)
        elif block.type not in FLAT:
            raise UserError(f"has cells of kind {block.type!r}; only triangles can be improved")
    if not start:
        raise UserError("has no triangles")
    marks = None if fixed is None else _marks(contents, fixed)
    return Stored(Mesh.of(contents.points, np.concatenate(rows), marks), contents, tuple(blocks))


def _marks(contents: Any, name: str) -> Any:
    if name not in contents.point_data:
        known = ", ".join(sorted(contents.point_data)) or "none"
        raise UserError(f"has no point data {name!r} (there are: {known})")
    values = np.asarray(contents.point_data[name])
    return (values.reshape(len(values), -1) != 0).any(axis=1)


def write_mesh(
    path: Path | str, stored: Stored, points: Floats, triangles: Ints | None = None, **kept: Any
) -> None:
    """Write a mesh in the format that the suffix of ``path`` names, wholly or not at all.

    ``points``: (n, 2), in place of those of ``stored``; z, cells, point and cell data stay as
    they were.  With ``triangles``, the connectivity is new: ``kept`` then holds ``vertices``, for
    each new point the old one whose data it takes, and ``cells``, the same for triangles.

    Raises:
        UserError: the format is unknown or cannot hold the mesh.
    """
    contents = stored.contents
    if triangles is None:
        contents = _with_points(contents, points)
    else:
        contents = _reconnected(stored, points, triangles, kept["vertices"], kept["cells"])
    replace(Path(path), _written(contents, Path(path)))


def _with_points(contents: Any, points: Floats) -> Any:
    import copy

    moved = copy.copy(contents)
    moved.points = np.array(contents.points, dtype=np.float64)
    moved.points[:, :2] = points
    return moved


def _reconnected(
    stored: Stored, points: Floats, triangles: Ints, vertices: Ints, cells: Ints
) -> Any:
    """The same contents on another connectivity; lines and vertices go, as they may be gone."""
    import meshio

    old = stored.contents
    height = np.asarray(old.points, dtype=np.float64)
    places = points
    if height.shape[1] == 3:
        z = height[stored.mesh.triangles[0, 0], 2]
        places = np.column_stack([points, np.full(len(points), z)])
    point_data = {name: np.asarray(data)[vertices] for name, data in old.point_data.items()}
    cell_data = {
        name: [np.concatenate([np.asarray(data[place]) for place, _ in stored.blocks])[cells]]
        for name, data in old.cell_data.items()
    }
    return meshio.Mesh(
        places,
        [(TRIANGLES, triangles)],
        point_data=point_data,
        cell_data=cell_data,
        field_data=old.field_data,
    )


def _read(path: Path) -> Any:
    """What meshio reads; whatever it says or raises becomes one line."""
    import meshio

    if not path.is_file():
        raise UserError(f"{path}: {'is no file' if path.exists() else 'no such file'}")
    with _quiet():
        try:
            return meshio.read(path)
        except (Exception, SystemExit) as error:  # its readers raise whatever they stumble over
            reason = str(error) or "meshio cannot read it"
            raise UserError(f"{path}: not a mesh: {reason}") from None


def _written(contents: Any, path: Path) -> bytes:
    """The bytes of a file of this name."""
    import meshio

    suffix = "".join(path.suffixes[-1:]).lower()
    with tempfile.TemporaryDirectory(prefix="avd-mesh-") as folder, _quiet():
        scratch = Path(folder, "mesh" + suffix)
        try:
            meshio.write(os.fspath(scratch), contents)
        except (Exception, SystemExit) as error:  # its writers raise whatever they stumble over
            reason = str(error) or "meshio cannot write it"
            raise UserError(f"{path}: {reason}") from None
        return scratch.read_bytes()


@contextlib.contextmanager
def _quiet() -> Any:
    """Nothing of what the library prints reaches the user's streams."""
    import warnings

    with (
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(io.StringIO()),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")
        yield
