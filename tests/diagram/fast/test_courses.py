"""The ways of edges: on their curves, from node to node, and as the reference builder has them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness.diagram import build
from harness.diagram.fast.counting import fast_diagram
from harness.diagram.fast.courses import ArcCourse
from harness.diagram.planar_map import PlanarMap
from harness.geometry.visual_angle import visual_angle
from tests.diagram.fast.both_builders import (
    CASES,
    HEPTAGON,
    Points,
    both,
    distance,
    partner,
    size_of,
)
from tests.diagram.support import polygon, segments


@pytest.fixture(scope="module", params=CASES)
def maps(request: pytest.FixtureRequest) -> tuple[PlanarMap, PlanarMap]:
    return both(request.param)


def uncertainty(diagram: PlanarMap, points: Points) -> Points:
    """What rounding does to visual angles at points (m, 2): near an endpoint, more."""
    ends = diagram.instance.segments.reshape(-1, 2)
    near = np.hypot(*(points[:, None] - ends).transpose(2, 0, 1)).min(axis=1)
    slack: Points = 1e-10 + 1e-14 * (size_of(diagram) + np.abs(ends).max()) / near
    return slack


def test_polylines_tie_their_segments_and_nobody_beats_them(
    maps: tuple[PlanarMap, PlanarMap],
) -> None:
    fast, _ = maps
    for edge in fast.edges:
        inner = edge.polyline(size_of(fast) / 300)[1:-1]
        angles = np.stack([visual_angle(inner, s) for s in fast.instance.segments])
        best = angles.min(axis=0) if fast.objective == "smallest" else angles.max(axis=0)
        for segment in edge.segments:
            assert np.all(np.abs(angles[segment] - best) <= uncertainty(fast, inner))


def test_polylines_run_from_node_to_node_without_repetition(
    maps: tuple[PlanarMap, PlanarMap],
) -> None:
    fast, _ = maps
    for edge in fast.edges:
        line = edge.polyline(size_of(fast) / 100)
        assert line.shape[0] >= 2
        assert np.all(np.any(np.diff(line, axis=0) != 0, axis=1))
        for k, point in ((edge.start, line[0]), (edge.end, line[-1])):
            if k is None:
                assert tuple(line[0]) == tuple(line[-1])
            elif fast.nodes[k].kind != "infinity":
                assert point == pytest.approx(fast.nodes[k].point, rel=1e-12, abs=1e-12)


def test_polylines_go_the_way_of_the_reference(maps: tuple[PlanarMap, PlanarMap]) -> None:
    fast, reference = maps
    assert len(fast.edges) == len(reference.edges)
    coarse, fine = size_of(fast) / 100, size_of(fast) / 2000
    for edge in fast.edges:
        way, its = edge.polyline(fine), partner(fast, edge, reference).polyline(coarse)
        assert distance(its, way, fast) <= fine * (1 + 1e-6)  # its points lie on the edge
        assert distance(way, edge.polyline(coarse), fast) <= coarse * (1 + 1e-6)


def test_cotangent_ranges_are_those_of_the_reference(maps: tuple[PlanarMap, PlanarMap]) -> None:
    fast, reference = maps
    for edge in fast.edges:
        other = partner(fast, edge, reference)
        assert edge.cotangent_range == pytest.approx(other.cotangent_range, rel=1e-9, abs=1e-9)


def test_ranges_hold_everywhere(maps: tuple[PlanarMap, PlanarMap]) -> None:
    fast, _ = maps
    for edge in fast.edges:
        low, high = edge.cotangent_range
        inner = edge.polyline(size_of(fast) / 1e4)[1:-1]
        angle = visual_angle(inner, fast.instance.segments[edge.segments[0]])
        slack = uncertainty(fast, inner)
        assert np.all(angle >= math.atan2(1, high) - slack)
        assert np.all(angle <= math.atan2(1, low) + slack)


def test_cases_reach_the_fast_builder() -> None:
    """A small instance may be handed over to the reference builder; few are here."""
    fast = [name for name in CASES if isinstance(both(name)[0].edges[0].course, ArcCourse)]
    assert len(fast) >= len(CASES) - 3


def test_unbounded_edges_are_followed_out_of_any_window() -> None:
    fast, _ = both("five")
    for reach in (1.0, 1e4, 1e7):
        window = (-reach, -reach, reach, reach)
        for edge in fast.edges:
            line = edge.polyline(reach / 100, window)
            for k, point in ((edge.start, line[0]), (edge.end, line[-1])):
                if k is not None and fast.nodes[k].kind == "infinity":
                    direction = fast.nodes[k].point
                    assert max(map(abs, point)) > reach
                    far = math.hypot(*point)
                    if reach == 1e7:
                        assert point / far == pytest.approx(direction, abs=1e-3)


def test_a_tolerance_is_positive() -> None:
    fast, _ = both("star")
    with pytest.raises(ValueError, match="positive"):
        fast.edges[0].polyline(0.0)


def test_refinement_ends_where_doubles_do() -> None:
    far = 2**40
    moved = [(x + far, y - 3 * far) for x, y in HEPTAGON.floats.tolist()]
    fast = fast_diagram(polygon(*moved), "kernel", "smallest", workers=1)
    for edge in range(len(fast.edges)):
        assert len(ArcCourse(fast, edge).polyline(1e-9)) < 2_000


@pytest.mark.parametrize("offset", [0.0, 2.0**-40, 2.0**-20])
def test_nearly_crossing_branches_are_kept_apart(offset: float) -> None:
    """Mirror images have a bisector that crosses itself; a nudge parts its branches by √offset."""
    fast = build(segments(((-2, 0), (-1, 1)), ((2 + offset, 0), (1, 1))))
    for edge in fast.edges:
        inner = edge.polyline(0.01)[1:-1]
        one, two = (visual_angle(inner, fast.instance.segments[k]) for k in edge.segments)
        assert one == pytest.approx(two, abs=1e-9)
