"""Planted controls: families whose growth is proved, to see whether an analysis finds it.

``control-constant`` and ``control-linear`` are circular saws.  A saw has m ≥ 3 equal teeth about
the origin O.  Tooth k has a steep flank A_k, the edge from the tip at distance 1 and angle
2πk/m to the root at distance 1/2 and angle 2πk/m + η, seen from O under the small angle η; and
a back, a chain of edges from that root out to the next tip, each seen from O under an
angle of at least α = 16η.

**Theorem.**  In its kernel a saw has exactly m Voronoi cells and one vertex, O, of degree m
(where all flanks tie).  A small generic perturbation leaves m cells and turns O into m − 2
vertices of degree 3.

*Proof.*  Let d be the distance of the line of A_0 from O.

1. *The kernel is the regular m-gon cut out by the lines of the flanks.*  Its corners are at
   distance κ = d / cos(π/m) from O, and the lines of the backs are farther away than that.
2. *Only flanks win.*  Seen from a point at distance at most κ from O, the direction of a
   polygon vertex, at distance at least 1/2, differs from that seen from O by at most
   asin(2κ).  So every edge of a back has visual angle at least α − 2 asin(2κ), which is greater
   than η.  The discs {visual angle of A_k ≥ η} all have O on their boundary and are rotations of
   one another by 2π/m about O, so only O is in all of them: elsewhere in the kernel some flank is
   seen under less than η.
3. *Each flank owns one sector.*  For a level below η the disc of A_k contains O in its
   interior; at polar angle ψ from its centre the distance from O to its circle is
   q cos ψ + √(r² − q² sin² ψ), which decreases in |ψ|.  So, the discs being rotations of one
   another, the circle nearest to O in any direction is that of the flank whose centre is most
   nearly opposite: at every level the m flanks win m equal arcs, in cyclic order.  As the level
   falls the arcs grow out from O and turn together, and sweep m spiral sectors.
4. *Noise.*  Away from O two neighbouring flanks tie along the rays between sectors, transversally,
   and all others are seen under a clearly larger angle.  Near O the visual angles are
   affine up to second order, with gradients in convex position: a perturbation changes the
   constants, every flank keeps its (unbounded) cell, and m cells meeting in a tree have m − 2
   vertices.  Neighbouring gradients separate like m⁻², so noise must be well below
   n⁻³ for this to happen inside the kernel, whose radius is of order 1/n.  ∎

The inequalities of steps 1 and 2 are checked in the tests for every n up to a few hundred, and
hold in the limit: κ ≈ η/cos(π/m) ≤ 2η, and 16η − 2·4η > η.
"""

from __future__ import annotations

import numpy as np

from generators.family import Family, Interval, Parameter
from generators.portable import Array, Stream, inverse_power, perturbed, polar

_RATIO = 16.0  # shortest visual angle of a back edge from O, in visual angles of a flank
_ROOT = 0.5
_NOISE = Parameter("noise", float, 1e-3, "relative noise, times n³", Interval(0.0, 0.1))


def control_constant(n: int, seed: int = 0, *, noise: float = 1e-3) -> Array:
    """A saw with three teeth, whose backs share the other n − 3 edges: 3 cells, 1 vertex; (n, 2).

    In the kernel the diagram has 3 cells, 3 edges and 1 vertex for every n, by the theorem of
    this module with m = 3.  O(n).
    """
    CONTROL_CONSTANT.check(n, {"noise": noise})
    backs = [(n - 3 + tooth) // 3 for tooth in range(3)]
    stream = Stream("control-constant", n, seed)
    return perturbed(_saw(backs), noise * inverse_power(n, 3), stream)


def control_linear(n: int, seed: int = 0, *, noise: float = 1e-3) -> Array:
    """A saw with n/2 teeth of two edges each: n/2 cells, n/2 − 2 vertices; shape (n, 2).

    In the kernel the diagram has n/2 cells, and n/2 − 2 vertices (one, of degree n/2, in the
    symmetric case), by the theorem of this module with m = n/2.  O(n).
    """
    CONTROL_LINEAR.check(n, {"noise": noise})
    stream = Stream("control-linear", n, seed)
    return perturbed(_saw([1] * (n // 2)), noise * inverse_power(n, 3), stream)


def _saw(backs: list[int]) -> Array:
    """The vertices of a saw whose tooth k has ``backs[k]`` edges in its back."""
    flank = 1.0 / (_RATIO * max(backs) + 1.0)  # in pitches of 1/m turn
    count = np.array(backs)
    tooth = np.repeat(np.arange(len(backs)), count + 1)
    # Step 0 is the tip, steps 1, 2, … the root and then the inner vertices of the back.
    first = np.append(0, np.cumsum(count + 1)[:-1])
    step = np.arange(len(tooth)) - first[tooth]
    along = np.divide(step - 1.0, count[tooth])
    angle = np.where(step == 0, 0.0, np.add(flank, np.multiply(1.0 - flank, along)))
    radius = np.where(step == 0, 1.0, np.add(_ROOT, np.multiply(1.0 - _ROOT, along)))
    return polar(radius, np.add(tooth, angle), len(backs))


CONTROL_CONSTANT = Family(
    name="control-constant",
    kind="polygon",
    summary="circular saw with three teeth: one vertex for every n (a control)",
    source="theorem in generators.controls",
    growth="1",
    control=True,
    build=control_constant,
    parameters=(_NOISE,),
    smallest=6,
    largest=100_000,
)

CONTROL_LINEAR = Family(
    name="control-linear",
    kind="polygon",
    summary="circular saw with n/2 teeth: n/2 − 2 vertices (a control)",
    source="theorem in generators.controls",
    growth="n",
    control=True,
    build=control_linear,
    parameters=(_NOISE,),
    smallest=6,
    largest=100_000,
    even=True,
)
