"""Exact points of plane curves: real algebraic numbers, signs, intersections, fibres.

Everything the reference builder decides is one of three questions about integer polynomials in two
variables (u, v): what sign has G at a point, where do two curves meet, how many branches of a curve
lie below a point on the same vertical line u = const.

A point is kept as one real number t, the k-th real root of an irreducible integer polynomial g,
and polynomials U, N, D with rational coefficients: the point is (U(t), N(t)/D(t)).  So all
coordinates live in the field Q(t) = Q[t]/(g), and

* *zero* is decided exactly: the numerator of G(U, N/D) is divisible by g or it is not;
* a *sign* that is not zero is found by evaluating with balls of growing precision, which ends.

Curves are used in **generic position**: no two points of interest share u and no curve has a
vertical asymptote.  Whoever breaks that promise gets :class:`NotGeneric`, and the builder starts
again with another shear; nothing is ever decided on the strength of the promise alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property, lru_cache
from math import lcm

from flint import (
    arb,
    ctx,
    fmpq,
    fmpq_mpoly_ctx,
    fmpq_poly,
    fmpz_mpoly,
    fmpz_mpoly_ctx,
    fmpz_poly,
)

from harness.diagram.roots import real_root_balls

ONE = fmpq_poly([1])
RING = fmpz_mpoly_ctx.get(("u", "v"), "lex")
RATIONAL_RING = fmpq_mpoly_ctx.get(("u", "v"), "lex")
U, V = RING.gens()
FIRST_PRECISION = 96
LAST_PRECISION = 1 << 20


class NotGeneric(Exception):
    """Two points of interest share u, or a curve has a vertical asymptote: shear differently."""


def precisions() -> Iterator[int]:
    """Working precisions in bits, doubling; gives up (a defect, not a verdict) at a megabit."""
    bits = FIRST_PRECISION
    while bits <= LAST_PRECISION:
        yield bits
        bits *= 2
    raise ArithmeticError("a sign could not be decided with 2^20 bits")


def ball_sign(value: arb) -> int | None:
    """+1 or −1 where the ball proves it, 0 where it is exactly zero, None where it is open."""
    if value > 0:
        return 1
    if value < 0:
        return -1
    return 0 if value.is_zero() else None


Key = tuple[tuple[int, ...], int]
"""What a real algebraic number is known by: its polynomial's coefficients and its index."""


class RealNumber:
    """The ``index``-th real root (from 0, increasing) of an irreducible integer polynomial."""

    __slots__ = ("index", "key", "modulus", "polynomial")

    def __init__(self, polynomial: fmpz_poly, index: int) -> None:
        """``polynomial`` must be irreducible and primitive with a positive leading coefficient."""
        self.polynomial = polynomial
        self.index = index
        self.modulus = fmpq_poly(polynomial)
        self.key: Key = (tuple(int(c) for c in polynomial.coeffs()), index)

    def ball(self, bits: int) -> arb:
        """An enclosure of the number computed with ``bits`` bits."""
        return _real_roots(self.key[0], bits)[self.index]

    def sign_of(self, polynomial: fmpz_poly) -> int:
        """The exact sign of a univariate integer polynomial at this number."""
        if fmpq_poly(polynomial) % self.modulus == 0:
            return 0
        for bits in precisions():
            with ctx.workprec(bits):
                sign = ball_sign(polynomial(self.ball(bits)))
            if sign is not None:
                return sign
        raise AssertionError  # precisions() raises first


@lru_cache(maxsize=200_000)
def _real_roots(coefficients: tuple[int, ...], bits: int) -> tuple[arb, ...]:
    """Disjoint enclosures of the real roots of a squarefree integer polynomial, increasing."""
    return tuple(real_root_balls(fmpz_poly(list(coefficients)), bits))


