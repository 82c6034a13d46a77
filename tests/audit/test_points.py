"""Claims about points: levels, circles, peaks, discs.  Known instances and planted faults."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from harness.audit import discs, levels, peaks, plane
from harness.diagram import build
from harness.peak.discs import meet
from tests.audit.instances import BESIDE, CROSSING, DART, PARALLEL, SQUARE, TRIANGLE, polygon

OBLONG = polygon((0, 0), (1, 0), (1, 2), (0, 1))
"""Its peak is no Voronoi vertex, and there is one."""


@pytest.mark.parametrize("instance", [SQUARE, TRIANGLE, DART])
def test_levels_are_convex_in_the_kernel_and_circles_single(instance) -> None:
    assert levels.convex_kernel(instance).outcome == "holds"
    assert levels.circle_kernel(instance).outcome == "holds"


def test_the_wrong_domain_is_noticed() -> None:
    assert levels.convex_interior(DART).outcome == "fails"
    assert levels.circle_interior(DART).outcome == "fails"
    assert levels.circle_interior(SQUARE).outcome == "holds"  # convex: the kernel is all of it


def test_the_wrong_angle_is_noticed(monkeypatch) -> None:
    """With the largest angle in place of the smallest, level sets are not convex."""
    right = levels.cotangents
    monkeypatch.setattr(levels, "cotangents", lambda s, p: [min(right(s, p))])
    assert levels.convex_kernel(TRIANGLE).outcome == "fails"


def test_segments_and_flat_kernels_are_outside() -> None:
    flat = polygon((0, 0), (2, 0), (2, 2), (1, 0.5), (0, 2))
    for check in (levels.convex_kernel, peaks.check_kernel_peak, discs.check_intersection):
        assert check(CROSSING).outcome == "outside"
    assert levels.circle_kernel(flat).outcome in ("holds", "outside")


# --- peaks ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("instance", [SQUARE, TRIANGLE, DART, OBLONG])
def test_peaks_lie_on_edges_and_are_found_by_all_methods(instance) -> None:
    assert peaks.check_kernel_peak(instance).outcome in ("holds", "outside")
    assert peaks.check_naive(instance).outcome == "holds"
    assert peaks.check_parametric(instance).outcome == "holds"


def test_an_optimum_at_a_vertex_is_no_peak() -> None:
    assert peaks.check_kernel_peak(polygon((0, 0), (10, 0), (-3, 4))).outcome == "outside"


def test_a_diagram_without_the_edge_of_the_peak_is_noticed(monkeypatch) -> None:
    def broken(instance, domain):
        return replace(build(instance, domain, workers=1), edges=(), nodes=())

    monkeypatch.setattr(peaks, "diagram", broken)
    assert peaks.check_kernel_peak(OBLONG).outcome == "fails"


def test_an_edge_left_out_in_the_plane_is_noticed(monkeypatch) -> None:
    assert plane.check_plane_peak(BESIDE).outcome == "holds"

    def broken(instance, domain):
        found = build(instance, domain, workers=1)
        worst = sorted(found.edges, key=lambda edge: edge.cotangent_range[0])[-1:]
        return replace(found, edges=tuple(worst))

    monkeypatch.setattr(plane, "diagram", broken)
    assert plane.check_plane_peak(BESIDE).outcome == "fails"


def test_some_peaks_are_vertices_and_some_are_not() -> None:
    assert peaks.check_not_a_vertex(OBLONG).outcome == "holds"
    assert peaks.check_not_a_vertex(TRIANGLE).outcome == "fails"
    assert peaks.check_not_a_vertex(polygon((0, 0), (10, 0), (-3, 4))).outcome == "outside"


def test_a_wrong_peak_and_too_many_operations_are_noticed(monkeypatch) -> None:
    right = peaks.peak

    def wrong(instance, method=None, **options):
        found = right(instance, method, **options)
        return found if method is None else replace(found, lower=0.1, upper=0.1)

    monkeypatch.setattr(peaks, "peak", wrong)
    assert peaks.check_naive(SQUARE).outcome == "fails"
    assert peaks.check_parametric(SQUARE).outcome == "fails"
    monkeypatch.setattr(peaks, "peak", right)
    monkeypatch.setattr(peaks, "COMPARISONS", -1.0)
    assert peaks.check_parametric(SQUARE).outcome == "fails"


def test_two_segments_have_no_common_optimum() -> None:
    for instance in (CROSSING, PARALLEL, BESIDE):
        assert plane.check_two_segments(instance).outcome == "fails"


# --- discs ---------------------------------------------------------------------------------------


def test_corners_of_a_lens_and_of_a_disc_in_another() -> None:
    lens = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([1.0, 1.0])
    assert discs.corners_by_balls(*lens) == discs.corners(meet(*lens)) == Counter({(0, 1): 2})
    inside = np.array([[0.0, 0.0], [0.5, 0.0]]), np.array([2.0, 1.0])
    assert discs.corners_by_balls(*inside) == discs.corners(meet(*inside)) == Counter()


def test_three_circles_through_one_point_are_not_decided() -> None:
    centres = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    assert discs.corners_by_balls(centres, np.ones(3)) is None


def test_a_lost_arc_and_too_many_steps_are_noticed(monkeypatch) -> None:
    assert discs.check_intersection(DART).outcome == "holds"
    monkeypatch.setattr(discs, "BATCHES", 0.0)
    assert discs.check_intersection(DART).outcome == "fails"
    monkeypatch.undo()

    def broken(centres, radii):
        found = meet(centres, radii)
        return replace(found, upper=found.lower)

    monkeypatch.setattr(discs, "meet", broken)
    assert discs.check_intersection(DART).outcome == "fails"
