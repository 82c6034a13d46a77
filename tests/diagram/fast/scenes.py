"""Two segments over a triangle, chosen to make rounding errors large and signs doubtful."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from hypothesis import strategies as st

from tests.diagram.fast.exact_forms import Corner, Point, Scene
from tests.strategies import cross

OFFSETS: tuple[int | Fraction, ...] = (0, 1_000_000, 2**40, 2**52, Fraction(2**40, 3))
#: 1 for the numbers of the lattice as they are; the others nudge them.
NUDGES = (0, 2**-52, 2**-30, 1e-12, 1e-3)


def _fraction_point(x: Any, y: Any) -> Point:
    return Fraction(x), Fraction(y)


def _moved(scene: Scene, image: Any) -> Scene:
    """The scene under an affine map of points; directions (w = 0) stay."""
    segments = tuple((image(a), image(b)) for a, b in scene.segments)
    corners = tuple((*image((x, y)), w) if w else (x, y, w) for x, y, w in scene.corners)
    return replace(scene, segments=segments, corners=corners)


def moved(scene: Scene, factor: Fraction, dx: Fraction, dy: Fraction) -> Scene:
    """Scaled and translated."""
    return _moved(scene, lambda p: (p[0] * factor + dx, p[1] * factor + dy))


def rounded(scene: Scene) -> Scene:
    """With every coordinate a double, as most input is; what was on a line need not stay there.

    A corner that was an endpoint stays one.
    """
    result = _moved(scene, lambda p: (Fraction(float(p[0])), Fraction(float(p[1]))))
    kept = tuple(e & z for e, z in zip(scene.ends, scene.zeros, strict=True))
    return replace(result, zeros=kept)


def fine(scene: Scene) -> bool:
    """Whether segments are no points and the triangle is counter-clockwise."""
    p, q, r = scene.corners
    determinant = (
        p[0] * (q[1] * r[2] - r[1] * q[2])
        - p[1] * (q[0] * r[2] - r[0] * q[2])
        + p[2] * (q[0] * r[1] - r[0] * q[1])
    )
    return determinant > 0 and all(a != b for a, b in scene.segments)


def lattice(bound: int = 8) -> st.SearchStrategy[Fraction]:
    whole = st.integers(-bound, bound)
    nudged = st.builds(lambda n, e: n + Fraction(e), whole, st.sampled_from(NUDGES))
    return st.builds(Fraction, whole | nudged)


def points() -> st.SearchStrategy[Point]:
    return st.tuples(lattice(), lattice())


@st.composite
def corners_beside(draw: st.DrawFn, segments: list[tuple[Point, Point]]) -> tuple[Any, list[int]]:
    """A corner, and for both segments 0, 1 (on the line) or 2 (an endpoint)."""
    kind = draw(st.sampled_from(["free", "free", "end", "line", "near line", "circle", "far"]))
    which = draw(st.integers(0, 1))
    a, b = segments[which]
    t = Fraction(draw(st.integers(-6, 9)), draw(st.integers(1, 3)))
    x, y = a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])
    if kind == "end":
        x, y = a
    elif kind == "near line":
        x, y = x + Fraction(draw(st.sampled_from(NUDGES))), y
    elif kind == "circle":  # where the segment is seen under a right angle, Q = 0
        s = Fraction(draw(st.integers(-4, 4)), 3)
        dx, dy = b[0] - a[0], b[1] - a[1]
        u, v = 1 / (1 + s * s), s / (1 + s * s)
        x, y = a[0] + u * dx - v * dy, a[1] + u * dy + v * dx
    elif kind == "free":
        x, y = draw(points())
    if kind == "far":
        direction = draw(st.integers(-3, 3)), draw(st.integers(-3, 3))
        x, y = _fraction_point(*(direction if any(direction) else (1, 0)))
    w = int(kind != "far")
    marks = []
    for p, q in segments:
        if w and (x, y) in (p, q):
            marks.append(2)
        else:
            area = cross((x, y), p, q) if w else x * (q[1] - p[1]) - y * (q[0] - p[0])
            marks.append(int(area == 0))
    return (x, y, Fraction(w)), marks


def _other_segment(draw: st.DrawFn, first: tuple[Point, Point]) -> tuple[Point, Point]:
    """A second segment: any, or nearly the first, nearly parallel, collinear, joined, or equal."""
    (ax, ay), (bx, by) = first
    nudge = Fraction(draw(st.sampled_from(NUDGES)))
    kind = draw(st.sampled_from(["any", "near", "parallel", "collinear", "joined", "shifted"]))
    if kind == "near":
        return (ax + nudge, ay), (bx, by + nudge)
    if kind == "parallel":
        return (ax, ay + 1), (bx + nudge, by + 1)
    if kind == "collinear":
        return (ax + 2 * (bx - ax), ay + 2 * (by - ay)), (ax + 3 * (bx - ax), ay + 3 * (by - ay))
    if kind == "joined":
        return (bx, by), draw(points())
    if kind == "shifted":
        dx, dy = draw(points())
        return (ax + dx, ay + dy), (bx + dx, by + dy)
    return draw(points()), draw(points())


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """Scaled as the builder does; with structural zeros wherever they are true."""
    first = (draw(points()), draw(points()))
    segments = [first, _other_segment(draw, first)]
    made = [draw(corners_beside(segments)) for _ in range(3)]
    zeros = [sum(1 << k for k, (_, marks) in enumerate(made) if marks[s]) for s in range(2)]
    ends = [sum(1 << k for k, (_, m) in enumerate(made) if m[s] == 2) for s in range(2)]
    scene = Scene(
        tuple(segments),
        tuple(corner for corner, _ in made),
        (zeros[0], zeros[1]),
        (ends[0], ends[1]),
        draw(st.sampled_from([1, -1])),
    )
    if not fine(scene):
        scene = swapped(scene)
    if not fine(scene):
        scene = Scene(STANDARD.segments, STANDARD.corners, sense=scene.sense)
    offset = Fraction(draw(st.sampled_from(OFFSETS)))
    factor = Fraction(2) ** draw(st.sampled_from([0, 0, -300, 200]))
    factor = factor / draw(st.sampled_from([1, 3]))
    scene = moved(scene, factor, factor * offset, -factor * offset / 2)
    if draw(st.booleans()) and fine(rounded(scene)):
        scene = rounded(scene)
    return scene.scaled()


def swapped(scene: Scene) -> Scene:
    """With the last two corners exchanged."""

    def bits(flags: int) -> int:
        return flags & 1 | (flags & 2) << 1 | (flags & 4) >> 1

    p, q, r = scene.corners
    zeros = bits(scene.zeros[0]), bits(scene.zeros[1])
    ends = bits(scene.ends[0]), bits(scene.ends[1])
    return Scene(scene.segments, (p, r, q), zeros, ends, scene.sense)


def _corner(x: int, y: int) -> Corner:
    return Fraction(x), Fraction(y), Fraction(1)


STANDARD = Scene(
    (
        (_fraction_point(5, 1), _fraction_point(4, 6)),
        (_fraction_point(-3, 2), _fraction_point(-4, -1)),
    ),
    (_corner(0, 0), _corner(2, 1), _corner(1, 3)),
)


def steps(most: int = 40) -> st.SearchStrategy[list[tuple[int, int]]]:
    """Halvings: anyhow, or ever the same, towards one corner."""
    anyhow = st.lists(st.tuples(st.integers(0, 2), st.integers(0, 1)), max_size=most)
    same = st.builds(
        lambda step, times: [step] * times,
        st.tuples(st.integers(0, 2), st.integers(0, 1)),
        st.integers(0, most),
    )
    return anyhow | same
