"""A mesh on its way: coordinates that change, moves that are counted, time that runs out."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from harness.mesh.mesh import Mesh
from harness.mesh.points import ROOM
from harness.mesh.quality import Quality, least_angles, quality_of
from harness.mesh.stars import Flags, Ints, Stars, coloured, triangles_of
from harness.mesh.validation import Floats

CHUNK = 512
"""Vertices of one colour that a thread takes at a time."""
SAME = 1e-9
"""Degrees by which angles that rounding alone tells apart may differ."""


Step = Callable[[int], tuple[int, int, int, bool]]
"""Given how many visits it may make: how many it made, moves, flips, and whether all is done."""


@dataclass(frozen=True)
class Sweep:
    """What the mesh looked like after a sweep: its number from 1, what was done, moves so far."""

    number: int
    stage: str
    quality: Quality
    moves: int
    seconds: float


@dataclass
class State:
    """A mesh while it is improved; its stars may change too, see :meth:`reconnect`.

    ``x``, ``y``: (n,), at most 1 in absolute value.  ``visits`` and ``moves`` count vertices that
    were looked at and moved.  ``origins``: (n,), for each vertex the one that it was made
    beside, or itself; ``born``: (1,), the next place for a new one.  ``history``: a record of
    every sweep.
    """

    triangles: Ints
    stars: Stars
    free: Flags
    x: Floats
    y: Floats
    order: Ints
    colours: Ints
    pool: ThreadPoolExecutor
    deadline: float = np.inf
    tell: Callable[[Sweep], None] | None = None
    begin: float = field(default_factory=time.perf_counter)
    visits: int = 0
    moves: int = 0
    flips: int = 0
    origins: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    born: Ints = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    history: list[Sweep] = field(default_factory=list)

    @property
    def is_late(self) -> bool:
        """Whether the time is over."""
        return time.monotonic() >= self.deadline

    @property
    def points(self) -> Floats:
        """The coordinates (n, 2)."""
        return np.column_stack([self.x, self.y])

    @property
    def least(self) -> Floats:
        """The least angle of each triangle, increasing, in degrees."""
        return np.sort(least_angles(self.points, self.triangles))

    def kept(self) -> tuple[Any, ...]:
        """All that changes, to be restored."""
        arrays = (self.x, self.y, *self.stars[1:])
        return (*(array.copy() for array in arrays), self.flips)

    def restore(self, kept: tuple[Any, ...]) -> None:
        """Go back to what was kept."""
        for array, old in zip((self.x, self.y, *self.stars[1:]), kept[:-1], strict=True):
            array[:] = old
        if self.flips != kept[-1]:
            self.reconnect(kept[-1] - self.flips)

    def reconnect(self, flips: int) -> None:
        """Read triangles and colours off the stars again, after so many flips of edges."""
        if flips:
            self.flips += flips
            self.triangles = triangles_of(*self.stars, len(self.x))
            self.order, self.colours = coloured(*self.stars[:3], self.free)

    def record(self, stage: str) -> None:
        """Note what the mesh looks like now, and tell who wants to know."""
        seconds = time.perf_counter() - self.begin
        now = quality_of(self.points, self.triangles)
        self.history.append(Sweep(len(self.history) + 1, stage, now, self.moves, seconds))
        if self.tell is not None:
            self.tell(self.history[-1])

    def sweep(self, kernel: Any, *settings: Any) -> int:
        """Run ``kernel(order, first, last, offsets, degrees, ring, x, y, *settings)`` everywhere.

        Colour after colour: vertices of one colour do not see each other, so they may be moved at
        the same time, and the result is the same for every number of threads.  The kernel returns
        how many vertices moved, and so does this.
        """
        moved = 0
        arrays = (*self.stars[:3], self.x, self.y)
        for first, last in zip(self.colours[:-1].tolist(), self.colours[1:].tolist(), strict=True):

            def run(start: int, last: int = last) -> int:
                stop = min(start + CHUNK, last)
                return int(kernel(self.order, start, stop, *arrays, *settings))

            starts = range(first, last, CHUNK)
            run_all = map if len(starts) < 2 else self.pool.map
            moved += sum(run_all(run, starts))
        self.visits += len(self.order)
        self.moves += moved
        return moved

    def spend(self, visits: int, portion: int, stage: str, step: Step) -> None:
        """Take steps of at most ``portion`` visits until all is done, or time or visits are over.

        After each the time limit is looked at, and the mesh recorded.
        """
        left = visits
        while left > 0 and not self.is_late:
            visited, moves, flips, done = step(min(left, portion))
            self.visits += visited
            self.moves += moves
            self.reconnect(flips)
            self.record(stage)
            left -= max(visited, 1)
            if done:
                return


@contextmanager
def state_of(
    mesh: Mesh, workers: int | None, deadline: float, tell: Callable[[Sweep], None] | None
) -> Iterator[State]:
    """The state of a mesh whose coordinates are at most 1 in absolute value."""
    free = ~mesh.fixed
    given = mesh.stars
    stars = Stars(given.offsets, given.degrees.copy(), given.ring.copy(), given.closed.copy())
    order, colours = coloured(*stars[:3], free)
    x, y = (np.ascontiguousarray(mesh.points[:, k]).copy() for k in (0, 1))
    with ThreadPoolExecutor(workers or len(os.sched_getaffinity(0))) as pool:
        yield State(mesh.triangles, stars, free, x, y, order, colours, pool, deadline, tell)


def with_places(mesh: Mesh, count: int) -> Mesh:
    """The same mesh with so many vertices at the end that have no triangles, and room for some."""
    n, stars = len(mesh.points), mesh.stars
    none = np.zeros(count, dtype=np.int64)
    return Mesh(
        np.concatenate([mesh.points, np.zeros((count, 2))]),
        mesh.triangles,
        np.concatenate([mesh.fixed, np.ones(count, dtype=np.bool_)]),
        Stars(
            np.concatenate([stars.offsets, stars.offsets[n] + ROOM * np.arange(1, count + 1)]),
            np.concatenate([stars.degrees, none]),
            np.concatenate([stars.ring, np.full(ROOM * count, -1)]),
            np.concatenate([stars.closed, none.astype(np.bool_)]),
        ),
        mesh.kept,
    )


def rises(before: Floats, after: Floats) -> bool:
    """Whether a vector of angles, sorted increasingly, is above another in lexicographic order.

    In degrees; differences of at most ``SAME`` are none, but nothing is above whose first angle
    is less, however small both are.  Vectors may differ in length: the one that ends first is
    above, as what is not there is not bad.
    """
    if after[0] < before[0]:
        return False
    m = min(len(before), len(after))
    apart = np.flatnonzero(np.abs(after[:m] - before[:m]) > SAME)
    if len(apart):
        return bool(after[apart[0]] > before[apart[0]])
    return len(after) < len(before)
