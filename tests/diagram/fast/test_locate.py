"""Points of a fast map: located in the cells that the reference has there; zeros are isolated."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction

import flint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram.checks import _open_contests
from harness.diagram.counts import OBJECTIVES
from harness.diagram.fast.univariate import isolated_zeros
from harness.geometry.predicates import compare_visual_angles
from tests.diagram.fast.both_builders import CASES, both
from tests.diagram.fast.sources import instance

# --- zeros ---------------------------------------------------------------------------------------


def bernstein_with_zeros(zeros: list[Fraction], factor: int) -> list[int]:
    """The Bernstein coefficients, times an integer, of a cubic with three given zeros."""
    t = flint.fmpq_poly([factor])
    for zero in zeros:
        t *= flint.fmpq_poly([flint.fmpq(-zero.numerator, zero.denominator), 1])
    a, b, c, d = (t[k] for k in range(4))
    row = [a, a + b / 3, a + 2 * b / 3 + c / 3, a + b + c + d]
    unit = flint.fmpq(3)
    for value in row:
        unit *= value.denom()
    return [int((unit * value).p) for value in row]


rationals = st.builds(Fraction, st.integers(-30, 60), st.integers(1, 30))
near = st.builds(lambda x, e: x + Fraction(1, 2**e), rationals, st.integers(20, 200))
#: Inside, and no halving hits them.
thirds = st.builds(lambda k, m: Fraction(3 * k + 1, 3 * 2**m), st.integers(0, 7), st.integers(3, 9))


@settings(max_examples=150)
@given(st.lists(rationals | near, min_size=3, max_size=3, unique=True), st.sampled_from([1, -7]))
def test_zeros_are_isolated(zeros: list[Fraction], factor: int) -> None:
    """However near together, and beside zeros at the ends or outside."""
    found = isolated_zeros(bernstein_with_zeros(zeros, factor))
    inside = sorted(zero for zero in zeros if 0 < zero < 1)
    assert len(found) == len(inside)
    for zero, truth in zip(found, inside, strict=True):
        zero.narrow(250)
        assert zero.low < truth < zero.high or zero.low == truth == zero.high
        assert zero.high - zero.low <= Fraction(1, 2**250)


@given(thirds, rationals)
def test_double_zeros_are_refused(double: Fraction, other: Fraction) -> None:
    b = bernstein_with_zeros([double, double, other], 1)
    with pytest.raises(ArithmeticError):
        isolated_zeros(b)


# --- cells ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_points_are_located_as_by_the_reference(name: str) -> None:
    """In corresponding cells, one to one; near nodes, where many cells meet, above all."""
    fast, reference = both(name)
    rng = random.Random(name)
    nodes = [node.point for node in fast.nodes if node.kind != "infinity"]
    points = [point for point, _ in (*fast.witnesses, *reference.witnesses)]
    for x, y in rng.choices(nodes, k=40):
        reach = 2.0 ** -rng.randint(0, 30)
        points.append((Fraction(x + rng.gauss(0, reach)), Fraction(y + rng.gauss(0, reach))))
    pairs = set(zip(fast.locate(points), reference.locate(points), strict=True))
    assert len({one for one, _ in pairs}) == len(pairs) == len({other for _, other in pairs})
    assert {one for one, _ in pairs} >= set(range(len(fast.cells)))
    for one, other in pairs:
        if one is not None and other is not None and one >= 0:
            assert fast.cells[one].segment == reference.cells[other].segment


@pytest.mark.parametrize("name", CASES)
def test_witnesses_are_in_their_cells(name: str) -> None:
    fast, _ = both(name)
    assert fast.locate([point for point, _ in fast.witnesses]) == [c for _, c in fast.witnesses]
    assert {c for _, c in fast.witnesses} >= set(range(len(fast.cells)))


# --- the contests of the checks ------------------------------------------------------------------


@pytest.mark.parametrize("source", ["segments", "rational", "far", "nudged", "tiny"])
def test_contests_that_are_not_left_open_are_won(source: str) -> None:
    rng = random.Random(source)
    left = 0
    for index in range(12):
        made = instance(source, 4, index)
        # Only the instance and the objective matter.
        diagram = replace(both("across")[0], instance=made, objective=OBJECTIVES[index % 2])
        segments = made.rational_segments()
        size = max(abs(x) for s in segments for p in s for x in p)
        points, owners = [], []
        for _ in range(40):
            x, y = rng.choice(rng.choice(segments))
            reach = float(size) * 2.0 ** -rng.randint(0, 60)
            points.append(
                (x + Fraction(rng.uniform(-1, 1) * reach), y + Fraction(rng.random() * reach))
            )
            owners.append(rng.randrange(made.n))
        found = set(_open_contests(diagram, points, owners))
        sense = 1 if diagram.objective == "smallest" else -1
        for row, (point, owner) in enumerate(zip(points, owners, strict=True)):
            for k in range(made.n):
                if k != owner and (row, k) not in found:
                    order = compare_visual_angles(point, segments[owner], segments[k])
                    assert order is not None
                    assert order * sense < 0
                    left += 1
    assert left > 50
