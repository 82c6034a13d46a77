"""One input of the diagram: a simple polygon, or a set of segments with disjoint interiors."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, cast

import numpy as np

from harness.errors import UserError
from harness.geometry import coordinates
from harness.geometry.coordinates import Exact, Floats, Kind, Point
from harness.geometry.exact import orientation

__all__ = ["Instance", "Point"]


@dataclass(frozen=True, eq=False)
class Instance:
    """A polygon or a set of segments, with the exact value of every coordinate.

    ``floats`` holds the nearest doubles: shape (m, 2), the vertices in the order given, for
    ``kind`` "polygon"; shape (n, 2, 2), segment × endpoint × coordinate, for "segments".
    ``exact`` is None if the doubles *are* the coordinates, and otherwise a tuple nested in the
    same way that holds every coordinate as a :class:`~fractions.Fraction`.

    Segment i of a polygon joins vertex i to vertex i + 1, whatever the orientation of the
    polygon, but is directed so that the interior lies on its left.

    ``source`` is where the instance was read from; messages begin with it.  An instance is only
    well-formed; :func:`harness.geometry.validation.validate` says whether it is simple.
    """

    kind: Kind
    floats: Floats
    exact: Exact | None = None
    name: str | None = None
    family: str | None = None
    params: Mapping[str, Any] = field(default_factory=dict)
    seed: int | None = None
    source: str | None = None

    def __post_init__(self) -> None:
        """Check shapes and finiteness; freeze the array."""
        if self.kind not in ("polygon", "segments"):
            raise UserError(f'kind must be "polygon" or "segments", not {self.kind!r}')
        shape = (2,) if self.kind == "polygon" else (2, 2)
        floats = np.array(self.floats, dtype=np.float64)
        if floats.shape[1:] != shape and floats.size:
            raise UserError(f"a {self.kind} instance needs coordinates of shape (n, {shape})")
        if not np.isfinite(floats).all():
            raise UserError("coordinates must be finite")
        floats = floats.reshape(-1, *shape)
        floats.flags.writeable = False
        object.__setattr__(self, "floats", floats)
        object.__setattr__(self, "params", dict(self.params))

    @classmethod
    def from_arrays(cls, kind: Kind, values: Any, **meta: Any) -> Instance:
        """An instance from nested sequences or an array of vertices or of segments.

        Leaves are numbers (taken as their doubles), :class:`~fractions.Fraction` or strings
        holding rationals (taken exactly).  ``meta`` are the descriptive fields of the class.
        Raises :class:`UserError` naming the offending index.  Linear time.
        """
        if kind not in ("polygon", "segments"):
            raise UserError(f'kind must be "polygon" or "segments", not {kind!r}')
        floats, exact = coordinates.parse(values, kind)
        return cls(kind=kind, floats=floats, exact=exact, **meta)

    @classmethod
    def from_generated(cls, generated: Any) -> Instance:
        """The instance a generator made (anything with its attributes will do)."""
        return cls(
            kind=generated.kind,
            floats=np.asarray(generated.coordinates, dtype=np.float64),
            family=generated.family,
            params=generated.params,
            seed=generated.seed,
        )

    @classmethod
    def from_geo_interface(cls, shape: Any) -> Instance:
        """The instance of a GeoJSON-like mapping or of an object with ``__geo_interface__``.

        Polygons without holes, line strings and collections of line strings are understood;
        anything else raises :class:`UserError`.
        """
        from harness.geometry.formats import geo_rows

        kind, rows = geo_rows(getattr(shape, "__geo_interface__", shape))
        return cls.from_arrays(kind, rows)

    @property
    def n(self) -> int:
        """The number of segments."""
        return len(self.floats)

    @property
    def label(self) -> str:
        """What messages call this instance."""
        return self.source or self.name or self.kind

    @cached_property
    def orientation(self) -> int:
        """1 for a counter-clockwise simple polygon, −1 for a clockwise one; 0 if flat or empty.

        The turn at the lexicographically least vertex, which is convex in every simple polygon
        (a flat turn there is a spike).  Exact; O(n).  Segments have orientation 1.
        """
        if self.kind == "segments":
            return 1
        if not self.n:
            return 0
        least = self._least_vertex()
        before, here, after = ((least + k) % self.n for k in (-1, 0, 1))
        return orientation(*(self.exact_vertex(i) for i in (before, here, after)))

    def _least_vertex(self) -> int:
        """The index of the lexicographically least vertex of a polygon, exactly."""
        x, y = self.floats[:, 0], self.floats[:, 1]
        candidates = np.flatnonzero(x == x.min())  # rounding is monotone: no other can be least
        if self.exact is None:
            return int(candidates[np.argmin(y[candidates])])
        return min((int(i) for i in candidates), key=self.exact_vertex)

    def exact_vertex(self, index: int) -> Point:
        """Vertex ``index`` of a polygon, exactly."""
        if self.exact is not None:
            return cast(Point, self.exact[index])  # vertices, since this is a polygon
        x, y = self.floats[index].tolist()
        return Fraction(x), Fraction(y)

    @cached_property
    def segments(self) -> Floats:
        """The segments as doubles, shape (n, 2, 2); see the class for their direction."""
        if self.kind == "segments":
            return self.floats
        ends = np.stack([self.floats, np.roll(self.floats, -1, axis=0)], axis=1)
        directed = ends[:, ::-1].copy() if self.orientation < 0 else ends
        directed.flags.writeable = False
        return directed

    def rational_segment(self, index: int) -> tuple[Point, Point]:
        """Segment ``index`` with exact endpoints, directed as in :attr:`segments`."""
        if self.kind == "segments":
            if self.exact is not None:
                return cast(tuple[Point, Point], self.exact[index])
            (ax, ay), (bx, by) = self.floats[index].tolist()
            return (Fraction(ax), Fraction(ay)), (Fraction(bx), Fraction(by))
        start, end = self.exact_vertex(index), self.exact_vertex((index + 1) % self.n)
        return (end, start) if self.orientation < 0 else (start, end)

    def rational_segments(self) -> list[tuple[Point, Point]]:
        """All segments with exact endpoints, directed as in :attr:`segments`.  O(n)."""
        return [self.rational_segment(i) for i in range(self.n)]

    def to_json(self) -> str:
        """The instance file's text; reading it back gives the same coordinates exactly."""
        key = "vertices" if self.kind == "polygon" else "segments"
        data: dict[str, Any] = {"kind": self.kind}
        for name in ("name", "family", "params", "seed"):
            if getattr(self, name) not in (None, {}):
                data[name] = getattr(self, name)
        data[key] = self.floats.tolist() if self.exact is None else _written(self.exact)
        return json.dumps(data, ensure_ascii=False, allow_nan=False, default=_plain) + "\n"


def _written(value: Any) -> Any:
    """Nested exact coordinates as JSON: numbers for doubles, strings for other rationals."""
    if isinstance(value, tuple):
        return [_written(item) for item in value]
    nearest = float(value)
    return nearest if Fraction(nearest) == value else str(value)


def _plain(value: Any) -> Any:
    """Numpy scalars among the parameters as the Python numbers they are."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} cannot be written as JSON")
