"""Outlines tile what they should, curves lie on bisectors, windows hold what they must."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.counts import OBJECTIVES
from harness.diagram.planar_map import PlanarMap
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.report.drawing_shapes import (
    TOLERANCE,
    Shapes,
    checked_window,
    clip,
    framed,
    natural_window,
    roomiest_point,
)
from tests.strategies import instances


def area(ring: np.ndarray) -> float:
    x, y = (ring - ring[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def perimeter(ring: np.ndarray) -> float:
    return float(np.hypot(*(ring - np.roll(ring, -1, axis=0)).T).sum())


def is_inside(rings: list[np.ndarray], point: np.ndarray) -> bool:
    """By the even–odd rule, one chord after another."""
    inside = False
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            if (ay > point[1]) != (by > point[1]):
                inside ^= point[0] < ax + (point[1] - ay) * (bx - ax) / (by - ay)
    return bool(inside)


def visual_angles(diagram: PlanarMap, points: np.ndarray) -> np.ndarray:
    """(n, m) visual angles, by trigonometry."""
    arms = diagram.instance.segments[:, :, None, :] - points
    (ax, ay), (bx, by) = (np.moveaxis(arms[:, k], -1, 0) for k in (0, 1))
    return np.abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))


NONE = np.zeros((0, 2, 2))


@st.composite
def diagrams(draw: st.DrawFn, max_segments: int = 3, max_vertices: int = 5) -> PlanarMap:
    kind, coordinates = draw(instances(max_segments, max_vertices))
    domains = ["plane"] if kind == "segments" else ["kernel", "interior"]
    return build(
        Instance.from_arrays(kind, coordinates),
        draw(st.sampled_from(domains)),
        draw(st.sampled_from(OBJECTIVES)),
    )


@settings(max_examples=40)
@given(diagrams())
def test_the_outlines_of_the_cells_tile_the_domain(diagram: PlanarMap) -> None:
    shapes = Shapes(diagram, natural_window(diagram))
    outlines = [shapes.outlines(k) for k in range(len(diagram.cells))]
    x0, y0, x1, y1 = shapes._cut
    whole = (x1 - x0) * (y1 - y0) if diagram.corners is None else area(diagram.corners)
    parts = [sum(area(ring) for ring in rings) for rings in outlines]
    length = sum(perimeter(ring) for rings in outlines for ring in rings)
    slack = TOLERANCE * shapes.extent * length + 1e-9 * whole
    assert sum(parts) == pytest.approx(whole, abs=slack)
    assert min(parts) >= -slack
    for k, rings in enumerate(outlines):
        assert all(ring[:, 0].min() >= x0 and ring[:, 0].max() <= x1 for ring in rings), k


#: Six edges leave side by side in two opposite directions, some sampled much farther than others.
SIDE_BY_SIDE = [((-6, -2), (3, 1)), ((-7, 1), (2, 4)), ((1, 7), (7, 9))]


def test_outlines_between_parallel_asymptotes_hold_their_points_only() -> None:
    outlines_hold_their_points(build(Instance.from_arrays("segments", SIDE_BY_SIDE), "plane"))


@settings(max_examples=40)
@given(diagrams())
def test_an_outline_holds_the_points_of_its_cell_and_no_others(diagram: PlanarMap) -> None:
    outlines_hold_their_points(diagram)


def outlines_hold_their_points(diagram: PlanarMap) -> None:
    """Every witness lies in the outline of its cell and in no other."""
    shapes = Shapes(diagram, natural_window(diagram))
    x0, y0, x1, y1 = shapes.window
    outlines = [shapes.outlines(k) for k in range(len(diagram.cells))]
    for (x, y), cell in diagram.witnesses:
        point = np.array([float(x), float(y)])
        if not (x0 < x < x1 and y0 < y < y1):
            continue
        near = min(
            (roomy_distance(ring, point) for rings in outlines for ring in rings), default=math.inf
        )
        if near > 2 * TOLERANCE * shapes.extent:
            holders = [k for k, rings in enumerate(outlines) if is_inside(rings, point)]
            assert holders == [cell] * (cell >= 0)


def roomy_distance(ring: np.ndarray, point: np.ndarray) -> float:
    a, b = ring, np.roll(ring, -1, axis=0)
    along = b - a
    squares = (along**2).sum(axis=1)
    part = np.clip(((point - a) * along).sum(axis=1) / np.where(squares > 0, squares, 1), 0, 1)
    return float(np.hypot(*(point - a - part[:, None] * along).T).min())


@settings(max_examples=40)
@given(diagrams())
def test_curves_lie_where_the_best_angles_tie(diagram: PlanarMap) -> None:
    shapes = Shapes(diagram, natural_window(diagram))
    sense = 1 if diagram.objective == "smallest" else -1
    ends = diagram.instance.segments.reshape(-1, 2)
    for edge, curve in zip(diagram.edges, shapes.curves, strict=True):
        x0, y0, x1, y1 = shapes.window
        points = curve[((curve >= (x0, y0)) & (curve <= (x1, y1))).all(axis=1)]
        # Near an end point an angle turns quickly, and doubles cannot follow.
        apart = np.hypot(*(points[:, None] - ends).transpose(2, 0, 1)).min(axis=1)
        points = points[apart > 1e-3 * shapes.extent]
        if len(points):
            angles = visual_angles(diagram, points)
            i, j = edge.segments
            assert np.abs(angles[i] - angles[j]).max() < 1e-6
            assert (sense * (angles - angles[i])).min() > -1e-6


@settings(max_examples=60)
@given(diagrams())
def test_the_natural_window_shows_all_segments(diagram: PlanarMap) -> None:
    window = natural_window(diagram)
    x0, y0, x1, y1 = window
    ends = diagram.instance.segments.reshape(-1, 2)
    assert ((ends > (x0, y0)) & (ends < (x1, y1))).all()
    extent = float(np.ptp(ends, axis=0).max())
    assert max(x1 - x0, y1 - y0) <= 5 * extent  # nodes far away do not make them tiny
    assert checked_window(window) == window


coordinate = st.floats(-3, 3, width=16)


@given(
    st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=12),
    st.lists(st.tuples(st.floats(-0.99, 0.99), st.floats(-0.99, 0.99)), min_size=1, max_size=20),
)
def test_clipping_keeps_what_is_inside_the_box(ring, points) -> None:
    ring = np.array(ring)
    cut = clip(ring, (-1, -1, 1, 1))
    assert not len(cut) or np.abs(cut).max() <= 1
    for point in np.array(points):
        if roomy_distance(ring, point) > 1e-9:
            assert is_inside([ring], point) == is_inside([cut], point)


@given(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=8))
def test_the_roomiest_point_is_inside_and_as_far_as_it_says(ring) -> None:
    rings = [np.array(ring)]
    point, distance = roomiest_point(rings, NONE)
    assume(distance > 1e-9)
    assert is_inside(rings, point)
    assert roomy_distance(rings[0], point) == pytest.approx(distance, rel=1e-9, abs=1e-12)


def test_the_roomiest_point_avoids_holes() -> None:
    square = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
    hole = (1.0 + square / 2)[::-1]
    point, distance = roomiest_point([square, hole], NONE)
    assert not is_inside([hole], point)
    assert 0.4 < distance <= 0.5 * (1 + 1e-9) + 0.3  # corners have a little more room


def test_the_roomiest_point_keeps_away_from_segments() -> None:
    """A segment that the cell does not notice: its number must not be written over another's."""
    square = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
    far = [[(5.0, 2.0), (9.0, 2.0)]]
    across = [[(-1.0, 2.0), (5.0, 2.0)]]
    assert roomiest_point([square], np.array(far))[1] == roomiest_point([square], NONE)[1]
    point, distance = roomiest_point([square], np.array(across))
    assert abs(point[1] - 2.0) >= distance
    assert distance == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(
    "window",
    [
        (0, 0, 0, 1),
        (0, 1, 1, 0),
        (0, 0, math.nan, 1),
        (0, 0, math.inf, 1),
        (-1e300, -1e300, 1e300, 1e300),
        (0, 0, 1e-300, 1e-300),
        (1e9, 0, 1e9 + 1e-3, 1e-3),
    ],
)
def test_windows_that_cannot_be_drawn_are_refused(window) -> None:
    with pytest.raises(UserError, match="window"):
        checked_window(window)


def test_a_frame_is_never_a_sliver() -> None:
    x0, y0, x1, y1 = framed(np.array([(0.0, 5.0), (8.0, 5.0)]))
    assert 0.25 <= (y1 - y0) / (x1 - x0) <= 4
    assert y0 < 5 < y1
