"""Curves in generic position: where two meet, and how one crosses vertical lines."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from functools import cmp_to_key

from flint import arb, ctx, fmpq, fmpq_poly, fmpz_poly

from harness.diagram.algebra import (
    FIRST_PRECISION,
    NotGeneric,
    Point,
    Polynomial,
    RealNumber,
    ball_sign,
    compare_numbers,
    in_u,
    precisions,
    real_numbers,
)
from harness.diagram.roots import real_root_balls

Strip = tuple[Point | None, Point | None]
"""The vertical strip between two points; None stands for ∓∞."""


def compare_points(p: Point, q: Point) -> int:
    """The sign of the difference of two points' numbers."""
    return compare_numbers(p.number, q.number)


def sort_by_u(points: Sequence[Point]) -> list[Point]:
    """The points in order of increasing u, in O(N log N) comparisons."""
    return sorted(points, key=cmp_to_key(compare_points))


def rational_between(low: Point | None, high: Point | None) -> fmpq:
    """A short rational strictly between u(low) and u(high); None stands for ∓∞."""
    for bits in precisions():
        with ctx.workprec(bits):
            left = low.number.ball(bits).upper().fmpq() if low else None
            right = high.number.ball(bits).lower().fmpq() if high else None
        if left is None:
            return fmpq(0) if right is None else fmpq(right.ceil() - 1)
        if right is None:
            return fmpq(left.floor() + 1)
        if left < right:
            return _short_rational(left, right)
    raise AssertionError


def _short_rational(low: fmpq, high: fmpq) -> fmpq:
    """The dyadic rational with the shortest fraction in the open interval (low, high)."""
    scale = fmpq(1)
    while True:
        candidate = (low * scale).floor() + 1
        if fmpq(candidate) / scale < high:
            return fmpq(candidate) / scale
        scale *= 2


def intersect(
    f: Polynomial,
    g: Polynomial,
    strip: Strip = (None, None),
    plausible: Callable[[arb, arb], bool] = lambda u, v: True,
) -> list[Point]:
    """The real points common to two curves without a common component, with u in the closed strip.

    The u of a common point is a root of the resultant.  Pseudo-division in v leads from f and g to
    a polynomial s(u)·v + r(u) in the ideal of f and g, so v = −r/s at every common point at which
    s does not vanish, and there is only one.  Where s vanishes, v is read off
    gcd(f(u, ·), g(u, ·)) over the field of u, which is (v − β)^k in generic position.

    ``plausible`` may be given enclosures of both coordinates of a common point and answers False
    only if the point is certainly of no interest; where it says so for all, the result is empty
    and the costly factorisation of the resultant is saved.

    Raises:
        NotGeneric: two common points share u.
    """
    low, high = strip
    resultant = in_u(f.mpoly.resultant(g.mpoly, "v"))
    if resultant == 0:
        raise ValueError("the curves share a component")
    linear = _linear_combination(f, g)
    if linear is not None and not _any_plausible(resultant, linear, strip, plausible):
        return []
    points = []
    for number in real_numbers(resultant):
        if low is not None and compare_numbers(number, low.number) < 0:
            continue
        if high is not None and compare_numbers(number, high.number) > 0:
            continue
        if linear is not None and number.sign_of(linear[1]):
            r, s = (fmpq_poly(c) for c in linear)
            points.append(Point(number, fmpq_poly([0, 1]), -r, s))
        else:
            common = _gcd_over_field(_reduce(f, number), _reduce(g, number), number.modulus)
            points.append(Point(number, fmpq_poly([0, 1]), _only_root(common, number.modulus)))
    return points


def _any_plausible(
    resultant: fmpz_poly,
    linear: tuple[fmpz_poly, fmpz_poly],
    strip: Strip,
    plausible: Callable[[arb, arb], bool],
) -> bool:
    """Whether some real root could be the u of a plausible point in the strip."""
    low, high = (end and end.number.ball(FIRST_PRECISION) for end in strip)
    with ctx.workprec(FIRST_PRECISION):
        for root in real_root_balls(resultant, FIRST_PRECISION):
            if (low is not None and root < low) or (high is not None and root > high):
                continue
            v = -linear[0](root) / linear[1](root)
            if not v.is_finite() or plausible(root, v):
                return True
    return False


def _linear_combination(f: Polynomial, g: Polynomial) -> tuple[fmpz_poly, fmpz_poly] | None:
    """(r, s) with r(u) + s(u)·v in the ideal of f and g; None if there is none of this degree."""
    high, low = sorted((f.rows, g.rows), key=len, reverse=True)
    while len(low) > 2:
        rest = list(high)
        while len(rest) >= len(low):
            lead, shift = rest[-1], len(rest) - len(low)
            rest = [c * low[-1] for c in rest]
            for k, c in enumerate(low):
                rest[shift + k] -= lead * c
            while rest and rest[-1] == 0:
                rest.pop()
        high, low = low, rest
    return (low[0], low[1]) if len(low) == 2 else None


def _reduce(f: Polynomial, number: RealNumber) -> list[fmpq_poly]:
    """The coefficients of f(α, v) in the field of α, lowest first, no zeros at the top."""
    return _strip([row % number.modulus for row in f.rational_rows])


