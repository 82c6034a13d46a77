"""Instances survive being written and read; what is wrong is named in one line."""

import json
import math
import os
import sys
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.errors import UserError
from harness.geometry.formats import (
    parse_instance,
    read_instance,
    to_geojson,
    to_wkt,
    write_instance,
)
from harness.geometry.instance import Instance
from tests.geometry.shapes import lattice_polygons, lattice_segments

finite = st.floats(allow_nan=False, allow_infinity=False)
points = st.tuples(finite, finite).map(list)


def same(one, other):
    return one.kind == other.kind and one.rational_segments() == other.rational_segments()


@given(st.one_of(lattice_polygons(), lattice_segments()))
def test_json_keeps_every_coordinate_exactly(instance):
    again = parse_instance(instance.to_json())
    assert same(instance, again)
    assert (again.exact is None) == (instance.exact is None)


@given(st.lists(points, min_size=3, max_size=6))
def test_doubles_survive_all_formats(vertices):
    vertices[-1] = [vertices[0][0] / 2 + 1, 3.0]  # no closing repeat
    if vertices[-1] == vertices[0]:
        return
    instance = Instance.from_arrays("polygon", vertices)
    for text in (instance.to_json(), to_wkt(instance), to_geojson(instance)):
        assert same(parse_instance(text), instance)


@given(st.lists(st.tuples(points, points).map(list), min_size=1, max_size=5))
def test_segments_survive_all_formats(rows):
    instance = Instance.from_arrays("segments", rows)
    for text in (instance.to_json(), to_wkt(instance), to_geojson(instance)):
        assert same(parse_instance(text), instance)


def test_coordinates_mean_what_the_contract_says():
    text = (
        '{"kind": "segments", "segments": [[[0.1, "0.1"], ["1/3", 9007199254740993]],'
        ' [["-1e-300", " 2.50 "], [1e300, 5e-324]]], "name": "x", "family": "f",'
        ' "params": {"tilt": 0.5}, "seed": 18446744073709551615, "comment": "ignored"}'
    )
    instance = parse_instance(text)
    (a, b), (c, d) = instance.rational_segments()
    assert a == (Fraction(0.1), Fraction(1, 10))
    assert b == (Fraction(1, 3), 2**53)  # a number is its nearest double
    assert c == (Fraction(-1, 10**300), Fraction(5, 2))
    assert d == (Fraction(1e300), Fraction(5e-324))
    assert instance.floats[0, 0, 0] == instance.floats[0, 0, 1] == 0.1
    assert (instance.name, instance.family) == ("x", "f")
    assert (instance.params, instance.seed) == ({"tilt": 0.5}, 2**64 - 1)
    again = parse_instance(instance.to_json())
    assert (again.params, again.seed) == (instance.params, instance.seed)
    assert same(again, instance)


def test_strings_that_are_doubles_make_no_exact_instance():
    assert Instance.from_arrays("polygon", [["0.5", "1e3"], [2, 3], ["1/4", "7"]]).exact is None


@pytest.mark.parametrize(
    "text",
    [
        "POLYGON ((0 0, 4 0, 4 4.5, 0 0))",
        "polygon((0 0,4 0,4 4.5))",
        "SRID=4326; POLYGON ((0. .0, +4 0e0, 4 4.5, 0 0))",
        "MULTIPOLYGON (((0 0, 4 0, 4 4.5, 0 0)))",
        '{"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4.5], [0, 0]]]}',
        '{"type": "Feature", "properties": {}, "geometry":'
        ' {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4.5], [0, 0]]]}}',
        '\ufeff{"kind": "polygon", "vertices": [[0, 0], [4, 0], [4, 4.5]]}',
    ],
)
def test_one_triangle_in_many_languages(tmp_path, text):
    path = tmp_path / "triangle"
    path.write_text(text, encoding="utf-8")
    instance = read_instance(path)
    assert instance.kind == "polygon"
    assert instance.floats.tolist() == [[0, 0], [4, 0], [4, 4.5]]
    assert instance.source == str(path)


