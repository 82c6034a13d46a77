"""Lemma 6: the intersection of n discs by parallel divide and conquer."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
from flint import arb, ctx

from harness.audit import cases
from harness.audit.claim import Claim, Finding, Row, Series, as_facts
from harness.audit.growing import series_of
from harness.geometry.exact import rational
from harness.geometry.instance import Instance
from harness.peak.circles import of_discs
from harness.peak.discs import Judge, Meet, Present, Vertices, intersect, meet
from harness.peak.door import peak

Floats = npt.NDArray[np.float64]
Booleans = npt.NDArray[np.bool_]
Ints = npt.NDArray[np.int64]

BITS = 256
MOST_FOR_BALLS = 24
"""Discs up to which the independent O(n³) arrangement is made."""
#: batches ≤ BATCHES · log₂² n, each of at most WIDTH · n comparisons.
BATCHES, WIDTH = 16.0, 16.0
ABOVE = 0.05
"""How far above the optimal level the discs are taken, relative to 1 + |c*|."""


class Counting:
    """A judge that counts what another is asked: batches, comparisons, the widest batch."""

    def __init__(self, judge: Judge) -> None:
        """``judge`` answers."""
        self._judge = judge
        self.batches = self.comparisons = self.widest = 0

    def _note(self, count: int) -> None:
        self.batches += count > 0
        self.comparisons += count
        self.widest = max(self.widest, count)

    def cross(self, one: Ints, other: Ints) -> Booleans:
        """See :class:`harness.peak.discs.Judge`."""
        self._note(len(one))
        return self._judge.cross(one, other)

    def is_left(self, v: Vertices, w: Vertices) -> Booleans:
        """See :class:`harness.peak.discs.Judge`."""
        self._note(len(v.one))
        return self._judge.is_left(v, w)

    def is_below(
        self, v: Vertices, w: Vertices, one: Ints, other: Ints, halves: tuple[bool, bool]
    ) -> Booleans:
        """See :class:`harness.peak.discs.Judge`."""
        self._note(len(one))
        return self._judge.is_below(v, w, one, other, halves)


def discs_of(instance: Instance) -> tuple[Floats, Floats]:
    """Centres (n, 2) and radii (n,): discs of a polygon's edges a little above the peak's level.

    Their intersection has interior; the origin is the peak.
    """
    best = peak(instance)
    level = 1.0 / math.tan(best.angle)
    level += ABOVE * (1.0 + abs(level))
    ends = instance.segments - np.array([best.x, best.y])
    along = ends[:, 1] - ends[:, 0]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / 2
    radii = np.hypot(along[:, 0], along[:, 1]) / 2 * math.hypot(1.0, level)
    return ends.mean(axis=1) + level * normal, radii


def corners(found: Meet) -> Counter[tuple[int, int]]:
    """The pairs of discs whose circles meet in a corner of the intersection, from its arcs."""
    upper, lower = found.upper.tolist(), found.lower.tolist()
    if not upper:
        return Counter()
    pairs = [(upper[0], lower[0]), (upper[-1], lower[-1])]
    for chain in (upper, lower):
        pairs += pairwise(chain)
    return Counter((min(p), max(p)) for p in pairs if p[0] != p[1])


def corners_by_balls(centres: Floats, radii: Floats) -> Counter[tuple[int, int]] | None:
    """The same by trying all pairs of circles against all discs; None: not decided."""
    discs = [
        (rational(x), rational(y), rational(r) ** 2)
        for (x, y), r in zip(centres.tolist(), radii.tolist(), strict=True)
    ]
    found: Counter[tuple[int, int]] = Counter()
    with ctx.workprec(BITS):
        for i, j in combinations(range(len(discs)), 2):
            for x, y in _meetings(discs[i], discs[j]):
                inside = _is_inside(x, y, [d for k, d in enumerate(discs) if k not in (i, j)])
                if inside is None:
                    return None
                found[i, j] += inside
    return +found


def _meetings(one: Any, other: Any) -> list[tuple[Any, Any]]:
    """The two points where two circles cross, in balls."""
    (x, y, r), (u, v, s) = one, other
    dx, dy = u - x, v - y
    square = dx * dx + dy * dy
    if square == 0:
        return []
    along = (square + r - s) / (2 * square)
    height = r / square - along * along
    if height <= 0:
        return []
    h = arb(height).sqrt()
    return [(x + along * dx - k * h * dy, y + along * dy + k * h * dx) for k in (1, -1)]


def _is_inside(x: Any, y: Any, discs: Sequence[Any]) -> bool | None:
    """Whether a point is strictly inside all discs; None if balls cannot tell."""
    sure = True
    for u, v, s in discs:
        power = arb((x - u) ** 2 + (y - v) ** 2 - s)
        if power > 0:
            return False
        sure = sure and bool(power < 0)
    return True if sure else None


def check_intersection(instance: Instance) -> Finding:
    """The right arcs in the right number of steps."""
    if not cases.star_shaped(instance):
        return Finding("outside")
    centres, radii = discs_of(instance)
    found = meet(centres, radii)
    judge = Counting(Present(of_discs(centres, radii)))
    intersect(len(radii), judge)
    n, log = instance.n, math.log2(instance.n)
    facts = as_facts(
        arcs=len(found.arcs()),
        batches=judge.batches,
        comparisons=judge.comparisons,
        widest=judge.widest,
    )
    compared = ""
    if n <= MOST_FOR_BALLS:
        expected = corners_by_balls(centres, radii)
        if expected is None:
            return Finding("undecided", "three circles nearly meet in a point", facts)
        if expected != corners(found):
            return Finding("fails", "the corners differ from those of the arrangement", facts)
        compared = ", corners as by trying all pairs"
    if judge.batches > BATCHES * log**2 or judge.widest > WIDTH * n:
        return Finding(
            "fails",
            f"{judge.batches / log**2:.2f} log² n batches, up to {judge.widest / n:.2f} n wide",
            facts,
        )
    return Finding("holds", f"{len(found.arcs())} arcs, {judge.batches} batches{compared}", facts)


def steps(rows: Sequence[Row]) -> list[Series]:
    """How batches and comparisons grow, family by family."""
    return series_of(
        rows,
        "comparisons",
        {
            "batches": lambda _n, f: f["batches"],
            "batches/log₂² n": lambda n, f: f["batches"] / math.log2(n) ** 2,
            "widest batch/n": lambda n, f: f["widest"] / n,
        },
    )


SIZES = (8, 16, 32, 64, 128, 256, 512, 1024, 2048)

CLAIMS = (
    Claim(
        name="lemma-6",
        title="Lemma 6",
        gloss="n discs intersected in O(log² n) parallel steps",
        quote=(
            "Given a set of n circles, the above parallel algorithm for finding their intersection "
            "is implemented in O(log² n) time using n processors."
        ),
        reading=(
            "For the discs of a polygon's edges just above the level of the peak, the algorithm "
            f"finds the corners of the intersection, in at most {BATCHES:g} log₂² n batches of "
            f"independent comparisons, none wider than {WIDTH:g} n."
        ),
        failure=(
            "other corners than those found by trying all pairs of circles against all discs (for "
            f"n ≤ {MOST_FOR_BALLS}), or more or wider batches; the constants are ours"
        ),
        arithmetic=(
            "the algorithm runs in doubles; its corners are compared with those by balls of 256 "
            "bits of the same discs; batches are counted, not timed"
        ),
        limits=(
            "Counts at finite n neither prove nor refute a bound for all n. A batch of n "
            "comparisons is what n processors do at a time; a real parallel machine is not used."
        ),
        cases=cases.together(
            (cases.lattice_stars(4, 6, 8), 0.5),
            (cases.families(("near-regular", 20, {}), ("cavity", 8, {}), ("zigzag", 20, {})), 0.5),
            (
                cases.sizes({"near-regular": SIZES, "convex-circle": SIZES, "zigzag": SIZES}),
                1.0,
            ),
        ),
        check=check_intersection,
        kind="growth",
        series=steps,
        shrink=False,
        count=60,
    ),
)
