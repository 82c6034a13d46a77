"""Topologies ``flip`` and ``full``: better angles by exchanging edges, and by other vertices."""

from __future__ import annotations

import numpy as np

from harness.mesh.all_angles import SOFT, improve_all
from harness.mesh.points import try_points
from harness.mesh.soft import soft_sweep
from harness.mesh.state import State, rises
from harness.mesh.steps import even_out, ideal_degrees, lawson, try_flips

ROUNDS = 5
"""Times that degrees are evened out and vertices moved in turn."""
GENTLE = 12.0
FLOOR = np.radians(2.0)
TARGET = np.radians(50.0)
"""Vertices with no smaller angle are good enough."""
EFFORT = 3
"""Visits for flips that are tried, in multiples of those of all sweeps."""


def improve_flipping(state: State, sweeps: int) -> None:
    """Raise the smallest angle by moves and flips.

    The degrees of the whole mesh are evened out first, with soft sweeps between; then come the
    stages of fixed connectivity, and flips one by one around the worst vertices.  What comes out
    is above the input in lexicographic order, or the input.
    """
    begin = state.kept()
    before = state.least
    stars = (*state.stars, state.x, state.y)
    ideal = ideal_degrees(*stars)
    state.reconnect(lawson(*stars))
    for round_ in range(ROUNDS):
        if state.is_late:
            break
        for _ in range(2):
            state.sweep(soft_sweep, SOFT if round_ < 2 else GENTLE)
        state.reconnect(even_out(*stars, ideal, FLOOR))
        state.record("degrees")
    improve_all(state, sweeps)
    state.reconnect(lawson(*stars))
    _try_flips(state, ideal, EFFORT * sweeps)
    if not rises(before, state.least):
        state.restore(begin)
        improve_all(state, sweeps)


def improve_fully(state: State, sweeps: int) -> None:
    """The same, and then insertions and deletions of vertices around the worst ones.

    The state must have places for new vertices, without triangles, after the others.
    """
    improve_flipping(state, sweeps)
    waiting = state.free.copy()
    left = EFFORT * sweeps * len(state.order)
    arrays = (*state.stars, state.free, state.x, state.y, state.origins, state.born, TARGET)
    while left > 0 and not state.is_late:
        visits, moves, steps, done = try_points(waiting, *arrays, min(left, len(state.free)))
        state.visits += visits
        state.moves += moves
        state.reconnect(steps)
        state.record("vertices")
        left -= max(visits, 1)
        if done:
            break


def _try_flips(state: State, ideal: np.ndarray, sweeps: int) -> None:
    """Flips with smoothing, in portions, so that the time limit is heeded."""
    waiting = state.free.copy()
    left = sweeps * len(state.order)
    arrays = (*state.stars, state.free, state.x, state.y, ideal, TARGET)
    while left > 0 and not state.is_late:
        visits, moves, flips, done = try_flips(waiting, *arrays, min(left, len(state.order)))
        state.visits += visits
        state.moves += moves
        state.reconnect(flips)
        state.record("flips")
        left -= max(visits, 1)
        if done:
            break
