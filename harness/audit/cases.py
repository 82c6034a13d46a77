"""Where the instances of the claims come from: small lattices, and the families of the generators.

Random segments and polygons with small integer coordinates are full of the special positions in
which statements break, and their counterexamples are small from the start; the families show
whether it happens in general position, too.  Seeds come from what an instance is (family,
parameters, n, replicate and the base seed), so no order of a run matters.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping
from functools import cmp_to_key
from itertools import combinations, count
from typing import Any

from harness.audit.claim import Cases
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.geometry.kernel import kernel
from harness.geometry.validation import validate
from harness.study.task import Scalar, seed_of

Pair = tuple[int, int]
Admits = Callable[[Instance], bool]

ATTEMPTS = 10_000
"""How often a lattice instance is drawn before its size is given up."""


def families(*wanted: tuple[str, int, Mapping[str, Scalar]]) -> Cases:
    """Instances of generator families (name, n, parameters), in turn, with new seeds each round."""

    def cases(count: int, seed: int) -> Iterator[Instance]:
        for k in range(count):
            family, n, params = wanted[k % len(wanted)]
            yield generated(family, n, params, seed, k // len(wanted))

    return cases


def sizes(
    names: Mapping[str, tuple[int, ...]],
    params: Mapping[str, Mapping[str, Scalar]] | None = None,
    replicates: int = 1,
) -> Cases:
    """Each family at each of its sizes, ``replicates`` of each, whatever the count: for growth.

    ``names``: sizes by family; "family:anything" is another entry of the same family, with the
    ``params`` of that name.
    """

    def cases(_count: int, seed: int) -> Iterator[Instance]:
        for name, ns in names.items():
            for n in ns:
                family = name.partition(":")[0]
                for k in range(replicates):
                    yield generated(family, n, (params or {}).get(name, {}), seed, k)

    return cases


def together(*sources: tuple[Cases, float]) -> Cases:
    """Several sources, each with its share of the count, one after the other."""

    def cases(count: int, seed: int) -> Iterator[Instance]:
        for source, share in sources:
            yield from source(max(1, round(count * share)), seed)

    return cases


def generated(
    family: str, n: int, params: Mapping[str, Scalar], base_seed: int, replicate: int
) -> Instance:
    """An instance of a generator family, with the seed of its identity."""
    import generators

    seed = seed_of(base_seed, family, params, n, replicate)
    return Instance.from_generated(generators.generate(family, n, seed, **params))


# --- lattices ------------------------------------------------------------------------------------


def lattice_segments(*ns: int, size: int = 8, admits: Admits | None = None) -> Cases:
    """Disjoint segments with integer end points in [0, size]², n in turn.

    ``admits``: a further condition, such as that no two are parallel.
    """
    accepts = admits or disjoint

    def draw(rng: random.Random, n: int) -> Instance | None:
        rows: list[tuple[Pair, Pair]] = []
        for _ in range(n):
            rows.append((_point(rng, size), _point(rng, size)))
            if rows[-1][0] == rows[-1][1] or not accepts(_instance("segments", rows)):
                return None
        return _instance("segments", rows)

    return _drawn("lattice-segments", ns, size, draw)


def lattice_stars(*ns: int, size: int = 8, admits: Admits | None = None) -> Cases:
    """Star-shaped polygons with integer vertices in [−size, size]² around the origin, n in turn."""

    def draw(rng: random.Random, n: int) -> Instance | None:
        points = {(rng.randint(-size, size), rng.randint(-size, size)) for _ in range(n)}
        points.discard((0, 0))
        if len(points) < n:
            return None
        around = sorted(sorted(points), key=cmp_to_key(_before))
        if any(_cross(p, q) <= 0 for p, q in zip(around, [*around[1:], around[0]], strict=True)):
            return None
        found = _instance("polygon", around)
        return found if admits is None or admits(found) else None

    return _drawn("lattice-star", ns, size, draw)


def _drawn(
    family: str, ns: tuple[int, ...], size: int, draw: Callable[[random.Random, int], Any]
) -> Cases:
    """Draw until an instance is accepted, from a stream of its own for each instance."""

    def cases(count_: int, seed: int) -> Iterator[Instance]:
        for k in range(count_):
            n = ns[k % len(ns)]
            params: dict[str, Scalar] = {"size": size}
            own = seed_of(seed, family, params, n, k // len(ns))
            rng = random.Random(own)
            for attempt in count():
                if attempt == ATTEMPTS:
                    raise UserError(f"{family}: no instance of n = {n}, size = {size} was found")
                found = draw(rng, n)
                if found is not None:
                    break
            yield Instance(found.kind, found.floats, family=family, params=params, seed=own)

    return cases


def _instance(kind: Any, rows: Any) -> Instance:
    return Instance.from_arrays(kind, rows)


def _point(rng: random.Random, size: int) -> Pair:
    return rng.randint(0, size), rng.randint(0, size)


def _cross(p: Pair, q: Pair) -> int:
    return p[0] * q[1] - p[1] * q[0]


def _before(p: Pair, q: Pair) -> int:
    """The order of directions around the origin, counter-clockwise from the positive x-axis."""
    halves = [int(y < 0 or (y == 0 and x < 0)) for x, y in (p, q)]
    return halves[0] - halves[1] or -_cross(p, q)


# --- hypotheses ----------------------------------------------------------------------------------


def is_valid(instance: Instance) -> bool:
    """Whether an instance is proper; see :func:`harness.geometry.validation.validate`."""
    try:
        validate(instance)
    except UserError:
        return False
    return True


def disjoint(instance: Instance) -> bool:
    """Whether no two closed segments have a point in common, exactly; O(n²)."""
    return is_valid(instance) and not any(
        _touch(*pair) for pair in combinations(instance.rational_segments(), 2)
    )


def generic(instance: Instance) -> bool:
    """Disjoint, no two parallel, no end point on another's line: as the paper's proofs assume."""
    if not disjoint(instance):
        return False
    for (a, b), (c, d) in combinations(instance.rational_segments(), 2):
        s, t = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
        if s[0] * t[1] == s[1] * t[0]:
            return False
        if any(_is_on_line(p, a, b) for p in (c, d)) or any(_is_on_line(p, c, d) for p in (a, b)):
            return False
    return True


def star_shaped(instance: Instance) -> bool:
    """Whether an instance is a simple polygon whose kernel has interior, no angle straight."""
    return (
        instance.kind == "polygon"
        and instance.n >= 3
        and is_valid(instance)
        and instance.orientation != 0
        and _has_corners(instance)
        and kernel(instance).has_interior
    )


def _has_corners(instance: Instance) -> bool:
    """Whether a polygon turns at every vertex."""
    v = [instance.exact_vertex(k) for k in range(instance.n)]
    return all(
        (q[0] - p[0]) * (r[1] - p[1]) != (q[1] - p[1]) * (r[0] - p[0])
        for p, q, r in zip(v, v[1:] + v[:1], v[2:] + v[:2], strict=True)
    )


def _touch(s: Any, t: Any) -> bool:
    """Whether valid segments (no common inner points) share an end point or touch."""
    return any(_on(p, *t) for p in s) or any(_on(p, *s) for p in t)


def _is_on_line(p: Any, a: Any, b: Any) -> bool:
    """Whether a point is on the line through two others."""
    return bool((b[0] - a[0]) * (p[1] - a[1]) == (b[1] - a[1]) * (p[0] - a[0]))


def _on(p: Any, a: Any, b: Any) -> bool:
    """Whether a point is on a closed segment."""
    if not _is_on_line(p, a, b):
        return False
    return bool((a[0] - p[0]) * (b[0] - p[0]) + (a[1] - p[1]) * (b[1] - p[1]) <= 0)
