"""A candidate that is dropped wins nowhere in the triangle."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

from harness.diagram.fast.forms import error_factor
from harness.diagram.fast.prepare import Prepared, prepare
from harness.diagram.fast.prune import prune
from harness.diagram.fast.roots import double_double
from harness.diagram.fast.tables import root_table
from harness.geometry.predicates import compare_visual_angles, orientation
from tests.diagram.fast.exact_forms import Corner
from tests.diagram.fast.sources import instance

Triangle = list[Corner]


def triangle(rng: random.Random, prepared: Prepared) -> Triangle | None:
    """Any size, anywhere, at infinity, at endpoints; counter-clockwise."""
    ends = [point for s in prepared.instance.rational_segments() for point in s]
    size = max(abs(x) for p in ends for x in p) + 1
    x, y = rng.choice(ends)
    if rng.random() < 0.5:
        x, y = (Fraction(float(size) * rng.uniform(-2, 2)) for _ in range(2))
    radius = float(size) * 2.0 ** -rng.randint(0, 12)
    made: Triangle = []
    for k in range(3):
        kind = rng.random()
        if kind < 0.15:
            dx, dy = rng.choice([(1, 0), (0, 1), (1, 1), (-2, 1), (-1, -1)])
            made.append((Fraction(dx), Fraction(dy), Fraction(0)))
        elif kind < 0.4 and k == 0:
            made.append((x, y, Fraction(1)))
        else:
            u, v = (Fraction(radius * rng.uniform(-1, 1)) for _ in range(2))
            made.append((x + u, y + v, Fraction(1)))
    a, b, c = made
    turn = (
        a[0] * (b[1] * c[2] - c[1] * b[2])
        - a[1] * (b[0] * c[2] - c[0] * b[2])
        + a[2] * (b[0] * c[1] - c[0] * b[1])
    )
    if turn == 0:
        return None
    return made if turn > 0 else [a, c, b]


def kept(prepared: Prepared, corners: Triangle, sense: int) -> set[int]:
    """The candidates that are left, of all, with everything known that is known of roots."""
    n, scale = prepared.instance.n, prepared.scale
    doubles = np.array(
        [
            [
                part
                for value, middle in ((x, prepared.centre[0]), (y, prepared.centre[1]))
                for part in double_double((value - middle) * scale if w else value)
            ]
            for x, y, w in corners
        ]
    )
    weights = np.array([float(w) for _, _, w in corners])
    tables, norms, ids = np.empty((n, 9)), np.empty((n, 8)), np.arange(n)
    for k, (a, b) in enumerate(prepared.instance.rational_segments()):
        zeros = ends = 0
        for r, (x, y, w) in enumerate(corners):
            if w:
                zeros |= (orientation(a, b, (x, y)) == 0) << r
                ends |= ((x, y) in (a, b)) << r
            else:
                zeros |= ((b[0] - a[0]) * y == (b[1] - a[1]) * x) << r
        norm = norms[k, 0:2]
        root_table(
            prepared.segments[k],
            doubles,
            weights,
            zeros,
            ends,
            prepared.size,
            sense,
            tables[k],
            norm,
        )
    world = (
        prepared.lines,
        prepared.lengths,
        prepared.classes,
        np.zeros(1, np.int64),
        np.zeros((0, 3), np.int64),
    )
    work = (np.zeros(4, np.int64), *(np.zeros(n + 6, np.int64) for _ in range(3)))
    far = sum(1 << r for r in range(3) if weights[r] == 0)
    spots = np.full(3, -1)
    count, _ = prune(tables, norms, ids, 0, n, error_factor(0), far, False, work, world, spots)
    return set(ids[:count].tolist())


def winners(prepared: Prepared, corners: Triangle, weights: list[Fraction], sense: int) -> set[int]:
    """Who wins at a point of a triangle, exactly; none at an endpoint."""
    x, y, w = (
        sum((f * c[axis] for f, c in zip(weights, corners, strict=True)), Fraction(0))
        for axis in range(3)
    )
    p, best = (x / w, y / w), [0]
    segments = prepared.instance.rational_segments()
    for k in range(1, len(segments)):
        order = compare_visual_angles(p, segments[k], segments[best[0]])
        if order is None:
            return set()
        if order * sense < 0:
            best = [k]
        elif order == 0:
            best.append(k)
    return set(best)


@pytest.mark.parametrize(
    "source",
    ["segments", "aligned", "lattice-segments", "square-grid", "star", "nudged", "rational"],
)
def test_what_is_dropped_wins_nowhere(source: str) -> None:
    rng = random.Random(source)
    dropped = 0
    for index in range(25):
        made = instance(source, 3, index)
        prepared = prepare(made, parallels=True)
        for _ in range(4):
            corners = triangle(rng, prepared)
            if corners is None:
                continue
            sense = rng.choice([1, -1])
            left = kept(prepared, corners, sense)
            dropped += made.n - len(left)
            for _ in range(12):
                # Mostly close to a side or a corner.
                weights = [Fraction(2) ** -rng.choice([0, 1, 2, 5, 20]) for _ in range(3)]
                best = winners(prepared, corners, weights, sense)
                assert not best or best & left, (made.to_json(), corners, weights)
    assert dropped > 20
