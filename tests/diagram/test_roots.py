"""Real roots, also where they differ much in size or agree to many bits."""

from __future__ import annotations

from fractions import Fraction

from flint import ctx, fmpq, fmpz_poly
from hypothesis import given
from hypothesis import strategies as st

from harness.diagram.roots import real_root_balls

magnitudes = st.integers(-100, 100).map(lambda e: Fraction(2) ** e)
values = st.tuples(st.integers(-9, 9), magnitudes).map(lambda pair: pair[0] * pair[1])


def with_roots(chosen: list[Fraction]) -> fmpz_poly:
    polynomial = fmpz_poly([1])
    for root in chosen:
        polynomial *= fmpz_poly([-root.numerator, root.denominator])
    return polynomial


@given(st.lists(values, min_size=1, max_size=5), st.integers(0, 2))
def test_all_real_roots_are_enclosed_in_order(chosen: list[Fraction], pairs: int) -> None:
    polynomial = with_roots(chosen) * fmpz_poly([2, 1, 1]) ** pairs
    balls = real_root_balls(polynomial, 96)
    assert len(balls) == len(set(chosen))
    with ctx.workprec(2000):
        for ball, root in zip(balls, sorted(set(chosen)), strict=True):
            assert ball.contains(fmpq(root.numerator, root.denominator))


def test_roots_that_agree_to_two_hundred_bits() -> None:
    close = [Fraction(1), 1 + Fraction(1, 2**210), 1 + Fraction(1, 2**200)]
    balls = real_root_balls(with_roots(close), 300)
    with ctx.workprec(500):
        assert balls[0] < balls[1] < balls[2]
