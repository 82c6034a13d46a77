"""Sets of segments: disjoint, and crossing where the family says."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from generators import generate
from tests.strategies import cross


def exact(coordinates):
    return [tuple((Fraction(x), Fraction(y)) for x, y in s) for s in coordinates.tolist()]


def touch(s, t):
    """Whether two segments in general position have a point in common."""
    (a, b), (c, d) = s, t
    return (
        cross(a, b, c) * cross(a, b, d) <= 0
        and cross(c, d, a) * cross(c, d, b) <= 0
        and max(min(s)[0], min(t)[0]) <= min(max(s)[0], max(t)[0])
    )


def extensions_cross(s, t):
    """Whether the lines of two segments meet in a point outside both."""
    (a, b), (c, d) = s, t
    parallel = (b[0] - a[0]) * (d[1] - c[1]) == (b[1] - a[1]) * (d[0] - c[0])
    return (
        not parallel and cross(a, b, c) * cross(a, b, d) > 0 and cross(c, d, a) * cross(c, d, b) > 0
    )


@settings(max_examples=30)
@given(
    n=st.integers(1, 60),
    seed=st.integers(0, 2**32),
    length=st.floats(0.01, 2.0),
    spread=st.floats(0.0, 0.9),
)
def test_random_segments_are_disjoint_and_as_long_as_asked(n, seed, length, spread):
    made = generate("segments", n, seed, length=length, spread=spread).coordinates
    assert not any(touch(s, t) for s, t in combinations(exact(made), 2))
    sizes = np.hypot(*(made[:, 1] - made[:, 0]).T) * np.sqrt(n)
    assert (sizes >= length * (1 - spread) * (1 - 1e-9)).all()
    assert (sizes <= length * (1 + spread) * (1 + 1e-9)).all()
    middle = made.mean(axis=1)
    assert ((middle > -1e-9) & (middle < 1 + 1e-9)).all()


@pytest.mark.parametrize("length", [0.5, 2.0])
def test_ten_thousand_segments(length):
    made = generate("segments", 10_000, 1, length=length).coordinates
    longest = np.hypot(*(made[:, 1] - made[:, 0]).T).max()
    pairs = cKDTree(made.mean(axis=1)).query_pairs(longest, output_type="ndarray")
    one, two = made[pairs[:, 0]], made[pairs[:, 1]]

    def sides(s, t):
        u = s[:, 1] - s[:, 0]
        v = t - s[:, :1]
        return np.sign(u[:, None, 0] * v[:, :, 1] - u[:, None, 1] * v[:, :, 0])

    apart = (sides(one, two).prod(axis=1) > 0) | (sides(two, one).prod(axis=1) > 0)
    assert len(pairs) > 2000
    assert apart.all()


@given(n=st.integers(1, 20))
def test_the_regular_grid_crosses_once_in_every_square(n):
    made = exact(generate("grid", n).coordinates)
    level = [s for s in made if s[0][1] == s[1][1]]
    upright = [s for s in made if s[0][0] == s[1][0]]
    assert len(level) == (n + 1) // 2
    assert len(upright) == n // 2
    assert all(extensions_cross(s, t) for s in level for t in upright)
    assert all(b[0] - a[0] + b[1] - a[1] == 1 for a, b in made)


@settings(max_examples=30)
@given(n=st.integers(1, 24), seed=st.integers(0, 2**32), jitter=st.floats(1e-6, 0.6))
def test_every_pair_of_the_generic_grid_has_an_extension_crossing(n, seed, jitter):
    made = exact(generate("grid", n, seed, variant="generic", jitter=jitter).coordinates)
    assert all(extensions_cross(s, t) for s, t in combinations(made, 2))
    assert not any(touch(s, t) for s, t in combinations(made, 2))


def test_generic_grid_slopes_stay_apart_at_the_largest_jitter():
    """Over the whole grid no line leaves its own lane: 1 − 3·jitter/2 > 0."""
    for n in (2, 3, 10, 200):
        for seed in range(5):
            made = generate("grid", n, seed, variant="generic", jitter=0.6).coordinates
            rows = (n + 1) // 2
            a, b = made[:rows, 0], made[:rows, 1]
            slope = (b[:, 1] - a[:, 1]) / (b[:, 0] - a[:, 0])
            for x in (0.0, n / 2 + 0.5):
                height = a[:, 1] + slope * (x - a[:, 0])
                assert (np.diff(height) > 0.09).all()
                assert (height > 0).all()


def test_figure_2_is_a_loose_triangle():
    made = exact(generate("figure-2", 3).coordinates)
    assert all(extensions_cross(s, t) for s, t in combinations(made, 2))
    assert not any(touch(s, t) for s, t in combinations(made, 2))
