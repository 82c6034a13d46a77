"""Enclosures of the real roots of integer polynomials, however far apart or close together.

FLINT isolates all complex roots of a polynomial at once and is fast where their sizes are
comparable and they are well apart.  Coordinates like 1e-300 beside 1 make roots whose sizes differ
by hundreds of powers of two, or that nearly coincide, and that iteration takes forever.  There the
real roots are isolated by bisection with Descartes' rule of signs (Vincent; Collins and Akritas
1976), in exact integer arithmetic.
"""

from __future__ import annotations

import itertools
import math

from flint import arb, ctx, fmpq, fmpz_poly

WILD = 400
"""The spread of root sizes, in powers of two, beyond which bisection takes over."""

MODERATE = 200
"""Roots are scaled first if their mean size is further from 1 than this power of two."""

LONG = 3000
"""Coefficients up to this many bits do not hide roots close enough to matter."""

CLOSE = 600
"""How much smaller, in powers of two, the product of all squared root distances may be than the
sizes of the roots suggest, before bisection takes over."""


def real_root_balls(polynomial: fmpz_poly, bits: int) -> list[arb]:
    """Enclosures of the distinct real roots, increasing and disjoint, to about ``bits`` bits.

    The number of roots found does not depend on ``bits``.
    """
    with ctx.workprec(bits):
        if polynomial.degree() == 1:
            c, b = polynomial.coeffs()
            return [arb(fmpq(-c, b))]
        polynomial, exponent = _of_moderate_size(polynomial)
        if _is_hard(polynomial):
            squarefree = _squarefree_part(polynomial)
            roots = [_refine(squarefree, *interval, bits) for interval in _isolate(squarefree)]
        else:
            roots = [z.real for z, _ in polynomial.complex_roots() if z.imag == 0]
        return [root * arb(2) ** exponent for root in sorted(roots, key=lambda root: root.mid())]


