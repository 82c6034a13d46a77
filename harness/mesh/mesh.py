"""A checked triangulation of a part of the plane."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from harness.errors import UserError
from harness.mesh.interfaces import array_of, interfaces
from harness.mesh.stars import Flags, Ints, Stars
from harness.mesh.validation import Floats, checked


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangulation; made by :meth:`of`, which checks it.

    ``points``: (n, 2).  ``triangles``: (m, 3), counter-clockwise.  ``fixed``: (n,), the vertices
    that stay: those of the boundary and of interfaces, those that no triangle uses, and those that
    the user names.  ``kept``: (k, 2), the interior edges that stay (see
    :mod:`harness.mesh.interfaces`).
    """

    points: Floats
    triangles: Ints
    fixed: Flags
    stars: Stars
    kept: Ints

    @classmethod
    def of(
        cls,
        points: npt.ArrayLike,
        triangles: npt.ArrayLike,
        fixed: npt.ArrayLike | None = None,
        *,
        regions: npt.ArrayLike | None = None,
        edges: npt.ArrayLike | None = None,
    ) -> Mesh:
        """Check a triangulation; see :func:`harness.mesh.validation.checked`.

        ``fixed``: further vertices that stay, as indices or as n truth values.  ``regions``: (m,)
        or (m, j), what tells regions apart; edges between two regions stay, and so do ``edges``
        (e, 2).

        Raises:
            UserError: names the first triangle that is wrong.
        """
        xy, corners, stars = checked(points, triangles)
        stay = ~stars.closed | _marked(fixed, len(xy))
        kept = interfaces(corners, regions, edges)
        stay[kept] = True
        return cls(xy, corners, stay, stars, kept)

    @cached_property
    def free(self) -> Ints:
        """The vertices that may move, increasing."""
        return np.flatnonzero(~self.fixed)


def _marked(fixed: npt.ArrayLike | None, n: int) -> Flags:
    """Indices or truth values as truth values."""
    marks = np.zeros(n, dtype=np.bool_)
    if fixed is None:
        return marks
    given = array_of("fixed", fixed)
    if given.dtype == np.bool_ and given.shape == (n,):
        return given.copy()
    if given.size and (given.ndim != 1 or not np.issubdtype(given.dtype, np.integer)):
        raise UserError(f"fixed must be indices of vertices, or {n} truth values")
    wrong = np.flatnonzero((given < 0) | (given >= n))
    if len(wrong):
        raise UserError(f"fixed: there is no vertex {given[wrong[0]]}")
    marks[given.astype(np.int64)] = True
    return marks
