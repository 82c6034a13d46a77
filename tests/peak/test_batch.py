"""Batches of peaks: bounds that sampling cannot break, symmetries, known cases, planted faults."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.geometry.visual_angle import visual_angle
from harness.peak import peaks
from harness.peak.bounds import cotangent_bound
from tests.peak.polygons import KNOWN, STARS, generated, kernel_points, least_angles, regular
from tests.peak.polygons import segments_of as segments

CLOSE = 1e-12


def batch(family: str, sizes: range, seeds: range) -> tuple[list[np.ndarray], np.ndarray]:
    """All polygons of these sizes and seeds, and their offsets."""
    found = [generated(family, n, seed) for n in sizes for seed in seeds]
    polygons = [polygon for polygon in found if polygon is not None]
    return polygons, np.cumsum([0, *map(len, polygons)])


@pytest.mark.parametrize("family", STARS)
def test_no_point_of_the_kernel_beats_the_bound_and_the_point_reaches_the_angle(family):
    polygons, offsets = batch(family, range(3, 13), range(4))
    found = peaks(np.concatenate(polygons), offsets)
    assert (found.status == 0).all()
    assert (found.bounds - found.angles <= CLOSE).all()
    rng = np.random.default_rng(1)
    for k, polygon in enumerate(polygons):
        seen = least_angles(kernel_points(polygon, 2000, rng), polygon)
        assert np.nanmax(seen) <= found.bounds[k]
        if found.vertices[k] < 0:
            (reached,) = least_angles(found.points[k : k + 1], polygon)
            assert reached == pytest.approx(found.angles[k], abs=CLOSE)


@pytest.mark.parametrize("name", KNOWN)
def test_known_peaks(name):
    vertices, angle, point = KNOWN[name]
    found = peaks(np.array([vertices], dtype=float))
    assert found.status.tolist() == [0]
    assert found.angles[0] == pytest.approx(angle, abs=CLOSE)
    assert found.points[0] == pytest.approx(point, abs=1e-7)


def test_of_an_equal_vertex_and_wall_it_says_which():
    found = peaks([KNOWN["letter L"][0], KNOWN["letter L"][0][::-1]])
    assert found.vertices.tolist() == [3, 2]
    assert not found.walls.any()
    low = peaks([KNOWN["low trapezoid"][0]])
    assert low.bases[low.walls].tolist() == [0]
    assert low.vertices.tolist() == [-1]


@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 100, 1001])
def test_regular_polygons_tie_all_edges_at_once(n):
    found = peaks(regular(n)[np.newaxis])
    assert found.status.tolist() == [0]
    assert found.angles[0] == pytest.approx(2 * math.pi / n, abs=CLOSE)
    assert np.abs(found.points).max() < 1e-12


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10**6),
    n=st.integers(3, 12),
    turn=st.floats(0, 6.3),
    scale=st.floats(1e-3, 1e3),
    shift=st.integers(0, 11),
    flip=st.booleans(),
)
def test_similar_polygons_have_similar_peaks(seed, n, turn, scale, shift, flip):
    polygon = generated("star", n, seed)
    turned = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    image = scale * np.roll(polygon, shift, axis=0)[:: -1 if flip else 1] @ turned
    ours, theirs = peaks(polygon[np.newaxis]), peaks(image[np.newaxis])
    assert theirs.status.tolist() == ours.status.tolist() == [0]
    assert theirs.angles[0] == pytest.approx(ours.angles[0], abs=1e-11)
    image_of_ours = scale * ours.points @ turned
    assert theirs.points == pytest.approx(image_of_ours, abs=1e-5 * scale)


@given(seed=st.integers(0, 10**6), n=st.integers(3, 9))
def test_a_basis_alone_has_the_same_bound(seed, n):
    """The discs of the basis are seen under one angle: that of the peak."""
    polygon = generated("star-fat", max(n, 4), seed)
    found = peaks(polygon[np.newaxis])
    if found.vertices[0] < 0:
        tied = found.bases[0][(found.bases[0] >= 0) & ~found.walls[0]]
        seen = visual_angle(found.points[0], segments(polygon)[tied])
        assert seen == pytest.approx(found.angles[0], abs=1e-9)


@given(
    seed=st.integers(0, 10**6),
    weights=st.lists(st.floats(0, 1), min_size=3, max_size=3),
    edges=st.lists(st.integers(0, 6), min_size=3, max_size=3, unique=True),
    x=st.floats(-0.3, 0.3),
    y=st.floats(-0.3, 0.3),
)
def test_bounds_from_wrong_multipliers_are_far_but_true(seed, weights, edges, x, y):
    polygon = generated("near-regular", 7, seed)
    true = peaks(polygon[np.newaxis])
    starts = polygon - (x, y)
    along = np.roll(polygon, -1, axis=0) - polygon
    constraints = np.array([2 * edge for edge in edges])
    bound = cotangent_bound(
        1 / math.tan(true.angles[0]), constraints, np.array(weights), *starts.T, *along.T, 7
    )
    assert math.atan2(1, bound) >= true.angles[0]


def test_no_star_and_no_polygon_are_told_apart():
    comb = [(0, 0), (9, 0), (9, 9), (8, 1), (5, 1), (4, 9), (3, 1), (1, 1), (0, 9)]
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    double = [(0, 0), (1, 0), (1, 0), (0, 1)]
    flat = [(0, 0), (1, 0), (2, 0)]
    strange = [(0, 0), (1, 0), (math.nan, 1)]
    cases = [comb, square, double, flat, strange, [], square[:2]]
    offsets = np.cumsum([0, *map(len, cases)])
    found = peaks([point for case in cases for point in case], offsets)
    assert found.status.tolist() == [1, 0, 2, 2, 2, 2, 2]
    assert np.isnan(found.angles[[0, 2, 3, 4, 5, 6]]).all()


def test_the_number_of_workers_changes_nothing():
    polygons, offsets = batch("cavity", range(5, 8), range(20))
    every = np.tile(np.concatenate(polygons), (100, 1))
    step = offsets[1:][np.newaxis] + offsets[-1] * np.arange(100)[:, np.newaxis]
    starts = np.concatenate([[0], step.ravel()])
    one, two = peaks(every, starts, workers=1), peaks(every, starts, workers=2)
    assert (one.points == two.points).all()
    assert (one.angles == two.angles).all()


@pytest.mark.parametrize("workers", [0, -2])
def test_somebody_must_work(workers):
    with pytest.raises(UserError, match="at least one worker"):
        peaks(np.zeros((1, 4, 2)), workers=workers)


def test_nothing_is_no_trouble():
    assert len(peaks(np.empty((0, 2)), [0]).angles) == 0


@pytest.mark.parametrize(
    ("vertices", "offsets", "reason"),
    [
        (np.zeros((4, 2)), None, "shape"),
        (np.zeros((4, 3)), [0, 4], "shape"),
        (np.zeros((4, 2)), [0, 3, 2], "decrease at index 2"),
        (np.zeros((4, 2)), [0, 5], "leave"),
        (np.zeros((4, 2)), [0.0, 4.0], "whole numbers"),
        (np.zeros((4, 2)), [-1, 4], "leave"),
        (np.zeros((4, 2)), [], "whole numbers"),
        (np.zeros((4, 2)), np.array([0, 9, 4], dtype=np.uint64), "decrease at index 2"),
        (np.zeros((4, 2)), np.array([0, 2**63 + 5], dtype=np.uint64), "leave"),
        ([[(0, 0), (1, 0)], [(1, 1)]], None, "arrays of numbers"),
        ([["here", "there"]], [0, 1], "arrays of numbers"),
    ],
)
def test_shapes_that_do_not_fit_are_refused(vertices, offsets, reason):
    with pytest.raises(UserError, match=reason):
        peaks(vertices, offsets)
