"""``avd count``: the same numbers as the library, in order, whatever else is on the line."""

import io
import json

import pytest

from harness.cli.main import main
from harness.diagram import build
from harness.diagram.counts import NODE_KINDS
from harness.geometry.formats import parse_instance, read_instance

SQUARE = '{"kind": "polygon", "name": "a square", "vertices": [[0, 0], [4, 0], [4, 4], [0, 4]]}'
PAIR = "MULTILINESTRING ((0 0, 1 0), (3 1, 4 3))"
BOW_TIE = '{"kind": "polygon", "vertices": [[0, 0], [2, 2], [2, 0], [0, 2]]}'


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in (("square.json", SQUARE), ("pair.wkt", PAIR), ("bow-tie.json", BOW_TIE)):
        (tmp_path / name).write_text(text)
    return tmp_path


def records(capsys) -> list[dict]:
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize("options", [[], ["--objective", "largest"], ["--domain", "plane"]])
def test_json_is_what_the_library_counts(options, capsys):
    assert main(["count", "--json", "square.json", "pair.wkt", "square.json", *options]) == 0
    found = records(capsys)
    assert [record["file"] for record in found] == ["square.json", "pair.wkt", "square.json"]
    chosen = dict(zip((o[2:] for o in options[::2]), options[1::2], strict=True))
    for record in found:
        expected = build(read_instance(record["file"]), **chosen).counts.as_dict()
        assert {key: record[key] for key in expected} == expected
        assert record["seconds"] >= 0
        assert tuple(record["nodes"]) == NODE_KINDS
    assert [record.get("name") for record in found] == ["a square", None, "a square"]


@pytest.mark.usefixtures("files")
def test_known_squares(capsys):
    main(["count", "--json", "square.json"])
    (record,) = records(capsys)
    assert (record["cells"], record["edges"], record["vertices"]) == (4, 4, 1)
    assert record["degrees"] == {"4": 1}
    assert record["domain"] == "kernel"


def test_standard_input(monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(PAIR.encode())))
    assert main(["count", "-", "--json"]) == 0
    (record,) = records(capsys)
    assert record["file"] == "-"
    assert record["cells"] == build(parse_instance(PAIR)).counts.cells


@pytest.mark.parametrize("text", ["", "[1", BOW_TIE])
def test_bad_standard_input_is_named(text, monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    assert main(["count", "-"]) == 1
    told = capsys.readouterr()
    assert told.err.startswith("avd: standard input: ")
    assert told.err.count("\n") == 1


@pytest.mark.usefixtures("files")
def test_a_bad_file_is_named_and_the_others_are_counted(capsys):
    files = ["square.json", "bow-tie.json", "absent.json", "pair.wkt"]
    assert main(["count", "--json", *files]) == 1
    told = capsys.readouterr()
    assert [json.loads(line)["file"] for line in told.out.splitlines()] == [files[0], files[3]]
    complaints = told.err.splitlines()
    assert [line.split(":")[1].strip() for line in complaints] == files[1:3]


@pytest.mark.usefixtures("files")
def test_an_impossible_domain_names_the_file(capsys):
    assert main(["count", "pair.wkt", "--domain", "kernel"]) == 1
    told = capsys.readouterr()
    assert "pair.wkt" in told.err
    assert told.out == ""


@pytest.mark.usefixtures("files")
def test_the_table_is_aligned_and_agrees_with_the_json(capsys):
    main(["count", "--json", "square.json", "pair.wkt"])
    expected = records(capsys)
    assert main(["count", "square.json", "pair.wkt"]) == 0
    header, *rows = (line.split() for line in capsys.readouterr().out.splitlines())
    for row, record in zip(rows, expected, strict=True):
        flat = {**record, **record["nodes"]}
        assert row == [str(flat[name]) for name in header]
