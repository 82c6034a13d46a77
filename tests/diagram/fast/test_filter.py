"""The error bounds of the float filter, against rational arithmetic and against a search for worse.

The theorem is in the docstring of :mod:`harness.diagram.fast.forms`.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from harness.diagram.fast.collinear import collinear_cubic
from harness.diagram.fast.forms import (
    UNKNOWN,
    U,
    cubic,
    divided_by_distance,
    gradient_controls,
    surely_positive,
    value_and_gradient,
)
from harness.diagram.fast.tables import difference
from tests.diagram.fast.exact_forms import (
    CUBIC,
    Descent,
    Scene,
    bernstein,
    derivative,
    double_double,
    exact_collinear,
    exact_cubic,
    sign,
)
from tests.diagram.fast.scenes import STANDARD, fine, moved, rounded, scenes, steps

SIGNS = st.sampled_from([1, -1])


def coefficients(here: Descent, si: int, sj: int) -> tuple[np.ndarray, np.ndarray]:
    values, signs = np.empty(10), np.empty(10, np.int64)
    # Where the vectors are equal up to sign this is known beforehand; see ``prepare``.
    (a, b), (c, d) = here.scene.segments
    one, two = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    alike = two in (one, (-one[0], -one[1]))
    cubic(here.rows, 0, 1, si, sj, here.bound, here.far, int(alike), values, signs)
    return values, signs


def ratio(here: Descent, si: int = 1, sj: int = 1) -> float:
    """The greatest error of a coefficient of F, relative to the bound claimed for it."""
    values, _ = coefficients(here, si, sj)
    t, s = here.exact()
    errors: list[Fraction] = [
        abs(Fraction(value) - exact)
        for value, exact in zip(values.tolist(), exact_cubic(t, s, si, sj), strict=True)
    ]
    return float(max(errors)) / here.bound


# --- tables --------------------------------------------------------------------------------------


@given(st.lists(st.builds(Fraction, st.integers(), st.integers(1, 10**6)), min_size=2, max_size=2))
def test_a_difference_is_rounded_once(numbers: list[Fraction]) -> None:
    a, b = numbers
    size = max(abs(a), abs(b), Fraction(1))
    error = abs(Fraction(difference(*double_double(a), *double_double(b))) - (a - b))
    assert error <= Fraction(U) * abs(a - b) + size * Fraction(2) ** -101


@settings(max_examples=300)
@given(scenes(), steps())
def test_entries_of_tables_are_within_their_bounds(
    scene: Scene, path: list[tuple[int, int]]
) -> None:
    """Roots are off by 5u·ML and 6u·MQ; each halving adds u·ML, and 2u·MQ where a side is cut."""
    here = Descent.into(scene, path)
    for table, norm, exact in zip(here.tables, here.local_norms(), here.exact(), strict=True):
        for k, (value, truth) in enumerate(zip(table.tolist(), exact, strict=True)):
            if k < 3:
                allowed = (5 + here.depth) * U * norm[0]
            else:
                allowed = (6 + 2 * here.depth) * U * norm[1]
            assert abs(Fraction(value) - truth) <= Fraction(allowed)


@settings(max_examples=300)
@given(scenes(), steps())
def test_an_entry_is_zero_only_where_the_form_vanishes(
    scene: Scene, path: list[tuple[int, int]]
) -> None:
    here = Descent.into(scene, path)
    for table, exact in zip(here.tables, here.exact(), strict=True):
        for value, truth in zip(table.tolist(), exact, strict=True):
            assert value != 0.0 or truth == 0


# --- coefficients --------------------------------------------------------------------------------


@settings(max_examples=500)
@given(scenes(), steps(), SIGNS, SIGNS)
@example(STANDARD.scaled(), [], 1, 1)
@example(STANDARD.scaled(), [(0, 0)] * 40, 1, 1)
def test_coefficients_are_within_their_bound(
    scene: Scene, path: list[tuple[int, int]], si: int, sj: int
) -> None:
    assert ratio(Descent.into(scene, path), si, sj) <= 1


@settings(max_examples=500)
@given(scenes(), steps(), SIGNS, SIGNS)
def test_signs_are_never_wrong(scene: Scene, path: list[tuple[int, int]], si: int, sj: int) -> None:
    here = Descent.into(scene, path)
    values, signs = coefficients(here, si, sj)
    t, s = here.exact()
    truth = [sign(value) for value in exact_cubic(t, s, si, sj)]
    for value, claimed, true in zip(values.tolist(), signs.tolist(), truth, strict=True):
        assert claimed in (true, UNKNOWN)
        assert claimed != 0 or value == 0.0
    claim = surely_positive(here.rows, 0, 1, si, sj, here.bound, here.far, 0)
    assert not claim or (min(truth) >= 0 and max(truth) > 0)


@settings(max_examples=200)
@given(scenes(), steps(12))
def test_structural_zeros_are_seen(scene: Scene, path: list[tuple[int, int]]) -> None:
    """Where every product in a coefficient has a factor that vanishes by construction."""
    flagged = replace(scene, zeros=(7, 7), ends=(7, 7))
    _, signs = coefficients(Descent.into(flagged, path), 1, 1)
    tables = Descent.into(flagged, path).tables
    assert [t[:3].any() for t in tables] == [False, False]
    assert signs.tolist() == [0] * 10


@settings(max_examples=200)
@given(scenes(), steps(), st.integers(-9, 9), st.integers(1, 9))
def test_collinear_segments(scene: Scene, path: list[tuple[int, int]], at: int, times: int) -> None:
    """F over its factor L, for segments on one line."""
    a, b = scene.segments[0]
    vector = (b[0] - a[0], b[1] - a[1])
    start = (a[0] + at * vector[0], a[1] + at * vector[1])
    end = (start[0] + times * vector[0], start[1] + times * vector[1])
    scene = replace(scene, segments=((a, b), (start, end)), zeros=(0, 0), ends=(0, 0)).scaled()
    here = Descent.into(scene, path)
    # A coordinate of the vectors is as good as their lengths.
    axis = 0 if abs(vector[0]) >= abs(vector[1]) else 1
    length, other = (np.array(double_double(abs(q[axis] - p[axis]))) for p, q in scene.segments)
    values, signs = np.empty(10), np.empty(10, np.int64)
    norms = here.local_norms()
    bound = here.bound / (norms[0][1] * norms[1][0] + norms[1][1] * norms[0][0])
    bound *= norms[0][1] * other[0] + norms[1][1] * length[0]
    bound = collinear_cubic(here.rows, 0, 1, length, other, bound, 0, 0, values, signs)
    truth = exact_collinear(*here.exact(), Fraction(1, times))
    for value, claimed, exact in zip(values.tolist(), signs.tolist(), truth, strict=True):
        assert claimed in (sign(exact), UNKNOWN)
        assert abs(Fraction(value) / Fraction(other[0]) - exact) <= Fraction(bound) / Fraction(
            other[0]
        )


@settings(max_examples=200)
@given(scenes(), st.tuples(*[st.integers(-9, 9)] * 2), st.integers(0, 2), st.booleans())
def test_equal_vectors_divided_by_the_distance(
    scene: Scene, shift: tuple[int, int], k: int, turned: bool
) -> None:
    """Over a triangle with two corners at infinity F = λ_k·G: its quadratic factor, raised."""
    a, b = scene.segments[0]
    c, d = ((x + dx, y + dy) for (x, y), (dx, dy) in ((a, shift), (b, shift)))
    near = (Fraction(1, 3), Fraction(1, 5), Fraction(1))
    east, north = (Fraction(5), Fraction(1), Fraction(0)), (Fraction(-2), Fraction(3), Fraction(0))
    corners = [near, east, north]
    rolled = tuple(corners[-k:] + corners[:-k])
    segments = ((a, b), (d, c) if turned else (c, d))
    here = Descent.into(Scene(segments, rolled, sense=scene.sense).scaled(), [])
    sj = -1 if turned else 1
    values, _ = coefficients(here, 1, sj)
    divided_by_distance(values, k)
    exact = exact_cubic(*here.exact(), 1, sj)
    assert all(exact[c] == 0 for c, index in enumerate(CUBIC) if index[k] == 0)
    for point in itertools.product([Fraction(1, 4), Fraction(1), Fraction(3)], repeat=3):
        found = bernstein([Fraction(value) for value in values.tolist()], CUBIC, point)
        total, weight = sum(point), sum(point) ** 3
        # Homogeneous of degree 3 after raising: multiply the true G by λ₀ + λ₁ + λ₂.
        truth = bernstein(exact, CUBIC, point) / point[k] * total
        assert abs(found - truth) <= 9 * Fraction(here.bound) * weight


@given(scenes(), steps(8), st.tuples(st.integers(1, 9), st.integers(1, 9), st.integers(1, 9)))
def test_value_and_gradient_are_those_of_the_coefficients(
    scene: Scene, path: list[tuple[int, int]], weights: tuple[int, int, int]
) -> None:
    values, _ = coefficients(Descent.into(scene, path), 1, 1)
    exact = [Fraction(value) for value in values.tolist()]
    total = sum(weights)
    x, y = weights[1] / total, weights[2] / total
    point = (1 - Fraction(x) - Fraction(y), Fraction(x), Fraction(y))
    out, controls = np.empty(3), np.empty((6, 2))
    value_and_gradient(values, x, y, out)
    gradient_controls(values, controls)
    size = Fraction(float(np.abs(values).max()))
    truth = [bernstein(exact, CUBIC, point), *(derivative(exact, k, point) for k in (1, 2))]
    for found, expected, factor in zip(out.tolist(), truth, (24, 96, 96), strict=True):
        assert abs(Fraction(found) - expected) <= factor * Fraction(U) * size
    # The controls at the corners are the gradients there.
    for corner in range(3):
        at = tuple(Fraction(int(c == corner)) for c in range(3))
        for axis in (1, 2):
            expected = derivative(exact, axis, at)
            assert abs(Fraction(controls[corner, axis - 1]) - expected) <= 12 * Fraction(U) * size


# --- a search for large errors -------------------------------------------------------------------


def _mutated(scene: Scene, rng: random.Random) -> Scene:
    """One coordinate moved by an ulp, a little, or much."""
    numbers = [x for segment in scene.segments for point in segment for x in point]
    numbers += [x for corner in scene.corners for x in corner[:2]]
    k = rng.randrange(len(numbers))
    size = Fraction(2) ** -rng.choice([53, 53, 50, 40, 30, 20, 10, 5, 2])
    numbers[k] += size * Fraction(rng.uniform(-1, 1))
    if rng.random() < 0.7:
        numbers[k] = Fraction(float(numbers[k]))
    a = [(numbers[j], numbers[j + 1]) for j in range(0, 14, 2)]
    weights = [w for _, _, w in scene.corners]
    corners = tuple((*p, w) for p, w in zip(a[4:], weights, strict=True))
    changed = replace(scene, segments=((a[0], a[1]), (a[2], a[3])), corners=corners)
    return changed if fine(changed) else scene


def climb(scene: Scene, path: list[tuple[int, int]], rounds: int, seed: int) -> Iterator[float]:
    """Ever larger ratios of error and bound."""
    rng = random.Random(seed)
    best = ratio(Descent.into(scene, path))
    yield best
    for _ in range(rounds):
        candidate = _mutated(scene, rng).scaled()
        route = list(path)
        if route and rng.random() < 0.3:
            route[rng.randrange(len(route))] = (rng.randrange(3), rng.randrange(2))
        found = ratio(Descent.into(candidate, route))
        if found > best:
            scene, path, best = candidate, route, found
            yield best


@pytest.mark.parametrize("offset", [0, 10**6, 2**40, 2**52])
@pytest.mark.parametrize("depth", [0, 1, 6, 30])
def test_no_search_finds_an_error_beyond_the_bound(offset: int, depth: int) -> None:
    scene = moved(STANDARD, Fraction(1), Fraction(offset), Fraction(-offset))
    start = rounded(scene) if offset < 2**50 else scene
    path = [(k % 3, k % 2) for k in range(depth)]
    assert max(climb(start.scaled(), path, 150, depth)) <= 1
