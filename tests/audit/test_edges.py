"""Lemmas 1, 2 and 4: known instances, independent methods, planted faults."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.audit import cubics, extrema, regions
from harness.audit.cases import lattice_stars
from harness.diagram import build
from harness.geometry.visual_angle import cot_visual_angle
from tests.audit.instances import (
    BESIDE,
    CROSSING,
    DART,
    PARALLEL,
    SQUARE,
    TEE,
    TRIANGLE,
    VALLEY,
    polygon,
    segments,
)

# --- Lemma 1 -------------------------------------------------------------------------------------


@pytest.mark.parametrize("instance", [CROSSING, TEE, PARALLEL, SQUARE, DART])
def test_edges_lie_on_cubics(instance) -> None:
    assert cubics.check_cubic(instance).outcome == "holds"


@pytest.mark.parametrize("instance", [CROSSING, TEE])
def test_the_other_cubic_is_noticed(instance, monkeypatch) -> None:
    right = cubics.bisector_cubics
    monkeypatch.setattr(cubics, "bisector_cubics", lambda s, t: right(s, t)[::-1])
    assert cubics.check_cubic(instance).outcome == "fails"


def test_a_quartic_is_noticed(monkeypatch) -> None:
    class Quartic:
        coefficients = (1,)

        def __call__(self, x, y):
            return right(x, y) * (x + 100)

    cubic = cubics.bisector_cubics
    right = cubic(*CROSSING.rational_segments())[0]
    monkeypatch.setattr(cubics, "bisector_cubics", lambda *_: (Quartic(), Quartic()))
    assert cubics.check_cubic(CROSSING).outcome == "fails"


def test_a_pair_may_need_both_cubics() -> None:
    assert cubics.check_one_cubic(BESIDE).outcome == "fails"


# --- Lemma 2 -------------------------------------------------------------------------------------


def test_the_known_counterexample_to_lemma_2() -> None:
    assert regions.check_every_region(CROSSING).outcome == "holds"
    tee = segments(((0, 0), (1, 0)), ((3, -1), (4, 1)))
    found = regions.check_every_region(tee)
    assert (found.outcome, found.facts["undivided"]) == ("fails", 1)
    assert regions.cells_by_segment(TEE) == {0: 1, 1: 3}


def test_the_proof_of_lemma_2_fails_where_it_applies() -> None:
    assert regions.lines_meet_outside(*BESIDE.rational_segments())
    assert regions.check_case_of_proof(BESIDE).outcome == "fails"
    assert regions.check_one_of_two(BESIDE).outcome == "holds"
    assert regions.cells_by_segment(BESIDE) == {0: 3, 1: 1}


def test_that_a_region_is_undivided_shows_on_a_raster() -> None:
    """Independent of any builder: one component of pixels for one segment, three for the other."""
    from scipy.ndimage import label

    axis = np.linspace(-40, 41, 1400) + 0.0137
    points = np.stack(np.meshgrid(axis, axis), axis=-1)
    first, second = (cot_visual_angle(points, s) for s in BESIDE.segments)
    assert [label(first > second)[1], label(second > first)[1]] == [3, 1]


@pytest.mark.parametrize("instance", [PARALLEL, SQUARE, segments(((0, 0), (1, 0)))])
def test_what_lemma_2_does_not_speak_of_is_outside(instance) -> None:
    for check in (regions.check_every_region, regions.check_case_of_proof):
        assert check(instance).outcome == "outside"


def test_a_lost_cell_refutes_the_repaired_lemma(monkeypatch) -> None:
    def broken(instance, domain):
        found = build(instance, domain, workers=1)
        cells = {cell.segment: cell for cell in found.cells}
        return replace(found, cells=tuple(cells.values()))

    monkeypatch.setattr(regions, "diagram", broken)
    assert regions.check_one_of_two(CROSSING).outcome == "fails"


# --- Lemma 4 -------------------------------------------------------------------------------------


def test_a_valley_on_an_edge() -> None:
    found = extrema.check_kernel(VALLEY)
    assert (found.outcome, found.facts["minima"]) == ("fails", 1)
    edge = next(e for e in build(VALLEY, builder="reference").edges if set(e.segments) == {0, 3})
    points = edge.polyline(1e-4)
    cotangents = cot_visual_angle(points, VALLEY.segments[0])
    top = int(cotangents.argmax())
    assert 0 < top < len(points) - 1
    assert cotangents[top] > max(cotangents[0], cotangents[-1]) + 0.1
    assert np.hypot(*(points[top] - found.marks[0])) < 1e-2
    assert edge.cotangent_range[1] == pytest.approx(cotangents[top], abs=1e-6)


def test_polygons_without_valleys() -> None:
    assert extrema.check_kernel(TRIANGLE).outcome == "holds"


def test_a_tie_of_four_at_a_touching_point_is_not_decided() -> None:
    """Balls cannot prove it; the centre of a square is a vertex, and lies inside no edge."""
    assert extrema.check_kernel(SQUARE).outcome == "undecided"


def test_an_edge_may_have_a_maximum() -> None:
    trapezium = polygon((1, 1), (0, 1), (0, 0), (2, 0))
    assert extrema.check_convex(trapezium).outcome == "fails"
    assert extrema.check_kernel(trapezium).outcome == "holds"


@settings(max_examples=12)
@given(st.integers(0, 10**6))
def test_extrema_are_those_of_the_edges(seed) -> None:
    """Against values along the polylines of another room: the same number of turns of each kind."""
    (instance,) = lattice_stars(5)(1, seed)
    seen = extrema.extrema(instance, "kernel")
    if seen.undecided:
        return
    minima = maxima = 0
    for edge in build(instance, "kernel", workers=1).edges:
        points = edge.polyline(1e-5)
        values = cot_visual_angle(points, instance.segments[edge.segments[0]])[1:-1]
        turns = _turns(values)
        maxima += sum(turn < 0 for turn in turns)
        minima += sum(turn > 0 for turn in turns)
    # The polylines may miss a flat turn, and never show one that is not there.
    assert minima <= sum(e.is_minimum for e in seen.found)
    assert maxima <= sum(not e.is_minimum for e in seen.found)


def _turns(values: np.ndarray) -> list[int]:
    """+1 for each local maximum of the values, −1 for each minimum, ripples of rounding apart."""
    turns, extreme, direction = [], values[0] if len(values) else 0.0, 0
    for value in values:
        if abs(value - extreme) > 1e-5 * (1 + abs(value)):
            step = 1 if value > extreme else -1
            if direction and step != direction:
                turns.append(direction)
            direction, extreme = step, value
        elif direction and (value - extreme) * direction > 0:
            extreme = value
    return turns


def test_points_off_the_edges_do_not_count() -> None:
    """A third segment that is seen under less takes the edge, and its extremum, away."""
    alone = extrema.extrema(segments(((0, 0), (1, 0)), ((0, 2), (1, 2))), "plane")
    both = segments(((0, 0), (1, 0)), ((0, 2), (1, 2)), ((0.5, 5), (0.51, 5)))
    beaten = {e.pair for e in extrema.extrema(both, "plane").found}
    assert (0, 1) in {e.pair for e in alone.found}
    assert (0, 1) not in beaten
