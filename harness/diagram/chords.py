"""Polylines of edges: how near a chord is to its piece of the curve, proved with the bisector.

Let F be the cubic of the two tied segments (:mod:`harness.geometry.bisector`) on whose zeros the
edge lies, p and q two of its points, m a point of the edge between them, and R the rectangle of
half-width w over the chord pq, whose short sides pass through p and q.

    If F has no zero on the long sides of R and none but p and q on the short ones, and if m lies
    inside R, then the whole piece from p to q lies in R: within w of its chord.

The piece without p and q is connected, runs on zeros of F and, edges being simple curves, does not
come back to p or q.  So it does not meet the boundary of R, and with m all of it is inside.

That m is near the chord proves nothing by itself: a piece that turns one way and then the other may
have its middle on its chord.  On a side F is a cubic in one variable.  Four values give its
Bernstein coefficients; if they have one sign, it has no zero.  Outwards from p along a short side
the first coefficient is F(p) = 0, up to rounding; if the three others have one sign, and the
opposite one on the other half, then by Descartes' rule there is one zero in all, which p is.
Where a bisector crosses itself in p the second coefficient is 0, too, and the last two tell.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from harness.diagram.planar_map import Window
from harness.geometry.coordinates import Floats

Position = tuple[float, float]

SAME = 1e-14
"""Points closer than this part of their coordinates are the same for a polyline."""
SPARE = 3
"""How often a piece is halved whose middle is near its chord, but that cannot be proved near it."""
DEEPEST = 50
"""How often a piece is halved at most: its points go from the finest doubles on."""

_THIRDS = np.array([0.0, 1 / 3, 2 / 3, 1.0])
_TO_BERNSTEIN = np.array([[6, 0, 0, 0], [-5, 18, -9, 2], [2, -9, 18, -5], [0, 0, 0, 6]]) / 6
_ERROR = 640 * 2.0**-53
"""What a Bernstein coefficient on a side is off by at most, in units of D⁴, where D bounds the
distances of the side's points, among them p, from all four endpoints.

With u = 2⁻⁵³: endpoints relative to p are off by uD, points of a side, which are at most 2D from p,
by 6uD, their difference by 8uD.  So Q and L, at most D², are off by 2·√2·8uD² + 3uD² < 26uD² each,
and F = Q L ∓ Q L by 4·26uD⁴ + 4uD⁴ = 108uD⁴.  A row of the matrix from values to coefficients
has a sum of 34/6 at most, which makes 612uD⁴; the rest is for the rounding of that product.
"""


class BisectorChords:
    """Chords of the bisector of two segments."""

    def __init__(self, segments: Floats) -> None:
        """``segments``: both, shape (2, 2, 2)."""
        self._ends = np.asarray(segments, dtype=float)

    def prove(self, p: Position, m: Position, q: Position, width: float) -> bool:
        """Whether the piece of the bisector from p by m to q is proved to be within ``width``.

        p, m and q are taken to lie on it up to rounding (``SAME``).  False is no proof of anything.
        """
        ends = self._ends - p
        chord, middle = np.subtract(q, p), np.subtract(m, p)
        # All lengths in units of a power of two near the greatest, so that nothing overflows.
        unit = float(np.abs(ends).max() + np.abs(chord).max() + width)
        if not 0 < unit < math.inf:
            return False
        unit = 2.0 ** math.frexp(unit)[1]
        ends, chord, middle, width = ends / unit, chord / unit, middle / unit, width / unit
        length = math.hypot(*chord)
        if length == 0:
            return False
        along = chord / length
        across = np.array([-along[1], along[0]])
        if not (0 < middle @ along < length and abs(middle @ across) < width):
            return False
        sides = _sides(chord, width * across)
        farthest = float(np.hypot(*np.moveaxis(ends[:, :, None, None] - sides, -1, 0)).max())
        l_s, l_t = _forms(ends, middle)[1].tolist()
        if min(abs(l_s), abs(l_t)) <= _ERROR * farthest**2:
            return False  # which of the two cubics it is remains open
        (q_s, q_t), (m_s, m_t) = _forms(ends, sides)
        values = q_s * m_t - q_t * m_s if l_s * l_t > 0 else q_s * m_t + q_t * m_s
        off = 8 * SAME * max(map(abs, (*p, *q))) / unit / width
        return _has_no_other_zero(values @ _TO_BERNSTEIN.T, _ERROR * farthest**4, off)


def _sides(chord: Floats, aside: Floats) -> Floats:
    """Four points on each long side and each half of a short side, from the chord, (6, 4, 2)."""
    none = np.zeros(2)
    starts = np.array([aside, -aside, none, none, chord, chord])
    steps = np.array([chord, chord, aside, -aside, aside, -aside])
    sides: Floats = starts[:, None] + _THIRDS[:, None] * steps[:, None]
    return sides


def _forms(ends: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Q and L of two segments at points (…, 2), shapes (2, …)."""
    to_ends = ends.reshape(2, 2, *(1,) * (points.ndim - 1), 2) - points
    (ax, ay), (bx, by) = (np.moveaxis(to_ends[:, end], -1, 0) for end in (0, 1))
    return ax * bx + ay * by, ax * by - ay * bx


