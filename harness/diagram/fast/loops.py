"""Certificates that a cubic's zero set has no loop in a triangle, and its saddle points."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.forms import UNKNOWN, gradient_controls
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import (
    has_cone,
    has_double_zero,
    has_one_branch,
    is_radial,
    longest,
)


@compiled
def keeps_its_sign(signs):
    """Whether a cubic certainly has no zero inside the triangle."""
    positive = negative = False
    for c in range(10):
        if signs[c] == UNKNOWN:
            return False
        positive = positive or signs[c] == 1
        negative = negative or signs[c] == -1
    return positive != negative


@compiled
def hessian_controls(b, out_x, out_y):
    """Control vectors of the gradients of ∂₁F and ∂₂F, linear on T: (3, 2) each."""
    # Coefficients of order two on the corners 200 020 002 and the sides 110 101 011 of ∂F.
    steps = np.zeros((6, 2))
    gradient_controls(b, steps)
    for axis in range(2):
        out = out_x if axis == 0 else out_y
        c0, c1, c2 = steps[0, axis], steps[1, axis], steps[2, axis]
        c3, c4, c5 = steps[3, axis], steps[4, axis], steps[5, axis]
        out[0, 0], out[0, 1] = 2.0 * (c3 - c0), 2.0 * (c4 - c0)
        out[1, 0], out[1, 1] = 2.0 * (c1 - c3), 2.0 * (c5 - c3)
        out[2, 0], out[2, 1] = 2.0 * (c5 - c4), 2.0 * (c2 - c4)


@compiled
def saddle_bounds(hx, hy, bound):
    """(least, steep): a lower bound of −det of the Hessian and an upper bound of the squared norm
    of its rows, over the triangle; least = 0 if it is not certain that det < 0.
    """
    unit = 24.0 * bound
    least, steep = np.inf, 0.0
    for r in range(3):
        steep = max(steep, longest(hx[r], 4.0 * bound) + longest(hy[r], 4.0 * bound))
        for s in range(3):
            det = hx[r, 0] * hy[s, 1] - hx[r, 1] * hy[s, 0]
            slack = unit * (
                abs(hx[r, 0]) + abs(hx[r, 1]) + abs(hy[s, 0]) + abs(hy[s, 1]) + 4.0 * unit
            )
            if not det < -1.1 * slack:
                return 0.0, steep
            least = min(least, -det - slack)
    return least, steep


@compiled
def _leaves_corners_once(signs):
    """Whether at most one arc of the zero set begins at each corner where there is a double zero.

    At other corners on it that are known to be, the gradient is not zero.
    """
    for corner in range(3):
        if has_double_zero(signs, corner) and not has_one_branch(signs, corner):
            return False
    return True


@compiled
def has_no_loop(signs, values, bound, controls):
    """Whether the zero set of a cubic certainly contains no closed curve in the triangle.

    A loop would surround an extremum.  There is none if F is monotone in some direction, if the
    determinant of its Hessian is negative, if F has at most one zero on every ray from a corner,
    and if F has no zero at all.  Nor do two arcs of the zero set begin at a corner: it is smooth
    there, or there is a double zero with one branch in T.

    Fills ``controls`` with the control vectors of the gradient.
    """
    if has_cone(values, bound, controls) or keeps_its_sign(signs):
        return True
    hx, hy = np.empty((3, 2)), np.empty((3, 2))
    hessian_controls(values, hx, hy)
    if saddle_bounds(hx, hy, bound)[0] > 0.0 and _leaves_corners_once(signs):
        return True
    for corner in range(3):
        if is_radial(signs, corner):
            return True
    return False
