"""Flips, insertions, deletions: the mesh stays one, and its quality rises with every step."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.geometry.predicates import orientations
from harness.mesh import Mesh, improve
from harness.mesh.edges import can_flip, flip
from harness.mesh.points import delete, split, try_points
from harness.mesh.quality import corner_angles, least_angles
from harness.mesh.stars import triangles_of
from harness.mesh.state import rises, with_places
from harness.mesh.steps import even_out, ideal_degrees, lawson, try_flips
from harness.mesh.validation import boundary
from tests.mesh.meshes import hexagons, random_mesh, triangulations
from tests.mesh.test_improve import is_positive
from tests.mesh.test_validation import rows


def parts(points: np.ndarray, triangles: np.ndarray, places: int = 0):
    """Arrays of a mesh that may be changed: stars, free vertices, coordinates ≤ 1."""
    mesh = Mesh.of(np.ldexp(points, -4), triangles)
    if places:
        mesh = with_places(mesh, places)
    return (*(a.copy() for a in mesh.stars),), ~mesh.fixed, *mesh.points.T.copy()


def is_mesh(points: np.ndarray, triangles: np.ndarray) -> bool:
    """Whether it passes every check of validation."""
    return len(Mesh.of(points, triangles).triangles) == len(triangles)


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    (x, y), (u, v) = (b - a).T, (c - a).T
    return float((x * v - y * u).sum() / 2)


@given(triangulations(), st.data())
def test_a_flip_is_undone_by_its_reverse(made, data) -> None:
    points, triangles = made
    stars, _, x, y = parts(points, triangles)
    v = data.draw(st.integers(0, len(points) - 1))
    i = data.draw(st.integers(0, int(stars[1][v]) - 1))
    w = stars[2][stars[0][v] + i]
    a, b = can_flip(v, w, *stars, x, y)
    if a < 0:
        return
    flip(v, w, a, b, *stars)
    flipped = triangles_of(*stars, len(x))
    assert is_mesh(points, flipped)
    assert len(set(rows(flipped)) - set(rows(triangles))) == 2
    flip(a, b, w, v, *stars)
    assert rows(triangles_of(*stars, len(x))) == rows(triangles)


@given(triangulations())
def test_lawsons_flips_end_in_a_delaunay_mesh(made) -> None:
    points, triangles = made
    stars, _, x, y = parts(points, triangles)
    lawson(*stars, x, y)
    found = triangles_of(*stars, len(x))
    assert is_mesh(points, found)
    # The angles opposite to an inner edge add up to at most π, but for ties.
    angles, opposite = corner_angles(points, found), {}
    for triangle, turn in zip(found.tolist(), angles, strict=True):
        for k in range(3):
            edge = frozenset((triangle[(k + 1) % 3], triangle[(k + 2) % 3]))
            opposite.setdefault(edge, []).append(turn[k])
    assert max(sum(pair) for pair in opposite.values() if len(pair) == 2) < 180 + 0.1


@given(triangulations())
def test_degrees_are_evened_out(made) -> None:
    points, triangles = made
    stars, _, x, y = parts(points, triangles)
    ideal = ideal_degrees(*stars, x, y)
    before = int(((stars[1] - ideal) ** 2).sum())
    flips = even_out(*stars, x, y, ideal, 0.0)
    assert is_mesh(points, triangles_of(*stars, len(x)))
    after = int(((stars[1] - ideal) ** 2).sum())
    assert after <= before - 2 * flips  # the sum is of one parity


@given(triangulations(), st.data())
def test_vertices_go_in_and_out(made, data) -> None:
    points, triangles = made
    stars, _, x, y = parts(points, triangles, 1)
    z = len(points)
    v = data.draw(st.integers(0, z - 1))
    w = stars[2][stars[0][v] + data.draw(st.integers(0, int(stars[1][v]) - 1))]
    if not split(v, w, z, *stars, x, y):
        return
    more = triangles_of(*stars, len(x))
    now = np.column_stack([x, y])
    assert len(more) == len(triangles) + 2
    if not (orientations(*(now[more[:, k]] for k in range(3))) > 0).all():
        return  # the middle was rounded off the edge of a needle
    assert is_mesh(now, more)
    if delete(z, *stars, x, y):
        less = triangles_of(*stars, len(x))
        assert is_mesh(now[:z], less)
        assert len(less) == len(triangles)


@pytest.mark.parametrize("topology", ["flip", "full"])
@settings(max_examples=25)
@given(made=triangulations())
def test_the_result_is_a_better_mesh_of_the_same_domain(made, topology) -> None:
    points, triangles = made
    better = improve(points, triangles, topology=topology, sweeps=4)
    assert is_mesh(better.points, better.triangles)
    assert better.after.smallest >= better.before.smallest - 1e-9
    before = np.sort(least_angles(points, triangles))
    after = np.sort(least_angles(better.points, better.triangles))
    assert rises(before, after) or rows(better.triangles) == rows(triangles)
    assert area(better.points, better.triangles) == pytest.approx(area(points, triangles))
    old, new = (
        {tuple(map(tuple, p[edge].tolist())) for edge in boundary(t)[0]}
        for p, t in ((points, triangles), (better.points, better.triangles))
    )
    assert old == new
    assert len(better.vertices) == len(better.points)
    assert better.vertices.max() < len(points)
    assert len(better.cells) == len(better.triangles)


@pytest.mark.parametrize("share", [0.0, 0.5])
@pytest.mark.parametrize("kind", ["flips", "points"])
def test_quality_rises_with_every_step(kind, share) -> None:
    points, triangles = random_mesh(60, 4)
    stars, free, x, y = parts(points, triangles, 8)
    free &= np.random.default_rng(1).random(len(x)) >= share  # triangles of fixed vertices, too
    waiting, ideal = free.copy(), ideal_degrees(*stars, x, y)
    origins, born = np.arange(len(x)), np.array([len(points)])
    n = len(points)
    last = np.sort(least_angles(np.column_stack([x, y])[:n], triangles))
    kept = 0
    for _ in range(200):
        if kind == "flips":
            found = try_flips(waiting, *stars, free, x, y, ideal, 9.0, 1)
        else:
            found = try_points(waiting, *stars, free, x, y, origins, born, 9.0, 1)
        now, corners = np.column_stack([x, y]), triangles_of(*stars, len(x))
        assert is_positive(now, corners)
        vector = np.sort(least_angles(now, corners))
        if found[2]:
            assert rises(last, vector)
            kept += found[2]
        else:
            assert (vector == last).all()
        last = vector
        if found[3]:
            break
    assert kept > 2


@settings(max_examples=15)
@given(made=triangulations())
def test_flips_are_not_below_moves_alone(made) -> None:
    moved = improve(*made, sweeps=4)
    flipped = improve(*made, sweeps=4, topology="flip")
    assert flipped.after.smallest >= moved.after.smallest - 0.1  # close: then the mean decides


def test_flips_reach_what_is_asked_and_optimal_meshes_stay() -> None:
    points, triangles = random_mesh(1000)
    for topology in ("flip", "full"):
        assert improve(points, triangles, topology=topology).after.smallest >= 34
    still = improve(*hexagons(5), topology="full")
    assert (still.flips, len(still.triangles)) == (0, 50)
    assert np.abs(still.points - hexagons(5)[0]).max() < 1e-12


def test_data_of_new_vertices_and_triangles_comes_from_old_ones() -> None:
    points, triangles = random_mesh(200, 1)
    better = improve(points, triangles, topology="full")
    assert better.is_reconnected
    assert (better.points[: np.searchsorted(better.vertices, 50)] == points[:50]).all()
    old = points[triangles[better.cells]].mean(axis=1)
    new = better.points[better.triangles].mean(axis=1)
    nearest = np.linalg.norm(points[triangles].mean(axis=1)[None] - new[:, None], axis=2)
    assert np.linalg.norm(old - new, axis=1) == pytest.approx(nearest.min(axis=1))
