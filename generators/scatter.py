"""Sets of disjoint segments in the plane: ``segments``, ``grid`` and ``figure-2``."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from generators.family import Family, Interval, Parameter
from generators.portable import Array, Stream, unit_vectors

_Segment = tuple[float, float, float, float]


def segments(n: int, seed: int = 0, *, length: float = 0.5, spread: float = 0.5) -> Array:
    """n random disjoint segments with midpoints in the unit square; shape (n, 2, 2).

    Midpoints and directions are uniform and independent; lengths are uniform between
    (1 − spread) and (1 + spread) times ``length``/√n, so ``length`` is in units of the mean
    spacing of the segments.  A segment that meets an earlier one is drawn again (random
    sequential adsorption).  That always ends: the translates of a segment by a little are free.
    By the Crofton formula a candidate meets on average at most 2·length²/π of the segments
    before it, and about exp(−2·length²/π) of the last candidates are free.

    Candidates are compared only with segments in the nine cells around theirs of a grid as
    wide as the longest segment.

    Source: random sequential adsorption of needles; Evans, Rev. Mod. Phys. 65 (1993).
    Expected O(n e^(2·length²/π)).
    """
    SEGMENTS.check(n, {"length": length, "spread": spread})
    stream = Stream("segments", n, seed)
    scale = length / float(np.sqrt(float(n)))
    width = scale * (1.0 + spread)
    cells: dict[tuple[int, int], list[_Segment]] = {}
    kept: list[_Segment] = []
    for x, y, dx, dy in _needles(stream, scale, spread):
        column, row = int(x / width), int(y / width)
        needle = (x - dx, y - dy, x + dx, y + dy)
        near = (
            other
            for i in (column - 1, column, column + 1)
            for j in (row - 1, row, row + 1)
            for other in cells.get((i, j), ())
        )
        if all(_surely_disjoint(needle, other) for other in near):
            cells.setdefault((column, row), []).append(needle)
            kept.append(needle)
            if len(kept) == n:
                break
    return np.array(kept).reshape(n, 2, 2)


def _needles(stream: Stream, scale: float, spread: float) -> Iterator[tuple[float, ...]]:
    """Endless random needles: midpoint and half the vector along."""
    while True:
        batch = 1024
        middle = np.stack([stream.uniform(batch), stream.uniform(batch)], axis=1)
        half = np.multiply(0.5 * scale, np.add(1.0, np.multiply(spread, stream.signed(batch))))
        along = np.multiply(unit_vectors(stream.uniform(batch)), half[:, np.newaxis])
        yield from map(tuple, np.concatenate([middle, along], axis=1).tolist())


def _surely_disjoint(s: _Segment, t: _Segment) -> bool:
    """Whether one segment certainly lies strictly on one side of the other's line."""
    return _surely_aside(s, t) or _surely_aside(t, s)


def _surely_aside(s: _Segment, t: _Segment) -> bool:
    """Whether t lies strictly on one side of the line of s, rounding included.

    Each orientation determinant is off by less than 4·2⁻⁵³ of the sum of its two products
    (Shewchuk 1997); 10⁻¹⁵ leaves more than twice the room.
    """
    ax, ay, bx, by = s
    cx, cy, dx, dy = t
    first, second = (bx - ax) * (cy - ay), (by - ay) * (cx - ax)
    third, fourth = (bx - ax) * (dy - ay), (by - ay) * (dx - ax)
    one, two = first - second, third - fourth
    return (
        (one > 0.0) == (two > 0.0)
        and abs(one) > 1e-15 * (abs(first) + abs(second))
        and abs(two) > 1e-15 * (abs(third) + abs(fourth))
    )


def grid(n: int, seed: int = 0, *, variant: str = "regular", jitter: float = 0.5) -> Array:
    """The paper's worst case: n/2 horizontal and n/2 vertical segments; shape (n, 2, 2).

    The horizontal segments stand above each other left of the first quadrant, the vertical
    ones side by side below it (one fewer for odd n), and their extensions form a grid there.

    * ``regular`` — integer coordinates, all of length 1, spacing 1: full of parallels and ties;
    * ``generic`` — distances, lengths and slopes jittered, by ``jitter`` gaps in all.  A slope
      is at most jitter/2(n + 8), so the lines of two neighbours stay 1 − 3·jitter/2 > 0 apart
      over the whole grid and meet far away, outside both segments: *every* pair of the n
      segments has an extension crossing, n(n − 1)/2 of them.

    Source: Asano, Tamaki, Katoh & Tokuyama, "Angular Voronoi diagram with applications", ISVD
    2006, Figure 3.  O(n).
    """
    GRID.check(n, {"variant": variant, "jitter": jitter})
    rows = (n + 1) // 2
    place = np.concatenate([np.arange(1, rows + 1), np.arange(1, n - rows + 1)]).astype(np.float64)
    near, far = np.full(n, -1.0), np.full(n, -2.0)
    rise = np.zeros(n)
    if variant == "generic":
        stream = Stream("grid", n, seed)
        place = np.add(place, np.multiply(0.5 * jitter, stream.signed(n)))
        far = np.add(far, np.multiply(0.5 * jitter, stream.signed(n)))
        slope = np.multiply(0.5 * jitter / (n + 8), stream.signed(n))
        rise = np.multiply(slope, np.subtract(near, far))
    lengthwise = np.stack([far, near], axis=1)
    crosswise = np.stack([place, np.add(place, rise)], axis=1)
    out = np.stack([lengthwise, crosswise], axis=2)
    out[rows:] = out[rows:, :, ::-1].copy()
    return out


def figure_2(n: int = 3, seed: int = 0) -> Array:
    """Three segments round a triangle, in the manner of the paper's Figure 2; shape (3, 2, 2).

    The figure gives no coordinates; these are small integers in the same spirit: pairwise
    disjoint, no two parallel, all three extension crossings outside the segments.

    Source: Asano, Tamaki, Katoh & Tokuyama, "Angular Voronoi diagram with applications", ISVD
    2006, Figure 2.
    """
    FIGURE_2.check(n)
    return np.array(
        [[[-4.0, -3.0], [2.0, -4.0]], [[5.0, -2.0], [3.0, 3.0]], [[-1.0, 5.0], [-5.0, 1.0]]]
    )


SEGMENTS = Family(
    name="segments",
    kind="segments",
    summary="random disjoint segments in a square",
    source="random sequential adsorption of needles; Evans 1993",
    growth="n^2",
    build=segments,
    parameters=(
        Parameter("length", float, 0.5, "mean length, in units of 1/√n", Interval(0.001, 2.0)),
        Parameter("spread", float, 0.5, "relative half-width of the lengths", Interval(0.0, 0.9)),
    ),
    smallest=1,
    largest=100_000,
)

GRID = Family(
    name="grid",
    kind="segments",
    summary="n/2 horizontal and n/2 vertical segments whose extensions form a grid",
    source="Asano et al. 2006, Figure 3",
    growth="n^2",
    control=True,
    build=grid,
    parameters=(
        Parameter(
            "variant",
            str,
            "regular",
            "exact grid, or general position",
            choices=("regular", "generic"),
        ),
        Parameter("jitter", float, 0.5, "for generic: size of the jitter", Interval(1e-6, 0.6)),
    ),
    smallest=1,
    largest=1_000_000,
)

FIGURE_2 = Family(
    name="figure-2",
    kind="segments",
    summary="three segments round a triangle",
    source="Asano et al. 2006, Figure 2",
    growth="1",
    build=figure_2,
    random=False,
    smallest=3,
    largest=3,
)
