"""The fast builder: from an instance to the arrays of its diagram."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from harness.diagram.counts import Domain, Objective
from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.boxes import sift_triangles
from harness.diagram.fast.hard import LocalMap, solve
from harness.diagram.fast.leaves import EMPTY, HARD
from harness.diagram.fast.points import exact_point
from harness.diagram.fast.prepare import Floats, Ints, Prepared
from harness.diagram.fast.roots import Roots
from harness.diagram.fast.sifting import sift_kernel, sift_regions
from harness.diagram.fast.subdivide import subdivide
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction
from harness.geometry.kernel import Kernel

#: Triangles in one root, at most (and 300 m² with m candidates), in small instances, which another
#: builder takes if halving does not end, and in others.
FEW_TRIANGLES, MANY_TRIANGLES = 20_000, 1_000_000
#: An instance with at most so many segments is small.
SMALL = 32
#: A root with so many candidates is cut into 2^CUTS parts.
MANY, CUTS = 96, 5


#: lines, lengths, classes; first tie of each corner, ties.
World = tuple[Ints, Floats, Ints, Ints, Ints]


@dataclass(eq=False)
class Leaves:
    """All leaves of all roots, in the order of ``order``; see :func:`subdivide`.

    ``shapes`` (l, 9): the barycentric weights of the corners of the leaves that are not empty,
    ``lows`` what is missing in the doubles of the rows ``low_rows`` (increasing).
    """

    order: Ints
    tokens: Any
    kinds: Any
    choices: Any
    first_slot: Ints
    slots: Any
    shapes: Floats
    low_rows: Ints
    lows: Floats
    points: Floats
    shape_roots: Any
    open_first: Ints
    open_ids: Ints
    statistics: Ints

    def weights(self, row: int) -> list[list[Fraction]]:
        """The exact barycentric weights of the corners of a leaf that is not empty."""
        exact = [Fraction(x) for x in self.shapes[row].tolist()]
        low = int(np.searchsorted(self.low_rows, row))
        if low < len(self.low_rows) and self.low_rows[low] == row:
            exact = [x + Fraction(y) for x, y in zip(exact, self.lows[low].tolist(), strict=True)]
        return [exact[3 * k : 3 * k + 3] for k in range(3)]


@dataclass(frozen=True)
class Job:
    """Roots to subdivide, or a part of one.

    ``before``: tokens of triangles around the part that come before those of the part.
    """

    roots: Ints
    path: Ints
    before: tuple[int, ...] = ()


def merged(parts: list[Any], jobs: list[Job]) -> Leaves:
    """The leaves of several jobs, one after the other."""

    def joined(k: int) -> Any:
        return np.concatenate([part[k] for part in parts])

    def offsets(k: int) -> Ints:
        ends = np.cumsum([0, *(part[k][-1] for part in parts)])
        rows = [part[k][:-1] + end for part, end in zip(parts, ends[:-1], strict=True)]
        return np.concatenate([*rows, ends[-1:]])

    tokens = [
        piece
        for part, job in zip(parts, jobs, strict=True)
        for piece in (np.array(job.before, dtype=np.int8), part[0])
    ]
    shaped = [len(part[5]) for part in parts]
    order = [job.roots for job in jobs if not len(job.path) or not (job.path & 1).any()]
    return Leaves(
        order=np.concatenate(order),
        tokens=np.concatenate(tokens),
        kinds=joined(1),
        choices=joined(2),
        first_slot=offsets(3),
        slots=joined(4),
        shapes=joined(5),
        low_rows=np.concatenate(
            [part[6] + end for part, end in zip(parts, np.cumsum([0, *shaped[:-1]]), strict=True)]
        ),
        lows=joined(7),
        points=joined(8),
        shape_roots=joined(9),
        open_first=offsets(10),
        open_ids=joined(11),
        statistics=np.sum([part[12] for part in parts], axis=0),
    )


def find_leaves(
    prepared: Prepared,
    roots: Roots,
    candidates: tuple[Ints, Ints, Ints],
    definite: bool,
    sense: float,
    workers: int,
    world: World,
) -> Leaves:
    """Subdivide all roots, on several threads; the result does not depend on their number."""
    coordinates, weights, incident_first, incident = roots.corners.arrays(
        prepared.centre, prepared.scale
    )
    first, count, flat = candidates
    special = np.array(roots.corners.special)

    def run(job: Job) -> Any:
        return subdivide(
            job.roots,
            job.path,
            roots.triangles,
            coordinates,
            weights,
            special,
            incident_first,
            incident,
            first,
            count,
            flat,
            prepared.segments,
            prepared.size,
            sense,
            definite,
            world,
            FEW_TRIANGLES if prepared.instance.n <= SMALL else MANY_TRIANGLES,
        )

    jobs = list(_jobs(coordinates, weights, roots.triangles, count))
    if workers == 1:
        return merged([run(job) for job in jobs], jobs)
    with ThreadPoolExecutor(workers) as pool:
        return merged(list(pool.map(run, jobs)), jobs)


def _jobs(coordinates: Floats, weights: Floats, triangles: Ints, count: Ints) -> Iterator[Job]:
    """Jobs in the order of the roots, which do not depend on the number of workers.

    A root with many candidates of its own is cut into 2^``CUTS`` parts, others are taken together
    until they have about 1/64 of all candidates.
    """
    total = int(count.sum())
    cut = (count >= max(MANY, total // 256)) & weights[triangles].all(axis=1)
    batch = (np.cumsum(count) - count) // max(total // 64, 64)
    begins = np.ones(len(count), dtype=bool)
    begins[1:] = (batch[1:] != batch[:-1]) | cut[1:] | cut[:-1]
    starts = np.flatnonzero(begins)
    for start, stop in zip(starts, np.append(starts[1:], len(count)), strict=True):
        if cut[start]:
            yield from _parts(int(start), coordinates[triangles[start]][:, [0, 2]])
        else:
            yield Job(np.arange(start, stop), np.zeros(0, dtype=np.int64))


def _parts(root: int, points: Floats) -> Iterator[Job]:
    """One root in parts, its longest sides halved again and again."""
    todo: list[tuple[tuple[int, ...], Floats]] = [((), points)]
    before: list[int] = []
    while todo:
        path, (a, b, c) = todo.pop()
        if len(path) == CUTS:
            yield Job(np.array([root]), np.array(path, dtype=np.int64), tuple(before))
            before = []
            continue
        k = int(np.argmax([np.hypot(*(c - b)), np.hypot(*(a - c)), np.hypot(*(b - a))]))
        p, q, r = ((a, b, c), (b, c, a), (c, a, b))[k]
        middle = (q + r) / 2
        before.append(k)
        todo.append(((*path, 2 * k + 1), np.array([p, middle, r])))
        todo.append(((*path, 2 * k), np.array([p, q, middle])))


def candidates_of(
    prepared: Prepared,
    roots: Roots,
    found: Kernel | None,
    spans: list[tuple[int, int]],
    sense: float,
    definite: bool,
    world: World,
    workers: int,
) -> tuple[Ints, Ints, Ints]:
    """Candidates of every root: first, count, and all of them."""
    n, m = prepared.instance.n, len(found.sides) if found else 0
    if spans and found is not None:
        coordinates = roots.corners.arrays(prepared.centre, prepared.scale)[0][:, [0, 2]]
        chain = np.empty((2 * m + 1, 2))
        chain[0::2] = coordinates[m + np.arange(m + 1) % m]
        chain[1::2] = coordinates[(np.arange(m) + 1) % m]
        sifted: tuple[Ints, Ints, Ints] = sift_kernel(
            chain, m, n, prepared.segments, prepared.size, sense, world
        )
        return sifted
    coordinates, weights, _, _ = roots.corners.arrays(prepared.centre, prepared.scale)
    if isinstance(roots.corners, ArrangedCorners):
        return sift_triangles(
            roots.triangles,
            coordinates,
            weights,
            n,
            prepared.segments,
            prepared.size,
            sense,
            definite,
            world,
            workers,
        )
    first, flat = sift_regions(
        roots.regions,
        coordinates,
        weights,
        n,
        prepared.segments,
        prepared.size,
        sense,
        definite,
        world,
    )
    region = np.where(roots.region_of < 0, len(roots.regions), roots.region_of)
    return first[region], (first[1:] - first[:-1])[region], flat


def exact_corners(roots: Roots, leaves: Leaves, row: int) -> list[RationalPoint]:
    """The exact corners of a leaf that is not empty, by its row among these.

    Raises Contradiction if one is at infinity.
    """
    result = []
    for weights in leaves.weights(row):
        point = exact_point(roots, int(leaves.shape_roots[row]), weights)
        if point is None:
            raise Contradiction("a hard triangle at infinity")
        result.append(point)
    return result


def open_rows(leaves: Leaves) -> Ints:
    """The rows (among the leaves that are not empty) of hard and undecided leaves.

    Number k of them has the candidates from ``open_first[k]`` on.
    """
    shaped = np.flatnonzero(leaves.kinds != EMPTY)
    return np.flatnonzero((leaves.kinds[shaped] == HARD) | (leaves.choices[shaped] < 0))


def solve_open(
    prepared: Prepared,
    roots: Roots,
    leaves: Leaves,
    rows: Ints,
    domain: Domain,
    objective: Objective,
) -> dict[int, LocalMap]:
    """The local maps of the open leaves that are still open, by leaf; ``rows``: all of them."""
    shaped = np.flatnonzero(leaves.kinds != EMPTY)
    solved = {}
    for number, row in enumerate(rows.tolist()):
        leaf = int(shaped[row])
        if leaves.kinds[leaf] != HARD and leaves.choices[leaf] >= 0:
            continue
        low, high = leaves.open_first[number], leaves.open_first[number + 1]
        corners = exact_corners(roots, leaves, row)
        solved[leaf] = solve(
            prepared.instance, leaves.open_ids[low:high].tolist(), corners, domain, objective
        )
    return solved
