"""Places of nodes: boxes that contain them, of any precision, around the doubles."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from harness.diagram.fast.counting import fast_diagram
from harness.diagram.fast.leaves import QUAD, TRIPLE
from harness.diagram.fast.node_points import node_point
from harness.diagram.fast.places import place_of
from harness.diagram.planar_map import PlanarMap
from tests.diagram.fast.both_builders import CASES, both, size_of

BITS = (60, 150, 1000)


@pytest.fixture(scope="module", params=CASES)
def maps(request: pytest.FixtureRequest) -> tuple[PlanarMap, PlanarMap]:
    return both(request.param)


def test_boxes_meet_those_of_the_reference(maps: tuple[PlanarMap, PlanarMap]) -> None:
    fast, reference = maps
    size = size_of(fast)
    for node in fast.nodes:
        if node.kind == "infinity":
            assert node.place is None
            assert math.hypot(*node.point) == pytest.approx(1)
            continue
        assert node.place is not None
        other = min(
            (n for n in reference.nodes if n.kind == node.kind),
            key=lambda n: math.dist(n.point, node.point),
        )
        assert other.place is not None
        for bits in BITS:
            boxes = node.place.enclosure(bits), other.place.enclosure(bits)
            for (low, high), (its_low, its_high) in zip(
                *(zip(*box, strict=True) for box in boxes), strict=True
            ):
                assert low <= its_high
                assert its_low <= high
                assert high - low <= Fraction(size) * Fraction(2) ** (40 - bits)


def test_boxes_are_nested_around_the_double(maps: tuple[PlanarMap, PlanarMap]) -> None:
    fast, _ = maps
    size = size_of(fast)
    for node in fast.nodes:
        if node.place is None:
            continue
        (fine_low, fine_high) = node.place.enclosure(300)
        for low, high, value, a, b in zip(
            *node.place.enclosure(40), node.point, fine_low, fine_high, strict=True
        ):
            assert low <= b
            assert a <= high
            assert abs(Fraction(value) - a) <= Fraction(1e-12 * (size + abs(value)))


def test_a_tie_is_one(maps: tuple[PlanarMap, PlanarMap]) -> None:
    """At the middle of a tight box the segments of a triple point tie to as many digits."""
    fast, _ = maps
    for node in fast.nodes:
        if node.kind != "triple" or node.endpoint or node.place is None:
            continue
        low, high = node.place.enclosure(400)
        x, y = ((a + b) / 2 for a, b in zip(low, high, strict=True))
        values = []
        for k in node.segments:
            a, b = fast.instance.rational_segment(k)
            q = (a[0] - x) * (b[0] - x) + (a[1] - y) * (b[1] - y)
            line = (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)
            values.append(q / abs(line))
        assert max(values) - min(values) < Fraction(2) ** -300 * (1 + abs(values[0]))


def test_a_bad_guess_does_no_harm() -> None:
    """Points of ties do not depend on where the builder believes them to be."""
    instance, domain, objective = CASES["zigzag"]
    good = fast_diagram(instance, domain, objective, workers=1)
    bad = fast_diagram(instance, domain, objective, workers=1)
    bad.leaves.points[:] = np.random.default_rng(5).uniform(0.0, 0.5, bad.leaves.points.shape)
    assert len(good.arrays.vertices) > 0
    for vertex in range(len(good.arrays.vertices)):
        if good.leaves.kinds[good.arrays.vertices[vertex, 0]] not in (TRIPLE, QUAD):
            continue
        assert node_point(bad, vertex) == pytest.approx(node_point(good, vertex), abs=1e-12)
        place = place_of(bad, vertex)
        assert place is not None
        low, high = place.enclosure(100)
        assert all(float(a) == pytest.approx(float(b)) for a, b in zip(low, high, strict=True))
