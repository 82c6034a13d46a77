"""``star-fat``: random star polygons whose kernel contains a given disc, at any n.

Construction
------------
Let the disc have radius ρ and centre O, and write the distance of a point from O as ρ/cos x,
where x ∈ [0, ¼ turn) is its *tangent angle*: the angle at O between the point and either
tangent point of the disc as seen from it.  Take two points with tangent angles x, y, an angle
φ apart as seen from O.

**Lemma.**  The line through them misses the open disc, with the segment between them on the
far side, if and only if |x − y| ≤ φ ≤ x + y.

*Proof.*  As seen from O, the tangents from the first point touch the disc at angles ±x from
it, and those from the second at φ ± y.  The segment misses the open disc exactly if the arcs
[−x, x] and [φ − y, φ + y] meet: φ ≤ x + y (else O's disc bulges between them).  Its line
misses the open disc beyond the segment exactly if neither arc lies strictly inside the other,
that is, x ≤ φ + y and y ≤ φ + x.  ∎

So a closed polygon with vertices in angular order has the disc in its kernel if and only if the
tangent angles, as a function of the angle at O, form a 1-Lipschitz sequence and every gap obeys
φ ≤ x + y.  The second condition is granted by the floor x ≥ (longer adjacent gap)/2.  What is
left is to draw a random Lipschitz function between a floor and a ceiling, and such a function can
be drawn one value at a time without ever getting stuck (McShane's extension theorem: a
λ-Lipschitz function on a subset of a metric space extends): make the floor λ-Lipschitz, then the
interval

    max(floor, x_left − λ d_left, x_right − λ d_right)  ≤  x  ≤  min(ceiling, x_left + λ d_left, …)

is never empty, where left and right are the nearest vertices already drawn: the floor at the new
vertex is at most the floor at ``left`` plus λ d_left, and x_left, x_right differ by at most
λ(d_left + d_right).  There is no rejection and nothing to give up.

Drawing the vertices coarse to fine (midpoint displacement), each uniform on its interval, gives
outlines that vary at every scale, from the disc to the unit circle, however large n is.
"""

from __future__ import annotations

import numpy as np

from generators.family import Family, GeneratorError, Interval, Parameter
from generators.portable import Array, Stream, arccosine, cosine, cyclic_gaps, polar, unit_vectors

# Room for rounding: 2φ ≤ 0.998 (x + y) at the worst, and |x − y| ≤ 0.99 φ.
_FLOOR = 0.501
_CAP = 1.996
_LEAST_ROOM = 0.99


def star_fat(n: int, seed: int = 0, *, disc: float = 0.25, roughness: float = 0.9) -> Array:
    """A random star polygon in the unit circle whose kernel contains a disc about O; (n, 2).

    ``disc`` is the radius of the disc; ``roughness`` λ < 1 bounds the slope of the tangent
    angle (1 would let edges touch the disc).  The angles are uniform and independent; where
    a gap is too long for any edge to bridge it outside the disc (small n, large disc), they are
    drawn together towards the regular n-gon just as far as needed, which always suffices as
    ``disc`` < cos(π/n), the inradius of the regular n-gon.

    Source: construction and proof above.  O(n log n).
    """
    STAR_FAT.check(n, {"disc": disc, "roughness": roughness})
    stream = Stream("star-fat", n, seed)
    ceiling = arccosine(disc)
    turns = _angles(stream, n, _CAP * ceiling)
    x = _lipschitz(stream.uniform(n), turns, ceiling, roughness)
    return polar(np.divide(disc, unit_vectors(x)[:, 0]), turns)


def _angles(stream: Stream, n: int, longest: float) -> Array:
    """Sorted uniform angles, contracted towards the regular ones until no gap is too long."""
    # The gaps shorter than this have probability 1/250 together: a redraw, rarely.
    turns = stream.sorted_turns(n, min(2.0**-36, 2.0**-8 / (n * n)))
    excess = float(cyclic_gaps(turns).max()) - longest
    if excess <= 0.0:
        return turns
    share = min(1.0, excess / (excess + longest - 1.0 / n))
    regular = np.divide(np.arange(n, dtype=np.float64), n)
    return np.add(np.multiply(1.0 - share, turns), np.multiply(share, regular))


def _lipschitz(u: Array, turns: Array, ceiling: float, slope: float) -> Array:
    """A random ``slope``-Lipschitz function at ``turns`` on the circle, below ``ceiling``.

    Vertex i is placed at the fraction ``u[i]`` of its feasible interval, coarse to fine.
    """
    n = len(turns)
    floor = _floor(turns, ceiling, slope)
    at = np.append(turns, turns[0] + 1.0)  # index n is vertex 0 again, once round
    x = np.empty(n + 1)
    x[0] = x[n] = floor[0] + u[0] * (ceiling - floor[0])
    stride = 1
    while stride < n:
        stride *= 2
    while stride > 1:
        half = stride // 2
        new = np.arange(half, n, stride)
        left, right = new - half, np.minimum(new + half, n)
        down = np.multiply(slope, np.subtract(at[new], at[left]))
        up = np.multiply(slope, np.subtract(at[right], at[new]))
        low = np.maximum(np.subtract(x[left], down), np.subtract(x[right], up))
        low = np.maximum(low, floor[new])
        high = np.minimum(np.add(x[left], down), np.add(x[right], up))
        high = np.minimum(high, ceiling)
        x[new] = np.add(low, np.multiply(u[new], np.subtract(high, low)))
        stride = half
    return x[:n]


def _floor(turns: Array, ceiling: float, slope: float) -> Array:
    """The least ``slope``-Lipschitz function that lets every gap be bridged outside the disc.

    The least Lipschitz majorant of f is max over j of f(j) − slope·distance(i, j): one running
    maximum in each direction over three laps of the circle.
    """
    gaps = cyclic_gaps(turns)
    need = np.multiply(_FLOOR, np.maximum(gaps, np.roll(gaps, 1)))
    need = np.maximum(need, 0.1 * ceiling)
    n = len(turns)
    position = np.multiply(slope, np.concatenate([turns - 1.0, turns, turns + 1.0]))
    laps = np.tile(need, 3)
    rising = np.subtract(np.maximum.accumulate(np.add(laps, position)), position)
    falling = np.subtract(laps, position)[::-1]
    falling = np.add(np.maximum.accumulate(falling)[::-1], position)
    return np.asarray(np.maximum(rising, falling)[n : 2 * n])


def _condition(n: int, *, disc: float, **_others: float) -> None:
    """The disc must fit into the regular n-gon with some room."""
    most = _LEAST_ROOM * cosine(0.5 / n)
    if disc > most:
        raise GeneratorError(
            f"star-fat: disc = {disc:g} must be at most 0.99 cos(π/n) = {most:g} for n = {n}"
        )


STAR_FAT = Family(
    name="star-fat",
    kind="polygon",
    summary="random star polygon whose kernel contains a given disc",
    source="random Lipschitz function of the tangent angle (McShane extension)",
    growth="unknown",
    build=star_fat,
    parameters=(
        Parameter(
            "disc",
            float,
            0.25,
            "radius of the disc in the kernel (outline ≤ 1)",
            Interval(0.01, 0.99),
        ),
        Parameter(
            "roughness", float, 0.9, "share of the feasible slope in use", Interval(0.01, 0.99)
        ),
    ),
    largest=100_000,
    condition=_condition,
)
