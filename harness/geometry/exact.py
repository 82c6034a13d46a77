"""Exact arithmetic behind every filter: rationals of python-flint, and signs of determinants."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final

from flint import fmpq

#: A point with flint rationals; ``Any`` because flint has no type information.
ExactPoint = tuple[Any, Any]
#: What a filter says when rounding could change the sign.
UNSURE: Final = 2


def rational(value: float | Fraction) -> Any:
    """``value`` as a flint rational, exactly."""
    numerator, denominator = value.as_integer_ratio()
    return fmpq(numerator, denominator)


def fraction(value: Any) -> Fraction:
    """A flint rational as a :class:`~fractions.Fraction`."""
    return Fraction(int(value.p), int(value.q))


def point(pair: tuple[float | Fraction, float | Fraction]) -> ExactPoint:
    """A point with flint rationals."""
    return rational(pair[0]), rational(pair[1])


def sign(value: Any) -> int:
    """−1, 0 or 1."""
    return int(value > 0) - int(value < 0)


def cross(p: Any, q: Any, r: Any) -> Any:
    """(q − p) × (r − p): twice the signed area of the triangle p, q, r (any exact type)."""
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def orientation(p: Any, q: Any, r: Any) -> int:
    """1 if p, q, r turn left, −1 if right, 0 if collinear, for exact coordinates of any type."""
    return sign(cross(p, q, r))


def resolve(
    step: Callable[[int, list[tuple[int, int, int, int]]], tuple[int, int, int, int, int]],
    exact: Callable[[int, int, int], int],
) -> tuple[int, int, int]:
    """Drive a filtered algorithm to its end, answering what its float filter could not decide.

    ``step(start, known)`` works through its events from number ``start`` on and returns
    ``(event, status, i, j, k)``.  Status 2 asks for the sign of the predicate on (i, j, k), with
    nothing of ``event`` carried out yet: the sign is found by ``exact`` and ``step`` is called
    again with ``event`` and with (i, j, k, sign) among the ``known`` answers for that event.
    Any other status ends the work; ``(status, i, j)`` is returned.  So the hot loops may be
    compiled, know nothing of exact arithmetic, and are nevertheless never wrong.
    """
    event, known = 0, list[tuple[int, int, int, int]]()
    while True:
        reached, status, i, j, k = step(event, known)
        if status != UNSURE:
            return status, i, j
        if reached != event:
            event, known = reached, []
        known.append((i, j, k, exact(i, j, k)))
