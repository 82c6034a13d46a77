"""The method ``parametric``: Megiddo's parametric search (the paper, Theorem 7).

N. Megiddo, "Applying parallel computation algorithms in the design of serial algorithms", J. ACM
30 (1983).  The divide and conquer of :mod:`harness.peak.discs` is run on the discs of the unknown
level c*.  A comparison there is the sign of a function of c; where it changes are the *critical
values*.  Those of one batch are sorted, and the place of c* among them is found by O(log n)
*decisions*: have the discs of this level and the kernel a common point?  Each decision shrinks
the interval (low, high] that holds c*; inside it the batch has one outcome.  When all is done the
intersection has one shape for all c in the interval, so it shrinks to nothing at its lower end,
which is c*; unless the kernel's boundary, which is no disc, decides: then the rest is bisected.

Decisions are taken by the quadratic program of :mod:`harness.peak.powers`.  Functions of c are
evaluated in doubles, their sign changes looked for between ``LEVELS``, again after every
shrinking.  Two of them closer together may be overlooked; so the search is only a search, and its
result is proven like any other (:mod:`harness.peak.proof`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from harness.errors import UserError
from harness.peak.circles import Floats, Ints, crossing, crossing_margin, of_edges, ordinate
from harness.peak.discs import Booleans, Vertices, intersect
from harness.peak.polygon import Polygon
from harness.peak.powers import NONE, settle
from harness.peak.proof import prove
from harness.peak.result import Peak
from harness.peak.sampling import Ascent, ascent_over

_NEAR = (1e-11, 1e-8, 1e-5, 1e-2, 0.1, 0.3)
LEVELS = np.array([*_NEAR, 0.5, *(1 - part for part in reversed(_NEAR))])
"""Where in the interval sign changes are looked for: close to its ends, where c* may well be."""
MIDDLE = np.array([0.5])
HALVINGS = 60
CLOSED = 1e-14
"""The width of the interval, relative to 1 + |c|, below which decisions would be rounding."""
ROUNDS = 30
RECENTRED = 4
"""How often the search is begun, each time from coordinates rounded anew near its last end."""
NEAR = 1e-5
"""How far, in radians, the search may end from the proven angle.  Where the optimum is close to a
vertex, M(c) vanishes almost quadratically, and decisions are as accurate as the square root of
rounding."""

#: Comparisons of a batch: from levels (k, 1) or (1, m), and the numbers of m comparisons, to the
#: values whose signs are wanted, (k, m) or (1, m).
Values = Callable[[Floats, Ints], Floats]


class _ClosedError(Exception):
    """The interval is as narrow as can be told."""


def parametric_peak(polygon: Polygon) -> Peak:
    """The peak by parametric search.

    ``facts``: ``decisions``, each O(n) expected; ``comparisons``; ``batches`` of them;
    ``critical`` values.  Raises as :func:`harness.peak.proof.prove`, and
    :class:`harness.errors.UserError` if the search ends at another level than that of the peak,
    even when begun again from where it ended.
    """
    origin = polygon.inner_point()
    for _ in range(RECENTRED):
        search = Search(polygon.start[0], polygon.edges_from(origin))
        among = search.run()

        def look(start: float, edges: Floats, among: Ints = among) -> Ascent:
            return ascent_over(start, edges, among)

        found = prove(polygon, look, "parametric", search.facts)
        end = float(np.arctan2(1.0, search.high))
        if abs(found.angle - end) <= NEAR:
            return found
        origin = polygon.moved(origin, *search.point)  # more accurate from near by
    raise UserError(
        f"{polygon.instance.label}: parametric search in doubles ends at {end!r}, but the proven "
        f"angle is {found.angle!r}: the kernel is too thin for it, use the method lp"
    )


class Search:
    """One parametric search: the judge of comparisons at the unknown level."""

    def __init__(self, start: float, edges: Floats) -> None:
        """``start``: a level ≤ c*; ``edges``: (4, n), the origin near the polygon."""
        self.edges = edges.copy()
        self.low = self.high = start
        self.facts = dict.fromkeys(("decisions", "comparisons", "batches", "critical"), 0)
        self._state, self._basis = np.zeros(3), np.full(4, NONE)
        self._best = self._basis.copy()
        self._shift = (0.0, 0.0)

    @property
    def point(self) -> tuple[float, float]:
        """Where the last decision was taken, from the origin of the edges as given."""
        return self._shift[0] + float(self._state[0]), self._shift[1] + float(self._state[1])

    def run(self) -> Ints:
        """Search; the edges of the basis at c*."""
        with np.errstate(over="ignore", invalid="ignore"):  # far circles are no matter
            if not self.decide(self.low):
                self._search()
        basis = self._best[:3]
        return np.unique(basis[basis != NONE] >> 1)

    def _search(self) -> None:
        """Shrink the interval to nothing."""
        try:
            self._bracket()
            intersect(self.edges.shape[1], self)
            self._close()
        except _ClosedError:
            pass

    def decide(self, level: float) -> bool:
        """Whether the discs of this level and the kernel have a common point, i. e. c* ≤ level."""
        self.facts["decisions"] += 1
        room, chosen = np.zeros((4, 4)), np.zeros(3, dtype=np.int64)
        n = self.edges.shape[1]
        for _ in range(2):  # again from where it ended: more accurate from near by
            settle(level, self._state, self._basis, np.zeros(3), room, chosen, *self.edges, n)
        common = bool(self._state[2] <= 0.0)
        if common or self.high == self.low:
            self._best = self._basis.copy()
        return common

    def _bracket(self) -> None:
        """An upper end, by doubling; then the origin moves to a common point."""
        step = 1.0 + abs(self.low)
        while not self.decide(self.low + step):
            self.low += step
            step *= 2.0
            if not step < 1e300:
                raise _ClosedError
        self.high = self.low + step
        self._shift = self.point
        self.edges[0] -= self._state[0]
        self.edges[1] -= self._state[1]
        self._state[:2] = 0.0

    # --- the interval ----------------------------------------------------------------------------

    def _narrow(self, level: float) -> None:
        """Decide at a level inside and keep the half that holds c*."""
        if self.decide(level):
            self.high = level
        else:
            self.low = level
        self._check()

    def _check(self) -> None:
        """End the search if the interval is closed."""
        if not self.high - self.low > CLOSED * (1.0 + abs(self.high)):
            raise _ClosedError

    def _close(self) -> None:
        """One end of the interval is c* up to rounding, or the kernel's boundary decides.

        The first is seen by a decision just inside either end; otherwise bisect.
        """
        step = CLOSED * (1.0 + abs(self.high))
        self._narrow(self.high - step)
        self._narrow(self.low + step)
        while True:
            self._narrow(float(np.sinh(np.arcsinh([self.low, self.high]).mean())))

    def _levels(self, parts: Floats) -> Floats:
        """Levels strictly inside, at these parts of the way over the sizes in between."""
        ends = np.arcsinh([self.low, self.high])
        levels: Floats = np.sinh(ends[0] + parts * (ends[1] - ends[0]))
        return levels

    # --- comparisons -----------------------------------------------------------------------------

    def _signs(self, count: int, values: Values) -> Booleans:
        """Whether the values of a batch are positive at the unknown level."""
        self.facts["batches"] += 1
        self.facts["comparisons"] += count
        every = np.arange(count)
        for _ in range(ROUNDS):
            levels = self._levels(LEVELS)
            positive = values(levels[:, np.newaxis], every) > 0
            rows, changing = np.nonzero(positive[1:] != positive[:-1])
            if not len(rows):
                break
            critical = self._critical(levels[rows], levels[rows + 1], values, changing)
            if not self._place(np.unique(critical)):
                break  # they are an end of the interval, up to rounding
        signs: Booleans = (values(self._levels(MIDDLE)[:, np.newaxis], every) > 0)[0]
        return signs

    def _critical(self, low: Floats, high: Floats, values: Values, which: Ints) -> Floats:
        """Where comparisons change sign between two levels each, by bisection of all at once."""
        self.facts["critical"] += len(which)
        at_low = (values(low[np.newaxis], which) > 0)[0]
        for _ in range(HALVINGS):
            middle = np.sinh((np.arcsinh(low) + np.arcsinh(high)) / 2)
            same = (values(middle[np.newaxis], which) > 0)[0] == at_low
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.asarray((low + high) / 2)

    def _place(self, critical: Floats) -> bool:
        """The place of c* among critical values, by binary search; whether it took a decision."""
        narrowed = False
        while True:
            inside = critical[(critical > self.low) & (critical < self.high)]
            if not len(inside):
                return narrowed
            narrowed = True
            self._narrow(float(inside[len(inside) // 2]))

    def _x(self, level: Floats, v: Vertices) -> Floats:
        one, other = (of_edges(level, self.edges[:, k]) for k in (v.one, v.other))
        return crossing(one, other, np.broadcast_to(v.side, one.g.shape))[0]

    def cross(self, one: Ints, other: Ints) -> Booleans:
        """See :class:`harness.peak.discs.Judge`."""

        def values(level: Floats, k: Ints) -> Floats:
            return crossing_margin(
                of_edges(level, self.edges[:, one[k]]), of_edges(level, self.edges[:, other[k]])
            )

        return self._signs(len(one), values)

    def is_left(self, v: Vertices, w: Vertices) -> Booleans:
        """See :class:`harness.peak.discs.Judge`."""

        def values(level: Floats, k: Ints) -> Floats:
            return self._x(level, w.take(k)) - self._x(level, v.take(k))

        return self._signs(len(v.one), values)

    def is_below(
        self, v: Vertices, w: Vertices, one: Ints, other: Ints, halves: tuple[bool, bool]
    ) -> Booleans:
        """See :class:`harness.peak.discs.Judge`."""

        def values(level: Floats, k: Ints) -> Floats:
            x = (self._x(level, v.take(k)) + self._x(level, w.take(k))) / 2
            first, second = (
                ordinate(of_edges(level, self.edges[:, arc[k]]), x, np.full(x.shape, half))
                for arc, half in zip((one, other), halves, strict=True)
            )
            return second - first

        return self._signs(len(one), values)
