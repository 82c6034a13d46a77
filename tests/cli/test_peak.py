"""``avd peak``: what the library finds, in order, whatever else is on the line."""

import json
import math

import pytest

from harness.cli.main import main
from harness.geometry.formats import read_instance
from harness.peak import peak

SQUARE = '{"kind": "polygon", "name": "a square", "vertices": [[0, 0], [4, 0], [4, 4], [0, 4]]}'
OBTUSE = "POLYGON ((0 0, 10 0, -3 4, 0 0))"
PAIR = "MULTILINESTRING ((0 0, 1 0), (3 1, 4 3))"
COMB = '{"kind": "polygon", "vertices": [[0, 0], [9, 0], [9, 9], [5, 1], [4, 9], [1, 1], [0, 9]]}'


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    texts = {"square.json": SQUARE, "obtuse.wkt": OBTUSE, "pair.wkt": PAIR, "comb.json": COMB}
    for name, text in texts.items():
        (tmp_path / name).write_text(text)


@pytest.mark.parametrize("method", ["lp", "diagram", "parametric"])
def test_json_is_what_the_library_finds(method, capsys):
    assert main(["peak", "--json", "--method", method, "square.json", "obtuse.wkt"]) == 0
    found = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    for record in found:
        expected = json.loads(json.dumps(peak(read_instance(record["file"]), method).as_dict()))
        assert {key: record[key] for key in expected} == expected
        assert record["seconds"] > 0
    assert [record["angle"] for record in found] == pytest.approx(
        [math.pi / 2, math.pi - math.atan2(4, -3) / 2]
    )
    assert [record["vertex"] for record in found] == [None, 0]
    assert (found[0]["x"], found[0]["y"], found[0]["n"]) == (2.0, 2.0, 4)


def test_min_max_needs_no_method(capsys):
    assert main(["peak", "--json", "--objective", "min-max", "square.json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["method"], record["basis"]) == ("diagram", [0, 1, 2, 3])


def test_people_get_a_line(capsys):
    assert main(["peak", "--exact", "square.json", "obtuse.wkt"]) == 0
    square, obtuse = capsys.readouterr().out.splitlines()
    assert square == (
        "square.json: (2.0, 2.0)  angle 1.57079632679 (90°)  basis 0, 2  tied 0, 1, 2, 3  "
        "cot is a root of [0, 1]"
    )
    assert "at vertex 0: approached, not reached" in obtuse


def test_a_file_that_cannot_be_used_does_not_stop_the_others(capsys):
    assert main(["peak", "pair.wkt", "comb.json", "no.json", "square.json"]) == 1
    told = capsys.readouterr()
    assert told.out.startswith("square.json: (2.0, 2.0)")
    problems = told.err.splitlines()
    assert len(problems) == 3
    assert problems[0] == "avd: pair.wkt: only a polygon has a peak, not segments"
    assert problems[1].startswith("avd: comb.json: the polygon is not star-shaped")
    assert problems[2].startswith("avd: no.json: ")


def test_a_method_that_cannot_do_it_says_so(capsys):
    assert main(["peak", "--objective", "min-max", "--method", "lp", "square.json"]) == 1
    assert "diagram only" in capsys.readouterr().err