def real_numbers(polynomial: fmpz_poly) -> list[RealNumber]:
    """The real roots of an integer polynomial, without multiplicity, in no particular order."""
    found: list[RealNumber] = []
    for factor, _ in polynomial.factor()[1]:
        irreducible = -factor if factor.leading_coefficient() < 0 else factor
        coefficients = tuple(int(c) for c in irreducible.coeffs())
        count = len(_real_roots(coefficients, FIRST_PRECISION))
        found += [RealNumber(irreducible, index) for index in range(count)]
    return found


def irreducible_factors(mpoly: fmpz_mpoly) -> list[fmpz_mpoly]:
    """Each irreducible factor of an element of :data:`RING` once, but no constants."""
    try:
        return [factor for factor, _ in mpoly.factor()[1]]
    except OverflowError:
        # To put factors in order, python-flint takes coefficients for machine integers; rationals
        # it compares as such.
        rational = RATIONAL_RING.from_dict({m: fmpq(c) for m, c in mpoly.to_dict().items()})
        found = []
        for factor, _ in rational.factor()[1]:
            terms = factor.to_dict()
            common = lcm(*(int(c.q) for c in terms.values()))
            integral = RING.from_dict({m: int(c * common) for m, c in terms.items()})
            found.append(integral.primitive()[1])
        return found


class Polynomial:
    """An integer polynomial in (u, v): ``rows[k]`` is the coefficient of v^k, a polynomial in u."""

    def __init__(self, mpoly: fmpz_mpoly) -> None:
        """Wrap an element of :data:`RING`."""
        self.mpoly = mpoly
        degree_u, degree_v = (int(d) for d in mpoly.degrees())
        table = [[0] * (degree_u + 1) for _ in range(degree_v + 1)]
        for (i, k), coefficient in mpoly.to_dict().items():
            table[k][i] = int(coefficient)
        self.rows = [fmpz_poly(row) for row in table]

    @property
    def degree_v(self) -> int:
        """The degree in v."""
        return len(self.rows) - 1

    @cached_property
    def derivative(self) -> Polynomial:
        """∂/∂v."""
        return Polynomial(self.mpoly.derivative("v"))

    @cached_property
    def discriminant(self) -> fmpz_poly:
        """The discriminant with respect to v, a polynomial in u."""
        if self.degree_v < 2:
            return fmpz_poly([1])
        return in_u(self.mpoly.discriminant("v"))

    @cached_property
    def rational_rows(self) -> list[fmpq_poly]:
        """``rows`` over the rationals."""
        return [fmpq_poly(row) for row in self.rows]

    def at_balls(self, u: arb, v: arb) -> arb:
        """Enclosure of the value at (u, v), by Horner's rule."""
        value = self.rows[-1](u)
        for row in reversed(self.rows[:-1]):
            value = value * v + row(u)
        return value

    def on_fibre(self, u: fmpq) -> fmpz_poly:
        """The polynomial in v on the line u = const, denominators cleared by a positive factor."""
        return fmpq_poly([row(u) for row in self.rows]).numer()

    def on_horizontal(self, v: fmpq) -> fmpz_poly:
        """The polynomial in u on the line v = const, up to a positive factor."""
        value = fmpq_poly([0])
        for row in reversed(self.rational_rows):
            value = value * v + row
        return value.numer()

    def roots_on_fibre(self, u: fmpq) -> int:
        """How many real points the curve has on u = const, which must not be a critical value."""
        if self.degree_v == 1:
            return 1
        positive = self.discriminant(u) > 0
        return (3 if positive else 1) if self.degree_v == 3 else (2 if positive else 0)


def in_u(mpoly: fmpz_mpoly) -> fmpz_poly:
    """A polynomial in (u, v) that is free of v, as a polynomial in u."""
    terms = {int(i): int(c) for (i, _), c in mpoly.to_dict().items()}
    return fmpz_poly([terms.get(i, 0) for i in range(max(terms, default=0) + 1)])


