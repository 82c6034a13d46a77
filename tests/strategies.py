"""Hypothesis strategies that make instances, the degenerate ones above all.

Every instance is a plain pair ``(kind, coordinates)`` with exact coordinates (int or Fraction):
``("polygon", ((x, y), …))`` or ``("segments", (((x, y), (x, y)), …))``.

* Segments have disjoint interiors; endpoints may touch (shared endpoints, T-junctions).
* Polygons are strictly star-shaped about the origin (it lies strictly left of every edge of the
  counter-clockwise polygon), hence simple, with a kernel that has interior.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import cmp_to_key
from typing import Any

from hypothesis import strategies as st

Number = int | Fraction
Point = tuple[Number, Number]
Segment = tuple[Point, Point]
#: Kind, and a tuple of points or of segments.
Instance = tuple[str, tuple[Any, ...]]
#: (x, y) ↦ (a·x − b·y + tx, b·x + a·y + ty)
Similarity = tuple[Number, Number, Number, Number]


# --- exact geometry ------------------------------------------------------------------------------


def cross(a: Point, b: Point, c: Point) -> Number:
    """Twice the signed area of the triangle a, b, c."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def interiors_meet(s: Segment, t: Segment) -> bool:
    """Whether two segments have a point in common that is an endpoint of neither."""
    (a, b), (c, d) = s, t
    sides = cross(a, b, c), cross(a, b, d), cross(c, d, a), cross(c, d, b)
    if not any(sides):
        return max(min(s), min(t)) < min(max(s), max(t))
    return sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0


def disjoint_subset(segments: Iterable[Segment]) -> tuple[Segment, ...]:
    """The segments one after another, leaving out each that is a point or meets an earlier one."""
    kept: list[Segment] = []
    for segment in segments:
        if segment[0] != segment[1] and not any(interiors_meet(segment, s) for s in kept):
            kept.append(segment)
    return tuple(kept)


def around_origin(points: Iterable[Point]) -> tuple[Point, ...]:
    """The points by angle about the origin, the first of each direction only."""

    def turn(p: Point, q: Point) -> int:
        upper_p, upper_q = (p[1], p[0]) > (0, 0), (q[1], q[0]) > (0, 0)
        if upper_p != upper_q:
            return -1 if upper_p else 1
        side = cross((0, 0), p, q)
        return (side < 0) - (side > 0)

    ordered = sorted((p for p in points if p != (0, 0)), key=cmp_to_key(turn))
    return tuple(p for i, p in enumerate(ordered) if i == 0 or turn(ordered[i - 1], p) != 0)


def star_shaped_about_origin(vertices: Sequence[Point]) -> bool:
    """Whether vertices sorted by angle leave the origin strictly left of every edge."""
    following = (*vertices[1:], *vertices[:1])
    return len(vertices) >= 3 and all(
        cross((0, 0), p, q) > 0 for p, q in zip(vertices, following, strict=True)
    )


# --- segments ------------------------------------------------------------------------------------


def points(bound: int = 6) -> st.SearchStrategy[Point]:
    """Points of the integer lattice: a small bound makes ties and alignments frequent."""
    return st.tuples(st.integers(-bound, bound), st.integers(-bound, bound))


def rational_points(bound: int = 50, denominator: int = 7) -> st.SearchStrategy[Point]:
    """Points with small denominators: in general position more often than not."""
    number = st.builds(Fraction, st.integers(-bound, bound), st.integers(1, denominator))
    return st.tuples(number, number)


@st.composite
def _disjoint(
    draw: st.DrawFn, candidates: st.SearchStrategy[Sequence[Segment]], least: int, most: int
) -> Instance:
    segments: tuple[Segment, ...] = disjoint_subset(draw(candidates))[:most]
    if len(segments) < least:  # fill up with a row of short segments out of everybody's way
        reach: list[Any] = [abs(z) for a, b in segments for z in (*a, *b)]
        far = 2 + max(reach, default=0)
        row = [((far + 2 * i, far), (far + 2 * i + 1, far)) for i in range(least - len(segments))]
        segments = (*segments, *row)
    return "segments", segments


def segment_sets(
    min_size: int = 1, max_size: int = 5, *, at: st.SearchStrategy[Point] | None = None
) -> st.SearchStrategy[Instance]:
    """Segments between random points ``at`` (default: a small lattice), interiors disjoint."""
    point = points() if at is None else at
    segment = st.tuples(point, point)
    return _disjoint(st.lists(segment, min_size=min_size, max_size=max_size), min_size, max_size)


def rational_segment_sets(min_size: int = 1, max_size: int = 5) -> st.SearchStrategy[Instance]:
    """Random rational segments with disjoint interiors."""
    return segment_sets(min_size, max_size, at=rational_points())


_DIRECTIONS: tuple[tuple[int, int], ...] = ((1, 0), (0, 1), (1, 1), (2, -1), (3, 1), (1, -2))


