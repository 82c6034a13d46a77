"""What is no triangulation of the plane is refused, and the triangle named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.errors import UserError
from harness.mesh import Mesh, pieces
from harness.mesh.stars import triangles_of
from tests.mesh.meshes import grid_mesh, random_mesh, triangulations

SQUARE = [[0, 0], [2, 0], [2, 2], [0, 2]]


def rows(triangles: np.ndarray) -> list[tuple[int, ...]]:
    """Triangles, each from its least vertex on, sorted."""
    return sorted(tuple(np.roll(t, -int(np.argmin(t))).tolist()) for t in triangles)


@given(triangulations())
def test_stars_hold_the_triangles_and_the_boundary_stays(made) -> None:
    points, triangles = made
    mesh = Mesh.of(points, triangles)
    assert rows(triangles_of(*mesh.stars, len(points))) == rows(triangles)
    on_the_hull = (points == points.min(axis=0)) | (points == points.max(axis=0))
    assert (mesh.fixed == on_the_hull.any(axis=1)).all()


@given(triangulations(), st.data())
def test_an_inverted_triangle_is_named(made, data) -> None:
    points, triangles = made
    if len(triangles) < 3:
        return
    wrong = data.draw(st.integers(0, len(triangles) - 1))
    triangles[wrong] = triangles[wrong, ::-1]
    with pytest.raises(UserError, match=rf"^triangle {wrong} .* inverted"):
        Mesh.of(points, triangles)


def test_a_mesh_that_is_clockwise_throughout_is_turned() -> None:
    points, triangles = random_mesh(5)
    turned = Mesh.of(points, triangles[:, ::-1])
    assert rows(turned.triangles) == rows(triangles)


REFUSED = {
    "flat": ([[0, 0], [1, 1], [2, 2], [0, 2]], [[0, 1, 3], [0, 1, 2]], "triangle 1 .* flat"),
    "non-planar": (
        [[0, 0, 5], [1, 0, 5], [0, 1, 5], [1, 1, 6]],
        [[0, 1, 2], [1, 3, 2]],
        "triangle 1 .* plane",
    ),
    "twice": (SQUARE, [[0, 1, 2], [0, 2, 2]], "triangle 1 .* twice"),
    "unknown vertex": (SQUARE, [[0, 1, 4]], "triangle 0 .* not among the 4"),
    "negative vertex": (SQUARE, [[0, 1, -1]], "triangle 0 .* not among the 4"),
    "not finite": ([[0, 0], [1, 0], [0, np.inf]], [[0, 1, 2]], "point 2 .* finite"),
    "not numbers": ([["a", 0]], [[0, 1, 2]], "arrays of numbers"),
    "no triangle": (SQUARE, np.zeros((0, 3), int), "m ≥ 1"),
    "not whole": (SQUARE, [[0, 1, 2.5]], "whole numbers"),
    "repeated": (SQUARE, [[0, 1, 2], [0, 1, 2]], "triangle 1 .* not a manifold"),
    "three at an edge": (
        [[0, 0], [1, 0], [0, 1], [1, 1], [0.2, 2]],
        [[0, 1, 2], [1, 3, 2], [1, 4, 2]],
        r"triangle 2 .* and triangle 1 .* not a manifold",
    ),
    "held by a vertex": (
        [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]],
        [[0, 1, 2], [0, 3, 4]],
        r"triangle 1 .* hangs on the others by vertex 0",
    ),
    "crossing pieces": (
        [[0, 0], [4, 0], [0, 4], [1, 1], [5, 1], [1, 5]],
        [[0, 1, 2], [3, 4, 5]],
        "triangle 1 .* folded over triangle 0",
    ),
    "a piece on another": (
        [[0, 0], [9, 0], [0, 9], [1, 1], [2, 1], [1, 2]],
        [[0, 1, 2], [3, 4, 5]],
        r"triangle 1 .* lies on triangle 0",
    ),
    "a piece on an edge of another": (
        [*SQUARE, [0.75, 0.75], [1.25, 0.75], [0.75, 1.25]],
        [[0, 1, 2], [0, 2, 3], [4, 5, 6]],
        r"triangle 2 .* lies on triangle 0",
    ),
    "a piece on a vertex of another": (
        [*SQUARE, [1, 1], [0.75, 0.75], [1.25, 0.75], [1, 1.5]],
        [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [5, 6, 7]],
        r"triangle 4 .* lies on triangle 0",
    ),
    "a piece with corners in common": (
        [[0, 0], [6, 0], [6, 6], [0, 6], [3, 3], [0, 0], [6, 0], [6, 6]],
        [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [5, 6, 7]],
        r"triangle 4 .* folded over triangle 0",
    ),
    "the same piece twice": (
        [[0, 0], [9, 0], [0, 9], [0, 0], [9, 0], [0, 9]],
        [[0, 1, 2], [3, 4, 5]],
        "triangle 1 .* folded over triangle 0",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_and_how(case) -> None:
    points, triangles, message = REFUSED[case]
    with pytest.raises(UserError, match=message):
        Mesh.of(points, triangles)


def fan(turns: float, k: int, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """k triangles around the origin that together turn by ``turns`` full turns."""
    angles = np.arange(k + (not closed)) * 2 * np.pi * turns / k
    rim = np.arange(len(angles)) + 1
    points = np.concatenate([[[0, 0]], np.column_stack([np.cos(angles), np.sin(angles)])])
    pairs = np.column_stack([rim, np.roll(rim, -1)])[:k]
    return points, np.column_stack([np.zeros(k, int), pairs])


def test_a_star_that_turns_twice_is_folded() -> None:
    assert Mesh.of(*fan(1, 5, closed=True)).free.tolist() == [0]
    with pytest.raises(UserError, match="folded over others at vertex 0"):
        Mesh.of(*fan(2, 7, closed=True))


def test_a_fan_that_turns_too_far_is_folded_and_a_crack_is_not() -> None:
    assert not len(Mesh.of(*fan(0.9, 5, closed=False)).free)
    with pytest.raises(UserError, match="folded over others at vertex 0"):
        Mesh.of(*fan(1.1, 6, closed=False))
    points, triangles = fan(1, 6, closed=False)
    points[-1] = points[1]  # the first and the last edge lie on each other, from both sides
    assert not len(Mesh.of(points, triangles).free)


def test_fans_are_measured_where_differences_are_no_doubles() -> None:
    points, triangles = grid_mesh(1)
    m = np.finfo(np.float64).max
    assert not len(Mesh.of((2 * points - 1) * m, triangles).free)
    spiral, around = fan(1.1, 6, closed=False)
    with pytest.raises(UserError, match="folded over others at vertex 0"):
        Mesh.of(spiral * m, around)


def test_pieces_beside_each_other_and_holes_are_fine() -> None:
    points, triangles = grid_mesh(4)
    centres = points[triangles].mean(axis=1)
    ring = triangles[(np.abs(centres - 0.5) > 0.25).any(axis=1)]
    inner = np.array([[0.4, 0.4], [0.6, 0.4], [0.5, 0.6]])
    mesh = Mesh.of(np.concatenate([points, inner]), np.concatenate([ring, [[25, 26, 27]]]))
    assert not len(mesh.free)


def test_only_few_of_many_pieces_are_compared_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    holds = pieces._holds
    compared = []

    def counted(triangle: Any, point: Any) -> bool:
        compared.append(point)
        return holds(triangle, point)

    monkeypatch.setattr(pieces, "_holds", counted)
    ticks = np.meshgrid(np.arange(150.0), np.arange(150.0))
    corner = np.array([[0.0, 0.0], [0.5, 0.1], [0.2, 0.6]])
    points = (np.stack(ticks, axis=-1).reshape(-1, 1, 2) + corner).reshape(-1, 2)
    triangles = np.arange(len(points)).reshape(-1, 3)
    assert len(Mesh.of(points, triangles).triangles) == 22500
    assert compared == []
    points[-3:] = [0.2, 0.2] + 0.01 * (points[-3:] - points[-3])
    with pytest.raises(UserError, match=r"triangle 22499 .* lies on triangle 0 of another"):
        Mesh.of(points, triangles)
    assert len(compared) == 1


def test_fixed_vertices_are_indices_or_truth_values() -> None:
    points, triangles = grid_mesh(3)
    free = Mesh.of(points, triangles).free
    assert len(free) == 4
    assert Mesh.of(points, triangles, free[:1]).free.tolist() == free[1:].tolist()
    marks = np.isin(np.arange(len(points)), free[1:])
    assert Mesh.of(points, triangles, marks).free.tolist() == free[:1].tolist()
    for wrong in ([99], [-1], [0.5]):
        with pytest.raises(UserError, match=r"^fixed"):
            Mesh.of(points, triangles, wrong)
