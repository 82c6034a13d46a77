"""What no placement of the vertices can exceed, as long as the connectivity stays.

The angles of every triangle add up to 180°, those around a vertex to what they are now.  The
greatest least angle that angles with these sums can have is the value of a linear program, and
bounds the smallest angle of the mesh from above.  Any part of the mesh will do: taking fewer
triangles only leaves out conditions.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.mesh.quality import corner_angles, least_angles
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats

REACH = 6
"""Steps from the worst triangle to the edge of the part that is looked at."""


def upper_bound(points: Floats, triangles: Ints, reach: int = REACH) -> float:
    """Degrees that the smallest angle of the mesh cannot exceed by moving interior vertices.

    From the part of the mesh within ``reach`` steps of its worst triangle.  The program is solved
    in doubles, to about 1e-7 degrees.
    """
    part = _around(triangles, int(np.argmin(least_angles(points, triangles))), reach)
    corners = triangles[part]
    totals = np.zeros(len(points))
    np.add.at(totals, triangles, corner_angles(points, triangles))
    everywhere = np.bincount(triangles.ravel(), minlength=len(points))
    here = np.bincount(corners.ravel(), minlength=len(points))
    whole = np.flatnonzero((here == everywhere) & (here > 0))
    return _solve(corners, whole, totals[whole])


def _around(triangles: Ints, worst: int, reach: int) -> Ints:
    """The triangles that touch something within so many steps of one."""
    known = np.zeros(int(triangles.max()) + 1, dtype=np.bool_)
    known[triangles[worst]] = True
    for _ in range(reach):
        known[triangles[known[triangles].any(axis=1)]] = True
    return np.flatnonzero(known[triangles].any(axis=1))


def _solve(corners: Ints, whole: Ints, totals: Floats) -> float:
    """The greatest t such that angles t + u, u ≥ 0, have the sums that are known."""
    from scipy.optimize import linprog
    from scipy.sparse import coo_matrix

    m = len(corners)
    row_of = np.full(int(corners.max()) + 1, -1)
    row_of[whole] = m + np.arange(len(whole))
    flat = corners.ravel()
    of_vertex = np.flatnonzero(row_of[flat] >= 0)
    rows = np.concatenate([np.repeat(np.arange(m), 3), row_of[flat[of_vertex]]])
    columns = np.concatenate([np.arange(3 * m), of_vertex])
    counts = np.bincount(rows, minlength=m + len(whole))
    matrix = coo_matrix(
        (
            np.concatenate([np.ones(len(rows)), counts]),
            (
                np.concatenate([rows, np.arange(len(counts))]),
                np.concatenate([columns, np.full(len(counts), 3 * m)]),
            ),
        ),
        shape=(len(counts), 3 * m + 1),
    )
    cost = np.zeros(3 * m + 1)
    cost[-1] = -1.0
    sums = np.concatenate([np.full(m, 180.0), totals])
    solve: Any = linprog  # its types know no sparse matrices
    found = solve(cost, A_eq=matrix.tocsr(), b_eq=sums, bounds=(0, None), method="highs")
    return float(-found.fun) if found.status == 0 else np.inf
