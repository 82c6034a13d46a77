"""Real roots where they are far apart in size or nearly coincide."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import arb, ctx, fmpq, fmpz_poly
from hypothesis import given
from hypothesis import strategies as st

from harness.diagram import roots
from harness.diagram.roots import real_root_balls

magnitudes = st.integers(-700, 700).map(lambda e: Fraction(2) ** e)
values = st.tuples(st.integers(-9, 9), magnitudes).map(lambda pair: pair[0] * pair[1])


def with_roots(chosen: list[Fraction]) -> fmpz_poly:
    polynomial = fmpz_poly([1])
    for root in chosen:
        polynomial *= fmpz_poly([-root.numerator, root.denominator])
    return polynomial


def contains(ball: arb, value: Fraction) -> bool:
    return bool(ball.contains(fmpq(value.numerator, value.denominator)))


@given(st.lists(values, min_size=1, max_size=5), st.integers(0, 2))
def test_all_real_roots_are_enclosed_in_order(chosen: list[Fraction], pairs: int) -> None:
    polynomial = with_roots(chosen) * fmpz_poly([2, 1, 1]) ** pairs
    balls = real_root_balls(polynomial, 96)
    assert len(balls) == len(set(chosen))
    with ctx.workprec(4000):
        for ball, root in zip(balls, sorted(set(chosen)), strict=True):
            assert contains(ball, root)
            assert ball.rad() <= abs(ball.mid()) * arb(2) ** -80


@given(st.lists(st.fractions(-20, 20, max_denominator=9), min_size=1, max_size=5, unique=True))
def test_bisection_agrees_with_the_fast_way(chosen: list[Fraction]) -> None:
    polynomial = with_roots(chosen) * fmpz_poly([3, -1, 1])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(roots, "WILD", -1)
        bisected = real_root_balls(polynomial, 96)
    assert len(bisected) == len(chosen)
    for ball, fast in zip(bisected, real_root_balls(polynomial, 96), strict=True):
        assert ball.overlaps(fast)


def test_roots_that_agree_to_four_thousand_bits() -> None:
    close = [Fraction(1), 1 + Fraction(1, 2**4100), 1 + Fraction(1, 2**4000)]
    balls = real_root_balls(with_roots(close), 8500)
    assert len(balls) == 3
    with ctx.workprec(10000):
        assert balls[0] < balls[1] < balls[2]
