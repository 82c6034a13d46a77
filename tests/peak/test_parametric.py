"""Parametric search: the same peaks, and no more decisions and comparisons than it should take."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.peak import meet, peak
from harness.peak.parametric import Search
from harness.peak.polygon import Polygon
from tests import strategies
from tests.peak.polygons import KNOWN, STARS, generated, regular


def agree(one, other) -> bool:
    return max(one.lower, other.lower) <= min(one.upper, other.upper)


@pytest.mark.parametrize("family", STARS)
@pytest.mark.parametrize("n", [3, 5, 8, 30])
def test_it_finds_the_same_peak(family, n):
    vertices = generated(family, n, 7)
    if vertices is not None:
        assert agree(peak(vertices.tolist()), peak(vertices.tolist(), "parametric"))


@given(strategies.polygons())
@settings(max_examples=10)
def test_degenerate_polygons_have_the_same_peak(instance):
    assert agree(peak(instance[1]), peak(instance[1], "parametric"))


@pytest.mark.parametrize("name", KNOWN)
def test_known_peaks(name):
    vertices, angle, _ = KNOWN[name]
    assert peak(vertices, "parametric").angle == pytest.approx(angle, abs=1e-12)


@pytest.mark.parametrize("n", [3, 7, 24])
def test_regular_polygons(n):
    assert peak(regular(n).tolist(), "parametric").angle == pytest.approx(2 * math.pi / n)


@pytest.mark.parametrize("family", ["star", "near-regular", "convex-circle", "zigzag"])
def test_work_stays_within_a_constant_of_the_theorem(family):
    """O(n log² n) comparisons in O(log² n) batches, of each of which O(log n) are decided."""
    for n in (64, 512):
        found = peak(generated(family, n, 1).tolist(), "parametric").facts
        log = math.log2(n)
        assert found["comparisons"] <= 10 * n * log * log
        assert found["batches"] <= 10 * log * log
        assert found["decisions"] <= 100


def test_the_intersection_vanishes_at_the_optimum():
    """Just above c* the discs have a common point, just below none, by another routine."""
    for family in ("near-regular", "convex-circle", "cavity"):
        vertices = generated(family, 9, 3)
        polygon = Polygon(Instance.from_arrays("polygon", vertices.tolist()))
        found = peak(vertices.tolist(), "parametric")
        edges = np.roll(vertices, -1, axis=0) - vertices
        middles = vertices + edges / 2 - (found.x, found.y)
        normals = np.stack([-edges[:, 1], edges[:, 0]], axis=1) / 2
        assert polygon.n == 9
        for factor, empty in ((1 - 1e-6, False), (1 + 1e-6, True)):
            c = 1 / math.tan(found.angle * factor)
            radii = np.hypot(*edges.T) / 2 * math.hypot(1, c)
            assert meet(middles + c * normals, radii).is_empty == empty


def test_every_decision_is_right():
    polygon = Polygon(Instance.from_arrays("polygon", generated("star", 40, 2).tolist()))
    level = 1 / math.tan(peak(polygon.instance).angle)
    search = Search(polygon.start[0], polygon.edges_from(polygon.inner_point()))
    for factor in (0.5, 0.9, 0.999, 0.999999):
        assert not search.decide(level * factor)
        assert search.decide(level / factor)


def test_a_search_that_ends_elsewhere_is_found_out(monkeypatch):
    """Decisions that err on one side let the search end at another level."""
    vertices = generated("near-regular", 9, 1).tolist()
    right = Search.decide

    def wrong(self, level: float) -> bool:
        return right(self, level - 0.1)

    monkeypatch.setattr(Search, "decide", wrong)
    with pytest.raises(UserError, match="search in doubles ends at"):
        peak(vertices, "parametric")
