"""The corners at infinity of an arrangement, and free points inside its faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.arrangement import Arrangement
from harness.diagram.fast.forms import U
from harness.diagram.fast.line_points import TINY
from harness.diagram.fast.lines import Lines
from harness.diagram.fast.plane import turn_key, turns_left
from harness.diagram.fast.roots import Floats, Ints, between, free_number
from harness.diagram.fast.rows import are_apart
from harness.diagram.planar_map import RationalPoint
from harness.diagram.work import Contradiction


@dataclass(frozen=True, eq=False)
class Far:
    """Corners at infinity.

    ``of_line`` (2r,): of the lines' directions; ``chains``: the corners from each of these to the
    next, both included.
    """

    of_line: Ints
    chains: list[list[int]]

    def met(self, arrangement: Arrangement, half: int) -> list[int]:
        """The corners at infinity of a face to which a half-edge leads."""
        direction = -1 - int(arrangement.heads[half])
        return self.chains[direction] if arrangement.gap[half] else [int(self.of_line[direction])]


def far_corners(
    lines: Lines, corners: ArrangedCorners, more: list[RationalPoint], seed: int
) -> Far:
    """All corners at infinity, counter-clockwise."""
    count = int(lines.rank.max()) + 1
    # As long as everything is large: halfway from a point to infinity is as far out again.
    reach = Fraction(float(np.abs(corners.frame).max())) / corners.prepared.scale
    vectors: list[RationalPoint] = [(Fraction(0), Fraction(0))] * (2 * count)
    rows: list[list[int]] = [[] for _ in range(count)]
    for i, k in enumerate(lines.rank.tolist()):
        size = max(map(abs, lines.d[i]))
        dx, dy = (reach * Fraction(part, size) for part in lines.d[i])
        vectors[k] = dx, dy
        vectors[k + count] = -vectors[k][0], -vectors[k][1]
        rows[k] += [2 * segment for segment in lines.segments[i]]
    numbers = [
        corners.add(vector, sorted(rows[k % count]), weight=0.0, special=bool(rows[k % count]))
        for k, vector in enumerate(vectors)
    ]
    stations = list(zip(vectors, numbers, [bool(row) for row in rows] * 2, strict=True))
    chains = [
        _chain(corners, station, stations[(k + 1) % len(stations)], more, seed)
        for k, station in enumerate(stations)
    ]
    return Far(np.array(numbers), chains)


#: A corner at infinity: its direction, its number, and whether it is special.
Station = tuple[RationalPoint, int, bool]


def _chain(
    corners: ArrangedCorners, start: Station, stop: Station, more: list[RationalPoint], seed: int
) -> list[int]:
    """The corners at infinity from one station to the next, less than half a turn further: the
    directions of ``more`` between them, and free ones between special ones."""
    scale = max(map(abs, start[0]))
    inside = [d for d in more if turns_left(start[0], d) and turns_left(d, stop[0])]
    found = [start]
    for x, y in sorted(inside, key=turn_key):
        long = (x * scale, y * scale)
        found.append((long, corners.add(long, weight=0.0, special=True), True))
    chain = [start[1]]
    for (d, _, one), (e, number, two) in pairwise([*found, stop]):
        if one and two:
            if len(found) > 1 and not are_apart(d, e):
                raise Contradiction("two directions at infinity are too close")
            free = between(d, e, free_number(5 + len(chain), seed))
            if not (turns_left(d, free) and turns_left(free, e)):
                raise Contradiction("no room for a free direction")
            chain.append(corners.add(free, weight=0.0))
        chain.append(number)
    return chain


def free_middles(
    corners: ArrangedCorners,
    lines: Lines,
    arrangement: Arrangement,
    wanted: NDArray[np.bool_],
    far: Far | None,
    seed: int,
) -> Ints:
    """A free point in every wanted face, −1 for the others, (f,).

    ``far``: None if no wanted face reaches infinity.
    """
    heads, face, faces = arrangement.heads, arrangement.face, arrangement.faces
    half = np.arange(len(heads))
    weight = 1.0 + np.modf(half * 0.7548776662466927 + 0.1371 * (seed + 1))[0]
    finite = heads >= 0
    at = corners.frame[np.maximum(heads, 0)]
    total = np.bincount(face[finite], weight[finite], minlength=faces)
    middles = np.empty((faces, 2))
    for axis in range(2):
        summed = np.bincount(face[finite], weight[finite] * at[finite, 2 * axis], minlength=faces)
        middles[:, axis] = summed / np.maximum(total, 1.0)
    if far is not None:
        for h in np.flatnonzero(heads < 0).tolist():
            chain = far.met(arrangement, h)
            middles[face[h]] += _shares(chain, seed) @ corners.frame[chain, 0::2]
    unsure = wanted & ~_surely_inside(corners, lines, arrangement, middles)
    numbers = np.full(faces, -1, dtype=np.int64)
    numbers[wanted] = corners.add_free(middles[wanted]) + np.arange(int(wanted.sum()))
    for f in np.flatnonzero(unsure).tolist():
        point = _exact_middle(corners, arrangement, far, f, weight, seed)
        corners.replace(int(numbers[f]), point)
    return numbers


def _surely_inside(
    corners: ArrangedCorners, lines: Lines, arrangement: Arrangement, middles: Floats
) -> NDArray[np.bool_]:
    """Whether points, one in each face, are certainly inside it.

    With u = 2⁻⁵³ a product of the point and a line's rounded vector is off by 2u, both lines'
    numbers by u, and their differences by 2u of all that is added: 16u is more, and TINY for
    underflow.  What overflows is not certain.
    """
    rounded = lines.rounded()
    d, half = rounded.d, np.arange(len(arrangement.heads))
    scale = corners.prepared.scale / lines.unit
    c = np.array(
        [float(c * scale / (1 << k)) for c, k in zip(lines.c, rounded.length, strict=True)]
    )
    line = arrangement.line[half >> 1]
    x, y = middles[arrangement.face].T
    with np.errstate(all="ignore"):
        one, two, three = d[line, 0] * y, d[line, 1] * x, c[line]
        value = np.where(half & 1, -1.0, 1.0) * (one - two - three)
        size = np.abs(one) + np.abs(two) + np.abs(three)
        sure = value > 16 * U * size + TINY * (1 + np.abs(x) + np.abs(y))
    inside: NDArray[np.bool_] = (
        np.bincount(arrangement.face, ~sure, minlength=arrangement.faces) == 0
    )
    return inside


def _exact_middle(
    corners: ArrangedCorners,
    arrangement: Arrangement,
    far: Far | None,
    face: int,
    weight: Floats,
    seed: int,
) -> RationalPoint:
    """A point inside a face, as a rational combination of its corners.

    All its corners have positive weights, also those at infinity, and they are not all on the line
    of one side: so the point is on no side.
    """
    halves = arrangement.cycle[arrangement.first[face] : arrangement.first[face + 1]].tolist()
    x = y = total = Fraction(0)
    for h in halves:
        head = int(arrangement.heads[h])
        if head >= 0:
            w = Fraction(float(weight[h]))
            px, py = corners.exact_corner(head)
            x, y, total = x + w * px, y + w * py, total + w
    x, y = x / total, y / total
    for h in halves:
        if far is not None and arrangement.heads[h] < 0:
            chain = far.met(arrangement, h)
            for corner, share in zip(chain, _shares(chain, seed).tolist(), strict=True):
                dx, dy = corners.exact_corner(corner)
                x, y = x + Fraction(share) * dx, y + Fraction(share) * dy
    return x, y


def _shares(chain: Sequence[int], seed: int) -> Floats:
    """Weights of corners at infinity in a free point."""
    return np.array([float(free_number(k + 9, seed)) / len(chain) for k in range(len(chain))])
