"""The ascent: levels c₀ < c₁ < … → c*, the cotangent of the greatest least visual angle.

For multipliers ν of an optimal basis at level c (:mod:`harness.peak.powers`),

    D(c + δ) = min over the plane of Σ ν_i E_i − (1 + δ/c) Σ ν_e L_e = M(c) − s δ − κ δ²,
    s = Σ ν_i L_i(p),  κ = |Σ ν_i ∇L_i + Σ (ν_e/c) ∇L_e|²/4

(i: discs, e: walls, on which L_e(p) = 0) is a lower bound of M, so its zero δ > 0 is a lower bound
of c* − c: the levels rise and never pass c*.  The multipliers of walls grow with the level, as
the discs tend to half-planes; for c ≤ 0 they are left as they are.  D touches M at c, so the
convergence is quadratic (it is Newton's method for M(c) = 0, from the safe side; Dinkelbach's for
fractional programs comes from the other).

**Where it starts.**  The visual angles of all n edges add up to 2π in the kernel, so α* ≤ 2π/n.
And near a vertex of interior angle γ its two edges are seen under π − ψ and π − γ + ψ, where ψ is
the direction; so α* ≤ π − γ/2, the *cap* of the vertex, which is approached only there, along the
bisector.  (For a triangle with an angle γ ≥ 120° this is the optimum.)  Below the greatest cap
the two discs of the vertex meet nowhere inside but in the vertex itself, so that M vanishes
there for no good reason: the caps must be known beforehand.
"""

from __future__ import annotations

import numpy as np

from harness.geometry.jit import compiled
from harness.peak.powers import FAINT, NONE, settle

UNTURNED = 8.0 * 2.0**-53
MOST_STEPS = 200
CLOSE = 1e-16


@compiled
def cap_cotangent(ux, uy, vx, vy):
    """cot(π − γ/2) at a vertex between consecutive edge vectors u and v; −∞ if it is unknown.

    γ = π − turn, so π − γ/2 = π/2 + turn/2 and its cotangent is −tan(turn/2), written as
    sin/(1 + cos) or (1 − cos)/sin, whichever does not cancel.  The lengths of u and v are no
    matter and are taken out, lest their products leave the range of doubles.  Vectors so short
    that scaling may have rounded them say nothing, nor do those that turn back so nearly that it
    may be to either side (γ = 0 or 2π).
    """
    length, width = max(abs(ux), abs(uy)), max(abs(vx), abs(vy))
    if not min(length, width) > FAINT:
        return -np.inf
    ux, uy, vx, vy = ux / length, uy / length, vx / width, vy / width
    sine, cosine = ux * vy - uy * vx, ux * vx + uy * vy
    size = np.sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy))
    if cosine > 0.0:
        return -sine / (size + cosine)
    if not abs(sine) > UNTURNED * size:
        return -np.inf
    return -(size - cosine) / sine


@compiled
def greatest_cap(dx, dy, n):
    """(c, v): the greatest cap, as a cotangent, and its vertex v between edges v − 1 and v.

    Only of vertices whose cap is below 2π/n (they are reflex if n > 3); otherwise cot(2π/n), −1.
    """
    best, vertex = np.cos(2.0 * np.pi / n) / np.sin(2.0 * np.pi / n), NONE
    px, py = dx[n - 1], dy[n - 1]
    for v in range(n):
        if n == 3 or px * dy[v] - py * dx[v] <= 0.0:
            cap = cap_cotangent(px, py, dx[v], dy[v])
            if cap > best:
                best, vertex = cap, v
        px, py = dx[v], dy[v]
    return best, vertex


@compiled
def rise(c, value, basis, nu, state, ax, ay, dx, dy):
    """The greatest δ with D(c + δ) = 0; infinite if D never falls to zero."""
    s = hx = hy = 0.0
    for k in range(3):
        if basis[k] == NONE:
            continue
        i, weight = basis[k] >> 1, nu[k]
        if basis[k] & 1:
            weight = weight / c if c > 0.0 else 0.0
        else:
            s += weight * ((ax[i] - state[0]) * dy[i] - (ay[i] - state[1]) * dx[i])
        hx -= weight * dy[i]
        hy += weight * dx[i]
    kappa = 0.25 * (hx * hx + hy * hy)
    root = np.sqrt(s * s + 4.0 * kappa * value)
    return 2.0 * value / (s + root) if s > 0.0 else (root - s) / (2.0 * kappa)


@compiled
def ascend(c, state, basis, nu, row, chosen, ax, ay, dx, dy, m):
    """Raise c from a lower bound to c* over m edges; (c, steps), steps −1 if it did not converge.

    ``state``, ``basis``, ``nu``: see :func:`harness.peak.powers.settle`; they start as a guess
    (basis of −1: none) and end as the optimum.  If the edges given allow c itself, nothing rises
    and the point is that of least M.
    """
    for step in range(MOST_STEPS):
        settle(c, state, basis, nu, row, chosen, ax, ay, dx, dy, m)
        if not state[2] > 0.0:
            return c, step
        delta = rise(c, state[2], basis, nu, state, ax, ay, dx, dy)
        if not delta < np.inf:
            return c, -1
        c += delta
        if delta <= CLOSE * (1.0 + abs(c)):
            return c, step
    return c, -1
