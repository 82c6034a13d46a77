"""Triangulations to be improved: ``random-mesh`` and ``distorted-grid``.

Points are the same on every machine; which triangles of cocircular points are chosen is left to
Qhull, by way of scipy.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from generators.family import GeneratorError
from generators.portable import Array, Stream, surely_positive_cross

Triangles = NDArray[np.int64]
Made = tuple[Array, Triangles]

DISTORTION = 0.7
"""How far a vertex of the grid may be thrown along each axis, in steps of the grid."""
ROUNDS = 4
THINNEST = 0.02
"""Twice the least area of a triangle of the distorted grid, in squares of its steps."""


def random_mesh(n: int, seed: int = 0) -> Made:
    """The Delaunay triangulation of n uniformly random points in a square with fixed sides.

    The sides of the unit square carry regularly spaced points, round(√n) on each, the first 4
    round(√n) of all; so their distance is about that of the points inside.  Returns the points
    (k, 2) and the counter-clockwise triangles (m, 3).  O(n log n).
    """
    _check(n, 1)
    from scipy.spatial import Delaunay

    stream = Stream("random-mesh", n, seed)
    m = max(2, round(np.sqrt(n)))
    along, zero = np.divide(np.arange(m), m), np.zeros(m)
    sides = [
        np.column_stack(side)
        for side in (
            (along, zero),
            (zero + 1.0, along),
            (np.subtract(1.0, along), zero + 1.0),
            (zero, np.subtract(1.0, along)),
        )
    ]
    inner = np.column_stack([stream.uniform(n), stream.uniform(n)])
    points = np.concatenate([*sides, inner])
    return points, _positive(points, Delaunay(points).simplices.astype(np.int64))


def distorted_grid(n: int, seed: int = 0) -> Made:
    """An n × n grid of squares, each cut in two, whose inner vertices are thrown about.

    Each vertex in turn is moved by up to ``DISTORTION`` steps along either axis, and stays where
    it was if a triangle would become thin or inverted; ``ROUNDS`` times.  O(n²).
    """
    _check(n, 2)
    stream = Stream("distorted-grid", n, seed)
    step = n + 1
    index = np.arange(step * step).reshape(step, step)
    a, b, c, d = (
        x.ravel() for x in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    )
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    x = [float(i % step) for i in range(step * step)]
    y = [float(i // step) for i in range(step * step)]
    ring = (1, step + 1, step, -1, -step - 1, -step)
    inner = index[1:-1, 1:-1].ravel().tolist()
    for _ in range(ROUNDS):
        throws = np.multiply(stream.signed(2 * len(inner)), DISTORTION).reshape(-1, 2).tolist()
        for v, (dx, dy) in zip(inner, throws, strict=True):
            px, py = x[v] + dx, y[v] + dy
            around = [(x[v + k] - px, y[v + k] - py) for k in ring]
            if all(
                p * t - q * s > THINNEST
                for (p, q), (s, t) in zip(around, (*around[1:], around[0]), strict=True)
            ):
                x[v], y[v] = px, py
    return np.divide(np.column_stack([x, y]), n), triangles


TRIANGULATIONS: dict[str, Callable[[int, int], Made]] = {
    "random-mesh": random_mesh,
    "distorted-grid": distorted_grid,
}
"""By name: functions of (n, seed)."""


def _check(n: int, least: int) -> None:
    if n < least:
        raise GeneratorError(f"n = {n} must be at least {least}")


def _positive(points: Array, triangles: Triangles) -> Triangles:
    """The triangles counter-clockwise; those that are not surely so are on a side, and left out."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    left = surely_positive_cross(np.subtract(b, a), np.subtract(c, a))
    right = surely_positive_cross(np.subtract(c, a), np.subtract(b, a))
    return np.concatenate([triangles[left], triangles[right][:, ::-1]])
