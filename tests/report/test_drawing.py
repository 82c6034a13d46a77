"""Pictures show what is counted, are the same bytes every time, and fit their frames."""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given, settings
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from generators import generate
from harness.diagram import build
from harness.diagram.planar_map import PlanarMap
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.report.drawing import FORMATS, picture, plot, render
from harness.report.drawing_layers import NODE_MARKS, compound
from harness.report.drawing_shapes import natural_window
from tests.report.test_drawing_shapes import diagrams

MAGIC = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}
LABELS = {kind: name for kind, (name, _) in NODE_MARKS.items()}


def diagram_of(family: str, n: int, seed: int = 0, **options) -> PlanarMap:
    return build(Instance.from_generated(generate(family, n, seed)), **options)


@pytest.fixture(scope="module")
def square() -> PlanarMap:
    return build(Instance.from_arrays("polygon", [(0, 0), (4, 0), (4, 4), (0, 4)]))


@pytest.fixture(scope="module")
def three() -> PlanarMap:
    return diagram_of("figure-2", 3)


@pytest.fixture(scope="module")
def spiky() -> PlanarMap:
    """A polygon with a kernel less than half as large."""
    vertices = [(9, 0), (1, 1), (0, 9), (-1, 1), (-9, 0), (-1, -1), (0, -9), (1, -1)]
    return build(Instance.from_arrays("polygon", vertices))


@pytest.mark.parametrize("form", FORMATS)
def test_the_same_diagram_gives_the_same_bytes(form, square, three) -> None:
    first = render(square, form, labels=True)
    assert first.startswith(MAGIC[form])
    with mpl.rc_context({"lines.linewidth": 9.0, "font.size": 30, "svg.hashsalt": "other"}):
        render(three, form)
        assert render(square, form, labels=True) == first
        assert mpl.rcParams["font.size"] == 30


def test_an_unknown_form_is_refused(square) -> None:
    with pytest.raises(UserError, match="svg, png, pdf"):
        render(square, "jpg")


def test_the_svg_is_one_document_that_loads_nothing(three) -> None:
    root = ET.fromstring(render(three, "svg").decode())
    assert root.tag.endswith("svg")
    for element in root.iter():
        for name, value in element.attrib.items():
            assert not name.endswith("href") or value.startswith("#")
        assert not element.tag.endswith(("script", "image"))


@settings(max_examples=25)
@given(diagrams())
def test_everything_counted_is_drawn(diagram: PlanarMap) -> None:
    axes = Figure().add_subplot()
    x0, y0, x1, y1 = natural_window(diagram)
    # All nodes, wherever they are.
    points = np.array([n.point for n in diagram.nodes if n.kind != "infinity"]).reshape(-1, 2)
    low = np.min([(x0, y0), *points], axis=0) - 1
    high = np.max([(x1, y1), *points], axis=0) + 1
    plot(diagram, axes, window=[*low, *high])
    patches = [patch for patch in axes.patches if isinstance(patch, PathPatch)]
    assert len(patches) == diagram.counts.cells
    assert len({patch.get_facecolor() for patch in patches}) == diagram.counts.regions
    marks = {line.get_label(): len(line.get_xdata()) for line in axes.lines}
    expected = dict(diagram.counts.nodes, boundary=diagram.counts.boundary_points)
    assert marks == {LABELS[k]: v for k, v in expected.items() if v and k != "infinity"}
    edges, _casing, segments = (c for c in axes.collections if isinstance(c, LineCollection))
    assert len(segments.get_segments()) == diagram.instance.n
    assert len(edges.get_segments()) >= diagram.counts.edges


def test_one_colour_a_segment(three) -> None:
    axes = Figure().add_subplot()
    plot(three, axes)
    fills: dict[int, set] = {}
    patches = (patch for patch in axes.patches if isinstance(patch, PathPatch))
    for cell, patch in zip(three.cells, patches, strict=True):
        fills.setdefault(cell.segment, set()).add(patch.get_facecolor())
    assert all(len(colours) == 1 for colours in fills.values())
    assert len(set.union(*fills.values())) == len(fills)


def test_holes_stay_open() -> None:
    outer = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
    hole = np.array([(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0)])  # clockwise
    path = compound([outer, hole])
    assert list(path.codes).count(Outline.MOVETO) == 2
    figure = Figure(figsize=(1, 1), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, 4), ylim=(0, 4))
    axes.axis("off")
    axes.add_patch(PathPatch(path, facecolor="black", linewidth=0))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., 0]
    assert pixels[50, 50] == 255
    assert pixels[10, 10] == 0


def texts(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.texts]


def test_title_and_caption(square) -> None:
    assert any(text.startswith("4 cells, 4 edges, 1 vertex —") for text in texts(picture(square)))
    assert texts(picture(square, title="T", caption="C")) == ["C", "T"]
    assert texts(picture(square, caption="")) == []


