"""One level of the divide and conquer: all pairs of regions merged, in batches of comparisons."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from harness.peak.circles import Ints
from harness.peak.discs import Booleans, Judge, Slabs, Vertices, joined


class Gap(NamedTuple):
    """Between neighbouring vertices of two regions that are merged: their four arcs."""

    pair: Ints
    left: Vertices
    right: Vertices
    uppers: tuple[Ints, Ints]
    lowers: tuple[Ints, Ints]

    def take(self, index: Ints | Booleans) -> Gap:
        """Those with these numbers."""
        return Gap(
            self.pair[index],
            self.left.take(index),
            self.right.take(index),
            (self.uppers[0][index], self.uppers[1][index]),
            (self.lowers[0][index], self.lowers[1][index]),
        )


class _Lists(NamedTuple):
    """The vertices of regions: those of region k are items starts[k] … starts[k + 1] − 1."""

    vertices: Vertices
    starts: Ints


def merged(slabs: Slabs, n: int, judge: Judge) -> Slabs:
    """Regions 2k and 2k + 1 intersected to region k; the last of an odd number stays."""
    counts = np.bincount(slabs.region, minlength=n)
    even = n - n % 2
    lone = slabs.take(slabs.region >= even)
    there = (counts[slabs.region] > 0) & (counts[np.minimum(slabs.region ^ 1, n - 1)] > 0)
    slabs = slabs.take(there & (slabs.region < even))
    found = _innermost(_refined(_gaps(slabs, even, judge), judge), judge)
    tail = lone._replace(region=lone.region // 2)
    return Slabs(
        np.concatenate([found.region, tail.region]),
        joined(found.left, tail.left),
        joined(found.right, tail.right),
        np.concatenate([found.upper, tail.upper]),
        np.concatenate([found.lower, tail.lower]),
    )


def _lists(slabs: Slabs, n: int) -> _Lists:
    """The vertices of each region: the left ends of its slabs and the last right end."""
    counts = np.bincount(slabs.region, minlength=n)
    sizes = np.where(counts > 0, counts + 1, 0)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    first = np.concatenate([[0], np.cumsum(counts)])
    places = starts[slabs.region] + np.arange(len(slabs.region)) - first[slabs.region]
    present = np.flatnonzero(counts)
    lasts = starts[present + 1] - 1
    order = np.empty(starts[-1], dtype=np.int64)
    order[places] = np.arange(len(places))
    order[lasts] = len(places) + np.arange(len(lasts))
    every = joined(slabs.left, slabs.right.take(first[present + 1] - 1))
    return _Lists(every.take(order), starts)


def _gaps(slabs: Slabs, n: int, judge: Judge) -> Gap:
    """Step 1: the vertices of both regions of each pair in one order, and the gaps in between."""
    lists = _lists(slabs, n)
    region = np.repeat(np.arange(n), np.diff(lists.starts))
    place = np.arange(len(region)) - lists.starts[region]
    mine = region % 2 == 0
    position = _ranks(lists, region, np.flatnonzero(mine), judge)
    # A vertex of the other region comes after all of mine that were ranked at most its place.
    span = len(region) + 1
    keys = (region[mine] // 2) * span + position
    others = np.flatnonzero(~mine)
    pair = region[others] // 2
    before = np.searchsorted(keys, pair * span + place[others], side="right")
    first = np.searchsorted(keys, pair * span, side="left")
    rank = np.empty(len(region), dtype=np.int64)
    rank[mine] = place[mine] + position
    rank[others] = place[others] + before - first
    order = np.lexsort((rank, region // 2))
    seen_mine = np.cumsum(mine[order])
    seen_other = np.cumsum(~mine[order])
    pairs = region[order] // 2
    begin = np.searchsorted(pairs, pairs, side="left")
    k_mine = seen_mine - (seen_mine - mine[order])[begin] - 1
    k_other = seen_other - (seen_other - ~mine[order])[begin] - 1
    counts = np.bincount(slabs.region, minlength=n)
    offset = np.concatenate([[0], np.cumsum(counts)])
    inside = (
        (np.append(pairs[1:], -1) == pairs)
        & (k_mine >= 0)
        & (k_other >= 0)
        & (k_mine < counts[2 * pairs])
        & (k_other < counts[2 * pairs + 1])
    )
    at = np.flatnonzero(inside)
    one, two = offset[2 * pairs[at]] + k_mine[at], offset[2 * pairs[at] + 1] + k_other[at]
    return Gap(
        pairs[at],
        lists.vertices.take(order[at]),
        lists.vertices.take(order[at + 1]),
        (slabs.upper[one], slabs.upper[two]),
        (slabs.lower[one], slabs.lower[two]),
    )


def _ranks(lists: _Lists, region: Ints, mine: Ints, judge: Judge) -> Ints:
    """How many vertices of the partner's list are to the left of each of ``mine``."""
    partner = region[mine] ^ 1
    low = np.zeros(len(mine), dtype=np.int64)
    high = lists.starts[partner + 1] - lists.starts[partner]
    while (active := np.flatnonzero(low < high)).size:
        middle = (low[active] + high[active]) // 2
        probes = lists.vertices.take(lists.starts[partner[active]] + middle)
        left = judge.is_left(probes, lists.vertices.take(mine[active]))
        low[active] = np.where(left, middle + 1, low[active])
        high[active] = np.where(left, high[active], middle)
    return low


