"""Where the map's objects lie: nodes, edges and cells against the visual angles themselves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.counts import OBJECTIVES, Objective
from harness.diagram.planar_map import VERTEX_KINDS, PlanarMap
from harness.geometry.instance import Instance
from harness.geometry.visual_angle import visual_angle
from tests import strategies
from tests.diagram.support import SQUARE, instance_of, polygon, segments

FIVE = segments(
    ((901, 392), (1149, 234)),
    ((615, 61), (650, 182)),
    ((172, 893), (-123, 1022)),
    ((605, 893), (444, 1062)),
    ((687, 234), (824, 209)),
)

FRACTIONS = np.linspace(0, 1, 51)[1:-1]


def size_of(instance: Instance) -> float:
    return float(np.ptp(instance.segments.reshape(-1, 2), axis=0).max())


@pytest.fixture(scope="module", params=["plane", "largest", "kernel", "square", "corner"])
def diagram(request: pytest.FixtureRequest) -> PlanarMap:
    if request.param == "kernel":
        return build(polygon((6, 1), (5, 4), (1, 5), (-4, 6), (-6, 0), (-3, -5), (3, -4)))
    if request.param == "square":
        return build(polygon(*SQUARE), "plane")
    if request.param == "corner":
        return build(segments(((0, 0), (3, 1)), ((0, 0), (-1, 5))))
    return build(FIVE, objective="largest" if request.param == "largest" else "smallest")


def best_by_point(diagram: PlanarMap, points: Any) -> Any:
    """The best angle at each point and the angles of all segments, shapes (m,) and (n, m)."""
    angles = np.stack([visual_angle(points, s) for s in diagram.instance.segments])
    return (angles.min if diagram.objective == "smallest" else angles.max)(axis=0), angles


def test_polylines_lie_on_their_edges(diagram: PlanarMap) -> None:
    size = size_of(diagram.instance)
    for edge in diagram.edges:
        line = edge.polyline(size / 1000)
        inner = line[1:-1]
        best, angles = best_by_point(diagram, inner)
        for segment in edge.segments:
            assert angles[segment] == pytest.approx(best, abs=1e-7)


def test_polylines_run_from_node_to_node(diagram: PlanarMap) -> None:
    for edge in diagram.edges:
        line = edge.polyline(size_of(diagram.instance) / 100)
        for k, point in ((edge.start, line[0]), (edge.end, line[-1])):
            if k is None:
                assert tuple(line[0]) == tuple(line[-1])
            elif diagram.nodes[k].kind != "infinity":
                assert tuple(point) == diagram.nodes[k].point


def test_finer_polylines_stay_within_the_tolerance(diagram: PlanarMap) -> None:
    size = size_of(diagram.instance)
    shape = diagram.instance.segments.reshape(-1, 2)
    low, high = shape.min(axis=0) - size, shape.max(axis=0) + size
    for edge in diagram.edges:
        coarse, fine = edge.polyline(size / 50), edge.polyline(size / 5000)
        starts, ends = coarse[:-1], coarse[1:]
        for point in fine[np.all((fine >= low) & (fine <= high), axis=1)]:
            along = np.sum((point - starts) * (ends - starts), axis=1)
            weight = along / np.maximum(np.sum((ends - starts) ** 2, axis=1), 1e-300)
            foot = starts + np.clip(weight, 0, 1)[:, None] * (ends - starts)
            assert np.min(np.hypot(*(point - foot).T)) <= size / 50 * (1 + 1e-6)


def test_left_and_right_of_an_edge(diagram: PlanarMap) -> None:
    size = size_of(diagram.instance)
    tolerance = size / 1e5
    centre = diagram.instance.segments.mean(axis=(0, 1))
    tried = 0
    for edge in diagram.edges:
        line = edge.polyline(tolerance)
        near = np.abs(line - centre).max(axis=1) <= size
        if not np.any(near[1:] & near[:-1]):
            continue
        # Where the points are crowded the edge may be about to meet others.
        lengths = np.where(near[1:] & near[:-1], np.hypot(*np.diff(line, axis=0).T), 0)
        k = int(lengths.argmax()) + 1
        direction, middle = line[k] - line[k - 1], (line[k] + line[k - 1]) / 2
        # Three times as far to the side as the edge can be.
        step = 3 * tolerance * np.array([-direction[1], direction[0]]) / math.hypot(*direction)
        places = diagram.locate([middle + step, middle - step])
        if None not in places and -1 not in places:
            tried += 1
            assert places == [edge.left, edge.right]
    assert tried > len(diagram.edges) / 2


def test_cotangents_stay_in_their_range(diagram: PlanarMap) -> None:
    size = size_of(diagram.instance)
    for edge in diagram.edges:
        low, high = edge.cotangent_range
        assert low <= high
        inner = edge.polyline(size / 1000)[1:-1]
        cot = 1 / np.tan(visual_angle(inner, diagram.instance.segments[edge.segments[0]]))
        scale = 1 + np.abs(cot)
        assert np.all(cot >= low - 1e-6 * scale)
        assert np.all(cot <= high + 1e-6 * scale)
        if {"infinity"}.isdisjoint(
            diagram.nodes[k].kind for k in (edge.start, edge.end) if k is not None
        ):
            # The range is not only valid but tight: close samples come close to both ends.
            line = edge.polyline(size / 1e6)
            close = np.concatenate([line[:-1] + t * np.diff(line, axis=0) for t in FRACTIONS])
            cot = 1 / np.tan(visual_angle(close, diagram.instance.segments[edge.segments[0]]))
            angles = np.arctan2(1, [cot.min(), low, cot.max(), high])
            assert angles[0] == pytest.approx(angles[1], abs=0.05)
            assert angles[2] == pytest.approx(angles[3], abs=0.05)


def test_at_vertices_the_named_segments_tie(diagram: PlanarMap) -> None:
    for node in diagram.nodes:
        if node.kind in VERTEX_KINDS and not node.endpoint:
            best, angles = best_by_point(diagram, np.array([node.point]))
            tied = np.flatnonzero(np.abs(angles[:, 0] - best[0]) < 1e-9)
            assert tuple(tied) == node.segments
            assert (best[0] < 1e-9) == (node.kind == "crossing")


def test_enclosures_shrink_around_the_point(diagram: PlanarMap) -> None:
    for node in diagram.nodes:
        if node.place is None:
            assert node.kind == "infinity"
            assert math.hypot(*node.point) == pytest.approx(1)
            continue
        for bits in (64, 256):
            low, high = node.place.enclosure(bits)
            for a, value, b in zip(low, node.point, high, strict=True):
                assert a <= b
                assert float(a) - 1e-9 * (1 + abs(value)) <= value
                assert value <= float(b) + 1e-9 * (1 + abs(value))
                assert b - a <= size_of(diagram.instance) * 2.0 ** (40 - bits)


@settings(max_examples=40)
@given(strategies.segment_sets(min_size=2, max_size=4), st.sampled_from(OBJECTIVES), st.data())
def test_located_cells_belong_to_the_winner(
    plain: Any, objective: Objective, data: st.DataObject
) -> None:
    instance = instance_of(plain)
    diagram = build(instance, objective=objective)
    points = data.draw(st.lists(strategies.rational_points(12), min_size=1, max_size=4))
    for point, place in zip(points, diagram.locate(points), strict=True):
        if place is None:
            continue
        _, angles = best_by_point(diagram, np.array([[float(c) for c in point]]))
        own = angles[diagram.cells[place].segment, 0]
        if math.isfinite(own):
            best = np.nanmin(angles) if objective == "smallest" else np.nanmax(angles)
            assert own == pytest.approx(best, abs=1e-9)


def test_points_on_edges_and_outside_are_told() -> None:
    diagram = build(polygon(*SQUARE))
    assert diagram.locate([(2, 2), (1, 1), (0, 0), (4, 2)]) == [None, None, None, None]
    assert diagram.locate([(5, 2), (-1, -1)]) == [-1, -1]
    owners = [diagram.cells[k].segment for k in diagram.locate([(2, 3), (1, 2)]) if k is not None]
    # Near the upper side the lower one is seen under the smallest angle, and so around.
    assert owners == [0, 1]


def test_cot_is_constant_on_the_circle_through_four_endpoints() -> None:
    # Two equal parallel segments: one component of F- is the circle through their endpoints.
    diagram = build(segments(((0, 0), (4, 0)), ((0, 3), (4, 3))))
    ranges = [edge.cotangent_range for edge in diagram.edges]
    circular = [low for low, high in ranges if high - low <= 1e-12]
    assert circular
    for low in circular:
        assert math.atan2(1, low) == pytest.approx(math.atan2(4, 3)) or math.atan2(
            1, low
        ) == pytest.approx(math.pi - math.atan2(4, 3))


def test_edges_that_lead_very_far_away_have_short_polylines() -> None:
    # Almost parallel sides: nodes 10^16 away, where a tolerance is less than doubles can tell.
    turns = [math.pi * k / 3 for k in range(6)]
    diagram = build(polygon(*((3 + math.cos(t), 1 + math.sin(t)) for t in turns)), "plane")
    assert max(math.hypot(*node.point) for node in diagram.nodes) > 1e15
    lines = [edge.polyline(1e-4) for edge in diagram.edges]
    assert max(map(len, lines)) < 2_000
    for edge, line in zip(diagram.edges, lines, strict=True):
        corners = diagram.instance.segments[:, 0]
        from_corners = np.hypot(*np.moveaxis(line[:, None] - corners, -1, 0)).min(axis=1)
        # In doubles the angles are only known well away from the corners.
        near = line[(np.hypot(*line.T) < 10) & (from_corners > 1e-6)]
        angles = [visual_angle(near, diagram.instance.segments[k]) for k in edge.segments]
        assert angles[0] == pytest.approx(angles[1], abs=1e-7)
