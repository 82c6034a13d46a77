"""The error bound of the double-double tables, against rational arithmetic.

The theorem is in the docstring of :mod:`harness.diagram.fast.fine`.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram.fast.double import fma, plus, times
from harness.diagram.fast.fine import FINE, fine_coefficients, fine_root_table, fine_table
from harness.diagram.fast.fine_points import cubic_at
from harness.diagram.fast.jit import compiled
from tests.diagram.fast.exact_forms import (
    CUBIC,
    Floats,
    Scene,
    bernstein,
    double_double,
    exact_cubic,
    exact_table,
    halved,
    sign,
)
from tests.diagram.fast.scenes import scenes, steps

U2 = Fraction(2) ** -106
SIGNS = st.sampled_from([1, -1])


def weights_after(path: Sequence[tuple[int, int]]) -> list[list[Fraction]]:
    """Barycentric weights of the corners of a triangle after some halvings."""
    rows = [[Fraction(int(r == c)) for c in range(3)] for r in range(3)]
    for k, half in path:
        rows = [list(row) for row in halved(rows, k)[half]]  # type: ignore[arg-type]  # weights
    return rows


def fine_tables(scene: Scene, rows: list[list[Fraction]]) -> tuple[Floats, Floats]:
    """The fine tables of both segments of a scene in a triangle, and (MQ, ML) of each."""
    corners = np.array([[*double_double(x), *double_double(y)] for x, y, _ in scene.corners])
    weights = np.array([float(w) for _, _, w in scene.corners])
    lam = np.array([part for row in rows for part in map(float, row)] + [0.0] * 9)
    for k, exact in enumerate(x for row in rows for x in row):
        lam[9 + k] = float(exact - Fraction(lam[k]))
        assert Fraction(lam[k]) + Fraction(lam[9 + k]) == exact
    ends = [
        np.array([part for point in segment for x in point for part in double_double(x)])
        for segment in scene.segments
    ]
    size = max(float(np.abs(row).max()) for row in ends)
    size = max(size, float(np.abs(corners[weights == 1]).max(initial=0.0)))
    tables, norms = np.empty((2, 18)), np.empty((2, 2))
    for k, row in enumerate(ends):
        root, norm = np.empty(18), np.empty(2)
        flags = scene.zeros[k], scene.ends[k]
        fine_root_table(row, corners, weights, *flags, size, float(scene.sense), root, norm)
        fine_table(root, *flags, lam, tables[k])
        norms[k] = norm[1], norm[0]
    return tables, norms


def exact_tables(scene: Scene, rows: list[list[Fraction]]) -> list[list[Fraction]]:
    corners = [
        tuple(
            sum(f * c[axis] for f, c in zip(row, scene.corners, strict=True)) for axis in range(3)
        )
        for row in rows
    ]
    return [exact_table(s, corners, scene.sense) for s in scene.segments]  # type: ignore[arg-type]  # triples


def bound(norms: Floats) -> Fraction:
    return Fraction(FINE * (norms[0, 0] * norms[1, 1] + norms[1, 0] * norms[0, 1]))


@settings(max_examples=300, deadline=None)
@given(scenes(), steps(80), SIGNS, SIGNS)
def test_coefficients_are_within_their_bound(
    scene: Scene, path: list[tuple[int, int]], si: int, sj: int
) -> None:
    scene, rows = scene.scaled(), weights_after(path)
    tables, norms = fine_tables(scene, rows)
    truth = exact_cubic(*exact_tables(scene, rows), si, sj)
    for value, exact in zip(fine_coefficients(tables, 0, 1, si, sj), truth, strict=True):
        rounding = abs(exact) * Fraction(2) ** -51
        assert abs(Fraction(value) - exact) <= bound(norms) + rounding
        if abs(value) > bound(norms):
            assert sign(Fraction(value)) == sign(exact)


@settings(max_examples=300, deadline=None)
@given(scenes(), steps(60), st.tuples(st.integers(0, 9), st.integers(0, 9), st.integers(1, 9)))
def test_values_at_points_are_within_twice_the_bound(
    scene: Scene, path: list[tuple[int, int]], at: tuple[int, int, int]
) -> None:
    scene, rows = scene.scaled(), weights_after(path)
    tables, norms = fine_tables(scene, rows)
    x, y = (double_double(Fraction(w, sum(at))) for w in at[:2])
    point = [Fraction(x[0]) + Fraction(x[1]), Fraction(y[0]) + Fraction(y[1])]
    weights = (1 - point[0] - point[1], *point)
    truth = bernstein(exact_cubic(*exact_tables(scene, rows), 1, 1), CUBIC, weights)
    value = Fraction(cubic_at(tables, 0, 1, 1.0, 1.0, x, y))
    assert abs(value - truth) <= 2 * bound(norms) + abs(truth) * Fraction(2) ** -51


@settings(max_examples=200, deadline=None)
@given(scenes(), steps(80))
def test_an_entry_is_zero_only_where_the_form_vanishes(
    scene: Scene, path: list[tuple[int, int]]
) -> None:
    scene, rows = scene.scaled(), weights_after(path)
    tables, _ = fine_tables(scene, rows)
    for table, exact in zip(tables, exact_tables(scene, rows), strict=True):
        for value, truth in zip(table[:9].tolist(), exact, strict=True):
            assert value != 0.0 or truth == 0


def test_most_of_the_precision_is_there() -> None:
    """The bound is not idle: in deep triangles doubles would miss it by far."""
    rng = random.Random(5)
    worst = Fraction(0)
    for _ in range(200):
        corners = tuple(
            (Fraction(rng.random()), Fraction(rng.random()), Fraction(1)) for _ in "abc"
        )
        segments = tuple(
            tuple((Fraction(rng.random()), Fraction(rng.random())) for _ in "ab") for _ in "st"
        )
        scene = Scene(segments, corners)  # type: ignore[arg-type]  # pairs
        rows = weights_after([(rng.randrange(3), rng.randrange(2)) for _ in range(60)])
        tables, norms = fine_tables(scene, rows)
        truth = exact_cubic(*exact_tables(scene, rows), 1, 1)
        for value, exact in zip(fine_coefficients(tables, 0, 1, 1.0, 1.0), truth, strict=True):
            error = abs(Fraction(value) - exact) - abs(exact) * Fraction(2) ** -51
            worst = max(worst, error / bound(norms))
    assert worst < Fraction(1, 4)


@compiled
def _fma(x, y, z):  # type: ignore[no-untyped-def]  # compiled
    return fma(x, y, z)


@given(*[st.floats(-1e6, 1e6)] * 3)
def test_fma_rounds_once(x: float, y: float, z: float) -> None:
    exact = Fraction(x) * Fraction(y) + Fraction(z)
    assert _fma(x, y, z) == float(exact) or abs(exact) < Fraction(2) ** -1000


DOUBLES = st.floats(-8, 8).filter(lambda x: x == 0 or abs(x) > 1e-60)
PAIRS = st.tuples(DOUBLES, st.floats(-1, 1)).map(
    lambda p: (p[0], p[1] * float(np.spacing(abs(p[0]))) / 2)
)


@given(PAIRS, PAIRS)
def test_sums_and_products_of_double_doubles(
    one: tuple[float, float], two: tuple[float, float]
) -> None:
    a, b = (Fraction(h) + Fraction(low) for h, low in (one, two))
    total = sum((Fraction(x) for x in plus(*one, *two)), Fraction(0))
    product = sum((Fraction(x) for x in times(*one, *two)), Fraction(0))
    assert abs(total - (a + b)) <= 4 * U2 * abs(a + b) + Fraction(2) ** -1000
    assert abs(product - a * b) <= 5 * U2 * abs(a * b) + Fraction(2) ** -900


@pytest.mark.parametrize("depth", [10, 50, 90])
def test_weights_stay_exact(depth: int) -> None:
    rows = weights_after([(k % 3, k // 3 % 2) for k in range(depth)])
    for row in rows:
        for exact in row:
            high, low = double_double(exact)
            assert Fraction(high) + Fraction(low) == exact
