"""Weaves for the tests: shapes, ideal corners, tips and visual angles by plain geometry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import strategies as st

from generators import generate
from harness import AngularVoronoi
from harness.analysis.weave_rows import SHAPES
from harness.diagram.counts import Counts

Shape = tuple[str, int, float]


def inner_radius(family: str, n: int, value: float) -> float:
    return SHAPES[family][1](n, value)


def shapes(smallest: int, largest: int) -> st.SearchStrategy[Shape]:
    """(family, n, tilt or delta)."""
    sizes = st.integers(smallest // 2, largest // 2).map(lambda m: 2 * m)
    stars = st.tuples(st.just("zigzag"), sizes, st.floats(0.02, 1.5))
    convex = st.tuples(st.just("convex-weave"), sizes, st.floats(0.05, 0.95))
    return stars | convex


def count(family: str, n: int, value: float, seed: int, noise: float) -> Counts:
    given: dict[str, Any] = {SHAPES[family][0]: value, "noise": noise, "noise_power": 0}
    return AngularVoronoi(generate(family, n, seed, **given).coordinates).counts


def corners(m: int, inner: float) -> np.ndarray:
    turn = np.arange(2 * m) * math.pi / m
    radius = np.where(np.arange(2 * m) % 2 == 0, 1.0, inner)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)


def visual_angles(vertices: np.ndarray, p: np.ndarray) -> np.ndarray:
    a, b = vertices - p, np.roll(vertices, -1, axis=0) - p
    return np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))


def smallest(vertices: np.ndarray, p: np.ndarray) -> tuple[int, float, float]:
    """The edge seen under the smallest angle, that angle, and by how much the next is larger."""
    angle = visual_angles(vertices, p)
    order = np.argsort(angle)
    return int(order[0]), float(angle[order[0]]), float(angle[order[1]] - angle[order[0]])


def tip(vertices: np.ndarray, edge: int, level: float) -> float:
    """Direction from the centre to the nearest point of the circle of that angle over the edge."""
    a, b = vertices[edge], np.roll(vertices, -1, axis=0)[edge]
    inward = np.array([-(b - a)[1], (b - a)[0]])
    centre = (a + b) / 2 + inward / 2 / math.tan(level)
    return math.atan2(-centre[1], -centre[0])
