"""Predicates against rational arithmetic, where it is hardest; and their laws."""

from fractions import Fraction

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from harness.geometry import predicates
from harness.geometry.predicates import (
    UNDEFINED,
    UNSURE,
    compare_visual_angles,
    compare_visual_angles_at,
    orientation,
    orientations,
)
from tests.geometry.shapes import turn

finite = st.floats(allow_nan=False, allow_infinity=False)
extreme = st.sampled_from(
    [0.0, -0.0, 5e-324, 1e-300, -1e-300, 1e-160, 1.0, 1e160, 1e300, -1e300, 1.7976931348623157e308]
)
integers = st.integers(-4, 4)


@st.composite
def nearly(draw, count):
    """Points on a small lattice, moved and scaled, some coordinates to a neighbouring double."""
    offset = draw(st.sampled_from([0.0, 1e6, 2.0**40, 2.0**52, 1 / 3]))
    unit = draw(st.sampled_from([1.0, 0.1, 2.0**-30, 1e-300, 1e290]))
    values = draw(st.lists(integers, min_size=2 * count, max_size=2 * count))
    nudges = draw(st.lists(st.integers(-1, 1), min_size=2 * count, max_size=2 * count))
    moved = [(offset + value) * unit for value in values]
    moved = [
        float(np.nextafter(x, np.inf * n)) if n else x for x, n in zip(moved, nudges, strict=True)
    ]
    return np.array(moved).reshape(count, 2)


def points(count):
    rows = st.lists(st.one_of(finite, extreme), min_size=2 * count, max_size=2 * count).map(
        lambda row: np.array(row).reshape(count, 2)
    )
    return st.one_of(rows, nearly(count))


def exactly(point):
    return Fraction(float(point[0])), Fraction(float(point[1]))


def slow_comparison(p, a, b, c, d):
    """Compare visual angles by cases, from their definition."""
    p, a, b, c, d = map(exactly, (p, a, b, c, d))
    forms = []
    for u, v in ((a, b), (c, d)):
        (ux, uy), (vx, vy) = (u[0] - p[0], u[1] - p[1]), (v[0] - p[0], v[1] - p[1])
        forms.append((ux * vx + uy * vy, abs(ux * vy - uy * vx)))
    if (0, 0) in forms:
        return None
    # order of cot = Q/|L|, with +∞ for angle 0 and −∞ for angle π
    keys = [
        ((0, -Fraction(q, area)) if area else ((-1, 0) if q > 0 else (1, 0))) for q, area in forms
    ]
    return (keys[0] > keys[1]) - (keys[0] < keys[1])


@given(points(3))
def test_orientation_is_exact(rows):
    expected = turn(*map(exactly, rows))
    assert orientation(*map(tuple, rows.tolist())) == expected
    assert orientations(*rows) == expected
    assert predicates.filter_orientations(rows[None])[0] in (expected, UNSURE)


@given(points(5))
def test_comparison_of_visual_angles_is_exact(rows):
    expected = slow_comparison(*rows)
    p, a, b, c, d = map(tuple, rows.tolist())
    assert compare_visual_angles(p, (a, b), (c, d)) == expected
    vector = compare_visual_angles_at(rows[0], rows[1:3], rows[3:5])
    assert vector == (UNDEFINED if expected is None else expected)
    filtered = predicates.filter_visual_angles(rows[None])[0]
    assert filtered in (UNSURE, expected)


@given(st.lists(integers, min_size=10, max_size=10))
@example([1, 0, 0, 0, 2, 0, 3, 0, 4, 0])  # inside s, on the extension of t: π > 0
@example([5, 0, 0, 0, 2, 0, 3, 0, 4, 0])  # on both extensions
@example([0, 0, -1, 0, 1, 0, 0, -1, 0, 1])  # inside both
@example([0, 0, 1, 0, 2, 0, 0, 1, 1, 1])  # on the extension of one
@example([0, 0, 0, 0, 2, 0, 0, 1, 1, 1])  # at an endpoint
def test_special_positions(values):
    rows = np.array(values, dtype=float).reshape(5, 2)
    p, a, b, c, d = map(tuple, rows.tolist())
    answer = compare_visual_angles(p, (a, b), (c, d))
    assert answer == slow_comparison(*rows)
    assert (answer is None) == (p in (a, b, c, d) or a == b == p or c == d == p)


@given(st.lists(integers, min_size=10, max_size=10))
def test_laws(values):
    """Antisymmetry; direction of a segment is irrelevant; similarities change nothing."""
    p, a, b, c, d = (
        (Fraction(x), Fraction(y)) for x, y in zip(values[::2], values[1::2], strict=True)
    )
    answer = compare_visual_angles(p, (a, b), (c, d))
    assert compare_visual_angles(p, (b, a), (c, d)) == answer
    assert compare_visual_angles(p, (a, b), (d, c)) == answer
    if answer is not None:
        assert compare_visual_angles(p, (c, d), (a, b)) == -answer

    def similar(q):
        return Fraction(3 * q[0] - 4 * q[1], 7) + 2**70, Fraction(4 * q[0] + 3 * q[1], 7) - 1

    sp, sa, sb, sc, sd = map(similar, (p, a, b, c, d))
    assert compare_visual_angles(sp, (sa, sb), (sc, sd)) == answer


def test_points_on_a_circle_see_a_chord_alike():
    """Exactly equal angles at rational points of the unit circle; a neighbour tips the scale."""

    def on_circle(t):
        return Fraction(1 - t * t, 1 + t * t), Fraction(2 * t, 1 + t * t)

    chord = on_circle(Fraction(-1, 3)), on_circle(Fraction(-2, 3))
    rotation = on_circle(Fraction(1, 5))
    turned = tuple(
        (x * rotation[0] - y * rotation[1], x * rotation[1] + y * rotation[0]) for x, y in chord
    )
    for t in (Fraction(1, 2), Fraction(7, 3), Fraction(10**9, 10**9 + 1)):
        p = on_circle(t)
        assert compare_visual_angles(p, chord, turned) == 0
        q = p[0], p[1] + Fraction(1, 10**60)
        assert compare_visual_angles(q, chord, turned) != 0


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_broadcasting(seed):
    rng = np.random.default_rng(seed)
    p = rng.integers(-3, 4, (4, 1, 2)).astype(float)
    segments = rng.integers(-3, 4, (3, 2, 2)).astype(float)
    other = np.array([[0.0, 0.0], [1.0, 0.0]])
    result = compare_visual_angles_at(p, segments, other)
    assert result.shape == (4, 3)
    for i in range(4):
        for j in range(3):
            expected = slow_comparison(p[i, 0], *segments[j], *other)
            assert result[i, j] == (UNDEFINED if expected is None else expected)


def test_filter_decides_ordinary_input():
    """At unit scale and far from the origin, the filter settles what is not degenerate."""
    rng = np.random.default_rng(3)
    rows = rng.uniform(-1, 1, (5000, 5, 2))
    assert (predicates.filter_visual_angles(rows) != UNSURE).all()
    assert (predicates.filter_visual_angles(rows + 2.0**30) != UNSURE).mean() > 0.999
    assert (predicates.filter_orientations(rows[:, :3] * 1e-300) != UNSURE).all()
