"""What the leaves read off coefficients, against every cubic that the coefficients may stand for.

A claim about coefficients with an error bound is a claim about all cubics whose coefficients are
that near.  So cubics are drawn first as doubles and then shifted, coefficient by coefficient, by
as much as the error may be, mostly all of it; what holds is found in rational arithmetic, by
counting roots with Sturm's theorem and by evaluating.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

import flint
import numpy as np
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from harness.diagram.fast.forms import SIDES, STEPS, UNKNOWN, U
from harness.diagram.fast.leaves import (
    germ,
    has_cone,
    has_two_zeros,
    hull_determinant,
    is_radial,
    side_zero,
    sign_changes,
)
from tests.diagram.fast.exact_forms import CUBIC, bernstein, derivative, sign

#: Errors stay below (18 + 2d)/(24 + 2d) of the bound; the rest is for what follows.
SHARE = Fraction(19, 20)


@dataclass(frozen=True)
class Doubtful:
    """Coefficients as doubles, their signs and bound as ``cubic`` gives them; and the truth."""

    values: NDArray[np.float64]
    signs: NDArray[np.int64]
    bound: float
    exact: tuple[Fraction, ...]

    def side(self, k: int) -> list[Fraction]:
        return [self.exact[c] for c in SIDES[k].tolist()]


@st.composite
def doubtful(draw: st.DrawFn, structural: bool = True) -> Doubtful:
    small = st.integers(-4, 4)
    near_bound = st.builds(
        lambda s, e: s * (1 + e / 8), st.sampled_from([-1, 1]), st.integers(-1, 2)
    )
    bound = draw(st.sampled_from([1e-12, 2.0**-20, 1e-3, 0.25, 1.0]))
    values = np.empty(10)
    for c in range(10):
        values[c] = draw(st.one_of(small, small, near_bound.map(lambda x: x * bound)))
    if draw(st.booleans()):  # a side with a dip
        dip = SIDES[draw(st.integers(0, 2))]
        values[dip] = np.abs(values[dip]) * [1, -4, -4, 1]
    scale = 2.0 ** draw(st.sampled_from([0, -150, 150]))
    values, bound = values * scale, bound * scale
    signs = np.where(values > bound, 1, np.where(values < -bound, -1, UNKNOWN))
    exact = []
    for c in range(10):
        if structural and abs(values[c]) <= bound and draw(st.booleans()):
            values[c], signs[c] = 0.0, 0
            exact.append(Fraction(0))
        else:
            share = SHARE * Fraction(draw(st.sampled_from([-2, -1, 0, 1, 2])), 2)
            exact.append(Fraction(values[c]) + share * Fraction(bound))
    return Doubtful(values, signs.astype(np.int64), bound, tuple(exact))


def polynomial(side: Sequence[Fraction]) -> Any:
    """The polynomial in t with given Bernstein coefficients."""
    t, one = flint.fmpq_poly([0, 1]), flint.fmpq_poly([1])
    degree = len(side) - 1
    total = flint.fmpq_poly([0])
    weight = 1
    for k, value in enumerate(side):
        rational = flint.fmpq(value.numerator, value.denominator)
        total += weight * rational * t**k * (one - t) ** (degree - k)
        weight = weight * (degree - k) // (k + 1)
    return total


def zeros_inside(side: Sequence[Fraction]) -> int:
    """The number of different zeros in the open unit interval (Sturm); −1: all of it."""
    p = polynomial(side)
    if p == 0:
        return -1
    for point in (0, 1):  # zeros at the ends do not count
        factor = flint.fmpq_poly([-point, 1])
        while p.degree() > 0 and p(flint.fmpq(point)) == 0:
            p = p // factor
    chain = [p, p.derivative()]
    while chain[-1].degree() > 0:
        chain.append(-(chain[-2] % chain[-1]))
    values = [[q(flint.fmpq(point)) for q in chain if q != 0] for point in (0, 1)]
    changes = []
    for row in values:
        nonzero = [value > 0 for value in row if value != 0]
        changes.append(sum(int(x != y) for x, y in pairwise(nonzero)))
    return int(changes[0] - changes[1])


def test_zeros_are_counted() -> None:
    assert zeros_inside([Fraction(x) for x in (1, -3, 3, -1)]) == 3
    assert zeros_inside([Fraction(x) for x in (0, 1, -1, 0)]) == 1
    assert zeros_inside([Fraction(x) for x in (1, 1, 1, 1)]) == 0
    assert zeros_inside([Fraction(x) for x in (1, -2, 4, -8)]) == 1  # a triple zero
    assert zeros_inside([Fraction(x) for x in (1, 0, Fraction(-1, 3), 0)]) == 1  # and one at 1


# --- sides ---------------------------------------------------------------------------------------


@settings(max_examples=300)
@given(doubtful(), st.integers(0, 2))
def test_zeros_on_a_side(f: Doubtful, k: int) -> None:
    claimed = sign_changes(f.signs, f.values, f.bound, k)
    assert claimed in (-1, zeros_inside(f.side(k)))


@settings(max_examples=400)
@given(doubtful(), st.integers(0, 2))
def test_two_zeros_on_a_side(f: Doubtful, k: int) -> None:
    if has_two_zeros(f.values, f.bound, k):
        side = f.side(k)
        assert zeros_inside(side) == 2
        assert side[0] > 0
        assert side[3] > 0


@given(st.lists(st.integers(-20, 20), min_size=4, max_size=4), st.integers(0, 2))
def test_two_zeros_are_found_where_they_are_plain(side: list[int], k: int) -> None:
    """With hardly any error, and a dip that reaches one of fifteen places."""
    values = np.zeros(10)
    values[SIDES[k]] = side
    p = polynomial([Fraction(x) for x in side])
    dip = min(p(flint.fmpq(r, 16)) for r in range(1, 16))
    plain = side[0] > 0 and side[3] > 0 and dip < 0 and side[1] < 0 and side[2] < 0
    assert has_two_zeros(values, 1e-13, k) or not plain


@settings(max_examples=300)
@given(doubtful(), st.integers(0, 2), st.booleans())
def test_the_sign_near_an_end_of_a_side(f: Doubtful, k: int, at_end: bool) -> None:
    claimed = germ(f.signs, k, at_end)
    side = f.side(k)[::-1] if at_end else f.side(k)
    first = next((sign(value) for value in side if value != 0), 0)
    assert claimed in (UNKNOWN, first)


# --- gradients -----------------------------------------------------------------------------------


def controls_of(exact: Sequence[Fraction]) -> list[tuple[Fraction, Fraction]]:
    """The control vectors of the gradient."""
    return [
        (3 * (exact[x] - exact[base]), 3 * (exact[y] - exact[base]))
        for base, x, y in STEPS.tolist()
    ]


def cross(p: Sequence[Fraction], q: Sequence[Fraction]) -> Fraction:
    return p[0] * q[1] - p[1] * q[0]


def in_open_half_plane(vectors: Sequence[tuple[Fraction, Fraction]]) -> bool:
    """Whether one direction has a positive inner product with all vectors.

    That is so if and only if some vector has all others strictly within half a turn to its left,
    or along it.
    """

    def leads(v: tuple[Fraction, Fraction]) -> bool:
        return all(
            cross(v, w) > 0 or (cross(v, w) == 0 and v[0] * w[0] + v[1] * w[1] > 0) for w in vectors
        )

    return any(leads(v) for v in vectors)


PLACES = [
    (Fraction(a, 4), Fraction(b, 4), Fraction(4 - a - b, 4)) for a in range(5) for b in range(5 - a)
]


def rising(draw: st.DrawFn, f: Doubtful) -> Doubtful:
    """The cubic plus a linear form, so that cones are no accident."""
    slopes = draw(st.tuples(st.integers(-9, 9), st.integers(-9, 9)))
    scale = float(np.abs(f.values).max()) or 1.0
    steps = [(slopes[0] * j + slopes[1] * k) * scale for _, j, k in CUBIC]
    values = f.values + np.array(steps)
    shifts = [e - Fraction(v) for e, v in zip(f.exact, f.values.tolist(), strict=True)]
    exact = tuple(Fraction(v) + s for v, s in zip(values.tolist(), shifts, strict=True))
    # The bound is always at least 24u of what the coefficients may be.
    bound = max(f.bound, 24 * U * float(np.abs(values).max()))
    return Doubtful(values, np.full(10, UNKNOWN), bound, exact)


@st.composite
def sloping(draw: st.DrawFn) -> Doubtful:
    return rising(draw, draw(doubtful(structural=False)))


@settings(max_examples=300)
@given(doubtful(structural=False) | sloping())
def test_a_cone_is_one(f: Doubtful) -> None:
    controls = np.empty((6, 2))
    if has_cone(f.values, f.bound, controls):
        assert in_open_half_plane(controls_of(f.exact))
        gradients = [tuple(derivative(f.exact, axis, p) for axis in (1, 2)) for p in PLACES]
        assert in_open_half_plane(gradients)  # type: ignore[arg-type]  # pairs


@given(st.integers(-9, 9), st.integers(-9, 9), st.integers(0, 2**10))
def test_a_cone_is_seen_on_linear_forms(x: int, y: int, noise: int) -> None:
    assume((x, y) != (0, 0))
    values = np.array([float(x * j + y * k) for _, j, k in CUBIC])
    assert has_cone(values, 1e-6 + noise * 1e-9, np.empty((6, 2)))


@settings(max_examples=300)
@given(doubtful(structural=False) | sloping(), doubtful(structural=False) | sloping())
def test_determinants_in_the_hull(f: Doubtful, g: Doubtful) -> None:
    one, two = np.empty((6, 2)), np.empty((6, 2))
    has_cone(f.values, f.bound, one)
    has_cone(g.values, g.bound, two)
    least = Fraction(hull_determinant(one, two, f.bound, g.bound))
    if least != 0:
        for v in controls_of(f.exact):
            for w in controls_of(g.exact):
                assert cross(v, w) * sign(least) >= abs(least)
        # Between any two points the mean gradients are in the hulls; here, at points.
        for p in PLACES[::3]:
            slopes = [[derivative(h.exact, axis, p) for axis in (1, 2)] for h in (f, g)]
            assert cross(*slopes) * sign(least) >= abs(least)


@given(st.lists(st.integers(-3, 3), min_size=4, max_size=4))
@example([1, 0, 0, 1])
def test_determinants_are_seen_on_linear_forms(m: list[int]) -> None:
    (a, b, c, d) = m
    f = np.array([float(a * j + b * k) for _, j, k in CUBIC])
    g = np.array([float(c * j + d * k) for _, j, k in CUBIC])
    one, two = np.empty((6, 2)), np.empty((6, 2))
    has_cone(f, 1e-12, one)
    has_cone(g, 1e-12, two)
    found = hull_determinant(one, two, 1e-12, 1e-12)
    assert abs(found - 9 * (a * d - b * c)) < 1e-6


# --- double zeros at a corner --------------------------------------------------------------------


@st.composite
def with_double_zero(draw: st.DrawFn) -> tuple[Doubtful, int]:
    corner = draw(st.integers(0, 2))
    f = draw(doubtful())
    values, signs, exact = f.values.copy(), f.signs.copy(), list(f.exact)
    for c, index in enumerate(CUBIC):
        if index[corner] >= 2:
            values[c], signs[c], exact[c] = 0.0, 0, Fraction(0)
    return Doubtful(values, signs, f.bound, tuple(exact)), corner


@settings(max_examples=300)
@given(with_double_zero())
def test_rays_from_a_double_zero(made: tuple[Doubtful, int]) -> None:
    f, corner = made
    if not is_radial(f.signs, corner):
        return
    at = dict(zip(CUBIC, f.exact, strict=True))

    def along(index: int, far: int) -> tuple[int, int, int]:
        """λ-exponents: 1 or 0 at the corner, the rest on the two ends of the far side."""
        order = [0, 0, 0]
        order[corner] = 3 - far
        order[(corner + 1) % 3], order[(corner + 2) % 3] = far - index, index
        return order[0], order[1], order[2]

    near = [at[along(r, 2)] for r in range(3)]
    far = [at[along(r, 3)] for r in range(4)]
    assert zeros_inside(near) in (-1, 0, 1)
    assert zeros_inside(far) in (-1, 0, 1)
    for r in range(1, 12):
        t = Fraction(r, 12)
        point = [Fraction(0)] * 3
        point[(corner + 1) % 3], point[(corner + 2) % 3] = 1 - t, t

        def on_ray(s: Fraction, point: list[Fraction] = point) -> Fraction:
            weights = [s * x for x in point]
            weights[corner] += 1 - s
            return Fraction(bernstein(f.exact, CUBIC, weights))

        # On the ray F = s²(α + sβ): the sign changes as often as α and α + β say.
        ray = [on_ray(Fraction(s, 16)) for s in range(1, 17)]
        signs = [sign(value) for value in ray if value != 0]
        assert sum(x != y for x, y in pairwise(signs)) <= 1


def test_a_corner_without_a_double_zero_is_not_radial() -> None:
    signs = np.ones(10, np.int64)
    assert not any(is_radial(signs, corner) for corner in range(3))


@example(magnitudes=[0.30199, 0.48954, 6.54e-6, 1.82e-15], signs=[1, 1], k=0, rising=True)
@example(magnitudes=[1.0, 1e-18, 1e-18, 3e-15], signs=[-1, 1], k=1, rising=False)
@given(
    st.lists(st.floats(1e-18, 1.0), min_size=4, max_size=4),
    st.lists(st.sampled_from([-1, 1]), min_size=2, max_size=2),
    st.integers(0, 2),
    st.booleans(),
)
def test_a_zero_on_a_side_is_found_however_different_its_ends(
    magnitudes: list[float], signs: list[int], k: int, rising: bool
) -> None:
    """Its sign changes within 1e-12, or it is a rounding there."""
    way = 1 if rising else -1
    inner = [sign * m for sign, m in zip(signs, magnitudes[1:3], strict=True)]
    side = [-way * magnitudes[0], *inner, way * magnitudes[3]]
    values = np.zeros(10)
    values[SIDES[k]] = side
    found = side_zero(values, k, rising)

    def exact(t: Fraction) -> Fraction:
        a, b, c, d = map(Fraction, side)
        s = 1 - t
        return way * (s**3 * a + 3 * s * s * t * b + 3 * s * t * t * c + t**3 * d)

    at = Fraction(found)
    near = Fraction(1, 10**12)
    changes = exact(max(at - near, Fraction(0))) <= 0 <= exact(min(at + near, Fraction(1)))
    assert changes or abs(exact(at)) <= 16 * U * max(magnitudes)
