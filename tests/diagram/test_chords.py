"""Chords of edges: what is proved is true, for pieces of every length, and most is proved."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram import build
from harness.diagram.chords import BisectorChords, distance_to_chord
from harness.diagram.planar_map import Edge
from harness.geometry.coordinates import Floats
from tests import strategies
from tests.diagram.fast.both_builders import BUILDERS, CASES, WAVY, both
from tests.diagram.support import instance_of

EDGES = [(name, k) for name in CASES for k in range(len(both(name)[0].edges))]


def deviation(piece: Floats) -> float:
    """How far points between the first and the last are from the chord, at most."""
    p, q = piece[0].tolist(), piece[-1].tolist()
    return max(distance_to_chord(m, p, q) for m in piece[1:-1].tolist())


def fine(edge: Edge, size: float) -> Floats:
    return edge.polyline(1e-5 * size)


def size_of(name: str) -> float:
    return float(np.ptp(CASES[name][0].segments.reshape(-1, 2), axis=0).max())


@settings(max_examples=400)
@given(st.sampled_from(EDGES), st.data())
def test_what_is_proved_is_true(which: tuple[str, int], data: st.DataObject) -> None:
    name, k = which
    found = both(name)[0]
    line = fine(found.edges[k], size_of(name))
    if len(line) < 3:
        return
    first = data.draw(st.integers(0, len(line) - 3))
    last = data.draw(st.integers(first + 2, len(line) - 1))
    middle = data.draw(st.integers(first + 1, last - 1))
    piece = line[first : last + 1]
    chords = BisectorChords(found.instance.segments[list(found.edges[k].segments)])
    p, m, q = (line[i].tolist() for i in (first, middle, last))
    assert not chords.prove(p, m, q, 0.99 * deviation(piece))


def test_most_of_what_is_true_is_proved() -> None:
    proved = []
    for name, k in EDGES:
        found = both(name)[0]
        line = fine(found.edges[k], size_of(name))
        chords = BisectorChords(found.instance.segments[list(found.edges[k].segments)])
        for first in range(0, len(line) - 9, 8):
            piece = line[first : first + 9]
            p, m, q = (piece[i].tolist() for i in (0, 4, 8))
            proved.append(chords.prove(p, m, q, 2 * deviation(piece) + 1e-7 * size_of(name)))
    assert len(proved) > 300
    assert np.mean(proved) > 0.9


@pytest.mark.parametrize("builder", BUILDERS)
def test_an_edge_that_turns_both_ways_is_not_taken_for_its_chord(builder: str) -> None:
    found = build(WAVY, "kernel", "smallest", builder)
    (edge,) = [e for e in found.edges if min(p[1] for p in e.polyline(0.1).tolist()) > 2.2]
    for tolerance in (1e-1, 1e-2, 1e-3, 1e-4):
        coarse = edge.polyline(tolerance).tolist()
        for m in edge.polyline(1e-7).tolist():
            gaps = [distance_to_chord(m, p, q) for p, q in pairwise(coarse)]
            assert min(gaps) <= tolerance * (1 + 1e-6)


def test_a_chord_through_the_middle_of_a_wave_is_refused() -> None:
    found = build(WAVY, "kernel", "smallest")
    (edge,) = [e for e in found.edges if min(p[1] for p in e.polyline(0.1).tolist()) > 2.2]
    line = edge.polyline(1e-6)
    chords = BisectorChords(WAVY.segments[list(edge.segments)])
    refused = 0
    for first in range(0, len(line), 40):
        for last in range(first + 100, len(line), 40):
            piece, (p, q) = line[first : last + 1], line[[first, last]].tolist()
            gaps = [distance_to_chord(m, p, q) for m in piece.tolist()]
            across = [k for k in range(20, len(piece) - 20) if gaps[k] < 1e-2 * max(gaps)]
            for k in across[:1]:
                refused += 1
                assert not chords.prove(p, piece[k].tolist(), q, 0.5 * max(gaps))
                assert not chords.prove(p, piece[k].tolist(), q, 2 * gaps[k])
    assert refused > 3


@settings(max_examples=60, deadline=None)
@given(strategies.instances(), st.sampled_from(BUILDERS))
def test_polylines_are_as_near_as_they_say(given_: strategies.Instance, builder: str) -> None:
    instance = instance_of(given_)
    domain = "kernel" if given_[0] == "polygon" else "plane"
    found = build(instance, domain, "smallest", builder)
    size = float(np.ptp(instance.segments.reshape(-1, 2), axis=0).max())
    low = instance.segments.reshape(-1, 2).min(axis=0) - size
    high = low + 3 * size
    for edge in found.edges[:8]:
        coarse, way = edge.polyline(size / 100), edge.polyline(size / 3000)
        for m in way[np.all((way >= low) & (way <= high), axis=1)].tolist():
            pieces = list(pairwise(coarse.tolist()))
            assert min(distance_to_chord(m, p, q) for p, q in pieces) <= size / 100 * (1 + 1e-6)


@pytest.mark.parametrize("exponent", [-300, -60, 0, 60, 300])
def test_units_do_not_matter(exponent: int) -> None:
    found = build(WAVY, "kernel", "smallest")
    scale = 2.0**exponent
    for edge in found.edges:
        line = edge.polyline(1e-3) * scale
        chords = BisectorChords(WAVY.segments[list(edge.segments)] * scale)
        p, m, q = (line[k].tolist() for k in (0, len(line) // 2, -1))
        widths = [2.0**k for k in range(-12, 3)]
        plain = BisectorChords(WAVY.segments[list(edge.segments)])
        one = [chords.prove(p, m, q, w * scale) for w in widths]
        two = [plain.prove(*((line / scale)[k].tolist() for k in (0, len(line) // 2, -1)), w)
               for w in widths]  # fmt: skip
        assert one == two
        assert not chords.prove(p, m, p, scale)
        assert not chords.prove((math.nan, 0.0), m, q, scale)