@pytest.mark.parametrize(
    "text",
    [
        "MULTILINESTRING ((0 0, 1 0), (1 0, 2 5))",
        "LINESTRING (0 0, 1 0, 2 5)",
        '{"type": "MultiLineString", "coordinates": [[[0, 0], [1, 0], [2, 5]]]}',
        '{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry":'
        ' {"type": "LineString", "coordinates": [[0, 0], [1, 0]]}}, {"type": "Feature",'
        ' "geometry": {"type": "LineString", "coordinates": [[1, 0], [2, 5]]}}]}',
        '{"type": "GeometryCollection", "geometries":'
        ' [{"type": "LineString", "coordinates": [[0, 0], [1, 0], [2, 5]]}]}',
    ],
)
def test_two_segments_in_many_languages(text):
    instance = parse_instance(text)
    assert instance.kind == "segments"
    assert instance.floats.tolist() == [[[0, 0], [1, 0]], [[1, 0], [2, 5]]]


POLYGON = '{{"kind": "polygon", "vertices": [[0, 0], [1, 0], {}]}}'


BAD_FILES = [
    ("", "not JSON"),
    ("hello", "not JSON"),
    ("{", "line 1, column 2"),
    ("[" * 100_000, "nested too deeply"),
    ("[[0, 0], [1, 0]]", "a JSON object is expected, not a list"),
    ("3", "not an integer"),
    ("{}", "wrong kind"),
    ('{"kind": "circle"}', 'not "circle"'),
    ('{"kind": ["polygon"]}', "wrong kind"),
    ('{"kind": "polygon"}', 'needs the key "vertices"'),
    ('{"kind": "polygon", "segments": []}', 'needs the key "vertices"'),
    ('{"kind": "polygon", "vertices": [], "segments": []}', 'no key "segments"'),
    ('{"kind": "polygon", "kind": "segments"}', "'kind' appears twice"),
    ('{"kind": "polygon", "vertices": {"0": 1}}', "must be a list"),
    ('{"kind": "polygon", "vertices": [[0, 0]], "seed": true}', '"seed" must be an integer'),
    ('{"kind": "polygon", "vertices": [[0, 0]], "seed": 0.5}', '"seed" must be an integer'),
    ('{"kind": "polygon", "vertices": [[0, 0]], "name": 5}', '"name" must be a string'),
    ('{"kind": "polygon", "vertices": [[0, 0]], "params": []}', '"params" must be an object'),
    (POLYGON.format("[1]"), "vertex 2 (counting from 0): a point has 2 coordinates, not 1"),
    (POLYGON.format("[1, 2, 3]"), "vertex 2 (counting from 0): a point has 2"),
    (POLYGON.format("7"), "vertex 2 (counting from 0): 7 is not a pair"),
    (POLYGON.format('"ab"'), "vertex 2"),
    (POLYGON.format("null"), "vertex 2"),
    (POLYGON.format("[null, 1]"), "vertex 2"),
    (POLYGON.format("[true, 1]"), "vertex 2 (counting from 0): True is no coordinate"),
    (POLYGON.format("[[1], 1]"), "vertex 2"),
    (POLYGON.format("[NaN, 1]"), "vertex 2 (counting from 0): coordinate is not a number"),
    (POLYGON.format("[1, -Infinity]"), "vertex 2 (counting from 0): coordinate is infinite"),
    (POLYGON.format("[1e309, 1]"), "vertex 2 (counting from 0): coordinate is infinite"),
    (POLYGON.format("[1e-400, 1]"), "vertex 2 (counting from 0): number too small"),
    (POLYGON.format("[" + "9" * 400 + ", 1]"), "beyond the range of a double"),
    (POLYGON.format("[" + "9" * 350 + ", 1]"), "beyond the range of a double"),
    (POLYGON.format("[" + "9" * 9000 + ", 1]"), "beyond the range of a double"),
    (POLYGON.format('["one", 1]'), "vertex 2 (counting from 0): 'one' is no rational"),
    (POLYGON.format('["1/0", 1]'), "divides by zero"),
    (POLYGON.format('["nan", 1]'), "'nan' is no rational"),
    (POLYGON.format('["1_000", 1]'), "is no rational"),
    (POLYGON.format('["0x10", 1]'), "is no rational"),
    (POLYGON.format('["1e999", 1]'), "beyond the range of a double"),
    (POLYGON.format('["1e9999", 1]'), "exponent beyond"),
    (POLYGON.format('["1e999999999", 1]'), "is no rational"),
    (POLYGON.format('["' + "1" * 2000 + '", 1]'), "more than 1000 characters"),
    (
        '{"kind": "segments", "segments": [[[0, 0], [1, 1]], [[0, 0], [1, "x"]]]}',
        "endpoint 1 of segment 1 (counting from 0): 'x' is no rational",
    ),
    ('{"kind": "segments", "segments": [[0, 0], [1, 1]]}', "endpoint 0 of segment 0"),
    ('{"kind": "segments", "segments": [[[0, 0]]]}', "a segment has 2 endpoints, not 1"),
    ('{"type": "Polygon"}', 'without a list of "coordinates"'),
    ('{"type": "Polygon", "coordinates": [[], []]}', "1 hole(s)"),
    ('{"type": "Polygon", "coordinates": [5]}', "list of rings"),
    ('{"type": "Point", "coordinates": [1, 2]}', "Point is neither"),
    ('{"type": "Feature", "geometry": null}', "not GeoJSON"),
    ('{"type": "FeatureCollection", "features": []}', "found nothing"),
    ('{"type": "LineString", "coordinates": [[0, 0]]}', "at least two points"),
    ("POLYGON ((0 0, 4 0, 4 4, 0 0), (1 1, 2 1, 2 2, 1 1))", "1 hole(s)"),
    ("MULTIPOLYGON (((0 0, 1 0, 1 1)), ((5 5, 6 5, 6 6)))", "Polygon (2 in all)"),
    ("POLYGON Z ((0 0 0, 4 0 0, 4 4 0))", "only plane coordinates"),
    ("POLYGON EMPTY", "nothing in it"),
    ("POLYGON ((0 0, 4 0, 4 4", "unbalanced"),
    ("POLYGON ((0 0, 4 0, 4 4)))", "unbalanced"),
    ("POLYGON ((0 0, 4 0, 4 4)) and more", "'and' is not a number"),
    ("POLYGON ((0 0, 4 nan, 4 4))", "vertex 1 (counting from 0): coordinate is not a number"),
    ("POLYGON ((0 0, 4 1e-999, 4 4))", "vertex 1 (counting from 0): number too small"),
    ("POLYGON ((0 0, 4, 4 4))", "vertex 1 (counting from 0): a point has 2 coordinates"),
    ("POINT (1 2)", "Point is neither"),
    ("GEOMETRYCOLLECTION (POINT (1 2))", "neither a polygon nor a line string"),
]


