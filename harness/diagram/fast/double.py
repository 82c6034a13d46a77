"""Double-double arithmetic: a number is the unevaluated sum of two doubles, high and low.

With u = 2⁻⁵³ and barring underflow the relative errors are at most 3u² + 13u³ for a sum and 5u² for
a product (Joldes, Muller & Popescu, Tight and rigorous error bounds for basic building blocks of
double-word arithmetic, ACM TOMS 44, 2017).
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic

from harness.diagram.fast.jit import compiled

#: Stands for a number that rounded to zero but is not known to be zero: below all error bounds.
TINY = 1e-100


@intrinsic  # type: ignore[untyped-decorator]  # numba has no types
def fma(typing_context: Any, x: Any, y: Any, z: Any) -> Any:
    """x·y + z, rounded once."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    del typing_context, x, y, z
    return types.float64(types.float64, types.float64, types.float64), generate


@compiled
def sum_of(a, b):
    """a + b of two doubles, exactly."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


@compiled
def plus(ah, al, bh, bl):
    """a + b."""
    s, e = sum_of(ah, bh)
    t, f = sum_of(al, bl)
    e += t
    h = s + e
    e = e - (h - s) + f
    r = h + e
    return r, e - (r - h)


@compiled
def times(ah, al, bh, bl):
    """a·b."""
    p = ah * bh
    e = fma(ah, bh, -p)
    e = fma(ah, bl, e)
    e = fma(al, bh, e)
    h = p + e
    return h, e - (h - p)


@compiled
def plus_product(sh, sl, ah, al, bh, bl):
    """s + a·b."""
    ph, pl = times(ah, al, bh, bl)
    return plus(sh, sl, ph, pl)
