"""What cannot be built is refused in one line, never counted wrongly."""

from __future__ import annotations

import re

import pytest

from harness.diagram import build
from harness.errors import UserError
from tests.diagram.support import SQUARE, polygon, segments

COMB = [(0, 0), (9, 0), (9, 9), (6, 9), (6, 3), (3, 3), (3, 9), (0, 9)]


@pytest.mark.parametrize("size", [4e300, 4e-300])
def test_size_does_not_matter(size: float) -> None:
    square = [(x * size / 4, y * size / 4) for x, y in SQUARE]
    counts = build(polygon(*square)).counts
    assert counts == build(polygon(*SQUARE)).counts


def test_coordinates_of_very_different_size_are_refused() -> None:
    with pytest.raises(UserError, match="coordinates span 2043 powers of two"):
        build(polygon((0, 0), (4e300, 0), (4e-300, 4e-300)))


def test_a_polygon_without_kernel_has_an_interior_still() -> None:
    with pytest.raises(UserError, match="not star-shaped: its kernel is empty"):
        build(polygon(*COMB))
    diagram = build(polygon(*COMB), "interior")
    diagram.sanity_check()
    assert diagram.counts.cells > 0


def test_segments_have_no_kernel() -> None:
    with pytest.raises(UserError, match="domain kernel needs a polygon"):
        build(segments(((0, 0), (1, 0))), "kernel")


def test_unknown_builders_are_named() -> None:
    with pytest.raises(UserError, match=re.escape("unknown builder 'slow'")):
        build(polygon(*SQUARE), builder="slow")


def test_unbounded_edges_point_where_they_go() -> None:
    """Two segments almost parallel meet far away: the ends lie beyond that."""
    diagram = build(segments(((0, 0), (1, 0)), ((0, 1), (1, "1.000000000000000000000000000001"))))
    diagram.sanity_check()
    ends = [node.point for node in diagram.nodes if node.kind == "infinity"]
    assert all(x * x + y * y == pytest.approx(1) for x, y in ends)
