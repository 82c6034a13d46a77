"""Is an instance what the diagram is defined for?  Exactly decided, and the offender is named."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.geometry import exact, sweep
from harness.geometry.compiling import LARGE, compiled
from harness.geometry.coordinates import COUNTING
from harness.geometry.instance import Instance
from harness.geometry.scaling import scaled

Ints = npt.NDArray[np.int64]


def validate(instance: Instance) -> None:
    """Raise :class:`UserError`, naming indices and reason, unless the instance is proper.

    A polygon must have at least three vertices, all different, and be simple: edges meet only at
    the vertex that consecutive ones share.  Segments must be at least one, have positive length,
    and have disjoint relative interiors; they may share endpoints, and an endpoint of one may lie
    inside another.  Every decision is exact.  O(n log n) expected time.
    """
    if instance.kind == "polygon" and instance.n < 3:
        _refuse(instance, f"a polygon needs at least 3 vertices, not {instance.n}")
    if instance.n == 0:
        _refuse(instance, "there are no segments")
    rank, representative = _ranks(instance)
    if instance.kind == "polygon":
        _refuse_repeated_vertex(instance, rank)
        ends = np.stack([rank, np.roll(rank, -1)], axis=1)
    else:
        ends = rank.reshape(-1, 2)
        _refuse_repeated_segment(instance, ends)
    pair = _first_conflict(instance, np.sort(ends, axis=1), representative)
    if pair is not None:
        _refuse_pair(instance, *sorted(pair))


def first_conflict(instance: Instance) -> tuple[int, int] | None:
    """Two different segments of positive length that cross or overlap, or None.

    That an endpoint of one lies inside another is no conflict.  Exact, O(n log n) expected time.
    """
    if instance.n < 2:
        return None
    rank, representative = _ranks(instance)
    return _first_conflict(instance, np.sort(rank.reshape(-1, 2), axis=1), representative)


def _refuse(instance: Instance, reason: str) -> NoReturn:
    raise UserError(f"{instance.label}: {reason}")


def _ranks(instance: Instance) -> tuple[Ints, Ints]:
    """The lexicographic rank of every point (equal points share one), and a point of each rank."""
    points = instance.floats.reshape(-1, 2)
    order = np.lexsort((points[:, 1], points[:, 0]))
    if instance.exact is None:
        ordered = points[order]
        new = (ordered[1:] != ordered[:-1]).any(axis=1)
    else:
        values = _exact_points(instance)
        order = np.array(sorted(range(len(values)), key=values.__getitem__), dtype=np.int64)
        new = np.array([values[i] != values[j] for i, j in zip(order[1:], order, strict=False)])
    rank = np.empty(len(points), dtype=np.int64)
    rank[order] = np.concatenate([[0], np.cumsum(new)])
    return rank, order[np.concatenate([[True], new.astype(bool)])]


def _exact_points(instance: Instance) -> list[Any]:
    """The exact vertices or endpoints, in order."""
    nested: Any = instance.exact
    if instance.kind == "polygon":
        return list(nested)
    return [point for segment in nested for point in segment]


def _refuse_repeated_vertex(instance: Instance, rank: Ints) -> None:
    order = np.argsort(rank, kind="stable")
    same = np.flatnonzero(rank[order[1:]] == rank[order[:-1]])
    if not same.size:
        return
    pairs = np.stack([order[same], order[same + 1]], axis=1)
    i, j = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))][0].tolist()
    closing = " (leave out the closing repeat)" if (i, j) == (0, instance.n - 1) else ""
    _refuse(instance, f"repeated vertex: vertices {i} and {j} {COUNTING} are equal{closing}")


def _refuse_repeated_segment(instance: Instance, ends: Ints) -> None:
    point_like = np.flatnonzero(ends[:, 0] == ends[:, 1])
    if point_like.size:
        _refuse(instance, f"segment {point_like[0]} {COUNTING} has length zero")
    undirected = np.sort(ends, axis=1)
    order = np.lexsort((undirected[:, 1], undirected[:, 0]))  # stable: equal ones by index
    same = np.flatnonzero((undirected[order[1:]] == undirected[order[:-1]]).all(axis=1))
    if same.size:
        i, j = min((int(order[k]), int(order[k + 1])) for k in same)
        _refuse(instance, f"duplicate segment: segments {i} and {j} {COUNTING} are the same")


def _first_conflict(instance: Instance, ends: Ints, representative: Ints) -> tuple[int, int] | None:
    """Two segments in conflict, or None; ``ends`` are ranks, the smaller first."""
    coordinates, slack = scaled(instance.floats, instance.exact is not None)
    x, y = coordinates.reshape(-1, 2)[representative].T
    n = len(ends)
    # ends before starts at one point: key 2·rank for an end, 2·rank + 1 for a start
    key = np.concatenate([2 * ends[:, 1], 2 * ends[:, 0] + 1])
    events = np.concatenate([-1 - np.arange(n), np.arange(n)])[np.argsort(key, kind="stable")]
    data: tuple[Any, ...] = (
        *(ends[:, 0].copy(), ends[:, 1].copy(), instance.kind == "polygon", events),
        np.random.default_rng(0).permutation(n),
        *(np.full(n, -1, dtype=np.int64) for _ in range(5)),
        np.full(1, -1, dtype=np.int64),
    )
    xy: tuple[Any, Any] = (x.copy(), y.copy())
    large = n >= LARGE
    if large:
        run = compiled(sweep.sweep, *sweep.HELPERS)
    else:
        run = sweep.sweep
        data = tuple(item.tolist() if isinstance(item, np.ndarray) else item for item in data)
        xy = (x.tolist(), y.tolist())

    def step(start: int, known: sweep.Known) -> sweep.Outcome:
        answers: Any = np.array(known, dtype=np.int64).reshape(-1, 4) if large else known
        outcome: sweep.Outcome = run(start, *xy, slack, answers, *data)
        return outcome

    point = _exact_point_of(instance, representative)
    status, i, j = exact.resolve(
        step, lambda p, q, r: exact.orientation(point(p), point(q), point(r))
    )
    return (i, j) if status == 1 else None


def _exact_point_of(instance: Instance, representative: Ints) -> Any:
    """A function from the rank of a point to its exact coordinates."""
    points = instance.floats.reshape(-1, 2)
    values = None if instance.exact is None else _exact_points(instance)

    def point(rank: int) -> exact.ExactPoint:
        index = int(representative[rank])
        return exact.point(points[index].tolist() if values is None else values[index])

    return point


def _refuse_pair(instance: Instance, i: int, j: int) -> NoReturn:
    """Say exactly how segments i < j are in conflict."""
    (a, b), (c, d) = (instance.rational_segment(k) for k in (i, j))
    turns = [exact.orientation(*triple) for triple in ((a, b, c), (a, b, d), (c, d, a), (c, d, b))]
    if not any(turns):
        verb = "overlap"
    elif all(turns):
        verb = "cross"
    else:
        verb = "touch"
    if instance.kind == "polygon":
        _refuse(instance, f"the polygon intersects itself: edges {i} and {j} {COUNTING} {verb}")
    _refuse(instance, f"segments {i} and {j} {COUNTING} {verb}")
