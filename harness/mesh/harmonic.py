"""A start for the whole mesh at once: every free vertex in the mean of its neighbours.

That is one sparse linear system.  Inside a convex boundary the result is an embedding (Tutte,
"How to draw a graph", 1963); elsewhere triangles may be inverted, and then it is not used.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

from harness.mesh.stars import Ints, Stars
from harness.mesh.validation import Floats


def harmonic(x: Floats, y: Floats, stars: Stars, free: Ints) -> tuple[Floats, Floats]:
    """New coordinates (n,), (n,) with the free vertices in the means of their neighbours.

    The free vertices of every piece of the mesh must reach a fixed one, as they do where there is
    a boundary.  About O(n log n) memory and O(n^1.5) time, by sparse elimination.
    """
    n, m = len(x), len(free)
    number = np.full(n, -1)
    number[free] = np.arange(m)
    degrees = stars.degrees[free]
    rows = np.repeat(np.arange(m), degrees)
    within = np.arange(len(rows)) - np.repeat(np.cumsum(degrees) - degrees, degrees)
    neighbours = stars.ring[np.repeat(stars.offsets[free], degrees) + within]
    inner = number[neighbours] >= 0
    entries = (np.ones(int(inner.sum())), (rows[inner], number[neighbours[inner]]))
    matrix = diags(degrees.astype(np.float64)) - coo_matrix(entries, shape=(m, m))
    factors = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    found = []
    for values in (x, y):
        sides = np.zeros(m)
        np.add.at(sides, rows[~inner], values[neighbours[~inner]])
        moved = values.copy()
        moved[free] = factors.solve(sides)
        found.append(moved)
    return found[0], found[1]