def _strip(coefficients: list[fmpq_poly]) -> list[fmpq_poly]:
    while coefficients and coefficients[-1] == 0:
        coefficients.pop()
    return coefficients


def _monic(f: list[fmpq_poly], modulus: fmpq_poly) -> list[fmpq_poly]:
    unit, inverse, _ = f[-1].xgcd(modulus)
    scale = inverse / unit[0]
    return [c * scale % modulus for c in f]


def _gcd_over_field(f: list[fmpq_poly], g: list[fmpq_poly], modulus: fmpq_poly) -> list[fmpq_poly]:
    """Euclid's algorithm for polynomials in v over Q[t]/(modulus); the result is monic."""
    while g:
        g = _monic(g, modulus)
        f = list(f)
        while len(f) >= len(g):
            lead, shift = f[-1], len(f) - len(g)
            for k, c in enumerate(g):
                f[shift + k] = (f[shift + k] - lead * c) % modulus
            _strip(f)
        f, g = g, f
    return _monic(f, modulus)


def _only_root(f: list[fmpq_poly], modulus: fmpq_poly) -> fmpq_poly:
    """β where the monic f = (v − β)^k; NotGeneric if f has two different roots."""
    degree = len(f) - 1
    if degree < 1:
        raise ArithmeticError("a root of the resultant without a common point")
    root = (f[-2] / (-degree)) % modulus
    power = [fmpq_poly([1])]
    for _ in range(degree):
        shifted = [fmpq_poly([0]), *power]
        power = [
            (a - root * b) % modulus for a, b in zip(shifted, [*power, fmpq_poly([0])], strict=True)
        ]
    if power != f:
        raise NotGeneric("two common points of two curves share u")
    return root


def branches_around(f: Polynomial, p: Point, on_curve: bool = False) -> tuple[int, int]:
    """How many points of the curve f lie strictly below and above p on p's vertical line.

    p may lie on f (``on_curve``: it is known to).  With w = v − v(p), f on that line is Σ c_k w^k
    with c_k = ∂^k f/∂v^k / k! at p, so the exact signs of the derivatives decide: after dividing
    by w^m, m the multiplicity of p, the negative and positive roots of what is left are to be
    counted, which has degree at most 3.
    If all its roots are real, Descartes' rule of signs is exact; if two are not, only the sign of
    the product of the roots matters.
    """
    derivatives = [f]
    for _ in range(f.degree_v):
        derivatives.append(derivatives[-1].derivative)
    signs = [0 if on_curve else p.sign(f), *(p.sign(d) for d in derivatives[1:])]
    multiplicity = next(k for k, sign in enumerate(signs) if sign)
    rest = signs[multiplicity:]
    degree = len(rest) - 1
    if degree == 0:
        return 0, 0
    if degree >= 2 and not _all_roots_real(f, p, multiplicity, degree):
        if degree == 2:
            return 0, 0
        return (1, 0) if rest[0] == rest[-1] else (0, 1)
    nonzero = [sign for sign in rest if sign]
    above = sum(a != b for a, b in itertools.pairwise(nonzero))
    return degree - above, above


def _all_roots_real(f: Polynomial, p: Point, multiplicity: int, degree: int) -> bool:
    """Whether f on p's vertical line, divided by its zero at p, has only (simple) real roots."""
    if degree == 3:
        discriminant = p.number.sign_of(f.discriminant)
    else:
        discriminant = _quadratic_discriminant(f, p, multiplicity)
    if discriminant == 0:
        raise NotGeneric("a vertical tangent above or below a point of interest")
    return discriminant > 0


def _quadratic_discriminant(f: Polynomial, p: Point, multiplicity: int) -> int:
    """The sign of b² − 4ac for the quadratic that is left of f; 0 when it stays open."""
    for bits in precisions():
        if bits > 1 << 14:
            return 0
        u, v = p.balls(bits)
        with ctx.workprec(bits):
            quotient = [row(u) for row in f.rows]
            # Dividing by v − v(p) is known to leave no remainder, so dropping it is sound.
            for _ in range(multiplicity):
                quotient = _divide_out(quotient, v)
            c, b, a = quotient
            sign = ball_sign(b * b - 4 * a * c)
        if sign is not None:
            return sign
    return 0


def _divide_out(coefficients: list[arb], root: arb) -> list[arb]:
    quotient = [coefficients[-1]]
    for c in reversed(coefficients[1:-1]):
        quotient.append(quotient[-1] * root + c)
    return quotient[::-1]


def fibre_points(f: Polynomial, u: fmpq) -> list[Point]:
    """The real points of f on the line u = const (not a critical value), by increasing v."""
    numbers = real_numbers(f.on_fibre(u))
    numbers.sort(key=cmp_to_key(compare_numbers))
    return [Point(number, fmpq_poly([u]), fmpq_poly([0, 1])) for number in numbers]


def compare_with_rational(number: RealNumber, value: fmpq) -> int:
    """The sign of number − value, exactly."""
    return number.sign_of(fmpz_poly([-value.p, value.q]))
