"""Objective ``all``: raise the smallest of all angles, with the connectivity as it is.

Three stages, each of which does what the one before cannot: a start for the whole mesh at once
(harmonic, if that is softer than the input), soft sweeps that grow sharper, and patches around
the worst vertices.  In each star the smallest of all angles is quasiconcave in the kernel (Amenta,
Bern and Eppstein, "Optimal point placement for mesh smoothing", 1999), so the soft optimum tends
to the only true one.
"""

from __future__ import annotations

import numpy as np

from harness.mesh.angles import all_proven
from harness.mesh.harmonic import harmonic
from harness.mesh.patches import mend
from harness.mesh.quality import corner_angles
from harness.mesh.soft import soft_sweep
from harness.mesh.state import State, rises
from harness.mesh.validation import Floats

SOFT, SHARP = 5.0, 80.0
"""Sharpness of the first and of the last sweep, per radian."""
SHARE = 0.6
"""The part of all sweeps that is soft; the rest of the visits goes into patches."""


def improve_all(state: State, sweeps: int) -> None:
    """Raise the smallest angle, by as many visits of vertices as ``sweeps`` sweeps make.

    The sorted vector of the triangles' least angles ends above that of the input in lexicographic
    order, or the coordinates as they were.
    """
    first = _kept(state)
    begin = state.least
    best = first, begin
    soft = max(1, round(SHARE * sweeps))
    _start(state)
    for sharpness in np.geomspace(SOFT, SHARP, soft):
        if state.is_late:
            break
        state.sweep(soft_sweep, sharpness)
        state.record("soft")
        if state.history[-1].quality.smallest > best[1][0]:
            best = _kept(state), state.least
    now = state.least
    if rises(now, best[1]) or not rises(begin, now):
        state.x[:], state.y[:] = best[0]
    _mend(state, sweeps - soft)
    if not rises(begin, state.least):
        state.x[:], state.y[:] = first


def _kept(state: State) -> tuple[Floats, Floats]:
    return state.x.copy(), state.y.copy()


def _start(state: State) -> None:
    """Take the harmonic coordinates if they invert nothing and are softer than the input."""
    free = np.flatnonzero(state.free)
    if not len(free):
        return
    before = softness_of(state)
    old = _kept(state)
    state.x[:], state.y[:] = harmonic(state.x, state.y, state.stars, free)
    if not (all_proven(*state.stars, state.x, state.y) and softness_of(state) < before):
        state.x[:], state.y[:] = old
    else:
        state.moves += int(((state.x != old[0]) | (state.y != old[1])).sum())


def softness_of(state: State) -> float:
    """The sum of exp(−SOFT · angle) over all angles of the mesh; less is better."""
    angles = np.radians(corner_angles(state.points, state.triangles))
    return float(np.exp(-SOFT * angles).sum())


def _mend(state: State, sweeps: int) -> None:
    """Patches, in portions of one sweep's visits, so that the time limit is heeded."""
    failures = np.zeros(len(state.x), dtype=np.int64)
    arrays = (*state.stars, state.free, state.x, state.y, failures)
    order = np.flatnonzero(state.free)
    left = sweeps * len(order)
    while left > 0 and not state.is_late:
        visits, moves, done = mend(order, *arrays, min(left, len(order)))
        state.visits += visits
        state.moves += moves
        left -= visits
        state.record("patches")
        if done:
            break
