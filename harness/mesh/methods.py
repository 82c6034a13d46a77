"""The methods by name: each takes a state, and how many sweeps' worth of visits it may make."""

from __future__ import annotations

import numpy as np

from harness.mesh.all_angles import improve_all
from harness.mesh.apex import greedy
from harness.mesh.baselines import ascent_sweep, laplacian_sweep, smart_sweep
from harness.mesh.options import Options
from harness.mesh.reconnected import improve_flipping, improve_fully
from harness.mesh.state import State

PORTION, PORTIONS = 4096, 8
"""Visits of the greedy between two looks at the clock: at least so many, or a sweep's in so many
portions."""
SMALL = np.pi / 6
"""Stars with a smaller angle (radians) are left to ascent by ``combined``: 30°, as in the paper
of Freitag and Ollivier-Gooch."""
GUARDED = ("all", "apex", "smart-laplacian", "combined")
"""The objectives that never invert a triangle."""


def run(state: State, options: Options) -> bool:
    """Improve the state; whether there was nothing left to do, or the sweeps were used up."""
    if options.topology == "full":
        improve_fully(state, options.sweeps)
    elif options.topology == "flip":
        improve_flipping(state, options.sweeps)
    elif options.objective == "all":
        improve_all(state, options.sweeps)
    elif options.objective == "apex":
        _apex(state, options)
    else:
        _baseline(state, options)
    return not state.is_late


def _baseline(state: State, options: Options) -> None:
    """Sweeps of a method to compare with, until nothing moves."""
    for _ in range(options.sweeps):
        if state.is_late:
            return
        if options.objective == "laplacian":
            moved = state.sweep(laplacian_sweep)
        else:
            moved = state.sweep(smart_sweep)
            if options.objective == "combined":
                moved += state.sweep(ascent_sweep, SMALL)
        state.record(options.objective)
        if not moved:
            return


def _apex(state: State, options: Options) -> None:
    """The paper's greedy."""
    waiting = state.free.copy()
    remedies = options.remedy in ("bisector", "both"), options.remedy in ("chord", "both")
    arrays = (*state.stars, state.free, state.x, state.y)
    state.spend(
        options.sweeps * len(state.order),
        max(PORTION, len(state.order) // PORTIONS),
        "greedy",
        lambda portion: greedy(waiting, *arrays, *remedies, portion, portion),
    )
