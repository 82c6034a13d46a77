"""Enclosures of the real roots of integer polynomials."""

from __future__ import annotations

from flint import arb, ctx, fmpq, fmpz_poly


def real_root_balls(polynomial: fmpz_poly, bits: int) -> list[arb]:
    """Enclosures of the distinct real roots, increasing and disjoint, to about ``bits`` bits.

    FLINT isolates all complex roots with as much precision as that takes; the imaginary part of
    an enclosure is exactly zero if and only if the root is real.  Roots that agree to hundreds of
    bits cost seconds, which is why the builder limits the coordinates' span.
    """
    with ctx.workprec(bits):
        if polynomial.degree() == 1:
            c, b = polynomial.coeffs()
            return [arb(fmpq(-c, b))]
        roots = [z.real for z, _ in polynomial.complex_roots() if z.imag == 0]
    return sorted(roots, key=lambda root: root.mid())
