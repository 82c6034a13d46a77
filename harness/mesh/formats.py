"""The formats of meshio, read and written with what their makers do not promise.

Whatever meshio prints or raises becomes one line; what it wrote is read again and compared.
"""

from __future__ import annotations

import contextlib
import copy
import io
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from harness.errors import UserError
from harness.geometry.predicates import orientations
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats

TRIANGLES = "triangle"
TAGS = ("gmsh:physical", "gmsh:geometrical")
ENTITIES = "gmsh:dim_tags"
SETS = "gmsh:bounding_entities"
"""No set of cells, though it is kept among them."""
PICTURE = "svg"
"""The one format that meshio writes and does not read."""


def read_contents(path: Path) -> Any:
    """What meshio reads, as arrays of this machine's byte order.

    Raises:
        UserError: there is no such file, or it cannot be read.
    """
    if not path.is_file():
        raise UserError(f"{path}: {'is no file' if path.exists() else 'no such file'}")
    _format_of(path)
    return _read(path)


def _read(path: Path) -> Any:
    import meshio

    with _quiet():
        try:
            contents = meshio.read(path)
        except (Exception, SystemExit) as error:  # its readers raise whatever they stumble over
            raise UserError(f"{path}: not a mesh: {_reason(error)}") from None
    return _native(contents)


def _reason(error: BaseException) -> str:
    said = "" if isinstance(error, SystemExit) else " ".join(str(error).split())
    if "gmsh:physical" in said:
        said += (
            " (a Gmsh file with physical groups for some entities only; version 2.2 can be read)"
        )
    return said or "meshio cannot read it"


def _native(contents: Any) -> Any:
    """The same with every array in the byte order of this machine: some writers need that."""

    def turned(data: Any) -> Any:
        array = np.asarray(data)
        return array.astype(array.dtype.newbyteorder("="), copy=False)

    contents.points = turned(contents.points)
    contents.point_data = {name: turned(data) for name, data in contents.point_data.items()}
    contents.cell_data = {
        name: [turned(part) for part in data] for name, data in contents.cell_data.items()
    }
    for block in contents.cells:
        block.data = turned(block.data)
    return contents


def check_target(path: Path) -> None:
    """Raise UserError if no mesh can be written there, as far as that is known before."""
    _format_of(path)
    if path.is_dir():
        raise UserError(f"{path}: is a directory")
    if not path.parent.is_dir():
        raise UserError(f"{path}: there is no directory {path.parent}")


def _format_of(path: Path) -> str:
    """The name of the format that the suffix tells."""
    import meshio

    known = meshio.extension_to_filetypes
    suffix = _suffix(path)
    if suffix not in known:
        raise UserError(
            f"{path}: no format of meshes has the suffix {suffix!r}; "
            f"known are {', '.join(sorted(known))}"
        )
    name = str(known[suffix][-1])  # of ".msh" the last is Gmsh
    if name == "tetgen":
        raise UserError(f"{path}: meshio's TetGen files hold tetrahedra, not triangles")
    return name


def _suffix(path: Path) -> str:
    parts = [part.lower() for part in path.suffixes]
    return "".join(parts[-2:] if parts[-1:] == [".gz"] else parts[-1:])


def written(contents: Any, path: Path) -> tuple[bytes, list[str]]:
    """The bytes of a file of this name, and what of the contents they do not hold.

    What is written is read again where meshio can.

    Raises:
        UserError: the format is unknown, or cannot hold the triangles.
    """
    name = _format_of(path)
    reason = ""
    for attempt in (_plain if name == "gmsh" else _without_entities, _triangles_only, _bare):
        with tempfile.TemporaryDirectory(prefix="avd-mesh-") as folder:
            scratch = Path(folder, "mesh" + _suffix(path))
            failed = _write(attempt(contents), scratch, name)
            if failed is None:
                alone = Path(folder, "alone", scratch.name)  # formats may use further files
                alone.parent.mkdir()
                scratch.rename(alone)
                return alone.read_bytes(), _lost(contents, alone, path)
            reason = reason or failed
    raise UserError(f"{path}: meshio cannot write it" + (f": {reason}" if reason else ""))


