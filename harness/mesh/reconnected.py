"""Topologies ``flip`` and ``full``: better angles by exchanging edges, and by other vertices."""

from __future__ import annotations

import numpy as np

from harness.mesh.all_angles import SOFT, improve_all
from harness.mesh.points import try_points
from harness.mesh.soft import soft_sweep
from harness.mesh.stars import Ints
from harness.mesh.state import State, rises
from harness.mesh.steps import even_out, ideal_degrees, lawson, try_flips
from harness.mesh.validation import Floats

ROUNDS = 5
"""Times that degrees are evened out and vertices moved in turn."""
GENTLE = 12.0
FLOOR = np.radians(2.0)
TARGET = np.radians(50.0)
"""Vertices with no smaller angle are good enough."""
CLOSE = 0.1
"""Degrees by which two smallest angles may differ and the mean decides: where the boundary bounds
the smallest angle, all methods come close to that bound."""
EFFORT = 3
"""Visits for flips that are tried, in multiples of those of all sweeps."""


def improve_flipping(state: State, sweeps: int) -> None:
    """Raise the smallest angle by moves and flips.

    First by moves alone, which is enough for some meshes.  Then, from the start: the degrees of
    the whole mesh are evened out, with soft sweeps between; the stages of fixed connectivity
    follow, and flips are tried one by one around the worst vertices.  If that is no better (see
    ``CLOSE``) than moves alone, flips are tried from there.  What comes out is not below the input
    in lexicographic order.
    """
    begin, before = state.kept(), state.least
    ideal = ideal_degrees(*state.stars, state.x, state.y)
    improve_all(state, sweeps)
    moved, after = state.kept(), state.least
    if state.is_late:
        return
    state.restore(begin)
    _even_out(state, ideal)
    improve_all(state, sweeps)
    _try_flips(state, ideal, EFFORT * sweeps)
    if _is_better(state.least, after) and rises(before, state.least):
        return
    state.restore(moved)
    _try_flips(state, ideal, EFFORT * sweeps)
    if not (_is_better(state.least, after) and rises(before, state.least)):
        state.restore(moved)


def _even_out(state: State, ideal: Ints) -> None:
    """Even out the degrees of the whole mesh, with soft sweeps between."""
    stars = (*state.stars, state.x, state.y)
    state.reconnect(lawson(*stars))
    for round_ in range(ROUNDS):
        if state.is_late:
            break
        for _ in range(2):
            state.sweep(soft_sweep, SOFT if round_ < 2 else GENTLE)
        state.reconnect(even_out(*stars, ideal, FLOOR))
        state.record("degrees")


def _is_better(new: Floats, old: Floats) -> bool:
    """Whether sorted least angles are better: a greater first one, or if close a greater mean."""
    if abs(new[0] - old[0]) > CLOSE:
        return bool(new[0] > old[0])
    return bool(new.mean() > old.mean())


def improve_fully(state: State, sweeps: int) -> None:
    """The same, and then insertions and deletions of vertices around the worst ones.

    The state must have places for new vertices, without triangles, after the others.
    """
    improve_flipping(state, sweeps)
    waiting = state.free.copy()
    arrays = (*state.stars, state.free, state.x, state.y, state.origins, state.born, TARGET)
    state.spend(
        EFFORT * sweeps * len(state.order),
        len(state.free),
        "vertices",
        lambda portion: try_points(waiting, *arrays, portion),
    )


def _try_flips(state: State, ideal: Ints, sweeps: int) -> None:
    """Lawson's flips, and flips with smoothing."""
    state.reconnect(lawson(*state.stars, state.x, state.y))
    waiting = state.free.copy()
    arrays = (*state.stars, state.free, state.x, state.y, ideal, TARGET)
    state.spend(
        sweeps * len(state.order),
        len(state.order),
        "flips",
        lambda portion: try_flips(waiting, *arrays, portion),
    )
