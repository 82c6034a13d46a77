"""The paper's greedy: its vector rises with every step, and its remedies help at the rim."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from harness.mesh import Mesh, improve
from harness.mesh.apex import greedy, on_bisector
from harness.mesh.quality import corner_angles, least_angles
from harness.mesh.stars import triangles_of
from harness.peak import peak
from tests.mesh.meshes import random_mesh, triangulations
from tests.mesh.test_improve import is_positive


def vector(points: np.ndarray, triangles: np.ndarray, free: np.ndarray, rim: bool) -> list[float]:
    """The sorted α: least angle at each free vertex, or of all its triangles."""
    worth = np.full(len(points), np.inf)
    angles = corner_angles(points, triangles)
    if rim:
        angles = np.repeat(angles.min(axis=1), 3).reshape(-1, 3)
    np.minimum.at(worth, triangles, angles)
    return sorted(worth[free].tolist())


@pytest.mark.parametrize("remedies", [(False, False), (True, False), (False, True), (True, True)])
@settings(max_examples=12)
@given(made=triangulations())
def test_the_vector_rises_with_every_step(made, remedies) -> None:
    points, triangles = made
    mesh = Mesh.of(points, triangles)
    stars, free = mesh.stars, ~mesh.fixed
    x, y = np.ldexp(points, -4).T.copy()
    last = vector(points, triangles, mesh.free, any(remedies))
    waiting = free.copy()
    for _ in range(60):
        _, moved, flips, done = greedy(waiting, *stars, free, x, y, *remedies, 10**6, 1)
        now_points, now = np.column_stack([x, y]), triangles_of(*stars, len(x))
        assert is_positive(now_points, now)
        if moved or flips:
            found = vector(now_points, now, mesh.free, any(remedies))
            pairs = zip(last, found, strict=True)
            old, new = next(pair for pair in pairs if abs(pair[0] - pair[1]) > 1e-11)
            assert new > old
            last = found
        if done:
            break


def test_one_free_vertex_goes_to_the_peak() -> None:
    rim = np.array([(0, 0), (3, -1), (5, 1), (4, 4), (1, 3)], dtype=float)
    triangles = [(i, (i + 1) % 5, 5) for i in range(5)]
    better = improve(np.concatenate([rim, [[1, 1]]]), triangles, objective="apex")
    best = peak(rim.tolist())
    assert better.points[5] == pytest.approx([best.x, best.y], abs=1e-9)


def test_apex_does_not_look_at_the_rim_and_the_remedies_do() -> None:
    points, triangles = random_mesh(400, 2)
    plain = improve(points, triangles, objective="apex")
    remedied = {
        name: improve(points, triangles, objective="apex", remedy=name)
        for name in ("bisector", "chord", "both")
    }
    free = Mesh.of(points, triangles).free
    before = vector(points, triangles, free, rim=False)
    assert vector(plain.points, triangles, free, rim=False) > before
    assert plain.after.smallest < min(each.after.smallest for each in remedied.values())
    assert remedied["bisector"].flips == 0 < remedied["chord"].flips
    assert len(remedied["chord"].triangles) == len(triangles)
    for each in remedied.values():
        assert each.inverted == 0


def test_the_point_on_the_bisector_is_the_best_there() -> None:
    rim = np.array([(0, 0), (6, -1), (7, 2), (2, 3), (0.5, 2.5)], dtype=float)
    for at in range(5):
        best, px, py = on_bisector(at, 5, *rim.T.copy(), np.empty(15))
        direction = np.array([px, py]) - rim[at]
        arms = [rim[at - 1] - rim[at], rim[(at + 1) % 5] - rim[at]]
        cosines = [direction @ arm / np.hypot(*arm) for arm in arms]
        assert cosines[0] == pytest.approx(cosines[1])
        fan = np.array([(i, (i + 1) % 5, 5) for i in range(5)])

        def least(t: float, here=rim[at], way=direction, fan=fan) -> float:
            placed = np.concatenate([rim, [here + t * way]])
            if not is_positive(placed, fan):
                return 0.0
            return float(corner_angles(placed, fan)[:, 2].min())

        assert np.degrees(best) == pytest.approx(least(1.0), rel=1e-6)
        assert least(1.0) >= max(map(least, np.linspace(0.01, 5, 500))) - 1e-6


@pytest.mark.parametrize("objective", ["laplacian", "smart-laplacian", "combined"])
def test_baselines_do_what_they_are_known_for(objective) -> None:
    points, triangles = random_mesh(500)
    done = improve(points, triangles, objective=objective)
    assert done.after.mean > done.before.mean
    if objective != "laplacian":
        assert done.inverted == 0
        assert done.after.smallest >= done.before.smallest
    mesh = Mesh.of(points, triangles)
    if objective == "laplacian":
        converged = improve(points, triangles, objective=objective, sweeps=2000)
        for v in mesh.free[:20]:
            first = mesh.stars.offsets[v]
            around = mesh.stars.ring[first : first + mesh.stars.degrees[v]]
            mean = converged.points[around].mean(axis=0)
            assert converged.points[v] == pytest.approx(mean, abs=1e-9)


def test_laplacian_tells_that_it_has_inverted_a_triangle() -> None:
    # The mean of the rim lies outside the kernel of this arrow head.
    points = [(0, 0), (10, 1), (9, 0), (10, -1), (1, 0)]
    points = [(0, 0), (10, -9), (3, 0), (10, 9), (1.5, 0)]
    triangles = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    plain = improve(points, triangles, objective="laplacian")
    assert plain.inverted > 0
    assert plain.after.smallest == 0
    smart = improve(points, triangles, objective="smart-laplacian")
    assert smart.inverted == 0
    assert (least_angles(smart.points, np.array(triangles)) > 0).all()
