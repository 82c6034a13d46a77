"""Free lines around everything, in squares."""

from __future__ import annotations

from collections.abc import Iterator
from math import gcd

import numpy as np

from harness.diagram.fast.roots import free_number

U = 2.0**-53
IntPoint = tuple[int, int]

#: The first square, against the size of everything, and how each grows from the one before.
FIRST_SQUARE, GROWTH = 2, 4


def squares_about(
    d: list[IntPoint], c: list[int], ends: list[tuple[IntPoint, IntPoint]], seed: int
) -> Iterator[tuple[IntPoint, int]]:
    """The sides of all squares, as (d, c)."""
    xs, ys = ([point[axis] for segment in ends for point in segment] for axis in range(2))
    middle = ((min(xs) + max(xs)) // 2, (min(ys) + max(ys)) // 2)
    size = max(max(xs) - min(xs), max(ys) - min(ys))
    last = _reach(d, c, middle)
    slope = 0.2 + 0.5 * float(free_number(11, seed))
    radius = FIRST_SQUARE * size
    while True:
        for number in range(4):
            x, y = round(2**20 * slope), 2**20 + 1
            if number % 2:
                x, y = y, -x
            g = gcd(x, y) if y > 0 else -gcd(x, y)
            x, y = x // g, y // g
            away = int(radius * (1 + 0.1 * float(free_number(number, seed))) * np.hypot(x, y))
            yield (x, y), x * middle[1] - y * middle[0] + (away if number < 2 else -away)
        if radius > last:
            break
        radius *= GROWTH


def _reach(d: list[IntPoint], c: list[int], middle: IntPoint) -> float:
    """At least the distance of all crossings from a point, about."""
    x, y = (np.array([float(v[axis]) for v in d]) for axis in range(2))
    offset = np.array(
        [float(k - (v[0] * middle[1] - v[1] * middle[0])) for v, k in zip(d, c, strict=True)]
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
            exact = ux * vy - uy * vx
            if exact:
                size = np.hypot(
                    offset[i] * x[j] - offset[j] * x[i], offset[i] * y[j] - offset[j] * y[i]
                )
                most = max(most, float(size / abs(exact)))
    return 1.1 * most


def point_on(d: IntPoint, c: int) -> IntPoint:
    """An integer point on a line whose d is primitive."""
    x, y = d
    if x == 0:
        return -c * y, 0  # y = 1
    # −y·px + x·py = c with py ≡ c/x modulo y.
    py = c * pow(x, -1, abs(y)) if y else c // x
    return (x * py - c) // y if y else 0, py
