"""Polynomials of degree two and three in Bernstein form on [0, 1]."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

#: Zeros that agree to so many bits are not told apart.
_FINEST = 600


def zeros_inside(b: list[float]) -> list[float]:
    """The zeros in (0, 1) of a polynomial in Bernstein form, increasing; zeros of even order are
    found only by chance.

    By Descartes' rule: no sign change, no zero; one, one zero; else both halves are looked at.
    """
    return [t for t in _zeros(b, 50) if 0.0 < t < 1.0]


def _zeros(b: list[float], depth: int) -> list[float]:
    changes = _changes(b)
    if changes == 0 or depth == 0:
        return []
    if changes == 1:
        return [single_zero(b, next(c > 0 for c in b if c != 0))]
    left, right = _halves(b)
    middle = [0.5] if left[-1] == 0 else []
    before, after = _zeros(left, depth - 1), _zeros(right, depth - 1)
    return [t / 2 for t in before] + middle + [(1 + t) / 2 for t in after]


def _changes(b: Sequence[Any]) -> int:
    """How often the sign changes, zeros aside."""
    signs = [c > 0 for c in b if c != 0]
    return sum(x != y for x, y in pairwise(signs))


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


def rounded(values: Iterable[Any]) -> list[float]:
    """Integers divided by the power of two that brings the greatest near 1, as doubles."""
    whole = [int(value) for value in values]
    size = 1 << max(value.bit_length() for value in whole)
    return [value / size for value in whole]


class Zero:
    """A simple zero of a polynomial with integer coefficients, and no other, between two numbers.

    ``low`` < zero < ``high``, or all three are equal; both are dyadic.
    """

    def __init__(self, b: Sequence[Any], low: Fraction, high: Fraction) -> None:
        """``b``: Bernstein coefficients between the two numbers, with one change of sign."""
        self._b = b
        self.low, self.high = low, high

    def refine(self) -> None:
        """Halve the interval."""
        if self.low == self.high:
            return
        middle = (self.low + self.high) / 2
        left, right = _exact_halves(self._b)
        if left[-1] == 0:
            self.low = self.high = middle
        elif _changes(left) == 1:
            self._b, self.high = left, middle
        else:
            self._b, self.low = right, middle

    def narrow(self, bits: int) -> None:
        """Halve the interval until it is shorter than 2^−bits."""
        while (self.high - self.low) * 2**bits > 1:
            self.refine()


def isolated_zeros(b: Sequence[Any]) -> list[Zero]:
    """All zeros in (0, 1) of a polynomial in Bernstein form with integer coefficients, increasing.

    Exactly, by Descartes' rule.  Raises ArithmeticError if two of them agree to hundreds of bits.
    """
    return list(_isolated(b, Fraction(0), Fraction(1), _FINEST))


def _isolated(b: Sequence[Any], low: Fraction, high: Fraction, depth: int) -> Iterator[Zero]:
    changes = _changes(b)
    if changes == 1:
        yield Zero(b, low, high)
    elif changes > 1:
        if depth == 0:
            raise ArithmeticError("a double zero, or two that agree to hundreds of bits")
        middle = (low + high) / 2
        left, right = _exact_halves(b)
        yield from _isolated(left, low, middle, depth - 1)
        if left[-1] == 0:
            yield Zero(left, middle, middle)
        yield from _isolated(right, middle, high, depth - 1)


def _exact_halves(b: Sequence[Any]) -> tuple[list[Any], list[Any]]:
    """Both halves times 2^degree."""
    row = list(b)
    unit = 2 ** (len(row) - 1)
    left, right = [unit * row[0]], [unit * row[-1]]
    while len(row) > 1:
        row = [x + y for x, y in pairwise(row)]
        unit //= 2
        left.append(unit * row[0])
        right.append(unit * row[-1])
    return left, right[::-1]
