"""Sorting directed edges by direction: by rounded angles, and exactly where those are too close."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.geometry import exact
from harness.geometry.coordinates import Floats
from harness.geometry.instance import Instance

Ints = npt.NDArray[np.int64]


def by_direction(
    instance: Instance, edges: Ints, way: Floats, slack: float
) -> tuple[Ints, npt.NDArray[np.bool_]]:
    """``edges`` in the order of their slopes, exactly, and whether each equals the one before.

    All edges must run to the right, or all to the left; ``way`` (shape (m, 2)) are their computed
    directions, turned to the right and scaled as in :func:`harness.geometry.scaling.scaled`, and
    ``slack`` is the slack told there.

    First they are sorted by the computed angle.  Its error is at most 10u, u = 2⁻⁵³: u for the
    differences of coordinates, whose relative error is u, and generously 9u for the arc tangent;
    to this comes slack/|d| for errors ε of the coordinates themselves, which move a vector d by
    at most 2√2 ε < slack/8.  Where intervals of uncertainty overlap, exact slopes decide.
    O(m log m).
    """
    angle = np.arctan2(way[:, 1], way[:, 0])
    doubt = np.full(len(edges), 10 * 2.0**-53)
    if slack > 0:
        length = np.abs(way).max(axis=1)
        doubt += np.where(length > slack, slack / np.maximum(length, slack), 4.0)
    rank = np.argsort(angle, kind="stable")
    edges = edges[rank]
    high = np.maximum.accumulate((angle + doubt)[rank])
    low = np.minimum.accumulate((angle - doubt)[rank][::-1])[::-1]
    close = np.flatnonzero(high[:-1] >= low[1:])  # positions k that k + 1 may precede
    same = np.zeros(len(edges), dtype=np.bool_)
    for run in np.split(close, np.flatnonzero(np.diff(close) > 1) + 1):
        if run.size:
            part = slice(int(run[0]), int(run[-1]) + 2)
            edges[part], same[part] = _by_slope(instance, edges[part])
    return edges, same


def _by_slope(instance: Instance, edges: Ints) -> tuple[Ints, list[bool]]:
    """Edges of almost one direction sorted by their exact slopes, and which are ties."""
    slopes = _slopes(instance, edges)
    order = sorted(range(len(slopes)), key=slopes.__getitem__)
    ordered = [slopes[k] for k in order]
    return edges[order], [False, *(a == b for a, b in pairwise(ordered))]


def _slopes(instance: Instance, edges: Ints) -> list[Any]:
    """The exact slopes; edges whose coordinate differences are equal doubles share one."""
    known: dict[Any, Any] = {}
    slopes = []
    for edge, key in zip(edges.tolist(), _keys(instance, edges), strict=True):
        if key not in known:
            (ax, ay), (bx, by) = (exact.point(p) for p in instance.rational_segment(edge))
            known[key] = (by - ay) / (bx - ax)
        slopes.append(known[key])
    return slopes


def _keys(instance: Instance, edges: Ints) -> list[Any]:
    """Keys that only edges of one slope share: exact differences of doubles, or the edge."""
    indices: list[Any] = edges.tolist()
    if instance.exact is not None:
        return indices
    start, end = instance.segments[edges, 0], instance.segments[edges, 1]
    with np.errstate(over="ignore", invalid="ignore"):
        way = end - start
        back = end - way  # Knuth's two-sum gives the error of the difference without error
        known = ((end - (way + back)) + (back - start) == 0).all(axis=1)
    flat = way[:, 1] == 0
    way[flat] = (1.0, 0.0)
    pairs = map(tuple, way.tolist())
    return [
        pair if sure else edge
        for pair, sure, edge in zip(pairs, (known | flat).tolist(), indices, strict=True)
    ]