def _of_moderate_size(polynomial: fmpz_poly) -> tuple[fmpz_poly, int]:
    """(q, e) such that the roots of the polynomial are 2^e times those of q, about 1 in size."""
    sizes = _root_sizes(polynomial)
    exponent = round(sum(sizes) / len(sizes)) if sizes else 0
    if abs(exponent) <= MODERATE:
        return polynomial, 0
    degree = polynomial.degree()
    shifts = [exponent * i if exponent > 0 else -exponent * (degree - i) for i in range(degree + 1)]
    coefficients = [int(c) << k for c, k in zip(polynomial.coeffs(), shifts, strict=True)]
    common = math.gcd(*coefficients)
    return fmpz_poly([c // common for c in coefficients]), exponent


def _is_hard(polynomial: fmpz_poly) -> bool:
    """Whether roots differ wildly in size or nearly coincide (a question of speed only).

    lead^(2d−2) times the product of all squared root differences is the discriminant; were no two
    roots close, a difference would be about as large as the larger of the two roots.
    """
    sizes = _root_sizes(polynomial)
    if sizes and max(sizes) - min(sizes) > WILD:
        return True
    if polynomial.height_bits() <= LONG:
        return False
    squarefree = _squarefree_part(polynomial)
    sizes = _root_sizes(squarefree)
    if len(sizes) < 2:
        return False
    expected = (2 * len(sizes) - 2) * int(squarefree.leading_coefficient()).bit_length() + sum(
        2 * max(a, b) for a, b in itertools.combinations(sizes, 2)
    )
    return expected - int(squarefree.discriminant()).bit_length() > CLOSE


def _root_sizes(polynomial: fmpz_poly) -> list[float]:
    """log₂ of the absolute values of the nonzero complex roots, roughly.

    By the Newton polygon: minus the slopes of the upper hull of (i, log₂|c_i|), d of them.
    """
    points = [(i, int(c).bit_length()) for i, c in enumerate(polynomial.coeffs()) if c != 0]
    hull: list[tuple[int, int]] = []
    for x, y in points:
        while len(hull) >= 2:
            (x0, y0), (x1, y1) = hull[-2:]
            if (y1 - y0) * (x - x0) > (y - y0) * (x1 - x0):
                break
            hull.pop()
        hull.append((x, y))
    return [
        (a[1] - b[1]) / (b[0] - a[0])
        for a, b in itertools.pairwise(hull)
        for _ in range(b[0] - a[0])
    ]


def _squarefree_part(polynomial: fmpz_poly) -> fmpz_poly:
    squarefree = polynomial // polynomial.gcd(polynomial.derivative())
    return squarefree // squarefree.content()


def _isolate(polynomial: fmpz_poly) -> list[tuple[fmpq, fmpq]]:
    """Disjoint intervals [a, b], increasing, that hold one real root each of a squarefree p.

    Either a = b is the root, or the root lies in the open interval and p(a), p(b) ≠ 0.
    """
    rest, zero = polynomial, []
    if polynomial[0] == 0:
        zero = [(fmpq(0), fmpq(0))]
        rest = fmpz_poly(polynomial.coeffs()[1:])
    mirrored = rest(fmpz_poly([0, -1]))
    negative = [(-b, -a) for a, b in reversed(_isolate_positive(mirrored))]
    intervals = negative + zero + _isolate_positive(rest)
    return [_shrunk(polynomial, a, b) for a, b in intervals]


def _isolate_positive(polynomial: fmpz_poly) -> list[tuple[fmpq, fmpq]]:
    """Increasing intervals that hold one positive root each of a squarefree p with p(0) ≠ 0."""
    coefficients = [int(c) for c in polynomial.coeffs()]
    # Cauchy's bound: all roots are below 1 + max|c| / |lead| ≤ 2^size.
    size = max(c.bit_length() for c in coefficients) - abs(coefficients[-1]).bit_length() + 3
    size = max(size, 1)
    scaled = polynomial(fmpz_poly([0, 2**size]))
    found = []
    stack = [(scaled, fmpq(0), fmpq(2) ** size)]
    while stack:
        p, low, width = stack.pop()
        variations = _variations_on_unit_interval(p)
        if variations == 0:
            continue
        if variations == 1:
            found.append((low, low + width))
            continue
        degree = p.degree()
        left = fmpz_poly([c * 2 ** (degree - i) for i, c in enumerate(p.coeffs())])
        right = left(fmpz_poly([1, 1]))
        middle = low + width / 2
        if right[0] == 0:
            found.append((middle, middle))
            right = fmpz_poly(right.coeffs()[1:])
            left //= fmpz_poly([-1, 1])
        stack += [(left, low, width / 2), (right, middle, width / 2)]
    return sorted(found)


def _variations_on_unit_interval(p: fmpz_poly) -> int:
    """Descartes' bound for the roots in (0, 1): exact when it is 0 or 1."""
    reversed_p = fmpz_poly(list(reversed(p.coeffs())))
    signs = [c > 0 for c in reversed_p(fmpz_poly([1, 1])).coeffs() if c != 0]
    return sum(a != b for a, b in itertools.pairwise(signs))


def _shrunk(polynomial: fmpz_poly, low: fmpq, high: fmpq) -> tuple[fmpq, fmpq]:
    """The same root with p ≠ 0 at both ends (neighbouring roots may sit on them)."""
    if low == high:
        return low, high
    inside = _sign_just_right_of(polynomial, low)
    while polynomial(low) == 0 or polynomial(high) == 0:
        middle = (low + high) / 2
        value = polynomial(middle)
        if value == 0:
            return middle, middle
        if (value > 0) == (inside > 0):
            low = middle
        else:
            high = middle
    return low, high


def _sign_just_right_of(polynomial: fmpz_poly, x: fmpq) -> int:
    """The sign of p(x + ε)."""
    while (value := polynomial(x)) == 0:
        polynomial = polynomial.derivative()
    return 1 if value > 0 else -1


def _refine(polynomial: fmpz_poly, low: fmpq, high: fmpq, bits: int) -> arb:
    """Bisect an isolating interval until its relative width is 2^-bits."""
    if low == high:
        return arb(low)
    rising = polynomial(high) > 0
    tolerance = fmpq(1, 2**bits)
    while low * high <= 0 or high - low > tolerance * min(abs(low), abs(high)):
        middle = (low + high) / 2
        value = polynomial(middle)
        if value == 0:
            return arb(middle)
        if (value > 0) == rising:
            high = middle
        else:
            low = middle
    return arb(low).union(arb(high))