@st.composite
def collinear_runs(draw: st.DrawFn, max_size: int = 4) -> list[Segment]:
    """Segments on one line, some end to end."""
    dx, dy = draw(st.sampled_from(_DIRECTIONS))
    x, y = draw(points())
    steps = draw(
        st.lists(st.tuples(st.integers(0, 2), st.integers(1, 3)), min_size=2, max_size=max_size)
    )
    result: list[Segment] = []
    at = 0
    for gap, length in steps:
        start, at = at + gap, at + gap + length
        result.append(((x + start * dx, y + start * dy), (x + at * dx, y + at * dy)))
    return result


@st.composite
def parallel_rows(draw: st.DrawFn, max_size: int = 4) -> list[Segment]:
    """Parallel segments, often of equal length."""
    dx, dy = draw(st.sampled_from(_DIRECTIONS))
    lengths = st.just(draw(st.integers(1, 3))) | st.integers(1, 3)
    rows = draw(st.lists(st.tuples(st.integers(-2, 2), lengths), min_size=2, max_size=max_size))
    return [
        ((s * dx - i * dy, s * dy + i * dx), ((s + k) * dx - i * dy, (s + k) * dy + i * dx))
        for i, (s, k) in enumerate(rows)
    ]


@st.composite
def concurrent_lines(draw: st.DrawFn, max_size: int = 4) -> list[Segment]:
    """Segments whose lines all pass through one point, outside them or at their ends."""
    x, y = draw(points(3))
    rays = draw(st.lists(points(3), min_size=2, max_size=max_size))
    result: list[Segment] = []
    for dx, dy in around_origin(rays):
        near, length = draw(st.integers(0, 2)), draw(st.integers(1, 2))
        far = near + length
        result.append(((x + near * dx, y + near * dy), (x + far * dx, y + far * dy)))
    return result


@st.composite
def fans(draw: st.DrawFn, max_size: int = 4) -> list[Segment]:
    """Segments that share an endpoint."""
    x, y = draw(points(3))
    tips = around_origin(draw(st.lists(points(4), min_size=2, max_size=max_size)))
    return [((x, y), (x + dx, y + dy)) for dx, dy in tips]


@st.composite
def t_junctions(draw: st.DrawFn, max_size: int = 4) -> list[Segment]:
    """A beam with stems that stand on its interior."""
    dx, dy = draw(st.sampled_from(_DIRECTIONS))
    length = draw(st.integers(2, 5))
    beam: Segment = ((0, 0), (length * dx, length * dy))
    feet = draw(
        st.lists(st.integers(1, length - 1), min_size=1, max_size=max_size - 1, unique=True)
    )
    result = [beam]
    for foot in feet:
        sx, sy = draw(points(3))
        result.append(((foot * dx, foot * dy), (foot * dx + sx, foot * dy + sy)))
    return result


def degenerate_segment_sets(min_size: int = 1, max_size: int = 5) -> st.SearchStrategy[Instance]:
    """Collinear, parallel, concurrent, joined segments and T-junctions, alone or two mixed."""
    pattern = st.one_of(
        collinear_runs(max_size=max(2, max_size)),
        parallel_rows(max_size=max(2, max_size)),
        concurrent_lines(max_size=max(2, max_size)),
        fans(max_size=max(2, max_size)),
        t_junctions(max_size=max(2, max_size)),
    )
    mixed = st.builds(lambda one, two: [*one, *two], pattern, pattern)
    return _disjoint(pattern | mixed, min_size, max_size)


# --- polygons ------------------------------------------------------------------------------------


def _quadrant(turns: int, bound: int) -> st.SearchStrategy[Point]:
    """Lattice points with positive first and non-negative second coordinate, turned."""
    return st.tuples(st.integers(1, bound), st.integers(0, bound)).map(lambda p: turned(p, turns))


def turned(p: Point, quarters: int) -> Point:
    """``p`` turned by quarter turns about the origin."""
    for _ in range(quarters % 4):
        p = (-p[1], p[0])
    return p


@st.composite
def star_polygons(draw: st.DrawFn, max_size: int = 8, bound: int = 8) -> Instance:
    """Star polygons about the origin with small integer vertices; 3 ≤ n ≤ ``max_size``.

    One vertex in each quadrant keeps every gap below half a turn, so nothing has to be filtered;
    then each may be left out as long as that stays true, which gives triangles too.
    """
    base = [draw(_quadrant(k, bound)) for k in range(4)]
    more = draw(st.lists(points(bound), max_size=max(0, max_size - 4)))
    vertices = around_origin([*base, *more])
    while len(vertices) > max_size or draw(st.booleans()):
        shorter = [vertices[:i] + vertices[i + 1 :] for i in range(len(vertices))]
        fine = [v for v in shorter if star_shaped_about_origin(v)]
        if not fine:
            break
        vertices = draw(st.sampled_from(fine))
    return "polygon", vertices


