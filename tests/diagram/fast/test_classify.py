"""Leaves against the reference builder, with every coefficient shifted by what its bound allows.

A leaf may be refused; what is recognised must be what is there.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from harness.diagram.fast.classify import classify_definite
from harness.diagram.fast.forms import TERMS, UNKNOWN, U
from harness.diagram.fast.leaves import (
    ARC,
    CROSSING,
    EMPTY,
    FAILED,
    OPEN,
    QUAD,
    SADDLE,
    TRIPLE,
    TWO_ARCS,
)
from harness.diagram.fast.mixed import classify_mixed
from harness.diagram.fast.sides import new_scratch
from harness.geometry.instance import Instance
from tests.diagram.fast.exact_forms import exact_cubic, sign
from tests.diagram.fast.triangles import Cut, Seen, cuts, diagrams

#: Errors stay below (18 + 2d)/(24 + 2d) of the bound.
SHARE = Fraction(19, 20)
NAMES = {
    EMPTY: "empty",
    ARC: "arc",
    TRIPLE: "triple",
    TWO_ARCS: "two arcs",
    QUAD: "quad",
    SADDLE: "saddle",
    CROSSING: "crossing",
}
Table = list[Fraction]


def line_sign(table: Table) -> int:
    """The sign of L inside the triangle, 0 if it changes."""
    signs = {sign(value) for value in table[:3]} - {0}
    return signs.pop() if len(signs) == 1 else 0


def form_sign(table: Table) -> int:
    """The sign of Q on the triangle if its coefficients have one, else 0."""
    signs = {sign(value) for value in table[3:]} - {0}
    return signs.pop() if len(signs) == 1 else 0


def vanishing(c: int, t: Table, s: Table) -> bool:
    """Whether every product in a coefficient of F has a factor zero."""
    return all(
        (t[q] == 0 or s[k] == 0) and (s[q] == 0 or t[k] == 0)
        for q, k in TERMS[c].tolist()
        if q >= 0
    )


def size(t: Table, s: Table) -> float:
    """MQ_t ML_s + MQ_s ML_t."""

    def most(values: Table) -> float:
        return float(max(map(abs, values)))

    return most(t[3:]) * most(s[:3]) + most(s[3:]) * most(t[:3])


def shift(rng: random.Random, sure: bool) -> Fraction:
    """A share of the bound: all of it, mostly."""
    return SHARE * (rng.choice([-1, 1]) if sure else Fraction(rng.uniform(-1, 1)))


def definite(tables: list[Table], rng: random.Random, fineness: float) -> tuple[int, int, int, Any]:
    """Classify candidates none of whose lines crosses the triangle."""
    w = new_scratch()
    values, signs, bounds = w[0], w[1], w[2]
    sure = rng.random() < 0.7
    for a, b in combinations(range(len(tables)), 2):
        t, s = tables[a], tables[b]
        exact = exact_cubic(t, s, line_sign(t), line_sign(s))
        bound = max(24 * U * size(t, s), float(max(map(abs, exact))) * fineness)
        bounds[a, b] = bounds[b, a] = bound
        for c, value in enumerate(exact):
            if vanishing(c, t, s):
                values[a, b, c], signs[a, b, c] = 0.0, 0
            else:
                given = float(value + shift(rng, sure) * Fraction(bound))
                values[a, b, c] = given
                signs[a, b, c] = 1 if given > bound else (-1 if given < -bound else UNKNOWN)
            values[b, a, c] = -values[a, b, c]
            known = signs[a, b, c] != UNKNOWN
            signs[b, a, c] = -signs[a, b, c] if known else UNKNOWN
    kind, ports, choice = classify_definite(len(tables), w)
    return kind, ports, choice, w[4]


def mixed(tables: list[Table], rng: random.Random, fineness: float) -> tuple[int, int, int, Any]:
    """Classify two candidates at least one of whose lines crosses the triangle."""
    w = new_scratch()
    sure = rng.random() < 0.7
    shifted = [
        np.array([float(x * (1 + shift(rng, sure) * Fraction(fineness))) for x in table])
        for table in tables
    ]
    t, s = tables
    given, other = ([Fraction(x) for x in row.tolist()] for row in shifted)
    off = max(
        abs(x - y)
        for si in (1, -1)
        for x, y in zip(exact_cubic(t, s, si, 1), exact_cubic(given, other, si, 1), strict=True)
    )
    bound = max(24 * U * size(t, s), float(off / SHARE))
    kind, ports, choice = classify_mixed(
        np.stack(shifted), 0, 1, line_sign(t), line_sign(s), form_sign(t), bound, 0, 0, w
    )
    return kind, ports, choice, w[4]


def claims(cut: Cut, rng: random.Random) -> Iterator[tuple[int, int, list[tuple[int, int]]]]:
    """(kind, choice, slots) as recognised from ever less certain coefficients."""
    tables = cut.tables
    for fineness in (0.0, 1e-12, 1e-6, 1e-3, 1e-2, 0.03, 0.1):
        for _ in range(3):
            if all(map(line_sign, tables)):
                kind, ports, choice, slots = definite(tables, rng, fineness)
            elif len(tables) == 2 and len({form_sign(t) for t in tables} - {0}) == 1:
                if not all(map(form_sign, tables)):
                    return
                kind, ports, choice, slots = mixed(tables, rng, fineness)
            else:
                return
            if kind != FAILED:
                yield kind, choice, [(int(p), int(o)) for p, o in slots[: max(ports, 1)]]


def contradictions(kind: int, choice: int, slots: list[tuple[int, int]], seen: Seen) -> list[str]:
    """What a recognised leaf says that is not so."""
    plain = [degree for _, degree in seen.nodes]
    if kind == EMPTY:
        right = seen.ports == [] and seen.cells == 1 and seen.owner_at_start == slots[0][1]
        return [] if right else ["not empty"]
    wrong = [] if seen.ports == slots else [f"ports {slots}, truly {seen.ports}"]
    expected: dict[int, tuple[list[int], int]] = {
        ARC: ([], 1),
        TRIPLE: ([3], 3),
        TWO_ARCS: ([], 2),
        QUAD: ([3, 3], 5),
        CROSSING: ([4], 4),
    }
    if choice == OPEN:
        return wrong
    degrees, edges = expected[kind]
    if (plain, seen.edges) != (degrees, edges):
        return [*wrong, f"{seen.edges} edges and nodes {seen.nodes}"]
    if kind == CROSSING and seen.nodes[0][0] != "crossing":
        wrong.append(f"a {seen.nodes[0][0]} node")
    if kind == TWO_ARCS:
        joined = {frozenset((choice + 2 * r, (choice + 2 * r + 1) % 4)) for r in range(2)}
        if {frozenset((k, p)) for k, p in enumerate(seen.partner)} != joined:
            wrong.append(f"ports joined as {seen.partner}, not {joined}")
    if kind == QUAD:
        # With choice 0 slots 0 and 2 share an edge, so ports 1 and 2 end at one node.
        p = 1 - choice
        if seen.partner[p] != seen.partner[p + 1]:
            wrong.append(f"ports end at {seen.partner}")
    return wrong


def examined(cut: Cut, rng: random.Random, found: Counter[str]) -> list[str]:
    """Everything wrong with what is recognised in a triangle; counts kinds."""
    claimed = list(claims(cut, rng))
    if not claimed:
        return []
    try:
        seen = cut.view()
    except ValueError:  # too near together to tell apart in doubles
        return []
    wrong = []
    for kind, choice, slots in claimed:
        found[NAMES[kind] + (" open" if choice == OPEN else "")] += 1
        wrong += [
            f"{NAMES[kind]} {choice}: {text}" for text in contradictions(kind, choice, slots, seen)
        ]
    return wrong


SUITES = {
    "polygons": ["star", "zigzag", "convex-weave", "lattice-star", "regular", "nudged"],
    "symmetric": ["symmetric", "regular", "nudged", "square-grid"],
    "segments": ["segments", "grid", "lattice-segments", "aligned"],
}


@pytest.mark.parametrize("suite", SUITES)
def test_leaves_are_what_the_reference_sees(suite: str) -> None:
    rng = random.Random(suite)
    found: Counter[str] = Counter()
    every = diagrams(rng, SUITES[suite], 5)
    for _ in range(12):
        made = next(every)
        for cut in cuts(made, rng, 30):
            assert examined(cut, rng, found) == [], cut
    assert {"arc", "triple", "empty"} <= set(found)


def test_two_zeros_on_a_side_that_begins_at_an_endpoint() -> None:
    """Beside the extension of a segment, seen from its end, F₋ and F₊ change sign one after other.

    Both are zero at the end itself, so their zeros must not be sought there.
    """
    tip = (0.6822124741044564, 0.7416288935300173)
    segments = [
        ((0.0004259052132281338, 0.48102599308459515), (0.12433138461819052, 0.5721078130169469)),
        ((0.6711922315320911, 0.5882437806041907), tip),
    ]
    corners = [tip, (0.69189645, 1.06654734), (0.57358932, 0.96392033)]
    exact = tuple((Fraction(x), Fraction(y)) for x, y in corners)
    cut = Cut(Instance.from_arrays("segments", segments), "smallest", exact)  # type: ignore[arg-type]  # three long
    found: Counter[str] = Counter()
    assert examined(cut, random.Random(1), found) == []
    assert set(found) <= {"two arcs"}
