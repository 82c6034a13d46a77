"""``avd draw``: the picture that was asked for, where it was asked for."""

import pytest

from harness.cli.main import main
from harness.diagram import build
from harness.geometry.formats import read_instance
from harness.report.drawing import render

SQUARE = '{"kind": "polygon", "name": "a square", "vertices": [[0, 0], [4, 0], [4, 4], [0, 4]]}'


@pytest.fixture
def square(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "square.json"
    path.write_text(SQUARE)
    return path


@pytest.mark.parametrize("name", ["out.svg", "out.png", "out.pdf", "OUT.SVG"])
def test_the_ending_chooses_the_format(name, square, capfd):
    assert main(["draw", "square.json", "-o", name]) == 0
    assert capfd.readouterr() == ("", "")
    expected = render(build(read_instance(square)), name[-3:].lower(), title="a square")
    assert (square.parent / name).read_bytes() == expected


@pytest.mark.usefixtures("square")
@pytest.mark.parametrize("target", [[], ["-o", "-"]])
def test_standard_output_is_svg(target, capfdbinary):
    assert main(["draw", "square.json", "--title", "", *target]) == 0
    instance = read_instance("square.json")
    assert capfdbinary.readouterr().out == render(build(instance), "svg", title="")


@pytest.mark.usefixtures("square")
def test_options_reach_the_picture(capfdbinary):
    words = ["--no-nodes", "--labels", "--width", "4", "--caption", "C", "--domain", "plane"]
    words += ["--window", "0", "0", "2", "2", "--objective", "largest"]
    assert main(["draw", "square.json", *words]) == 0
    expected = render(
        build(read_instance("square.json"), "plane", "largest"),
        nodes=False,
        labels=True,
        width=4.0,
        window=(0, 0, 2, 2),
        caption="C",
        title="a square",
    )
    assert capfdbinary.readouterr().out == expected


@pytest.mark.parametrize(
    ("arguments", "status", "hint"),
    [
        (["-o", "out.jpg"], 2, "out.jpg"),
        (["-o", "out"], 2, ".svg, .png or .pdf"),
        (["-o", "absent/out.svg"], 1, "absent/out.svg"),
        (["--window", "0", "0", "0", "0"], 1, "window"),
        (["--width", "0"], 1, "width"),
        (["--window", "0", "0"], 2, "--window"),
    ],
)
def test_what_cannot_be_drawn_is_said_and_nothing_written(arguments, status, hint, square, capfd):
    try:
        found = main(["draw", "square.json", *arguments])
    except SystemExit as stop:
        found = stop.code
    told = capfd.readouterr()
    assert found == status
    assert hint in told.err
    assert told.out == ""
    assert [path.name for path in square.parent.iterdir()] == ["square.json"]


@pytest.mark.usefixtures("square")
@pytest.mark.parametrize("objective", ["smallest", "largest"])
def test_the_peak_is_marked_where_it_is(objective, capfdbinary):
    assert main(["draw", "square.json", "--peak", "--objective", objective, "--title", ""]) == 0
    diagram = build(read_instance("square.json"), objective=objective)
    marked = capfdbinary.readouterr().out
    assert marked == render(diagram, title="", peak=(2.0, 2.0))
    assert marked != render(diagram, title="")


def test_segments_have_no_peak_to_mark(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pair.wkt").write_text("MULTILINESTRING ((0 0, 1 0), (3 1, 4 3))")
    assert main(["draw", "pair.wkt", "--peak"]) == 1
    assert capsys.readouterr().err == "avd: pair.wkt: only a polygon has a peak, not segments\n"
