"""Diagrams whose counts are known by hand, by theorem, or from an independent exact arrangement."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given

from harness.diagram import build
from harness.geometry.instance import Instance
from tests import strategies
from tests.diagram.support import (
    SQUARE,
    corpus,
    corpus_instance,
    instance_of,
    polygon,
    segments,
    summary,
)


@pytest.mark.parametrize("name", corpus())
def test_the_corpus(name: str) -> None:
    case = corpus()[name]
    diagram = build(corpus_instance(case), case["domain"], case["objective"])
    diagram.sanity_check()
    found = summary(diagram)
    assert {key: found[key] for key in case["known"]} == case["known"]


@pytest.mark.parametrize("builder", ["fast", "reference"])
@pytest.mark.parametrize("across", [False, True])
def test_bisectors_of_two_lines_with_many_digits(builder: str, across: bool) -> None:
    """Equal segments on one line, and opposite sides of a square: F is a product of lines whose
    coefficients differ beyond machine integers only."""

    def pair(x: Any, y: Any) -> Instance:
        if across:
            return segments(((0, 0), (x, y)), ((-y, x), (x - y, y + x)))
        return segments(((0, 0), (x, y)), ((2 * x, 2 * y), (3 * x, 3 * y)))

    fine = build(
        pair(Fraction(2171994321321, 2**44), Fraction(17375954321987, 2**44)), builder=builder
    )
    assert fine.counts == build(pair(1, 2), builder=builder).counts


def test_two_segments_whose_lines_meet_outside_both() -> None:
    counts = build(segments(((0, 0), (1, 0)), ((3, 1), (4, 3)))).counts
    assert (counts.cells, counts.edges, counts.vertices) == (4, 8, 1)
    assert counts.nodes["crossing"] == 1
    assert counts.nodes["endpoint"] == 4
    assert counts.nodes["infinity"] == 4


def test_a_region_of_one_cell_against_lemma_2() -> None:
    # The line of s passes through the inside of t, so s keeps a single cell.
    diagram = build(segments(((0, 0), (1, 0)), ((3, -1), (3, 1))))
    owners = [cell.segment for cell in diagram.cells]
    assert (owners.count(0), owners.count(1)) == (1, 3)


def test_a_triangle_has_its_fermat_point() -> None:
    diagram = build(polygon((0, 0), (7, 1), (2, 5)))
    counts = diagram.counts
    assert (counts.cells, counts.edges, counts.vertices, dict(counts.degrees)) == (3, 3, 1, {3: 1})
    (vertex,) = (node for node in diagram.nodes if node.kind == "triple")
    # From the Fermat point all three sides are seen under 120°.
    corners = [(0, 0), (7, 1), (2, 5)]
    bearings = sorted(math.atan2(y - vertex.point[1], x - vertex.point[0]) for x, y in corners)
    assert bearings[1] - bearings[0] == pytest.approx(2 * math.pi / 3, abs=1e-12)
    assert bearings[2] - bearings[1] == pytest.approx(2 * math.pi / 3, abs=1e-12)


def test_a_wide_triangle_has_no_vertex() -> None:
    counts = build(polygon((0, 0), (10, 0), (-3, 4))).counts
    assert (counts.cells, counts.edges, counts.vertices) == (2, 1, 0)


def test_the_centre_of_a_square() -> None:
    diagram = build(polygon(*SQUARE))
    assert diagram.counts.cells == 4
    assert dict(diagram.counts.degrees) == {4: 1}
    (centre,) = (node for node in diagram.nodes if node.kind == "triple")
    assert centre.point == (2.0, 2.0)
    assert centre.segments == (0, 1, 2, 3)
    low, high = centre.place.enclosure(200) if centre.place else ((0, 0), (0, 0))
    assert all(a <= 2 <= b for a, b in zip(low, high, strict=True))


def test_a_single_segment_has_the_whole_plane() -> None:
    diagram = build(segments(((0, 0), (1, 0))))
    assert diagram.counts.cells == 1
    assert diagram.counts.unbounded == 1
    assert diagram.counts.edges == 0
    assert diagram.locate([(5, 5), (0.5, 0)]) == [0, 0]


def test_collinear_segments_split_the_plane_by_a_closed_edge() -> None:
    diagram = build(segments(((0, 0), (1, 0)), ((2, 0), (4, 0))))
    assert diagram.counts.loops == 1
    assert diagram.counts.cells == 2
    assert diagram.counts.components == 1
    assert sorted(cell.bounded for cell in diagram.cells) == [False, True]


def _line_meets_outside(s: Any, t: Any) -> bool:
    """Whether the lines of two segments meet in one point, outside both closed segments."""
    (a, b), (c, d) = s, t
    w, z = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    determinant = w[0] * z[1] - w[1] * z[0]
    if determinant == 0:
        return False
    along_s = Fraction((c[0] - a[0]) * z[1] - (c[1] - a[1]) * z[0]) / determinant
    along_t = Fraction((c[0] - a[0]) * w[1] - (c[1] - a[1]) * w[0]) / determinant
    return not 0 <= along_s <= 1 and not 0 <= along_t <= 1


def _in_general_position(instance: Instance) -> bool:
    """No three lines meet, none passes through another segment's end, and no two are parallel."""
    pairs = instance.rational_segments()
    meetings = set()
    for s, t in itertools.combinations(pairs, 2):
        (a, b), (c, d) = s, t
        w, z = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
        determinant = w[0] * z[1] - w[1] * z[0]
        if determinant == 0:
            return False
        along = ((c[0] - a[0]) * z[1] - (c[1] - a[1]) * z[0]) / determinant
        point = (a[0] + along * w[0], a[1] + along * w[1])
        if point in meetings or point in (a, b, c, d):
            return False
        meetings.add(point)
    return True


@given(strategies.rational_segment_sets(min_size=2, max_size=4))
def test_crossings_are_the_pairs_whose_lines_meet_outside(plain: Any) -> None:
    instance = instance_of(plain)
    if not _in_general_position(instance):
        return
    pairs = itertools.combinations(instance.rational_segments(), 2)
    expected = sum(_line_meets_outside(s, t) for s, t in pairs)
    counts = build(instance).counts
    assert counts.nodes.get("crossing", 0) == expected
    assert counts.nodes["endpoint"] == 2 * instance.n