def _has_no_other_zero(coefficients: Floats, error: float, off: float) -> bool:
    """Whether a cubic is proved to vanish at the chord's ends only, given those of the six sides.

    ``off``: by how much, in units of the half-width, rounding moves the ends.
    """
    signs = np.where(np.abs(coefficients) > error, np.sign(coefficients), 0.0)
    if not np.all(np.abs(signs[:2].sum(axis=1)) == 4):
        return False
    for k in (2, 4):
        last = signs[k : k + 2, 2:].sum(axis=1)
        if not np.all(np.abs(last) == 2):
            return False
        simple = np.all(np.abs(signs[k : k + 2, 1:].sum(axis=1)) == 3) and last[0] == -last[1]
        second, rest = coefficients[k : k + 2, 1], coefficients[k : k + 2, 2:]
        double = np.all(np.abs(second) <= off * np.abs(rest).max(axis=1))
        if not (simple or double):
            return False
    return True


def refined(
    point: Callable[[float], Position],
    cuts: Sequence[float],
    chords: BisectorChords,
    allowed: Callable[[Position, Position], float],
) -> Iterator[Position]:
    """Points of an arc from ``point(cuts[0])`` to ``point(cuts[-1])``.

    ``point`` runs along the arc; ``allowed``: what a chord between two points may be off by.  Every
    piece between cuts is halved once at least, and on until it is proved to be near its chord.
    Where that cannot be proved (where two branches of the bisector cross, and at the limits of
    doubles) it is halved ``SPARE`` times more than its middles ask for.
    """
    points = [point(r) for r in cuts]
    yield points[0]
    pieces = list(zip(cuts, points, cuts[1:], points[1:], strict=False))
    waiting = [(*piece, 0, SPARE) for piece in reversed(pieces)]
    while waiting:
        a, p, b, q, depth, spare = waiting.pop()
        middle = (a + b) / 2
        m = point(middle)
        width, gap = allowed(p, q), distance_to_chord(m, p, q)
        tiny = SAME * (abs(m[0]) + abs(m[1]))
        near = depth >= 1 and gap <= max(width, tiny)
        if depth == DEEPEST or (
            near and (math.dist(p, q) <= tiny or spare == 0 or chords.prove(p, m, q, width))
        ):
            yield q
            continue
        spare -= near
        waiting += [(middle, m, b, q, depth + 1, spare), (a, p, middle, m, depth + 1, spare)]


def default_window(points: Floats) -> Window:
    """Three times the box of points, shape (m, 2)."""
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    reach = max(x1 - x0, y1 - y0)
    return x0 - reach, y0 - reach, x1 + reach, y1 + reach


def allowed_in(window: Window, tolerance: float) -> Callable[[Position, Position], float]:
    """The tolerance near a window; what is far away is seen from it, and so may be off by more."""
    size = max(window[2] - window[0], window[3] - window[1])

    def allowed(p: Position, q: Position) -> float:
        dx = max(window[0] - max(p[0], q[0]), min(p[0], q[0]) - window[2], 0.0)
        dy = max(window[1] - max(p[1], q[1]), min(p[1], q[1]) - window[3], 0.0)
        return tolerance * (1 + math.hypot(dx, dy) / size)

    return allowed


def distance_to_chord(m: Position, p: Position, q: Position) -> float:
    """How far m is from the chord pq."""
    length = math.dist(p, q)
    if length == 0:
        return math.dist(m, p)
    along = ((m[0] - p[0]) * (q[0] - p[0]) + (m[1] - p[1]) * (q[1] - p[1])) / length**2
    along = min(1.0, max(0.0, along))
    return math.dist(m, (p[0] + along * (q[0] - p[0]), p[1] + along * (q[1] - p[1])))
