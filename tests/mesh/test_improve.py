"""Improving all angles: never worse, never inverted, and as good as what is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.geometry.predicates import orientations
from harness.mesh import improve
from harness.mesh.quality import corner_angles, least_angles
from harness.mesh.state import rises
from tests.mesh.meshes import grid_mesh, hexagons, needle, random_mesh, triangulations


def is_positive(points: np.ndarray, triangles: np.ndarray) -> bool:
    return bool((orientations(*(points[triangles[:, k]] for k in range(3))) > 0).all())


@settings(max_examples=40)
@given(triangulations(), st.integers(0, 6))
def test_the_mesh_is_never_worse_and_never_inverted(made, sweeps) -> None:
    points, triangles = made
    better = improve(points, triangles, sweeps=sweeps)
    before = np.sort(least_angles(points, triangles))
    after = np.sort(least_angles(better.points, triangles))
    assert is_positive(better.points, triangles)
    assert rises(before, after) or (better.points == points).all()
    assert better.after.smallest >= better.before.smallest - 1e-9


@given(triangulations(), st.data())
def test_fixed_vertices_stay(made, data) -> None:
    points, triangles = made
    fixed = data.draw(st.lists(st.integers(0, len(points) - 1)))
    better = improve(points, triangles, fixed=fixed, sweeps=3)
    rim = (points == points.min(axis=0)) | (points == points.max(axis=0))
    stay = rim.any(axis=1) | np.isin(np.arange(len(points)), fixed)
    assert (better.points[stay] == points[stay]).all()


@pytest.mark.parametrize("exponent", [-900, -300, 300, 900])
def test_scale_does_not_matter(exponent) -> None:
    points, triangles = random_mesh(60)
    here = improve(points, triangles, sweeps=6)
    there = improve(np.ldexp(points, exponent), triangles, sweeps=6)
    assert (np.ldexp(there.points, -exponent) == here.points).all()
    assert there.after == here.after


@pytest.mark.parametrize("mesh", [hexagons(6), grid_mesh(6)], ids=["equilateral", "grid"])
def test_what_is_optimal_does_not_move(mesh) -> None:
    better = improve(*mesh)
    assert np.abs(better.points - mesh[0]).max() < 1e-12
    again = improve(better.points, mesh[1])
    assert (again.points == better.points).all()


@pytest.mark.parametrize("height", [1e-2, 1e-6, 1e-9])
def test_needles_are_improved_too(height) -> None:
    points, triangles = needle(height)
    better = improve(points, triangles)
    # By symmetry the best place is the centre, where all four acute angles are atan(height).
    assert better.after.smallest == pytest.approx(np.degrees(np.arctan(height)), rel=0.05)
    assert better.after.smallest > 2 * better.before.smallest
    assert is_positive(better.points, triangles)


def test_one_vertex_finds_the_best_point_of_its_star() -> None:
    rng = np.random.default_rng(3)
    angle = np.sort(rng.uniform(0, 2 * np.pi / 7, 7) + np.arange(7) * 2 * np.pi / 7)
    radius = rng.uniform(0.8, 1.2, 7)
    rim = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    triangles = np.column_stack([np.arange(7), np.roll(np.arange(7), -1), np.full(7, 7)])

    def least(p: tuple[float, float]) -> float:
        return float(corner_angles(np.concatenate([rim, [p]]), triangles).min())

    better = improve(np.concatenate([rim, [[0.05, 0.1]]]), triangles)
    # A grid that closes in on the best point: the function is quasiconcave.
    centre, reach = np.zeros(2), 0.5
    for _ in range(40):
        ticks = np.linspace(-reach, reach, 9)
        tried = [(centre[0] + a, centre[1] + b) for a in ticks for b in ticks]
        centre = np.array(max(tried, key=least))
        reach *= 0.7
    assert better.after.smallest == pytest.approx(least(tuple(centre)), abs=0.2)
    assert better.after.smallest <= least(tuple(centre)) + 1e-6


@pytest.mark.parametrize("workers", [2, 3])
def test_the_result_does_not_depend_on_the_workers(workers) -> None:
    points, triangles = random_mesh(6000)
    one = improve(points, triangles, sweeps=3, workers=1)
    more = improve(points, triangles, sweeps=3, workers=workers)
    assert (one.points == more.points).all()


@pytest.mark.parametrize(
    "options",
    [{"objective": "combined"}, {"objective": "apex"}, {"topology": "flip"}, {"topology": "full"}],
)
def test_nor_does_that_of_the_other_methods(options) -> None:
    points, triangles = random_mesh(1500)
    one = improve(points, triangles, sweeps=3, workers=1, **options)
    more = improve(points, triangles, sweeps=3, workers=2, **options)
    assert (one.points == more.points).all()
    assert (one.triangles == more.triangles).all()


def test_random_meshes_reach_what_is_asked() -> None:
    better = improve(*random_mesh(1000))
    assert better.after.smallest >= 29.5
    assert better.after.percentile_1 >= 29
    assert better.visits <= 21 * 1000


def test_a_distorted_grid_becomes_regular() -> None:
    assert improve(*grid_mesh(40, 0.24)).after.smallest >= 44.5


def test_a_time_limit_returns_the_best_mesh_so_far() -> None:
    points, triangles = random_mesh(300)
    late = improve(points, triangles, time_limit=0.0)
    assert not late.complete
    assert (
        rises(
            np.sort(least_angles(points, triangles)), np.sort(least_angles(late.points, triangles))
        )
        or (late.points == points).all()
    )
    assert improve(points, triangles, time_limit=1e6).complete


def test_sweeps_are_told_as_they_happen() -> None:
    told = []
    better = improve(*random_mesh(100), sweeps=10, tell=told.append)
    assert told == better.history
    assert [sweep.number for sweep in told] == list(range(1, len(told) + 1))
    assert {sweep.stage for sweep in told} == {"soft", "patches"}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"objective": "best"}, "objective 'best'"),
        ({"objective": "apx"}, "did you mean 'apex'"),
        ({"topology": "free"}, "topology 'free'"),
        ({"remedy": "ear"}, "remedy 'ear'"),
        ({"sweeps": -1}, "sweeps -1"),
        ({"sweeps": 2.5}, "sweeps 2.5 must be a whole number"),
        ({"sweeps": "3"}, "sweeps '3' must be a whole number"),
        ({"sweeps": 10**9}, "sweeps 1000000000 must be .* at most 1000000"),
        ({"workers": 0}, "workers 0 must be a whole number, at least 1"),
        ({"workers": -1}, "workers -1"),
        ({"workers": "two"}, "workers 'two'"),
        ({"time_limit": -1}, "time_limit -1 must be a number of seconds"),
        ({"time_limit": float("nan")}, "time_limit nan"),
        ({"time_limit": "soon"}, "time_limit 'soon'"),
        ({"fixed": [1, [2, 3]]}, "fixed must be an array"),
        ({"regions": [1, [2, 3]]}, "regions must be an array"),
        ({"edges": [[1, 2], [3]]}, "edges must be an array"),
        ({"objective": "apex", "topology": "flip"}, "needs the objective 'all'"),
        ({"remedy": "chord"}, "needs the objective 'apex'"),
    ],
)
def test_wrong_options_are_named(options, message) -> None:
    with pytest.raises(UserError, match=message):
        improve(*grid_mesh(2), **options)


@pytest.mark.parametrize("scale", [8e307, 1e-307, 1e-318])
@pytest.mark.parametrize("topology", ["fixed", "full"])
def test_the_ends_of_doubles_are_in_reach(scale, topology) -> None:
    points, triangles = random_mesh(40, 3)
    better = improve(points * scale, triangles, topology=topology)
    assert is_positive(better.points, better.triangles)
    assert better.after.smallest > better.before.smallest


def test_a_mesh_beyond_doubles_is_refused() -> None:
    points, triangles = random_mesh(40, 3)
    with pytest.raises(UserError, match=r"point \d+ .* range of doubles"):
        improve(points * [1e300, 1e-300], triangles)
    flat = improve(points * [1e100, 1e-60], triangles)
    assert 0 <= flat.after.smallest < 1e-100


def test_vertices_that_no_triangle_uses_do_not_matter() -> None:
    points, triangles = random_mesh(40, 3)
    far = np.concatenate([points, [[1e300, -1e-300]]])
    plain, more = improve(points, triangles), improve(far, triangles)
    assert (more.points == np.concatenate([plain.points, far[-1:]])).all()
    assert more.after == plain.after


@pytest.mark.parametrize("gap", [1e-6, 1e-12, 1e-14, 1e-200])
@pytest.mark.parametrize("topology", ["fixed", "flip", "full"])
def test_the_smallest_angle_does_not_get_worse_however_small_it_is(gap, topology) -> None:
    # What all other angles gain, the triangle of the two close boundary vertices would lose.
    points = [(0, -gap), (3, -1), (3, 1), (0, gap), (0.3, 0)]
    triangles = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    better = improve(points, triangles, topology=topology)
    assert better.before.smallest == pytest.approx(np.degrees(2 * gap / 0.3), rel=1e-4, abs=0)
    assert better.after.smallest >= better.before.smallest


@given(triangulations())
def test_figures_do_not_depend_on_the_order_of_vertices(made) -> None:
    points, triangles = made
    points = points * [1, 1e-9]
    turned = np.roll(triangles, 1, axis=1)
    assert (least_angles(points, triangles) == least_angles(points, turned)).all()


def test_small_angles_have_all_their_digits() -> None:
    for apex in range(3):
        points = np.roll([(1.0, 0.0), (1.0, 1e-20), (0.0, 0.0)], apex, axis=0)
        assert least_angles(points, [(0, 1, 2)]) == pytest.approx(
            np.degrees(1e-20), rel=1e-9, abs=0
        )


def test_angles_of_small_triangles_in_large_meshes_have_their_digits() -> None:
    points = np.array([(1, 1), (-5e-61, 4e-61), (-6e-61, 6e-60), (0, 0), (1e-200, 0), (0, 1e-200)])
    assert least_angles(points, [(3, 4, 5)]) == pytest.approx(45)
    assert least_angles(points[[0, 3, 4, 5]], [(1, 2, 3), (1, 2, 0)])[0] == pytest.approx(45)
    side = points[2] - points[1]
    turn = (side[1] - side[0]) / 2  # divided by the squared distance to (1, 1)
    found = least_angles(points, [(0, 2, 1), (2, 1, 0), (1, 0, 2)])
    assert found == pytest.approx(np.degrees(turn), rel=1e-9, abs=0)
