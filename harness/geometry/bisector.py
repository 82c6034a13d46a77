"""The bisector of two segments: two circular cubics (the paper, Lemma 1).

Where the visual angles of s and t agree, Q_s|L_t| = Q_t|L_s|.  So the bisector lies on the curves

    F₊ = Q_s L_t − Q_t L_s = 0    where L_s L_t > 0,
    F₋ = Q_s L_t + Q_t L_s = 0    where L_s L_t < 0,

both of degree at most three.  The leading part of either is (x² + y²) times a linear form: they
pass through the circular points, hence "circular".  Reversing one segment exchanges the two (up
to sign).  The paper's equation (5), for s from (−1, 0) to (1, 0) and t of half length l about
(a, b) with slope φ, is F₋/2 if t is directed along (cos φ, sin φ), and −F₊/2 if it is reversed.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product

import numpy as np

from harness.geometry.coordinates import Floats, Point

Monomial = tuple[int, int]
Polynomial = dict[Monomial, Fraction]

#: The exponents (i, j) of xⁱyʲ, in the order of coefficients.
MONOMIALS: tuple[Monomial, ...] = tuple(
    (degree - j, j) for degree in range(4) for j in range(degree + 1)
)


@dataclass(frozen=True)
class Cubic:
    """A polynomial of degree at most three; ``coefficients`` are in the order of MONOMIALS."""

    coefficients: tuple[Fraction, ...]

    def __call__(self, x: Fraction, y: Fraction) -> Fraction:
        """The exact value at a rational point."""
        terms = zip(self.coefficients, MONOMIALS, strict=True)
        return sum((c * x**i * y**j for c, (i, j) in terms), Fraction(0))

    @cached_property
    def floats(self) -> Floats:
        """The coefficients over the largest of them, as nearest doubles, shape (10,)."""
        largest = max(map(abs, self.coefficients)) or Fraction(1)
        return np.array([float(c / largest) for c in self.coefficients])


def bisector_cubics(s: tuple[Point, Point], t: tuple[Point, Point]) -> tuple[Cubic, Cubic]:
    """(F₊, F₋) of two segments with rational endpoints, exactly."""
    first = _times(quadratic_form(s), linear_form(t))
    second = _times(quadratic_form(t), linear_form(s))
    return _combination(first, second, -1), _combination(first, second, 1)


def quadratic_form(s: tuple[Point, Point]) -> Polynomial:
    """Q(p) = |p|² − (a + b)·p + a·b for the segment from a to b."""
    (ax, ay), (bx, by) = s
    one = Fraction(1)
    return {
        (2, 0): one,
        (0, 2): one,
        (1, 0): -(ax + bx),
        (0, 1): -(ay + by),
        (0, 0): ax * bx + ay * by,
    }


def linear_form(s: tuple[Point, Point]) -> Polynomial:
    """L(p) = a × b + p × (a − b) for the segment from a to b."""
    (ax, ay), (bx, by) = s
    return {(1, 0): ay - by, (0, 1): bx - ax, (0, 0): ax * by - ay * bx}


def _times(p: Polynomial, q: Polynomial) -> Polynomial:
    result: Polynomial = {}
    for ((i, j), a), ((k, m), b) in product(p.items(), q.items()):
        result[i + k, j + m] = result.get((i + k, j + m), Fraction(0)) + a * b
    return result


def _combination(p: Polynomial, q: Polynomial, factor: int) -> Cubic:
    zero = Fraction(0)
    return Cubic(tuple(p.get(m, zero) + factor * q.get(m, zero) for m in MONOMIALS))
