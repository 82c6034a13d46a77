"""Large polygons: Clarkson's sampling algorithm for LP-type problems, expected O(n).

The least level c at which the discs of a set of edges and their walls have a common interior
point (never below the global lower bound the ascent starts from), together with M(c) at that
level, grows with the set of edges and is determined by at most three constraints: an LP-type
problem (Amenta, Bern and Eppstein; Eppstein, "Quasiconvex programming", 2005).

K. L. Clarkson, "Las Vegas algorithms for linear and integer programming when the dimension is
small", J. ACM 42 (1995), first algorithm: solve for a random sample of about √n edges and a
forced set; the edges that the optimum violates are O(√n) in expectation and contain one of each
basis not yet forced; force them.  After at most four such rounds nothing is violated.  Each round
looks at all edges once; the sample is solved by the direct ascent, whose pivots look at √n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from harness.geometry.jit import compiled
from harness.peak.ascent import ascend
from harness.peak.powers import GRANTED, NONE

Floats = npt.NDArray[np.float64]

DIRECT = 256
"""Up to so many edges the ascent looks at all of them."""
SAMPLE = 6
"""A sample has so many times √n edges."""
MOST_ROUNDS = 60


@dataclass
class Ascent:
    """Where an ascent ended: level, point, basis with multipliers, and what it took.

    ``constraints``: three numbers as in :mod:`harness.peak.powers`.  ``converged``: whether
    rounding let it come to an end.  ``rounds``: how often all edges were looked at for violators
    (0: the direct ascent, which looks at them in every pivot).
    """

    level: float
    point: Floats
    constraints: npt.NDArray[np.int64]
    multipliers: Floats
    converged: bool
    rounds: int = 0


def ascent_over(start: float, edges: Floats, among: npt.NDArray[np.int64] | None = None) -> Ascent:
    """The direct ascent from level ``start`` over all edges, or ``among`` some of them only.

    ``edges``: (4, n): starts and directions, counter-clockwise, the origin near the polygon.
    """
    ax, ay, dx, dy = edges if among is None else np.ascontiguousarray(edges[:, among])
    state, basis, nu = np.zeros(3), np.full(4, NONE), np.zeros(3)
    room, chosen = np.zeros((4, 4)), np.zeros(3, dtype=np.int64)
    c, steps = ascend(start, state, basis, nu, room, chosen, ax, ay, dx, dy, len(ax))
    found = basis[:3].copy()
    if among is not None:
        found = np.where(found == NONE, NONE, 2 * among[found >> 1] + (found & 1))
    return Ascent(c, state, found, nu, steps >= 0)


def sampled_ascent(start: float, edges: Floats, rng: np.random.Generator) -> Ascent:
    """The ascent over all edges, by sampling if there are many; expected O(n).

    The optimum does not depend on ``rng``, unless several bases determine it.
    """
    n = edges.shape[1]
    if n <= DIRECT:
        return ascent_over(start, edges)
    root = int(np.ceil(np.sqrt(n)))
    forced = np.empty(0, dtype=np.int64)
    found = np.empty(n, dtype=np.int64)
    level = start
    for rounds in range(1, MOST_ROUNDS + 1):
        sample = np.union1d(rng.integers(0, n, SAMPLE * root), forced)
        now = ascent_over(level, edges, sample)
        now.rounds = rounds
        count = violators(now.level, now.point, *edges, found)
        if count == 0:
            return now
        if count <= 2 * root:
            basis = now.constraints[now.constraints != NONE] >> 1
            forced = np.union1d(forced, np.concatenate([basis, found[:count]]))
            level = now.level  # its basis is forced: later levels cannot be lower
    return ascent_over(start, edges)


@compiled
def violators(c, state, ax, ay, dx, dy, found):
    """Fill ``found`` with the edges whose disc or wall does not hold the point; their number.

    See :func:`harness.peak.powers.most_violated` for what rounding is granted.
    """
    count = 0
    px, py, value = state[0], state[1], max(state[2], 0.0)
    for i in range(len(ax)):
        ux, uy, wx, wy = ax[i] - px, ay[i] - py, dx[i], dy[i]
        left, right = ux * wy, uy * wx
        area, size = left - right, abs(left) + abs(right)
        q = ux * (ux + wx) + uy * (uy + wy)
        granted = GRANTED * (abs(q) + abs(c) * size + value)
        if q - c * area - value > granted or -area > GRANTED * size:
            found[count] = i
            count += 1
    return count
