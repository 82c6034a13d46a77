"""How much noise a weave bears before the counts of ``weave`` change: a first-order estimate.

Move every vertex by at most ε times its radius, both along and across it.  Then Q sin θ − L cos θ
of an edge at distance D from p changes by about 2√2 εD at most, so two edges gain or lose 4√2 εD
against each other.  Along a level, an edge's function falls off from its tip like w·(angle)²,
where w = s·(1 − ρ) cos(h − θ)/(2 sin t).  While two tips pass, the one behind is hidden between
the tip that passes it and the next pair, an angle of about 2φ away, as long as the tips are closer
than 4√2 εD/(2wφ): for a time of |t − tⱼ| < √2 εD/(wφ).  By the same angle vertices are displaced
along the level.  The counts of ``weave`` need these times to be over before the next passing
begins, φ away, and before the rim or the centre; and they need the displaced vertices to be in the
kernel, of which a bulging level sees no more than an angle of (distance to the corner)/h beside an
axis:

    ε < gap·wφ / (√2 D).

In a zigzag star of fixed tilt w ~ s/n and gap ~ φ ~ 1/n: away from the centre passings bear a
noise like n⁻³, the first ones around it, where s ~ 1/n, one like n⁻⁴.  In a convex weave w ~ 1/n²
and s ~ 1: all passings bear a noise like n⁻⁴.  This is an estimate, with no proof; the tests and
the study find all counts as predicted below a quarter of it.
"""

from __future__ import annotations

import math

import numpy as np

from harness.analysis.models import Floats
from harness.analysis.weave import Radius, Weave, exact_ratio, predict

#: A vertex written in doubles is off by this much, relative to its radius, or less.
ROUNDING = 2.0**-51
#: Below this share of the tolerance every count is expected to be the predicted one.
SAFE = 0.25


def tolerance(m: int, outer: Radius, inner: Radius) -> float:
    """The relative noise up to which the generic counts of W(m, ρ) can be expected.

    Zero where a coincidence leaves them open, infinite if nothing passes.  Raises ValueError as
    ``predict`` does.  O(m).
    """
    weave = predict(m, outer, inner)
    if weave.coincident:
        return 0.0
    levels = _Levels(weave, float(exact_ratio(outer, inner)))
    if not len(levels.tip):
        return math.inf
    return min(float(levels.passing().min()), float(levels.leaving().min()), levels.cornering())


class _Levels:
    """The passing levels j ≥ 1 of a weave in doubles, each quantity as an array over j."""

    def __init__(self, weave: Weave, ratio: float) -> None:
        self.weave, self.ratio = weave, ratio
        self.h = h = math.pi / weave.n
        self.j = np.arange(max(weave.first, 1), weave.last + 1)
        self.tip = (2 * self.j + 1) * h
        self.level = h - np.arctan((1 - ratio) / (1 + ratio) / np.tan(self.tip))
        #: distance of the circles' centres from O, times sin θ
        self.centre = (1 - ratio) * np.cos(h - self.level) / np.sin(self.tip) / 2
        self.tie, self.saddle = self._radius(2 * h), self._radius(0.0)
        middle = np.minimum(self.tip + 2 * h, math.pi)
        #: from a tie to the middle of the farther edge of it
        self.far = np.sqrt(self.tie**2 + 1 - 2 * self.tie * np.cos(middle))

    def _radius(self, aside: float) -> Floats:
        """Distance from O in a direction ``aside`` from a tip."""
        along = self.centre * math.cos(aside) / np.sin(self.level)
        power = self.ratio * np.sin(2 * self.h - self.level) / np.sin(self.level)
        return np.asarray(np.sqrt(along**2 + power) - along)

    def passing(self) -> Floats:
        """What the passings of each level bear."""
        gap = np.minimum(math.pi - self.weave.tilt - self.tip, self.h)
        if self.weave.first > 0:
            gap = np.minimum(gap, self.tip - self.weave.tilt)
        else:
            gap = np.minimum(gap, self._clearance() / self.h)
        fall = self.tie * self.centre * 2 * self.h
        return np.asarray(gap * fall / (math.sqrt(2) * self.far))

    def _clearance(self) -> Floats:
        """Distances of ties and saddles from the corner on their axis in a convex weave."""
        odd = self.j % 2 == 1
        tie = np.where(odd, self.ratio, 1.0) - self.tie
        saddle = np.where(odd, 1.0, self.ratio) - self.saddle
        return np.asarray(np.where(self.j == 1, saddle, np.minimum(tie, saddle)))

    def leaving(self) -> Floats:
        """What the arcs bear before they leave a convex weave, or come back into it.

        The edge's function grows by about 2h along a ray, so 2√2 εD moves a level by √2 εD/h.
        """
        if self.weave.first > 0:
            return np.array([math.inf])
        normal = self.h + self.weave.tilt - np.where(self.j % 2 == 1, 0.0, 2 * self.h)
        centre = self.centre / np.sin(self.level)
        reach = np.sqrt(
            centre**2 + self.ratio * np.sin(2 * self.h - self.level) / np.sin(self.level)
        )
        length = math.sqrt(1 + self.ratio**2 - 2 * self.ratio * math.cos(2 * self.h))
        edge = self.ratio * math.sin(2 * self.h) / length
        over = np.where(self.j == 1, math.inf, np.abs(reach - centre * np.cos(normal) - edge))
        return np.asarray(over * self.h / (math.sqrt(2) * self.far))

    def cornering(self) -> float:
        """What the comparison of angles at an inner corner bears: edges there are about 2h long."""
        if self.weave.first > 1:
            return math.inf
        return abs(float(self.level[0]) - 2 * (self.h - self.weave.tilt)) * self.h / 4
