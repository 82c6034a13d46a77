"""From what a user wrote to numbers: doubles where they suffice, exact rationals where not."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from numbers import Integral, Rational, Real
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from harness.errors import UserError

Kind = Literal["polygon", "segments"]
Point = tuple[Fraction, Fraction]
Floats = npt.NDArray[np.float64]
#: The nesting of ``Instance.exact``: vertices, or segments of two endpoints.
Exact = tuple[Point, ...] | tuple[tuple[Point, Point], ...]

COUNTING = "(counting from 0)"
_DECIMAL = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d{1,4})?", re.ASCII)
_RATIO = re.compile(r"[+-]?\d+/\d+", re.ASCII)
_LONGEST = 1000
_LARGEST_EXPONENT = 1000


class Vanished(float):
    """A zero that a file wrote as a non-zero number, too small for a double: to be refused."""


def coordinate(value: Any) -> float | Fraction:
    """The number that ``value`` stands for; an exact rational only if it is not a double.

    A number is taken as its (nearest) double, exactly; a string as the rational it writes
    (``"1/3"``, ``"0.1"``, ``"1e-300"``); a :class:`~fractions.Fraction` as itself.

    Raises ``ValueError`` with the reason alone; the caller knows the index.
    """
    if isinstance(value, Vanished):
        raise ValueError("number too small for a double (write it as a string)")
    if isinstance(value, bool | np.bool_):
        raise ValueError(f"{value} is no coordinate")
    if isinstance(value, str):
        return _simplest(_rational(value))
    if isinstance(value, Rational) and not isinstance(value, Integral):
        return _simplest(Fraction(value))
    if not isinstance(value, Real):
        raise ValueError(f"{_shown(value)} is no coordinate (a number or a string is)")
    try:
        number = float(value)
    except OverflowError:
        raise ValueError("coordinate beyond the range of a double") from None
    if number != number:
        raise ValueError("coordinate is not a number (NaN)")
    if number in (float("inf"), float("-inf")):
        raise ValueError("coordinate is infinite or beyond the range of a double")
    return number


def _rational(text: str) -> Fraction:
    """The rational written by a string, which may be neither too long nor too large to hold."""
    stripped = text.strip()
    if len(stripped) > _LONGEST:
        raise ValueError(f"coordinate string of more than {_LONGEST} characters")
    if _RATIO.fullmatch(stripped):
        numerator, denominator = stripped.split("/")
        if int(denominator) == 0:
            raise ValueError(f"{_shown(text)} divides by zero")
        return Fraction(int(numerator), int(denominator))
    match = _DECIMAL.fullmatch(stripped)
    if not match:
        raise ValueError(f'{_shown(text)} is no rational number (such as "0.1", "1e-9" or "1/3")')
    if match[3] and abs(int(match[3][1:])) > _LARGEST_EXPONENT:
        raise ValueError(f"{_shown(text)}: exponent beyond ±{_LARGEST_EXPONENT}")
    return Fraction(stripped)


def _simplest(value: Fraction) -> float | Fraction:
    """``value`` as a double if it is one, else unchanged."""
    try:
        nearest = float(value)
    except OverflowError:
        raise ValueError("coordinate beyond the range of a double") from None
    return nearest if Fraction(nearest) == value else value


def _shown(value: Any) -> str:
    """A short rendering of a wrong value for a message."""
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


def parse(rows: Any, kind: Kind) -> tuple[Floats, Exact | None]:
    """Nearest doubles of a nested list of coordinates, and the exact values if they differ.

    ``rows`` is a sequence of points (``kind`` "polygon") or of pairs of points ("segments"); an
    array of numbers will do.  Returns ``(floats, exact)`` of an :class:`Instance`; the floats
    have shape (m, 2) or (n, 2, 2).  Raises :class:`UserError` naming the offending index.
    Linear time; a list of plain numbers takes a fast path.
    """
    plain = _parse_plain(rows, kind)
    if plain is not None:
        return plain, None
    if not _is_list(rows):
        raise UserError(f"{_plural(kind)} must be a list, not {_shown(rows)}")
    if kind == "polygon":
        return _pack([_point(row, f"vertex {i}") for i, row in enumerate(rows)], kind)
    return _pack([_segment(row, i) for i, row in enumerate(rows)], kind)


def _plural(kind: Kind) -> str:
    return "vertices" if kind == "polygon" else "segments"


def _parse_plain(rows: Any, kind: Kind) -> Floats | None:
    """The array of a well-formed, finite, purely numerical input, or None for the careful way."""
    depth = 2 if kind == "polygon" else 3
    if not isinstance(rows, np.ndarray):
        if not isinstance(rows, list | tuple) or not _only_floats(rows, depth):
            return None
    elif rows.dtype.kind not in "fiu":
        return None
    try:
        array = np.array(rows, dtype=np.float64)
    except ValueError:  # ragged
        return None
    if array.shape[1:] != (2,) * (depth - 1) or not np.isfinite(array).all():
        return None
    return array


def _only_floats(rows: Sequence[Any], depth: int) -> bool:
    """Whether all leaves are floats or ints that a double can hold (bools are not)."""
    for _ in range(depth - 1):
        if not all(type(row) is list or type(row) is tuple for row in rows):
            return False
        rows = [item for row in rows for item in row]
    return all(type(x) is float or (type(x) is int and abs(x) < 2**1023) for x in rows)


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple | np.ndarray)


def _point(row: Any, where: str) -> tuple[float | Fraction, float | Fraction]:
    """One point, or a :class:`UserError` that says ``where``."""
    if not _is_list(row):
        raise UserError(f"{where} {COUNTING}: {_shown(row)} is not a pair of coordinates")
    if len(row) != 2:
        raise UserError(f"{where} {COUNTING}: a point has 2 coordinates, not {len(row)}")
    try:
        return coordinate(row[0]), coordinate(row[1])
    except ValueError as reason:
        raise UserError(f"{where} {COUNTING}: {reason}") from None


def _segment(row: Any, index: int) -> tuple[Any, Any]:
    """One segment, or a :class:`UserError` that names it."""
    if not _is_list(row):
        raise UserError(f"segment {index} {COUNTING}: {_shown(row)} is not a pair of points")
    if len(row) != 2:
        raise UserError(f"segment {index} {COUNTING}: a segment has 2 endpoints, not {len(row)}")
    return (
        _point(row[0], f"endpoint 0 of segment {index}"),
        _point(row[1], f"endpoint 1 of segment {index}"),
    )


def _pack(rows: list[Any], kind: Kind) -> tuple[Floats, Exact | None]:
    """Nearest doubles of checked rows, and the exact values if some are not doubles."""
    shape = (len(rows), 2) if kind == "polygon" else (len(rows), 2, 2)
    points = rows if kind == "polygon" else [point for row in rows for point in row]
    leaves = [x for point in points for x in point]
    floats = np.array([float(x) for x in leaves], dtype=np.float64).reshape(shape)
    if all(isinstance(x, float) for x in leaves):
        return floats, None
    exact = tuple((Fraction(x), Fraction(y)) for x, y in points)
    return floats, exact if kind == "polygon" else tuple(zip(exact[::2], exact[1::2], strict=True))
