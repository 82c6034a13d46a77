"""Lattices of equal segments: ties of whole rows, at infinity and on mirror axes."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import combinations, product
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.counts import OBJECTIVES, Objective
from harness.diagram.fast.forms import relation
from harness.diagram.fast.map import build_fast
from harness.diagram.fast.rows import are_apart, halving_directions, ties_at_infinity
from harness.diagram.fast.ties import tie_arrays
from harness.diagram.planar_map import PlanarMap
from harness.geometry.instance import Instance
from tests.diagram.same_map import differences

Vector = tuple[int, int]


def lattice(columns: int, rows: int, one: Vector, two: Vector, *vectors: Vector) -> list[Any]:
    """Segments with the given vectors at every point of a lattice."""
    starts = [
        (x * one[0] + y * two[0], x * one[1] + y * two[1])
        for x, y in product(range(columns), range(rows))
    ]
    return [((x, y), (x + v[0], y + v[1])) for v in vectors for x, y in starts]


def moved(made: list[Any], change: Callable[[int, int], tuple[int, int]]) -> Instance:
    return Instance.from_arrays("segments", [[change(*p) for p in segment] for segment in made])


def same(x: int, y: int) -> tuple[int, int]:
    return x, y


SQUARE = lattice(7, 7, (4, 0), (0, 4), (1, 0))
#: Too many for the reference builder: what is not certified here is refused.
LARGE: dict[str, list[Any]] = {
    "square": SQUARE,
    "sheared": lattice(6, 6, (4, 0), (1, 4), (1, 0)),
    "sheared twice": lattice(6, 6, (4, 1), (1, 3), (1, 0)),
    "slanted": lattice(6, 6, (4, 0), (0, 4), (2, 1)),
    "pluses": lattice(5, 5, (4, 0), (0, 4), (1, 0), (0, 1)),
    "streets": lattice(4, 5, (1, 0), (0, 1), (1, 0)) + lattice(5, 4, (1, 0), (0, 1), (0, 1)),
    "row": lattice(40, 1, (3, 0), (0, 1), (1, 0)),
    "column": lattice(1, 40, (3, 0), (0, 3), (1, 0)),
}


def certified(made: Instance, objective: Objective = "smallest") -> PlanarMap:
    """The fast builder's own map: nothing is handed over."""
    found = build_fast(made, "plane", objective, [])
    found.sanity_check()
    assert found.certified
    assert found.work is not None
    assert found.work.triangles > 0
    return found


@pytest.mark.parametrize("name", LARGE)
def test_large_lattices_are_certified(name: str) -> None:
    certified(moved(LARGE[name], same))


def test_a_turned_lattice_has_the_same_counts() -> None:
    counts = [
        certified(moved(SQUARE, change)).counts
        for change in (
            same,
            lambda x, y: (3 * x - 4 * y, 4 * x + 3 * y),
            lambda x, y: (x - y, x + y),
        )
    ]
    assert counts[0] == counts[1] == counts[2]


SMALL: dict[str, list[Any]] = {
    "two by two": lattice(2, 2, (4, 0), (0, 4), (1, 0)),
    "sheared": lattice(3, 2, (4, 0), (1, 4), (1, 0)),
    "slanted": lattice(2, 3, (4, 0), (0, 4), (2, 1)),
    "pluses": lattice(2, 2, (4, 0), (0, 4), (1, 0), (0, 1)),
    "turned": [((4 * x, 3 * y), (4 * x + 2, 3 * y + 1)) for x, y in product(range(2), range(3))],
}


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("name", SMALL)
def test_small_lattices_are_those_of_the_reference(name: str, objective: Objective) -> None:
    made = moved(SMALL[name], same)
    assert (
        differences(certified(made, objective), build(made, "plane", objective, "reference")) == []
    )


# --- what ties at infinity -----------------------------------------------------------------------


def _second_order(made: Instance, i: int, j: int, d: Any) -> Fraction:
    """F_ij of segments with one vector in the direction d, to first order in w; see ``ties``."""
    (a, b), (c, e) = made.rational_segment(i), made.rational_segment(j)
    v = b[0] - a[0], b[1] - a[1]
    delta = a[0] + b[0] - c[0] - e[0], a[1] + b[1] - c[1] - e[1]
    square, along = d[0] ** 2 + d[1] ** 2, delta[0] * d[0] + delta[1] * d[1]
    return square * (v[0] * delta[1] - v[1] * delta[0]) + 2 * along * (d[0] * v[1] - d[1] * v[0])


@pytest.mark.parametrize("name", ["square", "slanted", "sheared twice", "pluses"])
def test_rows_tie_in_their_directions(name: str) -> None:
    made = moved(LARGE[name], same)
    known = ties_at_infinity(made)
    assert len(known) >= 4
    for d, ties in known.items():
        for i, j, which in ties:
            assert i < j
            (a, b), (c, e) = made.rational_segment(i), made.rational_segment(j)
            v, w = (b[0] - a[0], b[1] - a[1]), (e[0] - c[0], e[1] - c[1])
            if which in (1, 2):
                sign = 1 if which == 1 else -1
                assert d[0] * v[1] - d[1] * v[0] == sign * (d[0] * w[1] - d[1] * w[0])
            else:
                assert w == (v if which == 4 else (-v[0], -v[1]))
                assert abs(_second_order(made, i, j, d)) < Fraction(1, 2**500)


def test_irrational_directions_are_rounded_and_others_are_not() -> None:
    exact = set(ties_at_infinity(moved(SQUARE, same)))
    assert exact == {(x, y) for x, y in product((-1, 0, 1), repeat=2) if (x, y) != (0, 0)} - {
        (1, 0),
        (-1, 0),
    }
    rounded = ties_at_infinity(moved(LARGE["slanted"], same))
    assert any(x.denominator.bit_length() > 500 for d in rounded for x in d)


def test_directions_too_close_to_one_of_a_row_are_noticed() -> None:
    near = Fraction(1, 2**300)
    d = next(
        halving_directions(
            (Fraction(1), Fraction(0)), (Fraction(0), Fraction(1)), lambda _: Fraction(1)
        )
    )
    assert not are_apart(d, (d[0], d[1] + near))
    assert are_apart(d, (-d[0], -d[1]))
    assert are_apart((Fraction(1), Fraction(0)), (Fraction(1), Fraction(1, 2**100)))


@given(st.data())
def test_ties_are_found_among_many(data: Any) -> None:
    pairs = list(combinations(range(7), 2))
    ties = {
        (corner, *pair, data.draw(st.sampled_from([1, 2, 3, 4, 8])))
        for corner in range(2)
        for pair in data.draw(st.sets(st.sampled_from(pairs)))
    }
    first, rows = tie_arrays(ties, 2)
    known = {(corner, i, j): which for corner, i, j, which in ties}
    classes = np.full(7, -1)
    for (i, j), corner in product(pairs, range(2)):
        spots = np.array([-1, corner, -1])
        which = known.get((corner, i, j), 0)
        bits = sum((which >> b & 1) << (2 + 3 * b) for b in range(4))
        assert relation(i, j, classes, first, rows, spots) == bits
        assert relation(j, i, classes, first, rows, spots) == bits
