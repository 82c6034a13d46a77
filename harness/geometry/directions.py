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
    close = high[:-1] >= low[1:]  # whether position k + 1 may come before k
    same = np.zeros(len(edges), dtype=np.bool_)
    run = np.concatenate([[0], np.cumsum(~close)])  # runs of positions that may be out of order
    open_ = np.flatnonzero(np.append(close, False) | np.append(False, close))
    if open_.size:
        edges[open_], same[open_] = _by_slope(instance, edges[open_], run[open_].tolist())
    return edges, same


def _by_slope(instance: Instance, edges: Ints, run: list[int]) -> tuple[Ints, list[bool]]:
    """The edges of every run sorted by their exact slopes, and which are ties."""
    slopes = _slopes(instance, edges)
    keys = list(zip(run, slopes, strict=True))
    order = sorted(range(len(keys)), key=keys.__getitem__)
    return edges[order], [False, *(keys[i] == keys[j] for i, j in pairwise(order))]


def _slopes(instance: Instance, edges: Ints) -> list[Any]:
    """The exact slopes; edges whose coordinate differences are equal doubles share one."""
    floats, segments = instance.exact is None, instance.segments
    known: dict[Any, Any] = {}
    slopes = []
    for edge, key in zip(edges.tolist(), _keys(instance, edges), strict=True):
        if key not in known:
            ends = segments[edge].tolist() if floats else instance.rational_segment(edge)
            (ax, ay), (bx, by) = map(exact.point, ends)
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
