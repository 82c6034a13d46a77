"""Making a counterexample small: fewer segments first, then smaller whole coordinates.

The moves are those of this domain: leave out a segment or a vertex; round all coordinates to a
coarse lattice; move one coordinate towards 0.  A move counts if the instance becomes *simpler* (see
:func:`simplicity`) and still shows what it is to show.  Greedy, until no move counts or the budget
of checks is spent: the result is small, not proved to be smallest.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.audit.cases import is_valid
from harness.geometry.coordinates import Kind
from harness.geometry.instance import Instance

LATTICES = (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 20, 24, 32, 48, 64, 128, 256, 1024, 4096)
"""Widths to which coordinates are rounded, coarsest first."""

Simplicity = tuple[float, ...]


@dataclass(frozen=True)
class Shrunk:
    """The simplest instance that was found, and how many checks that took."""

    instance: Instance
    checks: int


def simplicity(instance: Instance) -> Simplicity:
    """A key that falls as instances get simpler.

    Segments; then for whole coordinates the greatest, their sum, and all of them in order; others
    are less simple than any.  Coordinates count from the lower left corner of the box.
    """
    values = instance.floats.reshape(-1, 2)
    if instance.exact is not None or (values != np.round(values)).any():
        return (instance.n, math.inf)
    moved = (values - values.min(axis=0)).reshape(-1)
    return (instance.n, float(moved.max()), float(moved.sum()), *moved.tolist())


def shrink(instance: Instance, shows: Callable[[Instance], bool], budget: int) -> Shrunk:
    """The simplest instance reached from ``instance`` for which ``shows`` holds.

    ``shows`` is asked of valid instances only, at most ``budget`` times.  Deterministic.
    """
    best, checks, improved = instance, 0, True
    seen = {simplicity(instance)}
    while improved:
        improved = False
        for candidate in moves(best):
            key = simplicity(candidate)
            if key in seen or key >= simplicity(best) or not is_valid(candidate):
                continue
            if checks == budget:
                return Shrunk(best, checks)
            seen.add(key)
            checks += 1
            if shows(candidate):
                best, improved = candidate, True
                break
    return Shrunk(best, checks)


def moves(instance: Instance) -> Iterator[Instance]:
    """Candidates for something simpler, the most simplifying ones first."""
    rows = instance.floats
    least = 3 if instance.kind == "polygon" else 1
    if instance.n > least:
        for k in range(instance.n):
            yield _of(instance.kind, np.delete(rows, k, axis=0))
    low = rows.reshape(-1, 2).min(axis=0)
    width = float((rows.reshape(-1, 2).max(axis=0) - low).max())
    for lattice in LATTICES:
        if not math.isfinite(simplicity(instance)[1]) or lattice < width:
            yield _of(instance.kind, np.round((rows - low) * (lattice / width)))
    if math.isfinite(simplicity(instance)[1]):
        yield from _single_moves(instance.kind, rows - low)


def _single_moves(kind: Kind, rows: Any) -> Iterator[Instance]:
    """One coordinate nearer to 0, and whole columns and rows of the lattice closed up."""
    for axis in (0, 1):
        for cut in np.unique(rows[..., axis])[1:].tolist():
            closer = rows.copy()
            closer[..., axis] -= rows[..., axis] >= cut
            yield _of(kind, closer)
    flat = rows.reshape(-1)
    for k in np.argsort(-flat, kind="stable").tolist():
        for value in dict.fromkeys((0.0, flat[k] // 2, flat[k] - 1)):
            if value < flat[k]:
                moved = flat.copy()
                moved[k] = value
                yield _of(kind, moved.reshape(rows.shape))


def _of(kind: Kind, rows: Any) -> Instance:
    """An instance with its box's lower left corner at the origin, if its coordinates are whole."""
    values = np.asarray(rows, dtype=np.float64)
    if values.size and (values == np.round(values)).all():
        values = values - values.reshape(-1, 2).min(axis=0)
    return Instance(kind, values)
