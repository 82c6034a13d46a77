"""Where two cubics in Bernstein form vanish together in a triangle."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement

import numpy as np

from harness.diagram.fast.forms import gradient_controls, value_and_gradient
from harness.diagram.fast.leaves import hull_determinant
from harness.diagram.fast.pairs import polar
from harness.diagram.fast.prepare import Floats

#: Starts of Newton's method if the leaf's own fails.
_STARTS = [((k + 0.5) / 8, (m + 0.5) / 8) for k in range(8) for m in range(8 - k)]


def independence(cubics: Floats) -> float:
    """The least |det| of gradients of two cubics (2, 10) over the triangle, relative to their
    sizes; if it is positive, they have one common zero at most."""
    controls = np.zeros((2, 6, 2))
    for cubic, gradients in zip(cubics, controls, strict=True):
        gradient_controls(cubic, gradients)
    largest = np.abs(controls).max(axis=(1, 2))
    return abs(float(hull_determinant(controls[0], controls[1], 0.0, 0.0))) / float(largest.prod())


#: So far outside the triangle's box Newton's method may go.
_BESIDE = 0.25
#: Halvings after which the search for a zero ends.
_HALVINGS = 24
#: The corners, with repetition, of the ten coefficients of a cubic.
_INDICES = tuple(combinations_with_replacement(range(3), 3))


def common_zero(f: Floats, g: Floats, guess: Sequence[float]) -> tuple[float, float, float] | None:
    """The weights of a common zero in the triangle, by Newton's method from a guess (x, y) and,
    if that fails, from points all over the triangle; None if none leads to one."""
    for start in (guess, *_STARTS):
        found = _newton(f, g, start)
        if found is not None:
            return found
    return _by_halving(f, g)


def _by_halving(f: Floats, g: Floats) -> tuple[float, float, float] | None:
    """The same from points near which neither cubic keeps its sign, ever closer to the zero."""
    level = [np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])]
    for _ in range(_HALVINGS):
        halves = []
        for a, b, c in level:
            longest = np.argmax([np.hypot(*(c - b)), np.hypot(*(a - c)), np.hypot(*(b - a))])
            p, q, r = ((a, b, c), (b, c, a), (c, a, b))[longest]
            middle = (q + r) / 2
            halves += [np.array([p, q, middle]), np.array([p, middle, r])]
        level = [half for half in halves if _may_vanish(f, half) and _may_vanish(g, half)]
        for half in level:
            found = _newton(f, g, half.mean(axis=0).tolist())
            if found is not None:
                return found
    return None


def _may_vanish(cubic: Floats, corners: Floats) -> bool:
    """Whether the coefficients of a cubic over a part of the triangle have both signs."""
    values = [polar(cubic, *(corners[k] for k in index)) for index in _INDICES]
    return bool(min(values) <= 0.0 <= max(values))


def _newton(f: Floats, g: Floats, start: Sequence[float]) -> tuple[float, float, float] | None:
    """The common zero of two cubics in the triangle to which Newton's method leads, if any."""
    x, y = start
    out = np.zeros(3)
    step = 1.0
    for _ in range(40):
        value_and_gradient(f, x, y, out)
        u, ux, uy = out.tolist()
        value_and_gradient(g, x, y, out)
        v, vx, vy = out.tolist()
        det = ux * vy - uy * vx
        if det == 0.0:
            return None
        dx, dy = (u * vy - v * uy) / det, (v * ux - u * vx) / det
        step = abs(dx) + abs(dy)
        if not step < np.inf:
            return None
        # Where both gradients are nearly parallel a step is far too long, but right across them.
        x, y = min(max(x - dx, -_BESIDE), 1 + _BESIDE), min(max(y - dy, -_BESIDE), 1 + _BESIDE)
        if step < 1e-15:
            break
    z = 1.0 - x - y
    return (z, x, y) if min(x, y, z) > -1e-12 and step < 1e-9 else None