def _refined(gaps: Gap, judge: Judge) -> Gap:
    """Steps 2 and 3: the gaps, cut at the crossings of their arcs."""
    (u, v), (w, z) = gaps.uppers, gaps.lowers
    count = len(gaps.pair)
    gap = np.tile(np.arange(count), 4)
    one, other = np.concatenate([u, w, u, v]), np.concatenate([v, z, z, w])
    fresh = _first_time(gap, one, other)
    gap, one, other = gap[fresh], one[fresh], other[fresh]
    there = np.flatnonzero(judge.cross(one, other))
    gap = np.repeat(gap[there], 2)
    points = Vertices(
        np.repeat(one[there], 2), np.repeat(other[there], 2), np.tile([1, -1], len(there))
    )
    inside = np.flatnonzero(judge.is_left(gaps.left.take(gap), points))
    gap, points = gap[inside], points.take(inside)
    inside = np.flatnonzero(judge.is_left(points, gaps.right.take(gap)))
    gap, points = gap[inside], points.take(inside)
    order = np.argsort(gap, kind="stable")
    gap, points = gap[order], _sorted(gap[order], points.take(order), judge)
    # Every gap begins with its own left end, followed by its crossings.
    owner = np.concatenate([np.arange(count), gap])
    every = joined(gaps.left, points)
    order = np.argsort(owner, kind="stable")
    owner, lefts = owner[order], every.take(order)
    is_last = np.append(owner[1:] != owner[:-1], True)[: len(owner)]
    following = np.minimum(np.arange(len(owner)) + 1, max(len(owner) - 1, 0))
    ends = gaps.right.take(owner)
    nexts = lefts.take(following)
    rights = Vertices(*(np.where(is_last, e, f) for e, f in zip(ends, nexts, strict=True)))
    return gaps.take(owner)._replace(left=lefts, right=rights)


def _first_time(gap: Ints, one: Ints, other: Ints) -> Ints:
    """Which pairs of circles come up for the first time in their gap.

    Above and below may be arcs of one disc, and then the pairs of arcs are not all different.
    """
    pairs = np.column_stack([gap, np.minimum(one, other), np.maximum(one, other)])
    return np.sort(np.unique(pairs, axis=0, return_index=True)[1])


def _sorted(gap: Ints, points: Vertices, judge: Judge) -> Vertices:
    """The crossings within each gap from left to right, by odd-even transposition."""
    order = np.arange(len(gap))
    begin = np.searchsorted(gap, gap, side="left")
    most = int(np.bincount(gap).max(initial=0)) if len(gap) else 0
    place = order - begin
    for turn in range(most):
        at = np.flatnonzero((place[:-1] % 2 == turn % 2) & (gap[:-1] == gap[1:]))
        swap = at[judge.is_left(points.take(order[at + 1]), points.take(order[at]))]
        order[swap], order[swap + 1] = order[swap + 1], order[swap]
    return points.take(order)


def _innermost(gaps: Gap, judge: Judge) -> Slabs:
    """Steps 3 and 4: the innermost arcs of each gap, where anything is left between them."""
    (u, v), (w, z) = gaps.uppers, gaps.lowers
    upper = np.where(judge.is_below(gaps.left, gaps.right, u, v, (True, True)), u, v)
    lower = np.where(judge.is_below(gaps.left, gaps.right, w, z, (False, False)), z, w)
    there = np.flatnonzero(judge.is_below(gaps.left, gaps.right, lower, upper, (False, True)))
    pair, upper, lower = gaps.pair[there], upper[there], lower[there]
    left, right = gaps.left.take(there), gaps.right.take(there)
    if not len(there):
        return Slabs(pair, left, right, upper, lower)
    changes = (pair[1:] != pair[:-1]) | (upper[1:] != upper[:-1]) | (lower[1:] != lower[:-1])
    first = np.flatnonzero(np.append(True, changes))
    last = np.append(first[1:], len(there)) - 1
    return Slabs(pair[first], left.take(first), right.take(last), upper[first], lower[first])
