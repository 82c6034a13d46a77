"""Exact predicates: orientation, and comparison of two visual angles at a point.

Each is first evaluated in doubles, with a bound on the rounding error; only if that leaves the
sign open is it evaluated in rational arithmetic.  So the answer is always exact, for any finite
doubles and any rationals, and usually costs no more than the floating point.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from harness.geometry import exact
from harness.geometry.coordinates import Floats

Signs = npt.NDArray[np.int8]
Number = float | Fraction
Pair = tuple[Number, Number]

#: A comparison at an endpoint of one of the segments, where its visual angle is not defined.
UNDEFINED: Final = 2
#: A filter's answer when rounding could change the sign.
UNSURE: Final = 3

_ROUND: Final = 5 * 2.0**-53
_PRODUCT: Final = 3 * 2.0**-53
_TINY: Final = 2.0**-1050


def orientation(p: Pair, q: Pair, r: Pair) -> int:
    """1 if p, q, r turn left, −1 if they turn right, 0 if they are collinear; exactly.

    Coordinates are finite doubles or fractions, in any mixture.  The rational stage is a few
    operations; for many triples of doubles use :func:`orientations`.
    """
    return exact.orientation(exact.point(p), exact.point(q), exact.point(r))


def orientations(p: npt.ArrayLike, q: npt.ArrayLike, r: npt.ArrayLike) -> Signs:
    """The orientations of triples of points with double coordinates, exactly.

    ``p``, ``q``, ``r`` have shapes (…, 2) that broadcast; the result has shape (…).
    """
    points = np.stack(np.broadcast_arrays(*(_array(x) for x in (p, q, r))), axis=-2)
    flat = points.reshape(-1, 3, 2)
    signs = filter_orientations(flat)
    _settle(signs, flat, lambda row: orientation(*row))
    return signs.reshape(points.shape[:-2])


def filter_orientations(triples: Floats) -> Signs:
    """Orientations of triples of doubles, shape (k, 3, 2), or UNSURE.

    Every row is scaled by a power of two into [−1, 1], which costs at most ε = 2⁻¹⁰⁷⁵ by
    underflow.  Then the determinant a − b of two products of coordinate differences is off by
    less than 5u(|a| + |b|) + 18ε + 2⁻¹⁰⁶⁰ (proof: :func:`harness.geometry.sweep.turn`), hence by
    less than 5u(|a| + |b|) + 2⁻¹⁰⁵⁰.
    """
    rows = _scaled_rows(triples)
    d, e = rows[:, 1] - rows[:, 0], rows[:, 2] - rows[:, 0]
    value, bound = _difference(d[:, 0], e[:, 1], d[:, 1], e[:, 0])
    return _signs(value, bound)


def compare_visual_angles(point: Pair, s: tuple[Pair, Pair], t: tuple[Pair, Pair]) -> int | None:
    """The sign of θ_point(s) − θ_point(t), exactly; None if ``point`` is an endpoint of s or t.

    Coordinates are finite doubles or fractions.  With the forms Q and L of
    :mod:`harness.geometry.visual_angle`, θ is the direction in [0, π] of the vector (Q, |L|), so
    the sign is that of D = Q_t|L_s| − Q_s|L_t|.  If both vectors lie on the axis (the point is on
    both lines: L_s = L_t = 0), D = 0 also for the opposite directions 0 and π: then the signs of
    Q_s and Q_t tell 0 (on an extension, Q > 0) from π (inside the segment, Q < 0).  If only L_s
    is zero, D = −Q_s|L_t| is right as it stands.  The vector is zero at an endpoint only.
    """
    p = exact.point(point)
    forms = []
    for segment in (s, t):
        (ax, ay), (bx, by) = ((x - p[0], y - p[1]) for x, y in map(exact.point, segment))
        forms.append((ax * bx + ay * by, abs(ax * by - ay * bx)))
        if forms[-1] == (0, 0):
            return None
    (qs, ls), (qt, lt) = forms
    if ls == 0 and lt == 0:
        return int(qs < 0) - int(qt < 0)
    return exact.sign(qt * ls - qs * lt)


def compare_visual_angles_at(
    points: npt.ArrayLike, s: npt.ArrayLike, t: npt.ArrayLike
) -> npt.NDArray[np.int8]:
    """The signs of θ_p(s) − θ_p(t) for doubles, exactly; UNDEFINED (2) at endpoints.

    ``points`` has shape (…, 2), the segments have shapes (…, 2, 2); leading shapes broadcast and
    give the shape of the result.  Vectorised; rows that the filter leaves open cost some
    microseconds each.
    """
    p, a, b = _array(points), _array(s), _array(t)
    shape = np.broadcast_shapes(p.shape[:-1], a.shape[:-2], b.shape[:-2])
    rows = np.empty((*shape, 5, 2))
    rows[..., 0, :] = p
    rows[..., 1:3, :] = a
    rows[..., 3:5, :] = b
    flat = rows.reshape(-1, 5, 2)
    signs = filter_visual_angles(flat)
    _settle(signs, flat, _compare_row)
    return signs.reshape(shape)


def _compare_row(row: list[Any]) -> int:
    p, a, b, c, d = row
    answer = compare_visual_angles(p, (a, b), (c, d))
    return UNDEFINED if answer is None else answer


def filter_visual_angles(rows: Floats) -> Signs:
    """Signs of θ(s) − θ(t) for rows (p, s₀, s₁, t₀, t₁) of doubles, shape (k, 5, 2), or UNSURE.

    *Error bound.*  Rows are scaled into [−1, 1], exactly but for underflow (ε = 2⁻¹⁰⁷⁵ per
    coordinate).  Q and L are sums of two products of coordinate differences, so that, as in
    :func:`filter_orientations`, each computed form c is off by at most
    e = 5u(|a| + |b|) + 2⁻¹⁰⁵⁰; taking the absolute value of L does not increase that.  The
    product of two forms is off by |c₁|e₂ + |c₂|e₁ + e₁e₂, its rounding by u|q| + 2⁻¹⁰⁷⁵, and the
    difference D of two products by another u(|q₁| + |q₂|)(1 + u).  The sum of these bounds is
    itself rounded, by a factor of less than 1 + 2⁻²⁰ and less than 2⁻¹⁰⁶⁰ by underflow.

    Nothing overflows, since differences are at most 2 and forms at most 8.  A sign is certain
    only if |D| exceeds the bound: then D ≠ 0, the point is no endpoint and not on both lines,
    and D alone decides (see :func:`compare_visual_angles`).
    """
    scaled = _scaled_rows(rows)
    ends = scaled[:, 1:] - scaled[:, :1]
    x, y = ends[..., 0], ends[..., 1]
    qs, qs_error = _difference(x[:, 0], x[:, 1], y[:, 0], -y[:, 1])
    ls, ls_error = _difference(x[:, 0], y[:, 1], y[:, 0], x[:, 1])
    qt, qt_error = _difference(x[:, 2], x[:, 3], y[:, 2], -y[:, 3])
    lt, lt_error = _difference(x[:, 2], y[:, 3], y[:, 2], x[:, 3])
    ls, lt = np.abs(ls), np.abs(lt)
    with np.errstate(under="ignore"):
        first, second = qt * ls, qs * lt
        bound = np.abs(qt) * ls_error + ls * qt_error + qt_error * ls_error
        bound += np.abs(qs) * lt_error + lt * qs_error + qs_error * lt_error
        bound += _PRODUCT * (np.abs(first) + np.abs(second))
        return _signs(first - second, (1 + 2.0**-20) * bound + _TINY)


def _array(values: npt.ArrayLike) -> Floats:
    return np.asarray(values, dtype=np.float64)


def _scaled_rows(rows: Floats) -> Floats:
    """Each row times the power of two that brings it into [−1, 1]; see the bounds above."""
    _, exponent = np.frexp(np.abs(rows).max(axis=(1, 2), keepdims=True, initial=0.0))
    with np.errstate(under="ignore"):
        return np.asarray(np.ldexp(rows, -exponent))


def _difference(a: Floats, b: Floats, c: Floats, d: Floats) -> tuple[Floats, Floats]:
    """ab − cd, and the bound on its error if the factors are coordinate differences."""
    with np.errstate(under="ignore"):
        first, second = a * b, c * d
        return first - second, _ROUND * (np.abs(first) + np.abs(second)) + _TINY


def _signs(value: Floats, bound: Floats) -> Signs:
    """The signs that are certain."""
    return np.where(np.abs(value) > bound, np.sign(value), UNSURE).astype(np.int8)


def _settle(signs: Signs, rows: Floats, decide: Callable[[list[Any]], int]) -> None:
    """Replace what the filter left open by exact answers."""
    for k in np.flatnonzero(signs == UNSURE).tolist():
        signs[k] = decide(rows[k].tolist())