class Point:
    """The point (U(t), N(t)/D(t)): t a real algebraic number, U, N, D rational polynomials."""

    __slots__ = ("_balls", "denominator", "number", "numerator", "u")

    def __init__(
        self, number: RealNumber, u: fmpq_poly, v: fmpq_poly, denominator: fmpq_poly = ONE
    ) -> None:
        """``v`` and ``denominator`` are N and D; D must not vanish at the number."""
        self.number = number
        self.u = u % number.modulus
        self.numerator = v % number.modulus
        self.denominator = denominator % number.modulus
        self._balls: dict[int, tuple[arb, arb]] = {}

    @classmethod
    def rational(cls, u: fmpq, v: fmpq) -> Point:
        """The point with the given rational coordinates; its number is u itself."""
        number = RealNumber(fmpz_poly([-u.p, u.q]), 0)
        return cls(number, fmpq_poly([u]), fmpq_poly([v]))

    @property
    def coordinates(self) -> tuple[fmpq, fmpq]:
        """(u, v) of a point made by :meth:`rational`."""
        return self.u[0], self.numerator[0] / self.denominator[0]

    def balls(self, bits: int) -> tuple[arb, arb]:
        """Enclosures of both coordinates computed with ``bits`` bits."""
        if bits not in self._balls:
            with ctx.workprec(bits):
                t = self.number.ball(bits)
                v = _horner(self.numerator, t) / _horner(self.denominator, t)
                self._balls[bits] = (_horner(self.u, t), v)
        return self._balls[bits]

    def is_same_place(self, other: Point) -> bool:
        """Whether two points with the same number, and so the same u, are equal."""
        cross = self.numerator * other.denominator - other.numerator * self.denominator
        return bool(cross % self.number.modulus == 0)

    def compare_v(self, other: Point) -> int:
        """The sign of v − v(other) for two points with the same number."""
        if self.is_same_place(other):
            return 0
        for bits in precisions():
            with ctx.workprec(bits):
                sign = ball_sign(self.balls(bits)[1] - other.balls(bits)[1])
            if sign is not None:
                return sign
        raise AssertionError  # precisions() raises first

    def multiplicity_on(self, f: Polynomial) -> int:
        """How often v is a zero of f on the vertical line through this point."""
        order = 0
        while self.sign(f) == 0:
            f, order = f.derivative, order + 1
        return order

    def is_zero_of(self, polynomial: Polynomial) -> bool:
        """Decide exactly whether the polynomial vanishes here."""
        modulus = self.number.modulus
        value, power = fmpq_poly([0]), ONE
        for row in reversed(polynomial.rational_rows):
            value = (value * self.numerator + row(self.u) * power) % modulus
            power = power * self.denominator % modulus
        return bool(value == 0)

    def sign(self, polynomial: Polynomial) -> int:
        """The exact sign of the polynomial here: −1, 0 or +1."""
        for attempt, bits in enumerate(precisions()):
            u, v = self.balls(bits)
            with ctx.workprec(bits):
                sign = ball_sign(polynomial.at_balls(u, v))
            if sign is not None:
                return sign
            if attempt == 0 and self.is_zero_of(polynomial):
                return 0
        raise AssertionError  # precisions() raises first

    def floats(self) -> tuple[float, float]:
        """Both coordinates (u, v) rounded to doubles."""
        u, v = self.balls(2 * FIRST_PRECISION)
        return float(u.mid()), float(v.mid())


def _horner(polynomial: fmpq_poly, t: arb) -> arb:
    value = arb(0)
    for coefficient in reversed(polynomial.coeffs()):
        value = value * t + arb(coefficient)
    return value


def compare_numbers(a: RealNumber, b: RealNumber) -> int:
    """The sign of a − b: two numbers are equal exactly if polynomial and index are."""
    if a.key == b.key:
        return 0
    for bits in precisions():
        with ctx.workprec(bits):
            sign = ball_sign(a.ball(bits) - b.ball(bits))
        if sign is not None:
            return sign
    raise AssertionError
