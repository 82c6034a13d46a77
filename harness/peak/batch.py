"""Many small polygons at once: arrays in, arrays out."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.geometry.jit import compiled
from harness.peak.cavity import peak_of

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

CHUNK = 4096
"""Polygons that a thread takes at a time."""


@dataclass(frozen=True, eq=False)
class Peaks:
    """The peaks of k polygons.

    ``points``: (k, 2).  ``angles``: (k,), in radians; the least visual angle of each polygon's
    edges from its point is at least that; NaN if doubles cannot prove the point to lie inside the
    kernel.  ``bounds``: (k,); no point of the kernel does better.
    ``bases``: (k, 3), the segments that determine the peak, −1 where there are fewer.
    ``walls``: (k, 3), whether the segment is there for its line, on which the point lies.
    ``vertices``: (k,), the vertex that the point is, −1 where it is none; the angle is then a
    limit, approached but not reached.  ``status``: (k,), 0 where bounds − angles ≤ 1e-12 (what
    doubles prove), 1 where they are further apart or the kernel has no interior, 2 where there is
    no polygon: fewer than three vertices, equal neighbours, no area, a value that is not finite,
    or one that certainly winds around more than once.
    """

    points: Floats
    angles: Floats
    bounds: Floats
    bases: Ints
    walls: npt.NDArray[np.bool_]
    vertices: Ints
    status: npt.NDArray[np.int8]


def peaks(
    vertices: npt.ArrayLike, offsets: npt.ArrayLike | None = None, *, workers: int | None = None
) -> Peaks:
    """The points of greatest least visual angle of many star-shaped polygons.

    ``vertices``: (m, 2); polygon j has the vertices offsets[j] … offsets[j + 1] − 1, in either
    orientation, and must be simple; ``offsets``: (k + 1,), increasing.  Or ``vertices`` of shape
    (k, n, 2), without offsets: k polygons of n vertices.  ``workers``: threads, by default one
    per processor; the result does not depend on it.

    No polygon stops the others: see :class:`Peaks` for ``status``.  About O(n) a polygon, a
    few microseconds for a hexagon.

    Raises:
        UserError: what is no array of numbers, shapes that do not fit, offsets that decrease or
            leave the array, fewer than one worker.
    """
    if workers is not None and workers < 1:
        raise UserError(f"at least one worker is needed, not {workers}")
    xy, starts = _checked(vertices, offsets)
    x, y = np.ascontiguousarray(xy[:, 0]), np.ascontiguousarray(xy[:, 1])
    k = len(starts) - 1
    found = np.full((k, 4), np.nan)
    bases, corners = np.full((k, 3), -1), np.full(k, -1)
    status = np.zeros(k, dtype=np.int8)
    longest = int(np.diff(starts).max(initial=0))

    def run(first: int) -> None:
        _run(x, y, starts, first, min(first + CHUNK, k), longest, found, bases, corners, status)

    with ThreadPoolExecutor(workers or len(os.sched_getaffinity(0))) as pool:
        for _ in pool.map(run, range(0, k, CHUNK)):
            pass
    return Peaks(
        points=found[:, :2],
        angles=found[:, 2],
        bounds=found[:, 3],
        bases=np.where(bases < 0, -1, bases >> 1),
        walls=(bases >= 0) & (bases & 1 == 1),
        vertices=corners,
        status=status,
    )


def _checked(vertices: npt.ArrayLike, offsets: npt.ArrayLike | None) -> tuple[Floats, Ints]:
    """Coordinates of shape (m, 2) and valid offsets."""
    try:
        xy = np.asarray(vertices, dtype=np.float64)
        starts = np.asarray([] if offsets is None else offsets)
    except (TypeError, ValueError) as problem:
        raise UserError(f"vertices and offsets must be arrays of numbers: {problem}") from None
    if offsets is None:
        if xy.ndim != 3 or xy.shape[2] != 2:
            raise UserError(f"vertices without offsets need the shape (k, n, 2), not {xy.shape}")
        starts = np.arange(len(xy) + 1) * xy.shape[1]
        return xy.reshape(-1, 2), starts
    if xy.ndim != 2 or xy.shape[1] != 2:
        raise UserError(f"vertices with offsets need the shape (m, 2), not {xy.shape}")
    if starts.ndim != 1 or not len(starts) or not np.issubdtype(starts.dtype, np.integer):
        raise UserError("offsets must be a sequence of whole numbers, one more than polygons")
    falls = np.flatnonzero(starts[1:] < starts[:-1])  # a difference may wrap around
    if starts[0] < 0 or starts[-1] > len(xy) or len(falls):
        where = f"decrease at index {falls[0] + 1}" if len(falls) else "leave the array"
        raise UserError(f"offsets {where}")
    return xy, starts.astype(np.int64)


@compiled
def _run(x, y, starts, first, last, longest, found, bases, corners, status):
    """Polygons first … last − 1, one after the other."""
    space = np.empty((4, longest))
    basis, nu, chosen = np.full(4, -1), np.zeros(3), np.full(3, -1)
    row = np.zeros((4, 4))
    for k in range(first, last):
        n = starts[k + 1] - starts[k]
        status[k], corners[k] = peak_of(x, y, starts[k], n, space, basis, nu, row, chosen, found[k])
        for slot in range(3):
            bases[k, slot] = basis[slot]
