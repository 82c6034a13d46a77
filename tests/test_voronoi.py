"""``AngularVoronoi``: the same diagram however the segments are given; documented shapes."""

from __future__ import annotations

import doctest
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings

import harness
from harness import AngularVoronoi, voronoi
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.geometry.predicates import compare_visual_angles
from tests.strategies import instances

TRIANGLE = [(0, 0), (4, 0), (1, 3)]
PAIR = [[(0, 0), (1, 0)], [(3, 1), (4, 3)]]


class Shape:
    """What shapely offers."""

    def __init__(self, kind: str, coordinates) -> None:
        self.__geo_interface__ = {"type": kind, "coordinates": coordinates}


@pytest.mark.parametrize(
    "given_as",
    [
        TRIANGLE,
        np.array(TRIANGLE, dtype=float),
        [("0", "0"), ("4", "0"), ("1", "3")],
        [(Fraction(0), 0), (4, Fraction(0)), (1, 3.0)],
        (tuple(point) for point in TRIANGLE),
        Instance.from_arrays("polygon", TRIANGLE),
        Shape("Polygon", [[*TRIANGLE, TRIANGLE[0]]]),
        {"type": "Polygon", "coordinates": [[*TRIANGLE, TRIANGLE[0]]]},
    ],
    ids=["list", "array", "strings", "fractions", "iterator", "instance", "shape", "geojson"],
)
def test_a_polygon_however_given(given_as) -> None:
    diagram = AngularVoronoi(given_as)
    assert (diagram.instance.kind, diagram.domain) == ("polygon", "kernel")
    assert (diagram.counts.cells, diagram.counts.vertices) == (3, 1)
    assert np.array_equal(diagram.segments[:, 0], TRIANGLE)


@pytest.mark.parametrize("given_as", [PAIR, np.array(PAIR), Shape("MultiLineString", PAIR)])
def test_segments_however_given(given_as) -> None:
    diagram = AngularVoronoi(given_as)
    assert (diagram.instance.kind, diagram.domain) == ("segments", "plane")
    assert np.array_equal(diagram.segments, PAIR)
    assert diagram.counts.nodes["crossing"] == 1


@pytest.mark.parametrize(
    ("given_as", "options", "hint"),
    [
        (5, {}, "shape"),
        ("POLYGON ((0 0, 1 0, 0 1))", {}, "shape"),
        ([], {}, ""),
        ([1, 2, 3], {}, ""),
        (np.zeros((2, 2, 3)), {}, ""),
        ([(0, 0), (1, 0), (0, float("nan"))], {}, ""),
        ([(0, 0), (2, 2), (2, 0), (0, 2)], {}, "cross"),
        (PAIR, {"domain": "kernel"}, "polygon"),
        (TRIANGLE, {"builder": "guess"}, "reference"),
    ],
)
def test_bad_input_is_one_line(given_as, options, hint) -> None:
    with pytest.raises(UserError) as caught:
        AngularVoronoi(given_as, **options)
    assert hint in str(caught.value)
    assert "\n" not in str(caught.value)


@settings(max_examples=25)
@given(instances(3, 5))
def test_shapes_and_location(case) -> None:
    kind, coordinates = case
    diagram = AngularVoronoi(Instance.from_arrays(kind, coordinates))
    counts = diagram.counts
    assert diagram.segments.shape == (counts.n, 2, 2)
    assert diagram.vertices.shape == (counts.vertices, 2)
    assert len(diagram.edges) == counts.edges
    assert len(diagram.cells) == counts.cells == len(diagram.cell_segments)
    assert len(set(diagram.cell_segments.tolist())) == counts.regions
    witnesses = [(point, cell) for point, cell in diagram.diagram.witnesses if cell >= 0][:4]
    points, cells = zip(*witnesses, strict=True)
    found = diagram.locate(points)
    assert found.dtype == np.int64
    assert found.tolist() == list(cells)
    # There the owner of the cell really has the least angle.
    segments = diagram.instance.rational_segments()
    for point, cell in witnesses:
        owner = segments[diagram.cell_segments[cell]]
        assert all((compare_visual_angles(point, owner, other) or 0) <= 0 for other in segments)


def test_location_tells_outside_and_on_an_edge() -> None:
    square = AngularVoronoi([(0, 0), (4, 0), (4, 4), (0, 4)])
    found = square.locate(np.array([(2, 1), (2, 3), (9, 9), (1, 1), (2, 2)]))
    # Far from an edge its visual angle is small: below the centre the top edge wins.
    assert square.cell_segments[found[:2]].tolist() == [2, 0]
    assert found[2:].tolist() == [voronoi.OUTSIDE, voronoi.ON_AN_EDGE, voronoi.ON_AN_EDGE]
    assert square.locate([]).shape == (0,)


@pytest.mark.parametrize("points", [[(1, 2, 3)], [(1,)], [(0, float("inf"))], [(np.nan, 0)]])
def test_location_refuses_what_is_no_point(points) -> None:
    with pytest.raises(ValueError, match=r"shape|finite"):
        AngularVoronoi(TRIANGLE).locate(points)


def test_pictures() -> None:
    diagram = AngularVoronoi(TRIANGLE, objective="largest")
    assert diagram._repr_svg_().startswith("<?xml")
    import matplotlib as mpl
    import matplotlib.pyplot as plt

    with mpl.rc_context({"backend": "agg"}):
        axes = diagram.plot(labels=True)
        assert diagram.plot(axes) is axes
        plt.close("all")
    assert "3 segments" in repr(diagram)


def test_the_example_in_the_documentation() -> None:
    assert doctest.testmod(voronoi).failed == 0


def test_the_package_is_imported_lazily() -> None:
    code = "import harness, sys; print('numpy' in sys.modules, harness.AngularVoronoi.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "False AngularVoronoi\n"
    with pytest.raises(AttributeError, match="Voronoy"):
        _ = harness.Voronoy
