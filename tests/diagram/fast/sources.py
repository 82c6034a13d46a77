"""Instances on which two builders are compared: every family, and input as degenerate as it gets.

A *source* makes an instance from a random generator; ``instance(source, seed, index)`` is always
the same instance.  Sizes stay where the reference builder takes well under a second.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

from generators.family import Family, GeneratorError, Parameter
from generators.registry import FAMILIES, generate
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.geometry.validation import validate
from tests.diagram.support import corpus, corpus_instance
from tests.strategies import (
    Instance as Plain,
)
from tests.strategies import (
    around_origin,
    disjoint_subset,
    interiors_meet,
    moved,
    star_shaped_about_origin,
    turned,
)

Random = random.Random
Source = Callable[[Random, int], Plain | Instance]

#: Segments at most: a polygon's, and in the plane without one.
MOST_EDGES, MOST_SEGMENTS = 7, 5
DIRECTIONS = ((1, 0), (0, 1), (1, 1), (2, -1), (3, 1), (1, -2))


# --- lattice -------------------------------------------------------------------------------------


def _point(rng: Random, bound: int) -> tuple[int, int]:
    return rng.randint(-bound, bound), rng.randint(-bound, bound)


def _lattice_star(rng: Random, _: int) -> Plain:
    """Star-shaped about the origin, with small integers."""
    while True:
        wanted = rng.randint(3, MOST_EDGES)
        points = around_origin(_point(rng, rng.choice([2, 4, 8])) for _ in range(wanted))
        if star_shaped_about_origin(points):
            return "polygon", points[::-1] if rng.random() < 0.3 else points


def _lattice_simple(rng: Random, _: int) -> Plain:
    """Any simple polygon, seldom star-shaped: a closed tour whose crossings are undone."""
    while True:
        tour = list(dict.fromkeys(_point(rng, 4) for _ in range(rng.randint(4, MOST_EDGES))))
        for _ in range(100):
            crossing = _first_crossing(tour)
            if crossing is None:
                return "polygon", tuple(tour)
            i, j = crossing
            tour[i + 1 : j + 1] = tour[i + 1 : j + 1][::-1]


def _first_crossing(tour: Sequence[Any]) -> tuple[int, int] | None:
    edges = [(tour[k], tour[(k + 1) % len(tour)]) for k in range(len(tour))]
    for i, j in combinations(range(len(tour)), 2):
        if interiors_meet(edges[i], edges[j]):
            return i, j
    return None


def _symmetric(rng: Random, _: int) -> Plain:
    """Orbits of lattice points under the symmetries of a rectangle or a square."""
    images: list[Callable[[Any], list[Any]]] = [
        lambda p: [p, turned(p, 2)],
        lambda p: [p, (p[0], -p[1])],
        lambda p: [p, (p[0], -p[1]), (-p[0], p[1]), turned(p, 2)],
        lambda p: [turned(p, k) for k in range(4)],
        lambda p: [turned(q, k) for q in (p, (p[1], p[0])) for k in range(4)],
    ]
    while True:
        image = rng.choice(images)
        orbits = [image(_point(rng, 5)) for _ in range(rng.randint(1, 4))]
        points = around_origin(p for orbit in orbits for p in orbit)
        if 3 <= len(points) <= 8 and star_shaped_about_origin(points):
            return "polygon", points


def _lattice_segments(rng: Random, _: int) -> Plain:
    while True:
        bound = rng.choice([1, 2, 3, 6])
        pairs = [(_point(rng, bound), _point(rng, bound)) for _ in range(rng.randint(1, 8))]
        kept = disjoint_subset(pairs)[:MOST_SEGMENTS]
        if kept:
            return "segments", kept


def _collinear(rng: Random) -> list[Any]:
    (dx, dy), (x, y), at = rng.choice(DIRECTIONS), _point(rng, 3), 0
    result = []
    for _ in range(rng.randint(2, 4)):
        start = at + rng.randint(0, 2)
        at = start + rng.randint(1, 3)
        result.append(((x + start * dx, y + start * dy), (x + at * dx, y + at * dy)))
    return result


def _parallel(rng: Random) -> list[Any]:
    (dx, dy), length = rng.choice(DIRECTIONS), rng.randint(1, 3)
    result = []
    for i in range(rng.randint(2, 4)):
        s, k = rng.randint(-2, 2), length if rng.random() < 0.7 else rng.randint(1, 3)
        result.append(
            ((s * dx - i * dy, s * dy + i * dx), ((s + k) * dx - i * dy, (s + k) * dy + i * dx))
        )
    return result


def _concurrent(rng: Random) -> list[Any]:
    """On lines through one point, some beginning there."""
    x, y = _point(rng, 3)
    result = []
    for dx, dy in around_origin(_point(rng, 3) for _ in range(rng.randint(2, 4))):
        near = rng.choice([0, 0, 1, 2])
        far = near + rng.randint(1, 2)
        result.append(((x + near * dx, y + near * dy), (x + far * dx, y + far * dy)))
    return result


def _junction(rng: Random) -> list[Any]:
    """A beam with stems on its inside."""
    dx, dy = rng.choice(DIRECTIONS)
    length = rng.randint(2, 4)
    result: list[Any] = [((0, 0), (length * dx, length * dy))]
    for foot in rng.sample(range(1, length), rng.randint(1, length - 1)):
        sx, sy = _point(rng, 3)
        result.append(((foot * dx, foot * dy), (foot * dx + sx, foot * dy + sy)))
    return result


def _aligned(rng: Random, _: int) -> Plain:
    """Collinear, parallel, concurrent and joined segments."""
    patterns = [_collinear, _parallel, _concurrent, _junction]
    while True:
        made = rng.choice(patterns)(rng)
        if rng.random() < 0.5:
            made += rng.choice(patterns)(rng)
        kept = disjoint_subset(made)[:MOST_SEGMENTS]
        if kept:
            return "segments", kept


def _grid(rng: Random, _: int) -> Plain:
    """Equal segments on a square lattice, parallel or not."""
    columns, rows = rng.choice([(2, 1), (3, 1), (2, 2), (3, 2), (5, 1)])
    step = rng.choice([2, 3])
    vectors = [rng.choice([(1, 0), (0, 1), (1, 1)])] * 6
    if rng.random() < 0.5:
        vectors = [rng.choice([(1, 0), (0, 1)]) for _ in vectors]
    cells = [(step * x, step * y) for x in range(columns) for y in range(rows)]
    made = [(p, (p[0] + v[0], p[1] + v[1])) for p, v in zip(cells, vectors, strict=False)]
    return "segments", tuple(made[: MOST_SEGMENTS + 1])


def _equal(rng: Random, _: int) -> Plain:
    """Equal segments on a lattice, with one vector or two, whose asymptotes are irrational."""
    columns, rows = rng.choice([(3, 1), (1, 3), (4, 1), (3, 2), (2, 3), (2, 4), (3, 3)])
    while True:
        (ax, ay), (bx, by) = _point(rng, 4), _point(rng, 4)
        vectors = [_point(rng, 2) for _ in range(rng.choice([1, 1, 2]))]
        if rng.random() < 0.3:
            vectors.append(turned(vectors[0], 1))
        starts = [(x * ax + y * bx, x * ay + y * by) for x in range(columns) for y in range(rows)]
        made = []
        for x, y in starts:
            dx, dy = rng.choice(vectors)
            made.append(((x, y), (x + dx, y + dy)))
        kept = disjoint_subset(made)
        if ax * by != ay * bx and len(kept) >= 3:
            return "segments", kept


# --- floats and rationals ------------------------------------------------------------------------


def _regular(rng: Random, _: int) -> Plain:
    """Regular and two-ring polygons in doubles: symmetric but for the last bits."""
    n = rng.randint(3, 8)
    radii = (1.0, rng.choice([1.0, 1.0, 0.7, 0.45])) if n % 2 == 0 else (1.0, 1.0)
    start, x, y = rng.choice([0.0, 0.25, 0.1]), *rng.choice([(0.0, 0.0), (0.0, 0.0), (3.0, 1.0)])
    turns = [2 * math.pi * (k + start) / n for k in range(n)]
    return "polygon", tuple(
        (
            Fraction(x + radii[k % 2] * math.cos(turns[k])),
            Fraction(y + radii[k % 2] * math.sin(turns[k])),
        )
        for k in range(n)
    )


LATTICE: tuple[Source, ...] = (
    _lattice_star,
    _lattice_simple,
    _symmetric,
    _lattice_segments,
    _aligned,
    _grid,
)


def _plain(rng: Random) -> Plain:
    made = rng.choice(LATTICE)(rng, 0)
    assert not isinstance(made, Instance)
    return made


def _rational(rng: Random, _: int) -> Plain:
    """A degenerate instance exactly turned, scaled and shifted: no coordinate is a double."""
    a, b = rng.choice([(1, 0), (3, 4), (-4, 3), (5, 12)])
    scale = Fraction(rng.randint(1, 9), rng.choice([3, 7, 35]))
    shift = Fraction(rng.choice([0, 1, 10**6, 2**40]), 3)
    return moved(_plain(rng), (scale * a, scale * b, shift, -shift / 7))


def _mapped(plain: Plain, change: Callable[[Any], Fraction]) -> Plain:
    def deep(value: Any) -> Any:
        return tuple(map(deep, value)) if isinstance(value, tuple) else change(value)

    return plain[0], deep(plain[1])


def _nudged(rng: Random, _: int) -> Plain:
    """A degenerate instance in doubles that are off by an ulp or so."""
    ulps = rng.choice([2.0**-52, 2.0**-50, 2.0**-40, 2.0**-30])
    return _mapped(
        _plain(rng), lambda x: Fraction(float(x) + rng.choice([-2, -1, 0, 0, 1, 2]) * ulps)
    )


def _far(rng: Random, _: int) -> Plain:
    """Moved far away from the origin, in doubles, exactly."""
    shift = rng.choice([10**6, 2**40, 2**49])
    kind, coordinates = _plain(rng)
    return moved((kind, coordinates), (1, 0, shift, -3 * shift))


def _tiny(rng: Random, _: int) -> Plain:
    """One part of the instance shrunk by a great factor."""
    kind, coordinates = _plain(rng)
    factor = Fraction(1, 2 ** rng.choice([10, 30, 50]))
    if kind == "polygon":
        return kind, tuple((x, y * factor) for x, y in coordinates)
    shrunk = tuple(
        (a, (a[0] + factor * (b[0] - a[0]), a[1] + factor * (b[1] - a[1])))
        if rng.random() < 0.5
        else (a, b)
        for a, b in coordinates
    )
    return kind, shrunk


def _corpus(_: Random, index: int) -> Instance:
    cases = list(corpus().values())
    return corpus_instance(cases[index % len(cases)])


# --- families ------------------------------------------------------------------------------------


def _value(rng: Random, parameter: Parameter) -> object:
    if rng.random() < 0.5:
        return parameter.default
    if parameter.choices:
        return rng.choice(parameter.choices)
    assert parameter.allowed is not None
    low, high = parameter.allowed.low, min(parameter.allowed.high, 4 * float(parameter.default))
    if parameter.type is int:
        return rng.randint(int(low), int(high))
    return rng.choice([low + (high - low) * rng.random(), low + (high - low) * 1e-6])


def _of_family(family: Family) -> Source:
    most = MOST_EDGES if family.kind == "polygon" else MOST_SEGMENTS
    sizes = range(family.smallest, max(family.smallest, most, 6 if family.even else 0) + 1)

    def source(rng: Random, _: int) -> Instance:
        n = rng.choice([n for n in sizes if not (family.even and n % 2)])
        params = {parameter.name: _value(rng, parameter) for parameter in family.parameters}
        return Instance.from_generated(generate(family.name, n, rng.randrange(10**6), **params))

    return source


SOURCES: Mapping[str, Source] = {
    **{name: _of_family(family) for name, family in FAMILIES.items()},
    "corpus": _corpus,
    "lattice-star": _lattice_star,
    "lattice-simple": _lattice_simple,
    "symmetric": _symmetric,
    "regular": _regular,
    "lattice-segments": _lattice_segments,
    "aligned": _aligned,
    "square-grid": _grid,
    "equal": _equal,
    "rational": _rational,
    "nudged": _nudged,
    "far": _far,
    "tiny": _tiny,
}


def instance(source: str, seed: int, index: int) -> Instance:
    """A valid instance; always the same for the same arguments."""
    rng = random.Random(f"{source}/{seed}/{index}")
    while True:
        try:
            made = SOURCES[source](rng, index)
            if not isinstance(made, Instance):
                made = Instance.from_arrays(made[0], made[1])  # type: ignore[arg-type]  # a kind
            validate(made)
        except (UserError, GeneratorError):
            continue
        return made
