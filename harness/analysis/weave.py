"""How many vertices and cells a weave has in its kernel: an exact prediction.

The weave W(m, ρ) is the polygon of n = 2m vertices at equal angles φ = π/m = 2h whose radii are
1 and ρ in turn, 0 < ρ < 1, and m ≥ 2.  Its edges are m copies A₀ … A₍ₘ₋₁₎ of one edge, turned by
multiples of 2φ, and their m mirror images B₀ …; the mirrors are the n rays ("axes") through the
vertices, even ones through outer vertices, odd ones through inner vertices.  With
T = (1 − ρ)/(1 + ρ), an edge's normal makes with the middle direction of its angle the angle ν,
tan ν = T cot h.

*Level circles.*  An edge ab is seen from p under the angle θ if Q sin θ = L cos θ, where
Q = (a − p)·(b − p) and L = (a − p) × (b − p).  As |a||b| and the angle between a and b are the same
for all edges, so is the part of Q sin θ − L cos θ that does not depend on the direction of p:

    (Q sin θ − L cos θ)/sin θ = s² + 2 s G(θ) cos(ψ − t) − K(θ),          p = s (cos ψ, sin ψ),

with K = ρ sin(φ − θ)/sin θ > 0 for θ < φ and G > 0 common to all edges.  Only t differs: the
*tip*, the direction in which the edge's circle comes nearest to the centre O.

*Winners.*  The greatest of these functions vanishes where θ is the smallest visual angle: the
point p belongs to the edge whose tip is nearest to ψ.  So at every level θ the diagram is the
one-dimensional Voronoi diagram of the n tips on the circle of directions.  Along a ray the level
falls strictly from φ, at O, where all edges tie.

*Tips.*  Measured from the middle direction of an edge of the family A (of B: mirrored),

    tan t(θ) · tan(h − θ) = T:    t falls strictly from π − ν at O to ν at level 0.

Three tips at one distance from a direction need two tips in one place, so vertices occur at the
levels where a tip of A meets one of B: at t = tⱼ = (j + ½)φ.  Then all n tips meet, in pairs, on m
axes (those of the parity of j + 1).  On each of them, a *saddle* of two edges: a passing.  On each
of the m other axes, midway, a *tie* of four edges.  With x = mν/π and k = ⌊x + ½⌋ the levels
strictly between ν and π − ν are j = k … m − 1 − k: there are m − 2k of them.  A tip that would pass
exactly at the rim (x + ½ a whole number) passes on the boundary, outside the open kernel.

*The rim.*  If ν ≥ 3φ/2 all edges are off the kernel, the rim is the level 0, and every level is
whole.  Otherwise the inner vertices are corners of the kernel, and at such a corner the level is
that of j = 1; if ν < φ/2 the polygon is convex, the outer vertices are corners as well, and there
the level is that of j = 0.  So the ties of j = 1 lie exactly in corners, and all points of j = 0:
they do not count.  In a convex weave the arcs of a level may leave the kernel through the middle
of an edge between two axes and come back (*bulges*), which cuts off one cell more for each arc.

*Counts.*  With S levels whose saddles and F levels whose ties are in the open kernel, and U levels
whose arcs bulge, the exactly symmetric weave has 1 + m(S + F) vertices (the centre, saddles, ties)
and n(S + 1 + U) cells.  Noise turns the centre into n − 2 triple points, a tie into two, a saddle
into none, at the price of one cell, and at each of the m corners where j = 1 arrives the tie in
the corner into one triple point, if the two edges there own sectors of it (their exterior angle
is less than the level there):

    vertices = n − 2 + nF + m·[corner],    cells = n + mS + nU,    edges = cells + vertices − 1.

If ν ≥ 3φ/2, S = F = m − 2k and the vertices are n(m − 2k + 1) − 2: about (n²/2)(1 − 2ν/π).  Every
convex weave has n²/2 − n − 2 of them, and n/2 more beyond δ ≈ 3/5.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, ctx, fmpq

#: Working precisions in bits; what the last cannot decide is taken to be an exact coincidence.
PRECISIONS = (128, 512, 4096)

Radius = int | float | Fraction


@dataclass(frozen=True)
class Weave:
    """The diagram of an ideal weave in its open kernel; all counts are exact integers.

    ``tilt`` is ν in radians (a double), ``first`` and ``last`` are the least and the greatest j of
    a passing level (``last < first``: there is none), ``rim_gap`` is the distance from ν to the
    nearest level in units of φ, at most ½: how near a passing is to the rim, and by symmetry to
    the centre.  ``coincident`` says that a passing lies exactly on the rim, or another comparison
    is exactly balanced: then noise, however small, decides, and the generic counts are one of
    several possible outcomes.
    """

    n: int
    tilt: float
    first: int
    last: int
    corner: bool
    bulges: int
    rim_gap: float
    coincident: bool

    @property
    def m(self) -> int:
        """Edges of one family."""
        return self.n // 2

    @property
    def saddles(self) -> int:
        """S: levels whose saddles are in the open kernel."""
        return max(0, self.last - max(self.first, 1) + 1)

    @property
    def ties(self) -> int:
        """F: levels whose ties are in the open kernel."""
        inside = self.first if self.first >= 2 else 2
        return max(0, self.last - inside + 1)

    @property
    def passings(self) -> int:
        """Passings of a tip of one family and a tip of the other, in the open kernel."""
        return self.m * self.saddles

    @property
    def vertices(self) -> int:
        """Generic number of vertices, all of degree 3."""
        return self.n - 2 + self.n * self.ties + self.m * self.corner

    @property
    def cells(self) -> int:
        """Generic number of cells."""
        return self.n + self.m * self.saddles + self.n * self.bulges

    @property
    def edges(self) -> int:
        """Generic number of edges, by Euler's formula for a connected diagram."""
        return self.cells + self.vertices - 1

    @property
    def symmetric_vertices(self) -> int:
        """Vertices of the exactly symmetric polygon."""
        return 1 + self.m * (self.saddles + self.ties)

    @property
    def symmetric_cells(self) -> int:
        """Cells of the exactly symmetric polygon."""
        return self.n * (self.saddles + 1 + self.bulges)

    @property
    def symmetric_edges(self) -> int:
        """Edges of the exactly symmetric polygon."""
        return self.symmetric_cells + self.symmetric_vertices - 1

    @property
    def symmetric_degrees(self) -> dict[int, int]:
        """Vertices by degree in the exactly symmetric polygon: the centre n, all others 4."""
        fours = self.symmetric_vertices - 1
        degrees = {4: fours} if fours else {}
        degrees[self.n] = degrees.get(self.n, 0) + 1
        return degrees


