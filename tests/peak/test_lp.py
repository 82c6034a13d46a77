"""Peaks of single polygons: three arithmetics, degenerate kernels, known cases, exact decisions."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.peak import peak
from harness.peak.polygon import Polygon
from harness.peak.rational import angle_ball, rational_ascent, rational_start
from harness.peak.sampling import ascent_over, sampled_ascent
from tests import strategies
from tests.peak.polygons import KNOWN, STARS, generated, kernel_points, least_angles, regular

#: A circle's worth of integer points: mirror images abound.
INTEGER_CIRCLE = [
    *((5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3)),
    *((-5, 0), (-4, -3), (-3, -4), (0, -5), (3, -4), (4, -3)),
]


def enclosure_by_rationals(vertices) -> tuple[float, float]:
    """(lower, upper) by the rational ascent alone."""
    polygon = Polygon(Instance.from_arrays("polygon", vertices))
    start = rational_start(polygon.exact_edges, 64)
    end = rational_ascent(polygon.exact_edges, start, 64)
    return float(angle_ball(end.reached).lower()), float(angle_ball(end.level).upper())


@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.parametrize("shift", [(0, 0), (10**7, -(10**9)), (Fraction(1, 3), 10**30)])
def test_known_peaks_wherever_they_are(name, shift):
    vertices, angle, point = KNOWN[name]
    moved = [(Fraction(x) + shift[0], Fraction(y) + shift[1]) for x, y in vertices]
    found = peak(moved)
    assert found.lower <= found.angle <= found.upper <= found.lower + 1e-12
    assert found.angle == pytest.approx(angle, abs=1e-12)
    assert [float(found.point[k] - shift[k]) for k in (0, 1)] == pytest.approx(point, abs=1e-7)


@settings(max_examples=60)
@given(st.sampled_from(STARS), st.integers(3, 10), st.integers(0, 10**6))
def test_doubles_agree_with_rationals(family, n, seed):
    vertices = generated(family, n, seed)
    if vertices is None:
        return
    found = peak(vertices.tolist())
    low, high = enclosure_by_rationals(vertices.tolist())
    assert found.lower <= high
    assert low <= found.upper


@settings(max_examples=40)
@given(strategies.polygons())
def test_degenerate_polygons_have_proven_peaks(instance):
    """All of these have the origin in the interior of their kernels."""
    found = peak(instance[1])
    assert found.upper - found.lower <= 1e-12
    low, high = enclosure_by_rationals(instance[1])
    assert found.lower <= high
    assert low <= found.upper


@pytest.mark.parametrize("thin", [1e-3, 1e-9, 1e-15, 1e-30, 1e-100])
def test_needles(thin):
    """Kernels of this aspect ratio: a strip, a sliver between two reflex vertices, a rhombus."""
    strip = [(0, 0), (1, 0), (1, -1), (3, -1), (3, thin), (0, thin)]
    rhombus = [(0, 0), (1, -thin), (2, 0), (1, thin)]
    sliver = [(-1, -1), (0, 0), (1, -1), (1, thin), (0, thin), (-1, 1)]
    for vertices in (strip, rhombus, sliver):
        found = peak(vertices)
        assert 0 <= found.lower <= found.upper <= found.lower + 1e-12
        low, high = enclosure_by_rationals(vertices)
        assert found.lower <= high
        assert low <= found.upper
    assert peak(rhombus).angle == pytest.approx(math.pi / 2, abs=1e-12)


@pytest.mark.parametrize("n", [3, 4, 5, 12, 13, 360, 1001])
@pytest.mark.parametrize("far", [0.0, 1e8])
def test_regular_polygons_tie_all_edges_at_once(n, far):
    found = peak((regular(n) + far).tolist())
    assert found.angle == pytest.approx(2 * math.pi / n, abs=1e-12 if not far else 1e-6)
    assert found.upper - found.lower <= 1e-12


@pytest.mark.parametrize(
    ("vertices", "reason"),
    [
        ([(0, 0), (9, 0), (9, 9), (8, 1), (5, 1), (4, 9), (3, 1), (1, 1), (0, 9)], "empty"),
        ([(0, 0), (1, 0), (1, -1), (4, -1), (4, 0), (3, 0), (3, 1), (0, 1)], "a segment"),
    ],
)
def test_without_inner_points_of_the_kernel_there_is_a_clear_error(vertices, reason):
    with pytest.raises(UserError, match=reason):
        peak(vertices)


def test_a_kernel_that_is_a_point_is_refused():
    pinwheel = [(0, 3), (-1, 1), (-3, 0), (-1, -1), (0, -3), (1, -1), (3, 0), (1, 1)]
    shifted = [(x + Fraction(y, 3), y) for x, y in pinwheel]
    assert peak(shifted).angle > 0
    windmill = [
        *((1, 0), (3, 0), (3, 1), (0, 1), (0, 3), (-1, 3)),
        *((-1, 0), (-3, 0), (-3, -1), (0, -1), (0, -3), (1, -3)),
    ]
    with pytest.raises(UserError, match=r"a point|empty"):
        peak(windmill)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({"method": "guess"}, "unknown method"),
        ({"objective": "min-min"}, "unknown objective"),
        ({"objective": "min-max", "method": "lp"}, "diagram only"),
        ({"objective": "min-max", "exact": True}, "no exact"),
        ({"seed": -1}, "must not be negative"),
    ],
)
def test_what_cannot_be_done_is_said(arguments, reason):
    with pytest.raises(UserError, match=reason):
        peak(KNOWN["square"][0], **arguments)


def test_segments_have_no_peak():
    segments = Instance.from_arrays("segments", [[(0, 0), (1, 0)], [(2, 2), (3, 3)]])
    with pytest.raises(UserError, match="only a polygon"):
        peak(segments)


@given(st.sampled_from(["star", "near-regular", "convex-circle"]), st.integers(0, 10**6))
@settings(max_examples=10)
def test_samples_find_what_looking_at_everything_finds(family, seed):
    polygon = Polygon(Instance.from_arrays("polygon", generated(family, 2000, seed).tolist()))
    edges, start = polygon.edges_from(polygon.inner_point()), polygon.start[0]
    direct = ascent_over(start, edges)
    for k in range(3):
        sampled = sampled_ascent(start, edges, np.random.default_rng(k))
        assert sampled.rounds > 0
        assert sampled.level == pytest.approx(direct.level, rel=1e-9)


def test_the_seed_changes_nothing():
    vertices = generated("star", 3000, 1).tolist()
    one, two = peak(vertices, seed=1), peak(vertices, seed=2)
    assert (one.basis, one.angle) == (two.basis, pytest.approx(two.angle, abs=1e-14))


@pytest.mark.parametrize("family", STARS)
def test_no_point_of_the_kernel_beats_it_and_superlevel_sets_are_convex(family):
    rng = np.random.default_rng(2)
    vertices = generated(family, 8, 3)
    if vertices is None:
        vertices = generated(family, 9, 3)
    found = peak(vertices.tolist())
    points = kernel_points(vertices, 10_000, rng)
    seen = least_angles(points, vertices)
    assert np.nanmax(seen) <= found.upper
    ways = rng.uniform(size=(5000, 1))
    between = ways * points[:5000] + (1 - ways) * points[5000:]
    lower = np.minimum(seen[:5000], seen[5000:])
    assert not (least_angles(between, vertices) < lower - 1e-12).any()


@pytest.mark.parametrize(
    ("vertices", "polynomial", "tied"),
    [
        (KNOWN["square"][0], (0, 1), (0, 1, 2, 3)),
        # cot(120°) = −1/√3; a triangle with rational vertices and a Fermat point inside.
        ([(0, 0), (4, 0), ("1/3", "7/2")], (-1, 0, 3), (0, 1, 2)),
        # tan(α/2) = 1/8 for the short sides.
        (KNOWN["oblong"][0], (-63, 16), (1, 3)),
        (KNOWN["letter L"][0], (-1, 1), (1, 2, 3, 4)),
        # The shortest edges, (4, 3) to (3, 4) and its like: from the centre cot α = 24/7.
        (INTEGER_CIRCLE, (-24, 7), (1, 4, 7, 10)),
    ],
)
def test_exact_decisions(vertices, polynomial, tied):
    found = peak(vertices, exact=True)
    assert found.exact.polynomial == polynomial
    assert found.exact.tied == tied


@given(st.sampled_from(STARS), st.integers(3, 10), st.integers(0, 10**6))
@settings(max_examples=40)
def test_the_algebraic_number_lies_in_the_enclosure(family, n, seed):
    vertices = generated(family, n, seed)
    if vertices is None:
        return
    found = peak(vertices.tolist(), exact=True)
    low, high = (angle_ball(c) for c in (found.exact.high, found.exact.low))
    assert not low > found.upper
    assert not high < found.lower
    assert set(found.exact.tied) >= set(found.basis) - set(found.walls) or found.vertex is not None
    assert len(found.exact.polynomial) <= 6
