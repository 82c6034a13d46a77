"""Leaves with corners at infinity, against the reference builder in triangles that reach very far.

A corner (dx, dy, 0) is replaced by (dx, dy, 2⁻ᵏ), a point far away in the same direction.  If the
diagram has nothing between there and infinity, the leaf must be what is seen in that triangle.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import pytest

from harness.diagram import build
from harness.diagram.counts import OBJECTIVES
from harness.diagram.fast.leaves import OPEN
from harness.diagram.planar_map import PlanarMap
from harness.geometry.instance import Instance
from harness.geometry.predicates import compare_visual_angles
from tests.diagram.fast.exact_forms import Corner, exact_table
from tests.diagram.fast.sources import instance
from tests.diagram.fast.test_classify import NAMES, claims, contradictions
from tests.diagram.fast.triangles import Cut

#: How far away.
BITS = 60


@dataclass(frozen=True)
class FarCut(Cut):
    """Candidates over a triangle with corners at infinity; ``corners``: its stand-in's."""

    homogeneous: tuple[Corner, Corner, Corner] = ()  # type: ignore[assignment]  # always given

    @property
    def tables(self) -> list[list[Fraction]]:
        sense = 1 if self.objective == "smallest" else -1
        return [
            exact_table(s, self.homogeneous, sense) for s in self.candidates.rational_segments()
        ]


def far_cuts(made: PlanarMap, rng: random.Random, count: int) -> Iterator[FarCut]:
    """Triangles with one or two corners at infinity, most of them thin, and who wins in them."""
    segments = made.instance.rational_segments()
    size = max(abs(x) for s in segments for p in s for x in p) + 1
    directions = [n.point for n in made.nodes if n.kind == "infinity"]
    for _ in range(count):
        thin = 2.0 ** -rng.randint(0, 12)
        dx, dy = rng.choice(directions) if directions else (1.0, 0.0)
        corners: list[Corner] = []
        for far in [True, rng.random() < 0.6, False]:
            if far:
                x, y = dx + thin * rng.uniform(-1, 1), dy + thin * rng.uniform(-1, 1)
                corners.append((Fraction(x), Fraction(y), Fraction(0)))
            else:
                reach = float(size) * 2.0 ** rng.randint(-1, 6)
                x, y = reach * dx + rng.uniform(-3, 3), reach * dy + rng.uniform(-3, 3)
                corners.append((Fraction(x), Fraction(y), Fraction(1)))
        rng.shuffle(corners)
        a, b, c = corners
        turn = (
            a[0] * (b[1] * c[2] - c[1] * b[2])
            - a[1] * (b[0] * c[2] - c[0] * b[2])
            + a[2] * (b[0] * c[1] - c[0] * b[1])
        )
        if turn == 0:
            continue
        if turn < 0:
            b, c = c, b
        near = tuple((p[0], p[1]) if p[2] else (p[0] * 2**BITS, p[1] * 2**BITS) for p in (a, b, c))
        winners = winners_in(made, (a, b, c))
        if 2 <= len(winners) <= 4:
            chosen = Instance.from_arrays("segments", [segments[k] for k in winners])
            yield FarCut(chosen, made.objective, near, (a, b, c))  # type: ignore[arg-type]  # three points


def winners_in(made: PlanarMap, corners: tuple[Corner, Corner, Corner]) -> list[int]:
    """Who wins at some points of a triangle with corners at infinity."""
    found = set()
    sense = 1 if made.objective == "smallest" else -1
    segments = made.instance.rational_segments()
    for k in range(1, 9):
        for m in range(1, 9 - k):
            for scale in (1, 1000):
                weights = [scale * k, scale * m, 9 - k - m]
                x, y, w = (
                    sum(f * c[axis] for f, c in zip(weights, corners, strict=True))
                    for axis in range(3)
                )
                p, best = (Fraction(x / w), Fraction(y / w)), 0
                for s in range(1, len(segments)):
                    order = compare_visual_angles(p, segments[s], segments[best])
                    if order is not None and order * sense < 0:
                        best = s
                found.add(best)
    return sorted(found)


@pytest.mark.parametrize("source", ["segments", "lattice-segments", "star", "aligned"])
def test_far_leaves_are_what_is_seen_far_away(source: str) -> None:
    rng = random.Random(source)
    found: Counter[str] = Counter()
    for index in range(6):
        made = build(instance(source, 8, index), "plane", OBJECTIVES[index % 2], "reference")
        for cut in far_cuts(made, rng, 12):
            claimed = list(claims(cut, rng))
            try:
                seen = cut.view() if claimed else None
            except ValueError:  # too near together to tell apart in doubles
                continue
            for kind, choice, slots in claimed:
                assert seen is not None
                found[NAMES[kind] + (" open" if choice == OPEN else "")] += 1
                assert contradictions(kind, choice, slots, seen) == [], cut
    assert {"arc"} <= set(found)