def predict(m: int, outer: Radius, inner: Radius) -> Weave:
    """The diagram of the weave with m spikes and the two radii, exactly as they are given.

    Floats are taken as the rationals they are; the angles are ideal.  Comparisons are made in
    ball arithmetic of growing precision.  ``outer`` and ``inner`` may come in either order.
    Raises ValueError if m < 2 or unless the radii are positive and different.  O(m) or O(1) if
    the weave is not convex.
    """
    ratio = exact_ratio(outer, inner)
    if m < 2:
        raise ValueError(f"no weave has m = {m}")
    for bits in PRECISIONS:
        ctx.prec, before = bits, ctx.prec
        try:
            return _weave(m, ratio, exact=bits == PRECISIONS[-1])
        except _UndecidedError:
            continue
        finally:
            ctx.prec = before
    raise AssertionError("the last precision decides")


def exact_ratio(outer: Radius, inner: Radius) -> Fraction:
    """ρ < 1, the smaller radius over the larger one.  Raises ValueError if there is none."""
    small, large = sorted((Fraction(outer), Fraction(inner)))
    if small <= 0 or small == large:
        raise ValueError(f"no weave has the radii {outer} and {inner}")
    return small / large


class _UndecidedError(ArithmeticError):
    """A ball contains the number it is compared with."""