@pytest.mark.parametrize(("text", "reason"), BAD_FILES, ids=[reason for _, reason in BAD_FILES])
def test_bad_files_are_refused_in_one_line(tmp_path, text, reason):
    path = tmp_path / "bad.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UserError) as caught:
        read_instance(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert reason in message
    assert "\n" not in message
    assert len(message) < 400


def test_unreadable_files_are_refused(tmp_path):
    binary = tmp_path / "binary"
    binary.write_bytes(b"\xff\xfe\x00")
    for path, reason in (
        (tmp_path / "absent", "No such file"),
        (tmp_path, "directory"),
        (binary, "not a text file"),
    ):
        with pytest.raises(UserError, match=reason):
            read_instance(path)


def test_a_failed_write_leaves_nothing_and_loses_nothing(tmp_path):
    doubles = Instance.from_arrays("polygon", [[0, 0], [1, 0], [0, 1]])
    rationals = Instance.from_arrays("polygon", [[0, 0], [1, 0], [0, "1/3"]])
    for name in ("a.wkt", "a.geojson"):
        write_instance(doubles, tmp_path / name)
        with pytest.raises(UserError, match="JSON instead"):
            write_instance(rationals, tmp_path / name)
        assert same(read_instance(tmp_path / name), doubles)
    (tmp_path / "directory").mkdir()
    with pytest.raises(UserError):
        write_instance(doubles, tmp_path / "directory")
    with pytest.raises(UserError):
        write_instance(doubles, tmp_path / "absent" / "a.json")
    assert sorted(os.listdir(tmp_path)) == ["a.geojson", "a.wkt", "directory"]


def test_anything_with_a_geo_interface():
    class Shape:
        def __init__(self, **data):
            self.__geo_interface__ = data

    ring = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0))
    polygon = Instance.from_geo_interface(Shape(type="Polygon", coordinates=(ring,)))
    assert polygon.floats.tolist() == [[0, 0], [1, 0], [0, 1]]
    line = Instance.from_geo_interface(Shape(type="LineString", coordinates=ring))
    assert line.n == 3
    with pytest.raises(UserError):
        Instance.from_geo_interface(Shape(type="Point", coordinates=(0, 0)))
    with pytest.raises(UserError):
        Instance.from_geo_interface(object())