def test_the_caption_owns_up_to_nodes_outside(three) -> None:
    a, b = three.instance.segments[0]
    window = [*np.minimum(a, b) - 0.01, *np.maximum(a, b) + 0.01]
    x0, y0, x1, y1 = window
    finite = [node for node in three.nodes if node.kind != "infinity"]
    hidden = sum(not (x0 <= n.point[0] <= x1 and y0 <= n.point[1] <= y1) for n in finite)
    assert hidden > 1
    assert texts(picture(three, window=window))[0].endswith(f"; {hidden} nodes not shown")


@pytest.mark.parametrize("options", [{}, {"nodes": False}, {"width": 3}, {"width": 12.5}])
def test_everything_fits_on_the_page(options, square, three, spiky) -> None:
    for diagram in (square, three, spiky):
        figure = picture(diagram, title="A title", **options)
        figure.canvas.draw()
        page = figure.bbox
        boxes = [axes.get_window_extent() for axes in figure.axes]
        boxes += [legend.get_window_extent() for legend in figure.legends]
        if figure.get_figwidth() > 4:  # a caption may be longer than a small picture is wide
            boxes += [text.get_window_extent() for text in figure.texts]
        for box in boxes:
            assert page.x0 - 0.5 <= box.x0
            assert box.x1 <= page.x1 + 0.5
            assert page.y0 - 0.5 <= box.y0
            assert box.y1 <= page.y1 + 0.5
        ordered = sorted(boxes[: len(figure.axes) + 1], key=lambda box: box.x0)
        for first, second in itertools.pairwise(ordered):
            assert not first.overlaps(second)
        assert figure.get_figwidth() == options.get("width", 7.0)


def test_a_small_kernel_is_enlarged(square, spiky) -> None:
    assert len(picture(square).axes) == 1
    overview, enlarged = picture(spiky).axes
    assert overview.get_xlim()[0] < -9
    x0, x1 = enlarged.get_xlim()
    corners = spiky.corners
    assert corners is not None
    assert x0 < corners[:, 0].min() < corners[:, 0].max() < x1
    assert x1 - x0 < 5
    assert len(picture(spiky, window=(-9, -9, 9, 9)).axes) == 1


def test_the_kernel_is_shown_where_it_is_not_the_domain(square) -> None:
    def legend(diagram: PlanarMap) -> set[str]:
        return {text.get_text() for text in picture(diagram).legends[0].get_texts()}

    inside = diagram_of("zigzag", 10, domain="interior")
    assert "kernel" in legend(inside)
    assert "kernel" not in legend(square)  # the kernel is all of it: nothing to show
    assert {"segment", "Voronoi edge", "triple point"} <= legend(inside)


def test_labels_name_the_segment_of_every_roomy_cell(square) -> None:
    plain, labelled = (
        [text.get_text() for text in picture(square, labels=labels).axes[0].texts]
        for labels in (False, True)
    )
    assert sorted(plain) == ["0", "1", "2", "3"]
    assert sorted(labelled) == sorted(plain * 2)


@pytest.mark.parametrize("width", [0.5, -1, float("nan"), 1e9])
def test_absurd_widths_are_refused(width, square) -> None:
    with pytest.raises(UserError, match="width"):
        picture(square, width=width)


@pytest.mark.parametrize("scale", [1e-90, 1e-9, 1e9, 1e90])
def test_pictures_do_not_depend_on_the_unit_of_length(scale) -> None:
    figures = [
        picture(build(Instance.from_arrays("polygon", np.array([(0, 0), (4, 0), (1, 3)]) * unit)))
        for unit in (1.0, scale)
    ]
    one, other = ([tuple(text.xy) for text in figure.axes[0].texts] for figure in figures)
    assert np.allclose(np.array(other) / scale, np.array(one))
    sizes = [figure.get_size_inches() for figure in figures]
    assert np.allclose(*sizes)
    figures[1].canvas.draw()


@pytest.mark.parametrize("scale", [1e-200, 1e200])
def test_what_cannot_be_drawn_is_said(scale) -> None:
    vertices = np.array([(0, 0), (4, 0), (1, 3)]) * scale
    with pytest.raises(UserError, match="too large, too small"):
        picture(build(Instance.from_arrays("polygon", vertices)))


def test_marks_are_distinct() -> None:
    looks = {tuple(sorted(map(str, mark.items()))) for _, mark in NODE_MARKS.values()}
    assert len(looks) == len(NODE_MARKS)
    assert all(isinstance(Line2D([], [], **mark), Line2D) for _, mark in NODE_MARKS.values())


@pytest.mark.parametrize("title", [r"$\frac{$", "\x01 bell", "\ud800", "50 % of $5"])
def test_any_title_makes_a_wellformed_picture(square, title) -> None:
    ET.fromstring(render(square, "svg", title=title, caption=title))
