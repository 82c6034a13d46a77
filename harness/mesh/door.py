"""The way into this room: points and triangles in, better ones out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.geometry.predicates import orientations
from harness.mesh.all_angles import improve_all
from harness.mesh.mesh import Mesh
from harness.mesh.options import OBJECTIVES
from harness.mesh.quality import Quality, quality
from harness.mesh.state import State, Sweep, state_of
from harness.mesh.stars import Ints
from harness.mesh.validation import Floats

SWEEPS = 20


class InvertedTriangle(ArithmeticError):
    """The result contains a triangle that is not positive; it is never handed out."""


@dataclass(frozen=True, eq=False)
class Improved:
    """A better mesh.

    ``points``: (n, 2).  ``triangles``: (m, 3), counter-clockwise.  ``before``, ``after``: figures
    in degrees.  ``moves`` of vertices and ``visits``, among them those that moved nothing.
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
    seconds: float
    complete: bool
    vertices: Ints
    cells: Ints
    history: list[Sweep] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """The figures by name, nested."""
        return {
            "before": self.before.as_dict(),
            "after": self.after.as_dict(),
            "visits": self.visits,
            "moves": self.moves,
            "seconds": round(self.seconds, 6),
            "complete": self.complete,
        }


def improve(
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    fixed: npt.ArrayLike | None = None,
    objective: str = OBJECTIVES[0],
    sweeps: int = SWEEPS,
    workers: int | None = None,
    time_limit: float | None = None,
    tell: Callable[[Sweep], None] | None = None,
) -> Improved:
    """Improve a triangulation; boundary vertices stay, and the smallest angle never gets worse.

    ``points``: (n, 2), or (n, 3) in one plane z = const.  ``triangles``: (m, 3), all in one
    orientation.  ``fixed``: further vertices that stay, as indices or n truth values.
    ``objective``: see :mod:`harness.mesh.options`.  ``sweeps``: at most that many times n visits
    of vertices.  ``workers``: threads, one per processor by default; the result does not depend
    on it.  ``time_limit``: seconds, after which the best mesh so far is returned.  ``tell`` is
    called after each sweep.  No triangle is ever inverted: moves are made where that is proven,
    and the result is checked exactly.

    Raises:
        UserError: names the first triangle that is wrong, or the option.
    """
    return improve_mesh(
        Mesh.of(points, triangles, fixed),
        objective=objective,
        sweeps=sweeps,
        workers=workers,
        time_limit=time_limit,
        tell=tell,
    )


def improve_mesh(
    mesh: Mesh,
    *,
    objective: str = OBJECTIVES[0],
    sweeps: int = SWEEPS,
    workers: int | None = None,
    time_limit: float | None = None,
    tell: Callable[[Sweep], None] | None = None,
) -> Improved:
    """The same for a mesh that is checked."""
    if objective not in OBJECTIVES:
        raise UserError(f"objective {objective!r} must be one of {', '.join(OBJECTIVES)}")
    if sweeps < 0:
        raise UserError(f"sweeps {sweeps} must be at least 0")
    start = time.perf_counter()
    deadline = np.inf if time_limit is None else time.monotonic() + time_limit
    exponent = _exponent(mesh.points)
    small = Mesh(np.ldexp(mesh.points, -exponent), mesh.triangles, mesh.fixed, mesh.stars)
    with state_of(small, workers, deadline, tell) as state:
        if sweeps and len(mesh.free):
            _METHODS[objective](state, sweeps)
        moved = (state.points != small.points).any(axis=1, keepdims=True)
        better = np.where(moved, np.ldexp(state.points, exponent), mesh.points)
        refuse_inverted(better, mesh.triangles)
        return Improved(
            points=better,
            triangles=mesh.triangles,
            before=quality(mesh.points, mesh.triangles),
            after=quality(better, mesh.triangles),
            visits=state.visits,
            moves=state.moves,
            seconds=time.perf_counter() - start,
            complete=not state.is_late,
            vertices=np.arange(len(better)),
            cells=np.arange(len(mesh.triangles)),
            history=state.history,
        )


_METHODS: dict[str, Callable[[State, int], None]] = {"all": improve_all}


def _exponent(points: Floats) -> int:
    """The power of two that brings all coordinates into [−1, 1], exactly where they stay normal."""
    return int(np.frexp(np.abs(points).max(initial=0.0))[1])


def refuse_inverted(points: Floats, triangles: Ints) -> None:
    """Raise :class:`InvertedTriangle` unless every triangle is positive, exactly."""
    signs = orientations(*(points[triangles[:, k]] for k in range(3)))
    wrong = np.flatnonzero(signs <= 0)
    if len(wrong):
        raise InvertedTriangle(f"triangle {wrong[0]} is not positive")
