"""The way into this room: points and triangles in, better ones out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.geometry.predicates import orientations
from harness.mesh.cuts import cut, uncut
from harness.mesh.glue import glued
from harness.mesh.mesh import Mesh
from harness.mesh.methods import GUARDED, run
from harness.mesh.options import Options, check_limits
from harness.mesh.quality import Quality, quality_of
from harness.mesh.stars import Ints
from harness.mesh.state import Sweep, state_of, with_places
from harness.mesh.validation import Floats

PLACES, LEAST_PLACES = 4, 16
"""One new vertex for so many free ones is possible, and at least so many."""
SMALLEST = -960
"""Coordinates below 2 to this power are near the least doubles, where these have few digits."""


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
    the old triangle whose data a new one takes, one of the same region.  ``made``: so many of the
    points, the last ones, are new.
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
    made: int = 0
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
    regions: npt.ArrayLike | None = None,
    edges: npt.ArrayLike | None = None,
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
    ``regions``: (m,) or (m, j), what tells regions of the mesh apart: edges between two regions
    stay, with their vertices, and so do ``edges`` (e, 2).
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
        Mesh.of(points, triangles, fixed, regions=regions, edges=edges),
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
    """The same for a mesh that is checked.

    Raises:
        UserError: ``workers`` or ``time_limit`` is no such number.
    """
    check_limits(workers, time_limit)
    start = time.perf_counter()
    deadline = np.inf if time_limit is None else time.monotonic() + time_limit
    whole = cut(mesh) if options.reconnects and len(mesh.kept) else uncut(mesh)
    small, exponent = _scaled(whole.mesh)
    if options.topology == "full":
        small = with_places(small, max(LEAST_PLACES, len(mesh.free) // PLACES))
    with state_of(small, workers, deadline, tell) as state:
        state.origins, state.born[0] = np.arange(len(small.points)), len(whole.owners)
        complete = run(state, options) if options.sweeps and len(mesh.free) else True
    done = glued(mesh, whole, small, state, exponent)
    inverted = _inverted(done.points, done.triangles)
    if len(inverted) and options.objective in GUARDED:
        _refuse_inverted(int(inverted[0]), exponent)
    return Improved(
        points=done.points,
        triangles=done.triangles,
        before=quality_of(mesh.points, mesh.triangles),
        after=quality_of(done.points, done.triangles),
        visits=state.visits,
        moves=state.moves,
        flips=state.flips,
        inverted=len(inverted),
        seconds=time.perf_counter() - start,
        complete=complete,
        vertices=done.vertices,
        cells=done.cells,
        made=done.made,
        history=state.history,
    )


def _scaled(mesh: Mesh) -> tuple[Mesh, int]:
    """The same mesh with coordinates of at most 1, and the power of two by which they are less.

    Raises:
        UserError: that is not exact, so what is proven of one mesh is not of the other.
    """
    used = np.where((mesh.stars.degrees > 0)[:, np.newaxis], mesh.points, 0.0)
    exponent = int(np.frexp(np.abs(used).max(initial=0.0))[1])
    small = np.ldexp(used, -exponent)
    lost = np.flatnonzero((np.ldexp(small, exponent) != used).any(axis=1))
    if len(lost):
        raise UserError(
            f"point {lost[0]} (counting from 0) has a coordinate that is more than 2^1000 times "
            "smaller than others: that is beyond the range of doubles"
        )
    return Mesh(small, mesh.triangles, mesh.fixed, mesh.stars, mesh.kept), exponent


def _refuse_inverted(triangle: int, exponent: int) -> NoReturn:
    if exponent < SMALLEST:
        raise UserError(
            f"the mesh is too small for doubles: rounded to what they hold there, triangle "
            f"{triangle} of the result would be inverted; scale the mesh up"
        )
    raise InvertedTriangle(f"triangle {triangle} is not positive")


def _inverted(points: Floats, triangles: Ints) -> Ints:
    """The triangles that are not positive, exactly."""
    signs = orientations(*(points[triangles[:, k]] for k in range(3)))
    return np.flatnonzero(signs <= 0)
