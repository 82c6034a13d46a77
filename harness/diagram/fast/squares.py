"""Free lines around everything, in squares.

Where exactly they lie does not matter, and how far they reach only for the shape of the triangles:
so here doubles may decide.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import gcd

import numpy as np

from harness.diagram.fast.forms import U
from harness.diagram.fast.roots import free_number

IntPoint = tuple[int, int]

#: The first square, against the size of everything, and how each grows from the one before.
FIRST_SQUARE, GROWTH = 2, 4
#: The last square is about so large at most, against all coordinates.
FARTHEST = 2.0**200


def bits_of(ends: list[tuple[IntPoint, IntPoint]]) -> int:
    """The bits of the greatest coordinate."""
    return max(x.bit_length() for segment in ends for point in segment for x in point)


def over(value: int, bits: int) -> float:
    """value/2^bits as a double, rounded once; integers may be far beyond the range of doubles."""
    return value / (1 << bits)


def squares_about(
    d: list[IntPoint], c: list[int], ends: list[tuple[IntPoint, IntPoint]], seed: int
) -> Iterator[tuple[IntPoint, int, IntPoint]]:
    """The sides of all squares: d, c, and an integer point on each."""
    xs, ys = ([point[axis] for segment in ends for point in segment] for axis in range(2))
    middle = ((min(xs) + max(xs)) // 2, (min(ys) + max(ys)) // 2)
    size = max(max(xs) - min(xs), max(ys) - min(ys))
    bits = bits_of(ends)
    last = _reach(d, c, middle, bits)
    slope = 0.2 + 0.5 * float(free_number(11, seed))
    radius = FIRST_SQUARE * size
    while True:
        for number in range(4):
            x, y = round(2**20 * slope), 2**20 + 1
            if number % 2:
                x, y = y, -x
            g = gcd(x, y) if y > 0 else -gcd(x, y)
            x, y = x // g, y // g
            longer = (1 + 0.1 * float(free_number(number, seed))) * np.hypot(x, y)
            away = int(radius * Fraction(float(longer)))
            offset = x * middle[1] - y * middle[0] + (away if number < 2 else -away)
            yield (x, y), offset, _point_on((x, y), offset, middle)
        if over(radius, bits) > last:
            break
        radius *= GROWTH


def _reach(d: list[IntPoint], c: list[int], middle: IntPoint, bits: int) -> float:
    """At least the distance of all crossings from a point over 2^bits, about; FARTHEST at most."""
    length = [max(map(int.bit_length, v)) for v in d]
    x, y = (np.array([over(v[k], n) for v, n in zip(d, length, strict=True)]) for k in range(2))
    offset = np.array(
        [
            over(k - (v[0] * middle[1] - v[1] * middle[0]), bits + n)
            for v, k, n in zip(d, c, length, strict=True)
        ]
    )
    most = 0.0
    for i in range(len(d)):
        w = x[i] * y - y[i] * x
        error = 8 * U * (np.abs(x[i] * y) + np.abs(y[i] * x))
        known = np.abs(w) > 2 * error
        with np.errstate(all="ignore"):
            far = np.hypot(offset[i] * x - offset * x[i], offset[i] * y - offset * y[i]) / np.abs(w)
        most = max(most, float(far[known].max(initial=0.0)))
        for j in np.flatnonzero(~known).tolist():
            (ux, uy), (vx, vy) = d[i], d[j]
            exact = over(abs(ux * vy - uy * vx), length[i] + length[j])
            if exact:
                size = np.hypot(
                    offset[i] * x[j] - offset[j] * x[i], offset[i] * y[j] - offset[j] * y[i]
                )
                most = max(most, float(size) / exact)
    return min(1.1 * most, FARTHEST)


def _point_on(d: IntPoint, c: int, middle: IntPoint) -> IntPoint:
    """An integer point near a given one on a line whose d is primitive, with x and y not zero."""
    x, y = d
    # −y·px + x·py = c with py ≡ c/x modulo y.
    py = c * pow(x, -1, abs(y))
    px = (x * py - c) // y
    steps = ((middle[0] - px) * x + (middle[1] - py) * y) // (x * x + y * y)
    return px + steps * x, py + steps * y
