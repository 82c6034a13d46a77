"""Special points inside root triangles: each gets a triangle of free points about itself."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

import numpy as np

from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.points import Homogeneous, determinant, homogeneous
from harness.diagram.fast.roots import Floats, Ints, free_number
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction


def inserted(
    corners: ArrangedCorners, triangles: Ints, points: Iterable[RationalPoint], seed: int
) -> Ints:
    """The triangles (r, 3) with every point inside one of them as a special corner.

    A triangle E₀E₁E₂ with the point p becomes nine: a small triangle of free points about p, its
    three parts at p, and six between both.  O(triangles) for each point.

    All nine are counter-clockwise.  With p = Σ σ_k E_k (indices modulo 3) the free points are
    I_k = p + a_k (E_k + τ_k E_{k+1}), where a_k and τ_k / min(1, σ_{k+1}/σ_k) lie between 1/32 and
    3/32.  In units of |E₀ E₁ E₂|:

        |p I_k I_{k+1}| = a_k a_{k+1} (σ_k τ_k τ_{k+1} − σ_{k+1} τ_{k+1} + σ_{k+2}),
        |E_k E_{k+1} I_{k+1}| = σ_{k+2} + a_{k+1} τ_{k+1},
        |E_k I_{k+1} I_k| = σ_{k+2} (a_{k+1} − a_k τ_k) − a_{k+1} τ_{k+1} (σ_{k+1} + a_k τ_k).

    Here σ_{k+1} τ_{k+1} ≤ 3/32 σ_{k+2}, so the first is positive, as is the second.  Further
    τ_k τ_{k+1} ≤ (3/32)² σ_{k+2} / max σ, and max σ ≥ 1/3, since the weights of p and of corners
    that are not at infinity are 1: so what is subtracted in the third is at most
    σ_{k+2} (0.0088 + a_{k+1} (0.094 + 0.003)), less than σ_{k+2} a_{k+1}.

    Raises Contradiction if a point lies on a side.
    """
    rows = triangles
    for number, point in enumerate(points):
        t, exact, shares = _containing(corners, rows, point)
        p = (*point, Fraction(1))
        middle = corners.add(point, special=True)
        outer = rows[t].tolist()
        inner = []
        for k in range(3):
            share = free_number(3 * number + k, seed) / 8
            turn = min(Fraction(1), shares[(k + 1) % 3] / shares[k])
            turn *= free_number(3 * number + k, seed + 1) / 8
            parts = zip(p, exact[k], exact[(k + 1) % 3], strict=True)
            x, y, w = (a + share * (b + turn * c) for a, b, c in parts)
            inner.append(corners.add((x / w, y / w)))
        new = []
        for k in range(3):
            a, b, q, r = outer[k], outer[(k + 1) % 3], inner[k], inner[(k + 1) % 3]
            new += [(a, b, r), (a, r, q), (q, r, middle)]
        rows = np.concatenate([rows[:t], rows[t + 1 :], np.array(new)])
    return rows


def _containing(
    corners: ArrangedCorners, triangles: Ints, point: RationalPoint
) -> tuple[int, list[Homogeneous], list[Fraction]]:
    """The triangle that contains a point, its corners, and barycentric coordinates of the point
    up to a factor."""
    centre, scale = corners.prepared.centre, corners.prepared.scale
    p = np.array([float((x - c) * scale) for x, c in zip(point, centre, strict=True)])
    areas = _areas(corners, triangles, p)
    with np.errstate(all="ignore"):
        share = areas.min(axis=1) / np.abs(areas).sum(axis=1)
    for t in np.argsort(-np.nan_to_num(share, nan=-1.0), kind="stable")[:64].tolist():
        exact = [homogeneous(corners, c) for c in triangles[t].tolist()]
        here = (*point, Fraction(1))
        signs = [determinant(here, exact[(k + 1) % 3], exact[(k + 2) % 3]) for k in range(3)]
        if min(signs) > 0:
            return t, exact, signs
        if min(signs) == 0:
            raise Contradiction("a special point on a side of a triangle")
    raise Contradiction("a special point in no triangle")


def _areas(corners: ArrangedCorners, triangles: Ints, p: Floats) -> Floats:
    """Barycentric coordinates of a point in all triangles, in doubles, not normalised."""
    x, y = (corners.frame[:, 2 * axis][triangles] for axis in range(2))
    w = corners.weights[triangles]
    x, y = x - w * p[0], y - w * p[1]
    return np.stack(
        [x[:, k - 2] * y[:, k - 1] - x[:, k - 1] * y[:, k - 2] for k in range(3)],
        axis=1,
    )
