"""The exact kit under the reference builder against plain facts and floating point."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from flint import fmpq, fmpz_poly
from hypothesis import assume, given
from hypothesis import strategies as st

from harness.diagram.algebra import (
    NotGeneric,
    Point,
    Polynomial,
    RealNumber,
    U,
    V,
    compare_numbers,
    real_numbers,
)
from harness.diagram.fibres import (
    branches_around,
    compare_with_rational,
    fibre_points,
    intersect,
    rational_between,
    sort_by_u,
)

small = st.integers(-9, 9)
rationals = st.fractions(-9, 9, max_denominator=8)


def at(x: Any, y: Any) -> Point:
    return Point.rational(_q(x), _q(y))


def _q(value: Any) -> fmpq:
    fraction = Fraction(value)
    return fmpq(fraction.numerator, fraction.denominator)


@given(st.lists(st.integers(-30, 30), min_size=2, max_size=6, unique=True))
def test_real_numbers_are_the_roots(roots: list[int]) -> None:
    polynomial = fmpz_poly([1])
    for root in roots:
        polynomial *= fmpz_poly([-root, 1]) * fmpz_poly([root * root + 1, 0, 1])
    found = sorted(real_numbers(polynomial), key=lambda number: float(number.ball(64).mid()))
    assert [int(number.ball(64).unique_fmpz()) for number in found] == sorted(roots)


def test_numbers_compare_exactly_where_doubles_cannot() -> None:
    # x² = 2 and x² = 2 + 10^-60 have roots that agree to 60 digits.
    tiny = 10**60
    (_, a), (_, b) = (
        sorted(real_numbers(p), key=lambda n: float(n.ball(64).mid()))
        for p in (fmpz_poly([-2, 0, 1]), fmpz_poly([-2 * tiny - 1, 0, tiny]))
    )
    assert compare_numbers(a, b) == -1
    assert compare_numbers(b, a) == 1
    assert compare_numbers(a, RealNumber(fmpz_poly([-2, 0, 1]), 1)) == 0
    assert a.sign_of(fmpz_poly([-2, 0, 1])) == 0
    assert b.sign_of(fmpz_poly([-2, 0, 1])) == 1
    assert compare_with_rational(a, fmpq(3, 2)) == -1


@given(small, small, small, small)
def test_two_lines_meet_where_cramer_says(a: int, b: int, c: int, d: int) -> None:
    assume(a != b)
    f, g = Polynomial(V - a * U - c), Polynomial(V - b * U - d)
    (p,) = intersect(f, g)
    assert p.is_same_place(at(Fraction(d - c, a - b), a * Fraction(d - c, a - b) + c))


def test_intersections_of_a_circle_and_a_cubic() -> None:
    circle, cubic = Polynomial(U**2 + V**2 - 4), Polynomial(V**3 - V - U)
    points = sort_by_u(intersect(circle, cubic))
    assert len(points) == 2
    for p in points:
        u, v = p.floats()
        assert math.hypot(u, v) == pytest.approx(2, abs=1e-14)
        assert v**3 - v == pytest.approx(u, abs=1e-14)
        assert p.sign(circle) == p.sign(cubic) == 0
        assert p.sign(Polynomial(U**2 + V**2 - 3)) == 1


def test_curves_touching_on_a_vertical_line_twice_are_refused() -> None:
    # Both common points have u = 0.
    with pytest.raises(NotGeneric):
        intersect(Polynomial(V**2 + U - 1), Polynomial(V**2 - U - 1))


def test_common_components_are_refused() -> None:
    with pytest.raises(ValueError, match="component"):
        intersect(Polynomial((V - U) * (V + 1)), Polynomial((V - U) * (V - 1)))


def test_the_plausibility_filter_only_skips() -> None:
    circle, line = Polynomial(U**2 + V**2 - 25), Polynomial(V - 7 * U)
    assert len(intersect(circle, line)) == 2
    assert intersect(circle, line, plausible=lambda u, v: False) == []
    assert len(intersect(circle, line, plausible=lambda u, v: bool(u > 0))) == 2


def test_the_strip_is_closed() -> None:
    circle, line = Polynomial(U**2 + V**2 - 25), Polynomial(4 * V - 3 * U)
    assert len(intersect(circle, line, (at(-4, 0), at(4, 0)))) == 2
    assert len(intersect(circle, line, (at(-4, 0), at(3, 0)))) == 1


@given(st.lists(st.integers(-12, 12), min_size=1, max_size=3), st.integers(-12, 12))
def test_branches_around_counts_roots(roots: list[int], v: int) -> None:
    """f = Π (v − r_k − u) has the points r_k on the line u = 0."""
    polynomial = Polynomial(U * 0 + 1)
    for root in roots:
        polynomial = Polynomial(polynomial.mpoly * (V - root - U))
    others = [root for root in roots if root != v]
    if len(set(others)) < len(others):
        return  # a double point beside p: not generic
    expected = (sum(root < v for root in roots), sum(root > v for root in roots))
    assert branches_around(polynomial, at(0, v)) == expected


def test_branches_around_with_complex_branches() -> None:
    # (v − 2)(v² + 1) + u: one real branch near u = 0, at v = 2.
    cubic = Polynomial((V - 2) * (V**2 + 1) + U)
    assert branches_around(cubic, at(0, 0)) == (0, 1)
    assert branches_around(cubic, at(0, 2), on_curve=True) == (0, 0)
    assert branches_around(cubic, at(0, 5)) == (1, 0)


def test_a_vertical_tangent_above_a_point_is_refused() -> None:
    parabola = Polynomial(V**2 - 4 * V + 4 - U)
    with pytest.raises(NotGeneric):
        branches_around(parabola, at(0, 0))


@given(rationals, rationals)
def test_rational_between_is_strictly_between(a: Fraction, b: Fraction) -> None:
    assume(a != b)
    low, high = sorted((a, b))
    middle = rational_between(at(low, 0), at(high, 0))
    assert _q(low) < middle < _q(high)
    assert rational_between(None, at(low, 0)) < _q(low)
    assert rational_between(at(high, 0), None) > _q(high)


@given(st.tuples(*[small] * 10), small)
def test_fibre_points_are_the_real_roots(coefficients: tuple[int, ...], u: int) -> None:
    monomials = [U**i * V**k for i, k in itertools.product(range(4), repeat=2) if i + k <= 3]
    mpoly = sum((c * m for c, m in zip(coefficients, monomials, strict=True)), 0 * U)
    if mpoly.total_degree() < 1 or int(mpoly.degrees()[1]) < 1:
        return
    f = Polynomial(mpoly)
    fibre = f.on_fibre(fmpq(u))
    assume(fibre.degree() == f.degree_v and fibre.discriminant() != 0)
    points = fibre_points(f, fmpq(u))
    assert len(points) == f.roots_on_fibre(fmpq(u))
    values = [p.floats()[1] for p in points]
    assert values == sorted(values)
    roots = np.roots([float(c) for c in reversed(fibre.coeffs())])
    real = np.sort(roots[np.abs(roots.imag) < 1e-6].real)
    if len(real) == len(values):
        assert values == pytest.approx(list(real), abs=1e-4)
