"""The contents of a mesh file around a better mesh: blocks, data and sets in their places."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.mesh.formats import SETS, TRIANGLES
from harness.mesh.stars import Flags, Ints
from harness.mesh.validation import Floats

GONE = -1


@dataclass(frozen=True, eq=False)
class Renewed:
    """A mesh whose connectivity is new, with what its data come from.

    ``vertices`` (n,), ``cells`` (m,): the old vertex and triangle whose data each takes.
    ``made``: so many of the points, the last ones, are new.
    """

    points: Floats
    triangles: Ints
    vertices: Ints
    cells: Ints
    made: int

    def numbers(self, count: int) -> Ints:
        """For each of ``count`` old vertices its new number, or GONE."""
        stayed = self.vertices[: len(self.vertices) - self.made]
        found = np.full(count, GONE)
        found[stayed] = np.arange(len(stayed))
        return found


def with_points(contents: Any, points: Floats) -> Any:
    """The same with other coordinates in the plane; z stays."""
    moved = copy.copy(contents)
    moved.points = np.array(contents.points, dtype=np.float64)
    moved.points[:, :2] = points
    return moved


def with_triangles(contents: Any, new: Renewed) -> Any:
    """The same with other triangles.

    Each triangle goes into the block of the one that its data come from; lines and single
    vertices stay where their vertices do; blocks that are empty now go.
    """
    import meshio

    numbers = new.numbers(len(contents.points))
    chosen, blocks = _blocks(contents, new, numbers)
    kept = [k for k, block in enumerate(blocks) if len(block)]
    return meshio.Mesh(
        _in_space(contents, new),
        [(contents.cells[k].type, blocks[k]) for k in kept],
        point_data={name: data[new.vertices] for name, data in contents.point_data.items()},
        cell_data={
            name: [np.asarray(parts[k])[chosen[k]] for k in kept]
            for name, parts in contents.cell_data.items()
        },
        field_data=contents.field_data,
        point_sets={
            name: _present(numbers[np.asarray(members)])
            for name, members in contents.point_sets.items()
        },
        cell_sets={
            name: [parts[k] if name == SETS else _among_chosen(chosen[k], parts[k]) for k in kept]
            for name, parts in contents.cell_sets.items()
        },
        gmsh_periodic=_periodic(contents, numbers),
        info=contents.info,
    )


def _blocks(contents: Any, new: Renewed, numbers: Ints) -> tuple[list[Ints], list[Ints]]:
    """For each block the old cells whose data its cells take, and the vertices of its cells."""
    chosen, blocks, start = [], [], 0
    for block in contents.cells:
        if block.type == TRIANGLES:
            here = (new.cells >= start) & (new.cells < start + len(block.data))
            chosen.append(new.cells[here] - start)
            blocks.append(new.triangles[here])
            start += len(block.data)
        else:
            data = numbers[np.asarray(block.data, dtype=np.int64)]
            stay: Flags = (data != GONE).reshape(len(data), -1).all(axis=1)
            chosen.append(np.flatnonzero(stay))
            blocks.append(data[stay])
    return chosen, blocks


def _in_space(contents: Any, new: Renewed) -> Floats:
    """The points, with the z of the old ones where these have one."""
    old = np.asarray(contents.points, dtype=np.float64)
    return new.points if old.shape[1] == 2 else np.column_stack([new.points, old[new.vertices, 2]])


def _present(numbers: Ints) -> Ints:
    there: Ints = numbers[numbers != GONE]
    return there


def _among_chosen(chosen: Ints, members: Any) -> Ints:
    """The cells of a block whose data come from a member of a set."""
    given = np.empty(0, dtype=np.int64) if members is None else np.asarray(members)
    return np.flatnonzero(np.isin(chosen, given))


def _periodic(contents: Any, numbers: Ints) -> Any:
    """Gmsh's pairs of boundary vertices, which stay, by their new numbers."""
    if contents.gmsh_periodic is None:
        return None
    return [
        [dimension, tags, affine, numbers[np.asarray(pairs, dtype=np.int64)]]
        for dimension, tags, affine, pairs in contents.gmsh_periodic
    ]