def test_instances_from_arrays_of_any_kind():
    rows = [[0, 0], [3, 0], [0, 4]]
    for values in (rows, tuple(map(tuple, rows)), np.array(rows), np.array(rows, dtype=np.float32)):
        assert Instance.from_arrays("polygon", values).floats.tolist() == rows
    mixed = Instance.from_arrays("polygon", [[Fraction(1, 3), np.int64(2)], [0, 1], [1.5, 1]])
    assert mixed.rational_segments()[0][0] == (Fraction(1, 3), 2)
    with pytest.raises(UserError, match="vertex 1"):
        Instance.from_arrays("polygon", np.array([[0, 0], [math.nan, 0], [0, 1]]))
    with pytest.raises(UserError, match="kind"):
        Instance.from_arrays("circle", rows)
    with pytest.raises(UserError):
        Instance(kind="polygon", floats=np.zeros((3, 3)))


def test_edges_have_the_interior_on_their_left_and_keep_their_index():
    rows = np.array([[0, 0], [3, 0], [0, 4]], dtype=float)
    ccw, cw = Instance.from_arrays("polygon", rows), Instance.from_arrays("polygon", rows[::-1])
    assert (ccw.orientation, cw.orientation) == (1, -1)
    for instance in (ccw, cw):
        for k, (a, b) in enumerate(instance.segments.tolist()):
            ends = {tuple(instance.floats[k]), tuple(instance.floats[(k + 1) % 3])}
            assert {tuple(a), tuple(b)} == ends
            centre = [1.0, 4 / 3]
            left = (b[0] - a[0]) * (centre[1] - a[1]) - (b[1] - a[1]) * (centre[0] - a[0])
            assert left > 0
            assert instance.rational_segments()[k] == tuple(
                tuple(map(Fraction, point)) for point in (a, b)
            )
    assert not ccw.floats.flags.writeable


def test_from_generated():
    class Made:
        kind, family, params, seed = "segments", "grid", {"variant": "regular"}, 7
        coordinates = np.array([[[0.0, 0.0], [1.0, 0.0]]])

    instance = Instance.from_generated(Made)
    assert (instance.n, instance.family, instance.seed) == (1, "grid", 7)
    assert json.loads(instance.to_json())["params"] == {"variant": "regular"}


def test_reading_geometry_needs_no_compiler():
    """Small inputs must not pay for importing Numba."""
    import subprocess

    code = (
        "import sys; from harness.geometry.instance import Instance;"
        "from harness.geometry.validation import validate;"
        "from harness.geometry.kernel import kernel;"
        "i = Instance.from_arrays('polygon', [[0, 0], [1, 0], [0, 1]]); validate(i); kernel(i);"
        "assert 'numba' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_a_pipe_is_written_to_and_not_replaced(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    instance = Instance.from_arrays("segments", [((0, 0), (1, 0))])
    write_instance(instance, pipe)
    assert json.loads(os.read(reader, 1000))["kind"] == "segments"
    os.close(reader)
    assert pipe.is_fifo()
