"""Rings of Delaunay vertices, against an independent triangulation."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from generators import generate
from generators.cavity import delaunay_ring


def random_points(seed: int, count: int, reach: float, hole: float = 0.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    radius = np.sqrt(rng.uniform(hole**2, reach**2, count))
    angle = np.sort(rng.uniform(0, math.tau, count))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


@given(seed=st.integers(0, 2**32), count=st.integers(40, 200), hole=st.floats(0.0, 4.0))
def test_the_ring_is_that_of_the_delaunay_triangulation(seed, count, hole):
    points = random_points(seed, count, 5.0, hole)
    ring = delaunay_ring(points, 5.0)
    if not ring:  # the ring is not settled by the points at hand
        return
    start, neighbours = Delaunay(np.vstack([points, [0.0, 0.0]])).vertex_neighbor_vertices
    theirs = neighbours[start[count] : start[count + 1]]
    assert sorted(ring) == sorted(theirs)
    assert np.count_nonzero(np.diff([*ring, ring[0]]) < 0) == 1  # counter-clockwise, once


def test_the_typical_valence_is_six():
    """Euler: the mean valence of a planar triangulation is 6 (here 400 vertices, σ = 1.33)."""
    reach = math.sqrt(80 / math.pi)
    valence = [len(delaunay_ring(random_points(s, 80, reach), reach)) for s in range(400)]
    assert abs(np.mean([v for v in valence if v]) - 6) < 0.3


@pytest.mark.parametrize(
    "points",
    [
        [(1.0, 0.0), (0.0, 1.0), (-1.0, 1.0)],  # all on one side of the origin
        [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)],  # larger circles than the reach
    ],
)
def test_an_unsettled_ring_is_empty(points):
    assert delaunay_ring(np.array(points), 1.2) == []


def test_cocircular_points_are_not_decided():
    """The corners of a square through the origin lie on one circle."""
    square = [(2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (-1.0, 0.0), (0.0, -1.0)]
    assert delaunay_ring(np.array(square), 100.0) == []


@pytest.mark.parametrize("n", [3, 4, 6, 7, 12, 40, 200])
def test_rings_have_the_valence_asked_for(n):
    for seed in range(3):
        made = generate("cavity", n, seed).coordinates
        assert len(made) == n
        assert np.hypot(made[:, 0], made[:, 1]).max() == pytest.approx(1.0)
