"""The range of cot θ along an edge that begins at a common endpoint of its two segments.

There cot θ has a limit: with φ the angle between the segments, cot(φ/2) for the edge that leaves
away from them and −cot(φ/2) for the one between them.
"""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.algebra import NotGeneric
from harness.diagram.cotangents import check_common_endpoints
from harness.diagram.counts import OBJECTIVES, Objective
from harness.diagram.planar_map import PlanarMap
from harness.diagram.reference import SHEARS
from harness.diagram.scene import Scene
from tests.diagram.support import polygon, segments

VECTORS = st.tuples(st.integers(-6, 6), st.integers(-6, 6)).filter(any)
CORNER = (1, 2)


def corner(w: Any, other: Any) -> Any:
    """Two segments from ``CORNER`` along two vectors."""
    return segments(*((CORNER, (CORNER[0] + x, CORNER[1] + y)) for x, y in (w, other)))


def ranges_at_corner(diagram: PlanarMap) -> list[tuple[float, float]]:
    (at,) = (k for k, node in enumerate(diagram.nodes) if node.point == CORNER)
    return sorted(e.cotangent_range for e in diagram.edges if at in (e.start, e.end))


def cotangent_of_half(w: Any, other: Any) -> float:
    angle = math.atan2(abs(w[0] * other[1] - w[1] * other[0]), w[0] * other[0] + w[1] * other[1])
    return 1 / math.tan(angle / 2)


@given(
    VECTORS,
    st.sampled_from([lambda x, y: (y, x), lambda x, y: (x, -y), lambda x, y: (-y, x)]),
    st.sampled_from(OBJECTIVES),
)
def test_segments_of_equal_length(w: Any, image: Any, objective: Objective) -> None:
    # The edges run along the line that halves the angle, and there cot θ only grows.
    other = image(*w)
    assume(w[0] * other[1] != w[1] * other[0])
    limit = cotangent_of_half(w, other)
    lows = [low for low, _ in ranges_at_corner(build(corner(w, other), "plane", objective))]
    assert lows == pytest.approx([-limit, limit], rel=1e-14)


@given(VECTORS, VECTORS, st.sampled_from(OBJECTIVES))
def test_any_two_segments(w: Any, other: Any, objective: Objective) -> None:
    assume(w[0] * other[1] != w[1] * other[0])
    limit = cotangent_of_half(w, other)
    ranges = ranges_at_corner(build(corner(w, other), "plane", objective))
    for (low, high), value in zip(ranges, (-limit, limit), strict=True):
        assert low - 1e-14 * limit <= value <= high + 1e-14 * limit


def test_two_segments_in_line_are_seen_under_a_right_angle() -> None:
    # The edge is the circle of points whose distances from the outer ends are as 1 to 2.
    ranges = ranges_at_corner(build(corner((1, 0), (-2, 0)), "plane"))
    assert {low for low, _ in ranges} == {0.0}


def test_an_unbounded_edge_at_a_corner_of_a_polygon() -> None:
    # Two sides with cos φ = 4/5 at (−1, 3), so cot(φ/2) = 3.
    diagram = build(polygon((1, 1), (-1, 3), (0, -4)), "plane")
    found = [edge for edge in diagram.edges if set(edge.segments) == {0, 1}]
    assert (3.0, math.inf) in [edge.cotangent_range for edge in found]


def test_an_edge_that_would_begin_vertically_in_sheared_coordinates() -> None:
    s = SHEARS[0]
    w, other = (1 - s, 1 + s), (-1 - s, 1 - s)  # the halving line runs along (−s, 1)
    scene = Scene(corner(w, other).rational_segments(), "smallest", s)
    with pytest.raises(NotGeneric):
        check_common_endpoints(scene)
    lows = [low for low, _ in ranges_at_corner(build(corner(w, other)))]
    assert lows == pytest.approx([-1.0, 1.0], rel=1e-15)
