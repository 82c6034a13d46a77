"""Polynomials of degree two and three in Bernstein form on [0, 1]."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from flint import fmpq_poly


def zeros_inside(b: list[float]) -> list[float]:
    """The zeros in (0, 1) of a polynomial in Bernstein form, increasing; zeros of even order are
    found only by chance.

    By Descartes' rule: no sign change, no zero; one, one zero; else both halves are looked at.
    """
    return [t for t in _zeros(b, 50) if 0.0 < t < 1.0]


def _zeros(b: list[float], depth: int) -> list[float]:
    signs = [c > 0 for c in b if c != 0]
    changes = sum(x != y for x, y in pairwise(signs))
    if changes == 0 or depth == 0:
        return []
    if changes == 1:
        return [single_zero(b, signs[0])]
    left, right = _halves(b)
    middle = [0.5] if left[-1] == 0 else []
    before, after = _zeros(left, depth - 1), _zeros(right, depth - 1)
    return [t / 2 for t in before] + middle + [(1 + t) / 2 for t in after]


def _halves(b: list[float]) -> tuple[list[float], list[float]]:
    left, right = [b[0]], [b[-1]]
    while len(b) > 1:
        b = [(x + y) / 2 for x, y in pairwise(b)]
        left.append(b[0])
        right.append(b[-1])
    return left, right[::-1]


def single_zero(b: list[float], starts_positive: bool) -> float:
    """The only zero in (0, 1) of a polynomial in Bernstein form, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if (value_at(b, middle) > 0.0) == starts_positive:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def value_at(b: list[float], t: float) -> float:
    """A cubic (or quadratic) in Bernstein form at t."""
    s = 1.0 - t
    if len(b) == 3:
        return s * s * b[0] + 2.0 * s * t * b[1] + t * t * b[2]
    return s * s * (s * b[0] + 3.0 * t * b[1]) + t * t * (3.0 * s * b[2] + t * b[3])


def from_bernstein(b: list[Any]) -> fmpq_poly:
    """The polynomial with four given Bernstein coefficients."""
    return fmpq_poly(
        [b[0], 3 * (b[1] - b[0]), 3 * (b[0] - 2 * b[1] + b[2]), b[3] - 3 * b[2] + 3 * b[1] - b[0]]
    )
