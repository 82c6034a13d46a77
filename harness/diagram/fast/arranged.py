"""Corners of the root triangles of an arrangement: very many, so in arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Generic, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast.line_points import Points
from harness.diagram.fast.lines import Lines
from harness.diagram.fast.prepare import Prepared
from harness.diagram.fast.roots import Floats, Ints, double_double
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Hopeless

T = TypeVar("T")


class _Computed(Sequence[T], Generic[T]):
    """A sequence whose members are computed when asked for."""

    def __init__(self, length: int, member: Callable[[int], T]) -> None:
        self._length, self._member = length, member

    def __len__(self) -> int:
        return self._length

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...
    def __getitem__(self, index: int | slice) -> T | list[T]:
        if isinstance(index, slice):
            return [self._member(k) for k in range(*index.indices(self._length))]
        if not -self._length <= index < self._length:
            raise IndexError(index)
        return self._member(index % self._length)

    def __iter__(self) -> Iterator[T]:
        return (self._member(k) for k in range(self._length))


class ArrangedCorners:
    """Corners as in :class:`harness.diagram.fast.roots.Corners`: the points on the lines, numbered
    as there, and after them points, at infinity or not, that are added.
    """

    def __init__(self, prepared: Prepared, lines: Lines, points: Points) -> None:
        """Raises Hopeless if two lines meet beyond the range of doubles; O(points)."""
        self.prepared, self.lines, self.pairs = prepared, lines, points.pairs
        self._others = points.others
        first, flat = _incidences(lines, points)
        self._frame: Floats = _frame_of_points(prepared, lines, points)
        self._weights: Floats = np.ones(len(points.pairs))
        self._special: NDArray[np.bool_] = np.diff(first) > 0
        self._first, self._flat = first, flat
        self._exactly: dict[int, RationalPoint] = {}
        #: What was added since: rows of the frame, weights, special or not, incident segments.
        self._waiting: list[tuple[Floats, float, bool, Sequence[int]]] = []
        self._count = len(points.pairs)

    # -- adding -----------------------------------------------------------------------------------

    def add(
        self,
        point: RationalPoint,
        incident: Sequence[int] = (),
        weight: float = 1.0,
        special: bool = False,
    ) -> int:
        """Add a corner; its number."""
        centre, scale = self.prepared.centre, self.prepared.scale
        row: list[float] = []
        for axis in range(2):
            value = point[axis] - centre[axis] if weight else point[axis]
            row += double_double(value * scale)
        number = self._extend(np.array([row]), weight, special, incident)
        self._exactly[number] = point
        return number

    def add_free(self, frame: Floats) -> int:
        """Add free points, given exactly by their coordinates (k, 2) in the frame; the first's
        number."""
        rows = np.zeros((len(frame), 4))
        rows[:, 0::2] = frame
        return self._extend(rows, 1.0, special=False)

    def replace(self, number: int, point: RationalPoint) -> None:
        """Move a free point."""
        self._settle()
        self._exactly[number] = point
        for axis in range(2):
            value = (point[axis] - self.prepared.centre[axis]) * self.prepared.scale
            self._frame[number, 2 * axis : 2 * axis + 2] = double_double(value)

    def _extend(
        self, rows: Floats, weight: float, special: bool, incident: Sequence[int] = ()
    ) -> int:
        number = self._count
        self._count += len(rows)
        self._waiting.append((rows, weight, special, incident))
        return number

    def _settle(self) -> None:
        """Put what was added into the arrays."""
        if not self._waiting:
            return
        waiting, self._waiting = self._waiting, []
        counts = [len(rows) for rows, _, _, _ in waiting]
        self._frame = np.concatenate([self._frame, *(rows for rows, _, _, _ in waiting)])
        weights = np.repeat([weight for _, weight, _, _ in waiting], counts)
        special = np.repeat([special for _, _, special, _ in waiting], counts)
        self._weights = np.concatenate([self._weights, weights])
        self._special = np.concatenate([self._special, special])
        flat = [np.array(incident, dtype=np.int64) for _, _, _, incident in waiting]
        ends = len(self._flat) + np.cumsum([len(row) for row in flat])
        self._flat = np.concatenate([self._flat, *flat])
        self._first = np.concatenate([self._first, np.repeat(ends, counts)])

    @property
    def frame(self) -> Floats:
        """Coordinates (c, 4) about the centre times the scale, as double-doubles."""
        self._settle()
        return self._frame

    @property
    def weights(self) -> Floats:
        """1, or 0 at infinity, (c,)."""
        self._settle()
        return self._weights

    @property
    def special(self) -> NDArray[np.bool_]:
        """Whether something is known to happen at each, (c,)."""
        self._settle()
        return self._special

    # -- reading ----------------------------------------------------------------------------------

    @property
    def exact(self) -> Sequence[RationalPoint]:
        """The exact coordinates of each corner."""
        return _Computed(self._count, self.exact_corner)

    @property
    def incident(self) -> Sequence[list[int]]:
        """The incident segments of each corner: 2·segment, + 1 if it is an endpoint."""
        self._settle()
        return _Computed(self._count, self._row)

    def _row(self, index: int) -> list[int]:
        row: list[int] = self._flat[self._first[index] : self._first[index + 1]].tolist()
        return row

    def exact_corner(self, index: int) -> RationalPoint:
        """The exact coordinates of a corner."""
        known = self._exactly.get(index)
        if known is not None:
            return known
        centre, scale = self.prepared.centre, self.prepared.scale
        if index >= len(self.pairs):
            x, y = (Fraction(float(v)) / scale for v in self.frame[index, 0::2])
            return centre[0] + x, centre[1] + y
        i, j = self.pairs[index].tolist()
        if i < 0:
            x, y = self._others[j]
            return centre[0] + x / self.lines.unit, centre[1] + y / self.lines.unit
        over_x, over_y, w = self.lines.crossing(i, j)
        w *= self.lines.unit
        return centre[0] + Fraction(over_x, w), centre[1] + Fraction(over_y, w)

    def arrays(self, centre: RationalPoint, scale: Fraction) -> tuple[Floats, Floats, Ints, Ints]:
        """As of :class:`harness.diagram.fast.roots.Corners`, with that centre and scale."""
        assert (centre, scale) == (self.prepared.centre, self.prepared.scale)
        self._settle()
        return self._frame, self._weights, self._first, self._flat

    def have_ends(self, corners: Ints) -> NDArray[np.bool_]:
        """Whether each of some corners (k,) is the endpoint of a segment."""
        self._settle()
        first, count = self._first[corners], self._first[corners + 1] - self._first[corners]
        row = np.repeat(np.arange(len(corners)), count)
        entry = np.repeat(first - (np.cumsum(count) - count), count) + np.arange(len(row))
        found = np.zeros(len(corners), dtype=bool)
        found[row[self._flat[entry] & 1 == 1]] = True
        return found

    def points(self) -> Floats:
        """Coordinates (c, 2) as doubles; directions of corners at infinity."""
        about = np.array([float(c) for c in self.prepared.centre])
        rounded: Floats = self.frame[:, 0::2] / float(self.prepared.scale)
        rounded += about * self.weights[:, None]
        return rounded


def _frame_of_points(prepared: Prepared, lines: Lines, points: Points) -> Floats:
    """Coordinates of the points on lines in the frame, each with an error of 2⁻¹⁰⁵ of it or, near
    the least doubles, of a least double."""
    up, down = prepared.scale.numerator, prepared.scale.denominator * lines.unit
    crossing = lines.crossing
    rows = []
    for i, j in points.pairs.tolist():
        if i >= 0:
            x, y, w = crossing(i, j)
            if w < 0:
                x, y, w = -x, -y, -w
        else:
            other = points.others[j]
            w = other[0].denominator * other[1].denominator
            x, y = int(other[0] * w), int(other[1] * w)
        w *= down
        rows.append((*_quotient(x * up, w), *_quotient(y * up, w)))
    return np.array(rows)


def _quotient(x: int, w: int) -> tuple[float, float]:
    """x/w as a double-double, for w > 0.

    Raises Hopeless if it is too large for one.
    """
    try:
        high = x / w
    except OverflowError:
        raise Hopeless("two lines meet beyond the range of doubles") from None
    p, q = high.as_integer_ratio()
    return high, (x * q - p * w) / (w * q)


def _incidences(lines: Lines, points: Points) -> tuple[Ints, Ints]:
    """The segments whose line passes through each point, and which of them end there (CSR)."""
    sizes = np.array([len(members) for members in lines.segments])
    firsts = np.cumsum(sizes) - sizes
    flat = np.array([k for members in lines.segments for k in members], dtype=np.int64)
    times = sizes[points.line]
    vertex = np.repeat(points.vertex, times)
    starts = np.repeat(np.cumsum(times) - times, times)
    segment = flat[np.repeat(firsts[points.line], times) + np.arange(len(vertex)) - starts]
    entry = 2 * segment + (points.ends[segment] == vertex[:, None]).any(axis=1)
    order = np.lexsort((entry, vertex))
    first = np.searchsorted(vertex[order], np.arange(len(points.pairs) + 1))
    return first.astype(np.int64), entry[order]