@st.composite
def convex_polygons(draw: st.DrawFn, max_size: int = 8, bound: int = 8) -> Instance:
    """Strictly convex lattice polygons around the origin: their kernel is all of them."""
    _, vertices = draw(star_polygons(max_size=max_size, bound=bound))
    hull = list(vertices)
    changed = True
    while changed:
        changed = False
        for i, p in enumerate(hull):
            before, after = hull[i - 1], hull[(i + 1) % len(hull)]
            if cross(before, p, after) <= 0:
                del hull[i]
                changed = True
                break
    return "polygon", tuple(hull)


_Images = Callable[[Point], list[Point]]
_SYMMETRIES: dict[str, _Images] = {
    "half turn": lambda p: [p, turned(p, 2)],
    "quarter turn": lambda p: [turned(p, k) for k in range(4)],
    "mirror": lambda p: [p, (p[0], -p[1])],
    "two mirrors": lambda p: [p, (p[0], -p[1]), (-p[0], p[1]), turned(p, 2)],
    "square": lambda p: [turned(q, k) for q in (p, (p[1], p[0])) for k in range(4)],
}


@st.composite
def symmetric_polygons(draw: st.DrawFn, max_size: int = 8, bound: int = 6) -> Instance:
    """Star polygons with a symmetry: mirror images, hence saddles and many-fold ties."""
    images = _SYMMETRIES[draw(st.sampled_from(sorted(_SYMMETRIES)))]
    # The first three orbits have the origin inside, whatever the symmetry.
    candidates: list[Point] = [(draw(st.integers(1, bound)), 0), (-draw(st.integers(1, bound)), 0)]
    candidates += [(draw(st.integers(-bound, bound)), draw(st.integers(1, bound)))]
    candidates += draw(st.lists(points(bound), max_size=2))
    vertices: tuple[Point, ...] = ()
    for p in candidates:
        larger = around_origin([*vertices, *images(p)])
        if len(larger) <= max_size or not star_shaped_about_origin(vertices):
            vertices = larger
    return "polygon", vertices


@st.composite
def straight_angled_polygons(draw: st.DrawFn, max_size: int = 8) -> Instance:
    """Star polygons with a vertex in the middle of an edge: collinear adjacent edges."""
    _, vertices = draw(star_polygons(max_size=max_size - 1, bound=5))
    at = draw(st.integers(0, len(vertices) - 1))
    (px, py), (qx, qy) = vertices[at], vertices[(at + 1) % len(vertices)]
    doubled = [(2 * x, 2 * y) for x, y in vertices]
    return "polygon", (*doubled[: at + 1], (px + qx, py + qy), *doubled[at + 1 :])


@st.composite
def polygons(draw: st.DrawFn, max_size: int = 8) -> Instance:
    """Any of the star polygons, either way round and from any vertex."""
    kind, vertices = draw(
        st.one_of(
            star_polygons(max_size=max_size),
            convex_polygons(max_size=max_size),
            symmetric_polygons(max_size=max_size),
            straight_angled_polygons(max_size=max_size),
        )
    )
    first = draw(st.integers(0, len(vertices) - 1))
    vertices = vertices[first:] + vertices[:first]
    return kind, vertices[::-1] if draw(st.booleans()) else vertices


def instances(max_segments: int = 5, max_vertices: int = 8) -> st.SearchStrategy[Instance]:
    """Anything the diagram must serve."""
    return st.one_of(
        segment_sets(1, max_segments),
        rational_segment_sets(1, max_segments),
        degenerate_segment_sets(1, max_segments),
        polygons(max_vertices),
    )


# --- similarities --------------------------------------------------------------------------------


def similarities() -> st.SearchStrategy[Similarity]:
    """Exact similarities: integer scaling, quarter turns, the 3-4-5 rotation, translation."""
    rotation = st.sampled_from(
        [
            (1, 0),
            (0, 1),
            (-1, 0),
            (Fraction(3, 5), Fraction(4, 5)),
            (Fraction(-4, 5), Fraction(3, 5)),
        ]
    )
    return st.builds(
        lambda turn, scale, tx, ty: (scale * turn[0], scale * turn[1], tx, ty),
        rotation,
        st.integers(1, 9),
        st.integers(-100, 100),
        st.integers(-100, 100),
    )


def moved(instance: Instance, similarity: Similarity) -> Instance:
    """The image of an instance under a similarity."""
    a, b, tx, ty = similarity

    def image(p: Point) -> Point:
        return a * p[0] - b * p[1] + tx, b * p[0] + a * p[1] + ty

    kind, coordinates = instance
    if kind == "polygon":
        return kind, tuple(image(p) for p in coordinates)
    return kind, tuple((image(p), image(q)) for p, q in coordinates)
