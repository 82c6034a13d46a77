"""Triangulations for the tests: random ones, grids, needles."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from harness.geometry.predicates import orientations


def random_mesh(n: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Delaunay of n random points in the unit square and regularly spaced ones on its sides."""
    rng = np.random.default_rng(seed)
    m = max(2, round(np.sqrt(n)))
    t, zero = np.arange(m) / m, np.zeros(m)
    sides = [(t, zero), (zero + 1, t), (1 - t, zero + 1), (zero, 1 - t)]
    points = np.concatenate([*(np.column_stack(side) for side in sides), rng.random((n, 2))])
    return points, positive(points, Delaunay(points).simplices.astype(np.int64))


def positive(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The triangles counter-clockwise, flat ones left out."""
    signs = orientations(*(points[triangles[:, k]] for k in range(3)))
    turned = np.where(signs[:, None] < 0, triangles[:, ::-1], triangles)
    return np.ascontiguousarray(turned[signs != 0])


def grid_mesh(k: int, shift: float = 0.0, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A k × k grid of squares, each cut in two; inner vertices shifted by up to shift/k."""
    ticks = np.arange(k + 1) / k
    x, y = np.meshgrid(ticks, ticks)
    points = np.column_stack([x.ravel(), y.ravel()])
    i = np.arange((k + 1) ** 2).reshape(k + 1, k + 1)
    a, b, c, d = (part.ravel() for part in (i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]))
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    inner = ((points > 0) & (points < 1)).all(axis=1)
    rng = np.random.default_rng(seed)
    points[inner] += rng.uniform(-shift, shift, (int(inner.sum()), 2)) / k
    return points, triangles


def hexagons(k: int) -> tuple[np.ndarray, np.ndarray]:
    """Equilateral triangles, k × k rhombi of two."""
    points, triangles = grid_mesh(k)
    x, y = points.T
    # Each square is cut along its diagonal (1, 1): that becomes a side of length 1 too.
    return np.column_stack([x - y / 2, y * np.sqrt(0.75)]), triangles


def needle(height: float) -> tuple[np.ndarray, np.ndarray]:
    """One free vertex, the last, in a rhombus whose kernel is as thin as itself."""
    points = [[0, 0], [1, -height], [2, 0], [1, height], [0.1, height / 100]]
    return np.array(points), np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


@st.composite
def triangulations(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """Random triangulations with some free vertices."""
    n, seed = draw(st.integers(1, 40)), draw(st.integers(0, 10**6))
    kind = draw(st.sampled_from(["random", "lattice", "grid"]))
    if kind == "grid":
        return grid_mesh(draw(st.integers(2, 6)), draw(st.sampled_from([0.0, 0.1, 0.24])), seed)
    if kind == "random":
        return random_mesh(n, seed)
    rng = np.random.default_rng(seed)  # many collinear and cocircular vertices
    corners = [[0, 0], [9, 0], [9, 9], [0, 9]]
    points = np.unique(np.concatenate([corners, rng.integers(1, 9, (n, 2))]), axis=0)
    points = points.astype(np.float64)
    return points, positive(points, Delaunay(points).simplices.astype(np.int64))