def _weave(m: int, ratio: Fraction, *, exact: bool) -> Weave:
    balanced: list[bool] = []

    def positive(value: arb) -> bool:
        """Whether value > 0; a ball around 0 is an exact 0 at the last precision."""
        if value > 0 or value < 0:
            return bool(value > 0)
        if not exact:
            raise _UndecidedError
        balanced.append(True)
        return False

    shape = _Shape(m, ratio)
    turns = shape.tilt * m / arb.pi()  # x
    k = int(float(turns) + 0.5)
    while not positive(k + arb(1) / 2 - turns):
        k += 1  # the level j = k is beyond the rim, or on it
    while k > 0 and positive(k - arb(1) / 2 - turns):
        k -= 1
    first, last = k, m - 1 - k
    corner = k <= 1 <= last and positive(shape.level(1) - (2 * shape.h - 2 * shape.tilt))
    bulges = 0
    if k == 0:
        bulges = sum(shape.bulges(j, positive) for j in range(2, last + 1))
    gap = min(abs(float(turns) - (j + 0.5)) for j in (k - 1, k))
    return Weave(
        2 * m, float(shape.tilt), first, last, corner, bulges, gap, coincident=bool(balanced)
    )


class _Shape:
    """The lengths and angles of a weave, as balls at the precision in force."""

    def __init__(self, m: int, ratio: Fraction) -> None:
        """Of radii 1 and ``ratio`` < 1."""
        self.m = m
        self.ratio = _ball(ratio)
        self.skew = _ball((1 - ratio) / (1 + ratio))  # T
        self.h = arb.pi() / (2 * m)
        self.tilt = (self.skew * self.h.cot()).atan()  # ν

    def tip(self, j: int) -> arb:
        """tⱼ, the direction of the tips from the middle of their edge at the level j."""
        return (2 * j + 1) * self.h

    def level(self, j: int) -> arb:
        """θⱼ, the visual angle at which tips pass for the j-th time, counted from the rim."""
        return self.h - (self.skew * self.tip(j).cot()).atan()

    def circle(self, j: int) -> tuple[arb, arb]:
        """Distance of the level circles' centres from O, and K: their power there is −K."""
        angle = self.level(j)
        distance = (1 - self.ratio) * (self.h - angle).cos() / self.tip(j).sin() / 2
        return distance / angle.sin(), self.ratio * (2 * self.h - angle).sin() / angle.sin()

    def radius(self, j: int, aside: arb) -> arb:
        """Distance from O of the level j in a direction that lies ``aside`` a tip."""
        distance, power = self.circle(j)
        along = distance * aside.cos()
        return (along * along + power).sqrt() - along

    def inradius(self) -> arb:
        """Distance of the edges' lines from O."""
        length = 1 + self.ratio * self.ratio - 2 * self.ratio * (2 * self.h).cos()
        return self.ratio * (2 * self.h).sin() / length.sqrt()

    def overhang(self, j: int) -> arb:
        """How far the circle of the level j, of which both axes are in the kernel, reaches beyond
        the line of the edge A₀ between them; negative if it does not.
        """
        distance, power = self.circle(j)
        return distance * self._toward(j) + (distance * distance + power).sqrt() - self.inradius()

    def _toward(self, j: int) -> arb:
        """Cosine between the normal of A₀ and the direction from O to the circle's centre."""
        return -(self.h + self.tilt - self._tip_axis(j)).cos()

    def _tip_axis(self, j: int) -> arb:
        """Direction of the tip between the outer vertex at 0 and the inner one at φ."""
        return arb(0) if j % 2 else 2 * self.h

    def bulges(self, j: int, positive: Callable[[arb], bool]) -> bool:
        """Whether the arcs of level j leave the convex weave between two neighbouring axes.

        Both ends of the arc are inside, so it leaves if and only if its point farthest in the
        direction of the edge's normal lies between the two axes and beyond the edge.
        """
        if not positive(self.overhang(j)):
            return False
        distance, power = self.circle(j)
        reach = (distance * distance + power).sqrt()
        axis, normal = self._tip_axis(j), self.h + self.tilt
        x = reach * normal.cos() - distance * axis.cos()
        y = reach * normal.sin() - distance * axis.sin()
        # strictly between the directions 0 and φ
        return positive(y) and positive(x * (2 * self.h).sin() - y * (2 * self.h).cos())


def _ball(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))
