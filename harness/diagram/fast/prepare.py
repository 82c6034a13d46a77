"""An instance as the arrays on which the compiled parts of the fast builder work."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast.roots import double_double
from harness.diagram.planar_map import RationalPoint
from harness.geometry.instance import Instance
from harness.geometry.predicates import orientation

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Prepared:
    """``segments`` (n, 8): ax, ay, bx, by as double-doubles, about ``centre`` and times ``scale``
    (a power of two).

    ``size``: the greatest of these coordinates, in absolute value.  ``lines`` (n,): a number for
    every line that holds several segments, −1 for the other segments.  ``classes`` (n,): likewise
    for equal vectors b − a, up to sign.  ``lengths`` (n, 2): of segments that share their line, a
    coordinate of b − a, in absolute value and as a double-double: the ratio of two is that of the
    lengths.
    """

    instance: Instance
    segments: Floats
    centre: RationalPoint
    scale: Fraction
    size: float
    lines: Ints
    classes: Ints
    lengths: Floats


def has_plain_size(instance: Instance) -> bool:
    """Whether products of a few coordinates, and their differences, stay far from overflow."""
    segments = instance.segments
    lengths = np.abs(segments[:, 1] - segments[:, 0]).max(axis=1)
    return bool(np.abs(segments).max() < 1e50 and lengths.min() > 1e-50)


def prepare(instance: Instance, parallels: bool) -> Prepared:
    """Arrays of an instance; ``parallels``: find equal vectors (needed at infinity only)."""
    n = instance.n
    points = instance.segments.reshape(-1, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    # Coordinates small against their distance from the origin are taken about their middle.
    far = np.abs(points).max() > 8 * (high - low).max()
    middle = 0.5 * (low + high) if far else np.zeros(2)
    centre = (Fraction(float(middle[0])), Fraction(float(middle[1])))
    largest = float(np.abs(points - middle).max())
    exponent = int(np.frexp(largest)[1]) if largest > 0 else 0
    scale = Fraction(2) ** -exponent
    segments = np.zeros((n, 8))
    if instance.exact is None:
        exact = instance.segments.reshape(n, 4)
        shift = np.tile(middle, 2)
        segments[:, 0::2] = exact - shift
        # What a difference of doubles lacks is a double.
        back = segments[:, 0::2] - exact
        segments[:, 1::2] = (exact - (segments[:, 0::2] - back)) - (shift + back)
        segments = np.ldexp(segments, -exponent)
    else:
        for k, (a, b) in enumerate(instance.rational_segments()):
            about = [c - centre[axis % 2] for axis, c in enumerate((*a, *b))]
            segments[k] = [part for c in about for part in double_double(c * scale)]
    none = np.full(n, -1, dtype=np.int64)
    lines = _common_lines(instance, segments[:, 0::2].reshape(n, 2, 2))
    return Prepared(
        instance=instance,
        segments=segments,
        centre=centre,
        scale=scale,
        size=float(np.abs(segments).max()),
        lines=lines,
        classes=_equal_vectors(instance) if parallels else none,
        lengths=_lengths(instance, lines),
    )


def _lengths(instance: Instance, lines: Ints) -> Floats:
    """See :class:`Prepared`."""
    lengths = np.zeros((instance.n, 2))
    axis_of: dict[int, int] = {}
    for k in np.flatnonzero(lines >= 0).tolist():
        a, b = instance.rational_segment(k)
        vector = (abs(b[0] - a[0]), abs(b[1] - a[1]))
        axis = axis_of.setdefault(int(lines[k]), 0 if vector[0] >= vector[1] else 1)
        lengths[k] = double_double(vector[axis])
    return lengths


def _common_lines(instance: Instance, segments: Floats) -> Ints:
    """Numbers of the lines that hold several segments.

    A line is described by its direction (as a point of a circle, twice around) and the foot of the
    perpendicular from the middle of everything; neighbours in these doubles are compared exactly.
    The vectors of the segments are rounded once, however short they are against their place, so
    that descriptions of one line differ by a few roundings only.
    """
    from scipy.spatial import cKDTree

    n = len(segments)
    result = np.full(n, -1, dtype=np.int64)
    centre = segments.reshape(-1, 2).mean(axis=0)
    size = float(np.ptp(segments.reshape(-1, 2), axis=0).max())
    d = _vectors(instance)
    with np.errstate(all="ignore"):
        d = d / np.abs(d).max(axis=1)[:, None]  # squares of its parts are no denormals
        u = d / np.hypot(d[:, 0], d[:, 1])[:, None]
        normal = np.stack([-u[:, 1], u[:, 0]], axis=1)
        offset = ((segments[:, 0] - centre) * normal).sum(axis=1) / size
    keys = np.column_stack(
        [u[:, 0] ** 2 - u[:, 1] ** 2, 2 * u[:, 0] * u[:, 1], offset[:, None] * normal]
    )
    keys = np.nan_to_num(keys)
    if n > 1 and not _has_neighbours(keys):
        return result
    for i, j in sorted(cKDTree(keys).query_pairs(1e-7)):
        if _same_line(instance, i, j):
            number = result[i] if result[i] >= 0 else (result[j] if result[j] >= 0 else i)
            result[i] = result[j] = number
    return result


def _vectors(instance: Instance) -> Floats:
    """b − a of every segment, rounded once."""
    if instance.exact is None:
        vectors: Floats = instance.segments[:, 1] - instance.segments[:, 0]
        return vectors
    return np.array(
        [[float(e - s) for s, e in zip(a, b, strict=True)] for a, b in instance.rational_segments()]
    )


def _has_neighbours(keys: Floats) -> bool:
    """Whether two rows may be closer than 1e-7, by a sort of one combination of the columns: as a
    vector it has length 1.31, so there it changes by less than 4e-7."""
    mixed = np.sort(keys @ np.array([0.7548776662, 0.5698402910, 0.8191725134, 0.3819660113]))
    return bool((np.diff(mixed) < 4e-7).any())


def _same_line(instance: Instance, i: int, j: int) -> bool:
    a, b = instance.rational_segment(i)
    c, d = instance.rational_segment(j)
    return orientation(a, b, c) == 0 and orientation(a, b, d) == 0


def _equal_vectors(instance: Instance) -> Ints:
    """Numbers of the vectors b − a (up to sign) that several segments have."""
    groups: defaultdict[tuple[Fraction, Fraction], list[int]] = defaultdict(list)
    for k, (a, b) in enumerate(instance.rational_segments()):
        vector = (b[0] - a[0], b[1] - a[1])
        groups[max(vector, (-vector[0], -vector[1]))].append(k)
    result = np.full(instance.n, -1, dtype=np.int64)
    for number, members in enumerate(groups.values()):
        if len(members) > 1:
            result[members] = number
    return result