def _write(contents: Any, scratch: Path, name: str) -> str | None:
    """Let meshio write a file; None, or what it says if it cannot."""
    import meshio

    settings = {}
    if name == "gmsh" and not _is_by_entity(contents):
        name = "gmsh22"  # with the tags of every cell
    if name == "xdmf":
        settings["data_format"] = "XML"  # one file
    with _quiet():
        try:
            meshio.write(scratch, contents, file_format=name, **settings)
        except (Exception, SystemExit) as error:  # its writers raise whatever they stumble over
            return " ".join(str(error).split())
    return None


def _plain(contents: Any) -> Any:
    """A copy; some writers change what they are given."""
    changed = copy.copy(contents)
    changed.point_data = dict(contents.point_data)
    changed.cell_data, changed.cell_sets = dict(contents.cell_data), dict(contents.cell_sets)
    return changed


def _without_entities(contents: Any) -> Any:
    """Without what is kept among sets of cells and is none: others than Gmsh stumble over it."""
    changed = _plain(contents)
    changed.cell_sets.pop(SETS, None)
    return changed


def _triangles_only(contents: Any) -> Any:
    """Without lines and vertices as cells, which some formats refuse, and without sets."""
    kept = [k for k, block in enumerate(contents.cells) if block.type == TRIANGLES]
    changed = _plain(contents)
    changed.cells = [contents.cells[k] for k in kept]
    changed.cell_data = {
        name: [parts[k] for k in kept] for name, parts in contents.cell_data.items()
    }
    changed.cell_sets, changed.point_sets = {}, {}
    return changed


def _bare(contents: Any) -> Any:
    """The triangles alone."""
    import meshio

    return meshio.Mesh(contents.points, [(TRIANGLES, triangles_in(contents))])


def _is_by_entity(contents: Any) -> bool:
    """Whether the newer version of Gmsh's format can hold it: one tag a block, and entities."""
    tags = [data for name, data in contents.cell_data.items() if name in TAGS]
    return (
        ENTITIES in contents.point_data
        and len(tags) == len(TAGS)
        and all(len(part) and (part == part[0]).all() for data in tags for part in data)
    )


def _lost(contents: Any, scratch: Path, path: Path) -> list[str]:
    """What does not come back from the file.

    Raises:
        UserError: the triangles do not, or rounding has turned one over.
    """
    if _format_of(path) == PICTURE:
        return ["anything but a picture"]
    try:
        again = _read(scratch)
    except UserError:
        raise UserError(f"{path}: meshio cannot read what it writes in this format") from None
    before, after = triangles_in(contents), triangles_in(again)
    if len(before) != len(after):
        raise UserError(f"{path}: of {len(before)} triangles the format holds {len(after)}")
    signs = _signs(again.points, after)
    wrong = np.flatnonzero(signs * _signs(contents.points, before) <= 0)
    if len(wrong):
        raise UserError(
            f"{path}: the format rounds coordinates so much that triangle {wrong[0]} "
            "(counting from 0) is inverted or flat"
        )
    kinds = {block.type for block in contents.cells} - {block.type for block in again.cells}
    lost = [f"cells of kind {kind}" for kind in sorted(kinds)]
    for what in ("point_data", "cell_data", "point_sets", "cell_sets"):
        names = getattr(contents, what).keys() - getattr(again, what).keys() - {SETS, ENTITIES}
        if what == "cell_sets" and any(names <= set(name.split("-")) for name in again.cell_data):
            continue  # VTK: as data of cells
        lost += [f"{what.replace('_', ' ')} {name}" for name in sorted(names)]
    return lost


def _signs(points: Any, triangles: Ints) -> Any:
    xy: Floats = np.asarray(points, dtype=np.float64)[:, :2]
    return orientations(*(xy[triangles[:, k]] for k in range(3)))


def triangles_in(contents: Any) -> Ints:
    """All triangles (m, 3) of what meshio has read, block after block."""
    found = [
        np.asarray(block.data, dtype=np.int64).reshape(-1, 3)
        for block in contents.cells
        if block.type == TRIANGLES
    ]
    return np.concatenate([np.empty((0, 3), dtype=np.int64), *found])


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Nothing of what the library prints reaches the user's streams."""
    import warnings

    with (
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(io.StringIO()),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")
        yield
