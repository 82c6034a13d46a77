"""What a mesh is worth in use: Poisson's equation on it, solved by finite elements.

−Δu = 1 with u = 0 on the boundary, linear elements.  The matrix holds cotangents of the mesh's
angles, so angles near 0 or π make it ill-conditioned, which costs iterations; how well the
elements fit the solution is another matter, which the energy tells.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import cg

from harness.mesh.quality import corner_angles
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats, boundary

RESIDUAL = 1e-8
"""The relative residual at which the iteration stops."""
MOST = 20
"""At most so many iterations for each unknown."""
SQUARE = 0.035144253738788451
"""The energy ∫u of the exact solution on the unit square (its torsional rigidity over 4):
1/12 − 16/π⁵ · Σ tanh(kπ/2)/k⁵ over odd k (Timoshenko and Goodier, "Theory of Elasticity")."""


@dataclass(frozen=True)
class Solved:
    """``iterations`` of conjugate gradients with the diagonal as preconditioner; the ``energy``."""

    iterations: int
    energy: float

    @property
    def error_on_unit_square(self) -> float:
        """‖∇(u − u_h)‖ / ‖∇u‖, if the domain is the unit square.

        By Galerkin's orthogonality its square is (∫u − ∫u_h) / ∫u; rounding may leave less than 0.
        """
        return float(np.sqrt(max(SQUARE - self.energy, 0.0) / SQUARE))


def solve(points: Floats, triangles: Ints) -> Solved | None:
    """Solve the problem on a mesh; None if an angle is not positive or nothing is unknown.

    ``points``: (n, 2); ``triangles``: (m, 3), counter-clockwise.  Rounding may change the number of
    iterations by a few from one machine to another.
    """
    angles = np.radians(corner_angles(points, triangles))
    inner = np.ones(len(points), dtype=np.bool_)
    inner[boundary(triangles)[0]] = False
    inner &= np.bincount(triangles.ravel(), minlength=len(points)) > 0
    if not (angles > 0).all() or not inner.any():
        return None
    matrix = _stiffness(angles, triangles, len(points))[inner][:, inner]
    load = _load(points, triangles)[inner]
    found, iterations = _conjugate_gradients(matrix, load)
    return Solved(iterations, float(load @ found))


def _stiffness(angles: Floats, triangles: Ints, n: int) -> Any:
    """Each triangle adds cot/2 of the angle opposite to an edge."""
    half = 0.5 / np.tan(angles)
    rows, columns = triangles[:, [1, 2, 0]].ravel(), triangles[:, [2, 0, 1]].ravel()
    values = -half.ravel()
    one_way = coo_matrix((values, (rows, columns)), shape=(n, n))
    both = (one_way + one_way.T).tocsr()
    return (both - diags(np.asarray(both.sum(axis=1)).ravel())).tocsr()


def _load(points: Floats, triangles: Ints) -> Floats:
    """A third of the area of its triangles for each vertex."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    (x, y), (u, v) = (b - a).T, (c - a).T
    load = np.zeros(len(points))
    np.add.at(load, triangles, ((x * v - y * u) / 6.0)[:, np.newaxis])
    return load


def _conjugate_gradients(matrix: Any, load: Floats) -> tuple[Floats, int]:
    count = 0

    def tick(_: Floats) -> None:
        nonlocal count
        count += 1

    preconditioner = diags(1.0 / matrix.diagonal())
    most = MOST * len(load)
    found, _ = cg(matrix, load, rtol=RESIDUAL, maxiter=most, M=preconditioner, callback=tick)
    return found, count
