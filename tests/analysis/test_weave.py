"""The exact prediction for weaves, against geometry computed another way and certified counts."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from generators import generate
from generators.weaves import convex_inner_radius, zigzag_inner_radius
from harness import AngularVoronoi
from harness.analysis.weave import predict
from harness.analysis.weave_noise import SAFE, tolerance
from tests.analysis.weaves import corners, count, inner_radius, shapes, smallest, tip


@given(shapes(smallest=6, largest=40), st.integers(0, 2**32 - 1))
@settings(max_examples=60)
def test_a_point_belongs_to_the_edge_whose_tip_is_nearest(shape, seed) -> None:
    """The theorem behind every count: tips are feet of circumscribed circles, angles are atan2."""
    n, inner = shape[1], inner_radius(*shape)
    vertices = corners(n // 2, inner)
    rng = np.random.default_rng(seed)
    radius = rng.uniform(0.01, 0.99)
    weave = predict(n // 2, 1.0, inner)
    inradius = math.cos(weave.tilt + math.pi / n)  # inside the kernel, whatever the direction
    direction = rng.uniform(0, 2 * math.pi)
    p = radius * inradius * np.array([math.cos(direction), math.sin(direction)])
    winner, level, margin = smallest(vertices, p)
    assume(margin > 1e-9 * level)
    aside = [
        abs(math.remainder(tip(vertices, edge, level) - direction, 2 * math.pi))
        for edge in range(n)
    ]
    assert min(aside) == pytest.approx(aside[winner], abs=1e-6)


@pytest.mark.parametrize("tilt", [0.9, 1.2, 1.45])
@pytest.mark.parametrize("n", [20, 34, 60])
def test_passings_are_those_seen_while_the_level_falls(n, tilt) -> None:
    """Steps through the levels, and counts how often the two families' tips change places."""
    inner = zigzag_inner_radius(n, tilt)
    weave = predict(n // 2, 1.0, inner)
    assert weave.first >= 2  # every level is whole
    vertices, phi = corners(n // 2, inner), 2 * math.pi / n
    levels = phi * (1 - np.linspace(1e-9, 1 - 1e-9, 20_001))
    turn = np.unwrap([tip(vertices, 0, level) - tip(vertices, 1, level) for level in levels])
    seen = sum(
        int(abs(math.floor(one / (2 * phi)) - math.floor(other / (2 * phi))))
        for one, other in itertools.pairwise(turn)
    )
    assert seen * weave.m == weave.passings
    assert turn[0] - turn[-1] == pytest.approx(2 * (math.pi - 2 * weave.tilt), abs=1e-5)


@given(shapes(smallest=4, largest=22), st.integers(0, 2**20))
@settings(max_examples=25, deadline=None)
def test_certified_counts_are_the_predicted_ones(shape, seed) -> None:
    weave = predict(shape[1] // 2, 1.0, inner_radius(*shape))
    bears = tolerance(shape[1] // 2, 1.0, inner_radius(*shape))
    assume(bears > 1e-10)  # below, rounding and noise are of one size
    counts = count(*shape, seed, SAFE * min(bears, 1e-3))
    assert (counts.vertices, counts.edges, counts.cells) == (
        weave.vertices,
        weave.edges,
        weave.cells,
    )
    assert counts.degrees == ({3: weave.vertices} if weave.vertices else {})


@pytest.mark.parametrize(
    ("family", "value"),
    [("zigzag", 0.05), ("zigzag", 0.5), ("zigzag", 1.3), ("convex-weave", 0.1),
     ("convex-weave", 0.55), ("convex-weave", 0.65)],
)  # fmt: skip
def test_large_weaves_are_as_predicted(family, value) -> None:
    n = 72
    inner = inner_radius(family, n, value)
    weave = predict(n // 2, 1.0, inner)
    counts = count(family, n, value, 1, SAFE * tolerance(n // 2, 1.0, inner))
    assert (counts.vertices, counts.cells) == (weave.vertices, weave.cells)


def test_both_builders_agree_with_the_prediction() -> None:
    weave = predict(4, 1.0, zigzag_inner_radius(8, 0.5))
    polygon = generate("zigzag", 8, 3, tilt=0.5, noise=1e-6, noise_power=0).coordinates
    for builder in ("fast", "reference"):
        counts = AngularVoronoi(polygon, builder=builder).counts
        assert (counts.vertices, counts.cells) == (weave.vertices, weave.cells)


@pytest.mark.parametrize("n", [4, 8])
@pytest.mark.parametrize(
    ("family", "value"), [("zigzag", 0.4), ("zigzag", 1.1), ("convex-weave", 0.7)]
)
def test_exactly_symmetric_weaves_are_as_predicted(n, family, value) -> None:
    """Quadrangles and octagons: the whole symmetry of no other weave fits in doubles."""
    weave = predict(n // 2, 1.0, inner_radius(family, n, value))
    counts = count(family, n, value, 0, 0.0)
    assert counts.vertices == weave.symmetric_vertices
    assert counts.edges == weave.symmetric_edges
    assert counts.cells == weave.symmetric_cells
    assert counts.degrees == weave.symmetric_degrees


@given(shapes(smallest=4, largest=4000))
@settings(max_examples=60)
def test_the_counts_obey_the_limits_that_are_claimed(shape) -> None:
    family, n, value = shape
    weave = predict(n // 2, 1.0, inner_radius(*shape))
    if family == "convex-weave":
        assert weave.vertices == n * n // 2 - n - 2 + (n // 2 if weave.corner else 0)
        if n >= 64:
            assert weave.corner == (value > 0.6) or abs(value - 0.6) < 0.01
    elif weave.first >= 2:
        passing = n / 2 - 2 * weave.first
        assert weave.vertices == n * (passing + 1) - 2
        assert abs(weave.vertices / n**2 - (0.5 - weave.tilt / math.pi)) < 2.1 / n
    assert weave.symmetric_cells == weave.cells + weave.passings
    # Euler's formula for the symmetric diagram: the degrees count every edge end that is no end
    # at the boundary, and in the generic one each vertex has three
    assert weave.edges == weave.vertices + weave.cells - 1


@given(shapes(smallest=6, largest=4000))
@settings(max_examples=40)
def test_order_and_scale_of_the_radii_do_not_matter(shape) -> None:
    m, inner = shape[1] // 2, Fraction(inner_radius(*shape))
    assert predict(m, 1, inner) == predict(m, inner * 3, 3)


def test_a_tip_that_passes_at_the_rim_is_seen_and_not_counted() -> None:
    """Radii 2 : 1 and m = 3 make a triangle: there ν = φ/2 exactly."""
    on_the_rim = predict(3, 2, 1)
    assert on_the_rim.coincident
    assert on_the_rim.first == 1
    assert tolerance(3, 2, 1) == 0.0
    nearly = Fraction(1, 10**60)
    before, after = predict(3, 2, 1 + nearly), predict(3, 2, 1 - nearly)
    assert (before.first, after.first) == (0, 1)
    assert not before.coincident
    assert not after.coincident


@pytest.mark.parametrize(("m", "outer", "inner"), [(1, 1, 0.5), (5, 1, 1), (5, 1, 0), (5, -1, 1)])
def test_what_is_no_weave_is_refused(m, outer, inner) -> None:
    with pytest.raises(ValueError, match="no weave"):
        predict(m, outer, inner)


def test_the_tolerance_of_convex_weaves_falls_like_the_fourth_power() -> None:
    small, large = (tolerance(m, 1, convex_inner_radius(2 * m, 0.5)) for m in (128, 512))
    assert small / large == pytest.approx(256, rel=0.05)
