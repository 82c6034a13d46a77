"""The plates show what they say, in the same bytes every time, and load nothing."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch

from generators import FAMILIES
from harness.cli.main import main
from harness.errors import UserError
from harness.report.drawing_colours import contrast
from harness.report.plates import PLATES, printed
from harness.report.plates.colours import oklch, weave_colour
from harness.report.plates.curves import thinned
from harness.report.plates.families import SHOWN
from harness.report.plates.parts import diagram_of
from harness.report.plates.shelf import captions, put, shelf
from harness.report.plates.weaves import SEED, N, draw_woven_kernel, opened_ties
from tests.report.studies import sample, store

NOWHERE = Path("nowhere")
QUICK = ("figure-1", "figure-2", "figure-5", "figure-6", "peaks")


@pytest.mark.parametrize("name", QUICK)
def test_the_same_bytes_whatever_the_settings_are(name) -> None:
    first = printed(PLATES[name], NOWHERE)
    with mpl.rc_context({"lines.linewidth": 9.0, "font.size": 30, "svg.hashsalt": "other"}):
        assert printed(PLATES[name], NOWHERE) == first
    root = ET.fromstring(first[0].decode())
    for element in root.iter():
        assert not element.tag.endswith(("script", "image"))
        for key, value in element.attrib.items():
            assert not key.endswith("href") or value.startswith("#")


def test_every_family_has_its_panel() -> None:
    assert set(SHOWN) == set(FAMILIES) - {"figure-2"}
    document, caption = printed(PLATES["families"], NOWHERE)
    words = re.findall(r"<text[^>]*>([^<]*)</text>", document.decode())
    assert set(SHOWN) <= set(words)
    assert "NOT" not in caption


def test_the_woven_kernel_shows_every_cell_and_says_its_counts() -> None:
    diagram = diagram_of("zigzag", N, SEED)
    figure = Figure(figsize=PLATES["woven-kernel"].size)
    caption = draw_woven_kernel(figure, NOWHERE)
    counts = diagram.counts
    for number in (counts.cells, counts.edges, counts.vertices):
        assert str(number) in caption
    cells = [patch for patch in figure.axes[0].patches if isinstance(patch, PathPatch)]
    assert len(cells) == counts.cells


def test_opened_ties_are_the_edges_between_cells_of_one_family() -> None:
    """Away from the centre the weave has two colours but for edges of microscopic length."""
    diagram = diagram_of("zigzag", N, SEED)
    found = opened_ties(diagram)
    assert all(diagram.nodes[k].kind == "triple" for _, ends, _ in found for k in ends)
    lengths = [length for length, _, _ in found]
    assert max(lengths) < 1e-3
    # Every triple point away from the centre belongs to one tie.
    ends = [k for _, pair, _ in found for k in pair]
    away = [
        k
        for k, node in enumerate(diagram.nodes)
        if node.kind == "triple" and np.hypot(*node.point) > 0.02
    ]
    assert sorted(ends) == away


@pytest.mark.parametrize("n", [8, 24, 60])
def test_families_of_the_weave_are_told_apart_by_every_reader(n) -> None:
    colours = [weave_colour(k, n) for k in range(n)]
    apart = contrast(colours)
    assert len(set(colours)) == n
    assert apart[::2, 1::2].min() > 0.2
    # The order is cyclic: no two neighbours of a family are further apart than the oval is wide.
    for parity in (0, 1):
        family = apart[parity::2, parity::2]
        steps = [family[k, (k + 1) % len(family)] for k in range(len(family))]
        assert max(steps) < 4 * np.median(steps)


def test_colours_no_screen_has_become_duller_ones() -> None:
    assert oklch(1.0, 0.0, 0.0) == "#ffffff"
    assert oklch(0.0, 0.0, 0.0) == "#000000"
    assert oklch(0.5, 0.0, 77.0) == "#636363"
    assert re.fullmatch("#[0-9a-f]{6}", oklch(0.6, 3.0, 140.0))


points = st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=2, max_size=40)


@given(points, st.floats(1e-3, 2))
def test_thinning_stays_near_every_point(curve, tolerance) -> None:
    curve = np.array(curve)
    kept = thinned(curve, tolerance)
    assert np.array_equal(kept[[0, -1]], curve[[0, -1]])
    for point in curve:
        a, b = kept[:-1], kept[1:]
        along = b - a
        square = np.maximum((along**2).sum(axis=1), 1e-300)
        part = np.clip(((point - a) * along).sum(axis=1) / square, 0, 1)
        assert np.hypot(*(point - a - part[:, None] * along).T).min() <= tolerance * (1 + 1e-9)


# --- plates of stored rows -----------------------------------------------------------------------


def test_growth_is_drawn_from_rows_and_refused_without(tmp_path: Path) -> None:
    plate = PLATES["growth"]
    with pytest.raises(UserError, match="figure growth: no rows of conjecture"):
        printed(plate, tmp_path)
    rows = sample()
    store(tmp_path / "quick", rows)
    document, caption = printed(plate, tmp_path)
    shown = rows[(rows["domain"] == "kernel") & (rows["status"] == "ok")]
    assert f"{len(shown)} polygons" in caption
    assert "results/quick" in caption
    for family in set(shown["family"]):
        assert f">{family}<" in document.decode()


# --- the verb and its directory ------------------------------------------------------------------


def test_the_verb_draws_what_it_lists(tmp_path: Path, capsys) -> None:
    assert main(["figures", "--list"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert listed == list(PLATES)
    out = tmp_path / "shelf"
    assert main(["figures", "figure-6", "figure-1", "--out", str(out)]) == 0
    assert capsys.readouterr().out.split() == [
        str(out / "figure-6.svg"),
        str(out / "figure-1.svg"),
    ]
    assert main(["figures", "figure-5", "--out", str(out), "--format", "pdf"]) == 0
    assert (out / "figure-5.pdf").read_bytes().startswith(b"%PDF")
    known = json.loads((out / "captions.json").read_text())
    assert list(known) == ["figure-1", "figure-5", "figure-6"]
    assert all(entry["title"] and entry["caption"] for entry in known.values())
    assert all(f"avd figures {name}" in entry["recipe"] for name, entry in known.items())
    assert list(shelf(out)) == ["figure-1", "figure-6"]  # those that a page can hold


def test_wrong_names_and_damaged_captions_are_refused(tmp_path: Path, capsys) -> None:
    assert main(["figures", "figure-7", "--out", str(tmp_path)]) == 1
    assert "no figure is called 'figure-7'" in capsys.readouterr().err
    (tmp_path / "captions.json").write_text("{")
    with pytest.raises(UserError, match=r"captions\.json: cannot be read"):
        put(PLATES["figure-1"], tmp_path, NOWHERE)
    (tmp_path / "captions.json").write_text("[]")
    with pytest.raises(UserError, match="not a list of captions"):
        captions(tmp_path)
    with pytest.raises(UserError, match="svg, png, pdf"):
        printed(PLATES["figure-1"], NOWHERE, "jpg")


def test_recipes_are_commands_that_are_understood() -> None:
    from harness.cli.main import build_parser

    parser = build_parser()
    for plate in PLATES.values():
        for command in plate.entry("")["recipe"]:
            parser.parse_args(command.split()[1:])
