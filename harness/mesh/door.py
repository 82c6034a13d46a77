"""The way into this room: points and triangles in, better ones out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.geometry.predicates import orientations
from harness.mesh.mesh import Mesh
from harness.mesh.methods import GUARDED, run
from harness.mesh.options import Options
from harness.mesh.quality import Quality, quality_of
from harness.mesh.stars import Ints
from harness.mesh.state import Sweep, state_of, with_places
from harness.mesh.validation import Floats

PLACES, LEAST_PLACES = 4, 16
"""One new vertex for so many free ones is possible, and at least so many."""


class InvertedTriangle(ArithmeticError):
    """The result contains a triangle that is not positive; it is never handed out."""


@dataclass(frozen=True, eq=False)
class Improved:
    """A better mesh.

    ``points``: (n, 2).  ``triangles``: (m, 3), counter-clockwise.  ``before``, ``after``: figures
    in degrees.  ``moves`` of vertices and ``visits``, among them those that moved nothing;
    ``flips`` of edges and other changes of
    connectivity.  ``inverted``: triangles that are not positive, 0 but for ``laplacian``.
    ``seconds``: of the improvement alone.  ``history``: a record of every sweep.  ``complete``:
    False if the time limit came first.  ``vertices`` (n,) and ``cells`` (m,): the old vertex and
    the old triangle whose data a new one takes.
    """

    points: Floats
    triangles: Ints
    before: Quality
    after: Quality
    visits: int
    moves: int
    flips: int
    inverted: int
    seconds: float
    complete: bool
    vertices: Ints
    cells: Ints
    history: list[Sweep] = field(default_factory=list)

    @property
    def is_reconnected(self) -> bool:
        """Whether the triangles are not those of the input."""
        return self.flips > 0 or len(self.cells) != len(self.triangles)

    def as_dict(self) -> dict[str, Any]:
        """The figures by name, nested."""
        return {
            "before": self.before.as_dict(),
            "after": self.after.as_dict(),
            "visits": self.visits,
            "moves": self.moves,
            "flips": self.flips,
            "inverted": self.inverted,
            "seconds": round(self.seconds, 6),
            "complete": self.complete,
        }


def improve(
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    fixed: npt.ArrayLike | None = None,
    objective: str = Options.objective,
    topology: str = Options.topology,
    remedy: str = Options.remedy,
    sweeps: int = Options.sweeps,
    workers: int | None = None,
    time_limit: float | None = None,
    tell: Callable[[Sweep], None] | None = None,
) -> Improved:
    """Improve a triangulation; boundary vertices stay.

    ``points``: (n, 2), or (n, 3) in one plane z = const.  ``triangles``: (m, 3), all in one
    orientation.  ``fixed``: further vertices that stay, as indices or n truth values.
    ``objective``, ``topology``, ``remedy``: see :mod:`harness.mesh.options`; with the objective
    ``all`` the smallest angle never gets worse.  ``sweeps``: at most that many times n visits of
    vertices.  ``workers``: threads, one per processor by default; the result does not depend on
    it.  ``time_limit``: seconds, after which the best mesh so far is returned.  ``tell`` is called
    after each sweep.  No triangle is ever inverted (but by ``laplacian``): moves are made where
    that is proven, and the result is checked exactly.

    Raises:
        UserError: names the first triangle that is wrong, or the option.
    """
    return improve_mesh(
        Mesh.of(points, triangles, fixed),
        Options(objective, topology, remedy, sweeps),
        workers=workers,
        time_limit=time_limit,
        tell=tell,
    )


def improve_mesh(
    mesh: Mesh,
    options: Options = Options(),  # noqa: B008 (it is frozen)
    *,
    workers: int | None = None,
    time_limit: float | None = None,
    tell: Callable[[Sweep], None] | None = None,
) -> Improved:
    """The same for a mesh that is checked."""
    start = time.perf_counter()
    deadline = np.inf if time_limit is None else time.monotonic() + time_limit
    exponent = int(np.frexp(np.abs(mesh.points).max(initial=0.0))[1])  # then all are in [−1, 1]
    small = Mesh(np.ldexp(mesh.points, -exponent), mesh.triangles, mesh.fixed, mesh.stars)
    if options.topology == "full":
        small = with_places(small, max(LEAST_PLACES, len(mesh.free) // PLACES))
    n = len(mesh.points)
    with state_of(small, workers, deadline, tell) as state:
        state.origins, state.born[0] = np.arange(len(small.points)), n
        complete = run(state, options) if options.sweeps and len(mesh.free) else True
    places = np.ldexp(state.points, exponent)
    stayed = (state.points[:n] == small.points[:n]).all(axis=1)
    places[:n][stayed] = mesh.points[stayed]
    used = state.stars.degrees > 0
    used[:n] |= mesh.stars.degrees == 0
    number = np.cumsum(used) - 1
    better, triangles = places[used], state.triangles
    if not used[:n].all() or len(better) != n:
        triangles = number[triangles]
    inverted = _inverted(better, triangles)
    if len(inverted) and options.objective in GUARDED:
        raise InvertedTriangle(f"triangle {inverted[0]} is not positive")
    return Improved(
        points=better,
        triangles=triangles,
        before=quality_of(mesh.points, mesh.triangles),
        after=quality_of(better, triangles),
        visits=state.visits,
        moves=state.moves,
        flips=state.flips,
        inverted=len(inverted),
        seconds=time.perf_counter() - start,
        complete=complete,
        vertices=state.origins[used],
        cells=_origins(mesh, better, triangles),
        history=state.history,
    )


def _inverted(points: Floats, triangles: Ints) -> Ints:
    """The triangles that are not positive, exactly."""
    signs = orientations(*(points[triangles[:, k]] for k in range(3)))
    return np.flatnonzero(signs <= 0)


def _origins(mesh: Mesh, points: Floats, triangles: Ints) -> Ints:
    """For each triangle the old one with the nearest centroid; itself if none has changed."""
    if triangles is mesh.triangles:
        return np.arange(len(triangles))
    from scipy.spatial import cKDTree

    old = cKDTree(mesh.points[mesh.triangles].mean(axis=1))
    return np.asarray(old.query(points[triangles].mean(axis=1))[1], dtype=np.int64)
