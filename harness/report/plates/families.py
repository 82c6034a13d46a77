"""A gallery of the families of instances, one small diagram for each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from generators import FAMILIES
from harness.diagram.planar_map import PlanarMap
from harness.report.drawing_colours import dark, styles
from harness.report.drawing_shapes import framed, natural_window
from harness.report.labels import plural
from harness.report.plates.colours import weave_colour
from harness.report.plates.curves import PrintShapes
from harness.report.plates.parts import (
    INK,
    SOFT,
    canvas,
    diagram_of,
    draw_edges,
    draw_ground,
    draw_segments,
    fill_cells,
)

#: Sizes at which the panels are legible; other families are drawn with ``SIZE`` segments.
SIZES = {"star": 8, "cavity": 6, "grid": 8, "segments": 6, "near-regular": 16}
SIZE = 12
SEEDS = {"star": 3, "cavity": 2}
#: The one instance of ``figure-2`` has a plate of its own.
SHOWN = tuple(name for name in FAMILIES if name != "figure-2")
COLUMNS = 4
PANEL, TITLE = 1.66, 0.46  # inches
WEAVES = ("zigzag", "convex-weave")


def height() -> float:
    """Inches that the gallery takes."""
    return -(-len(SHOWN) // COLUMNS) * (PANEL + TITLE) + 0.1


def draw_gallery(figure: Figure, _: Path) -> str:
    """One panel for each family, in the order of ``avd families``."""
    high = height()
    uncertified = []
    for k, name in enumerate(SHOWN):
        row, column = divmod(k, COLUMNS)
        left, top = 0.1 + column * (PANEL + 0.14), high - row * (PANEL + TITLE)
        diagram = diagram_of(name, SIZES.get(name, SIZE), SEEDS.get(name, 1))
        if not diagram.counts.certified:
            uncertified.append(name)
        axes = canvas(figure, (left, top - TITLE - PANEL, PANEL, PANEL), _window(diagram))
        _draw(axes, diagram, _colours(diagram, name))
        wide = figure.get_figwidth()
        counts = diagram.counts
        vertices = plural(counts.vertices, "vertex", "vertices")
        words = f"n = {counts.n}: {plural(counts.cells, 'cell')}, {vertices}"
        for text, below, size, weight, colour in (
            (name, 0.22, 8.5, "bold", INK),
            (words, 0.38, 7.2, "normal", SOFT),
        ):
            figure.text(
                left / wide, (top - below) / high, text, fontsize=size, weight=weight, color=colour
            )
    certified = "all certified" if not uncertified else f"NOT certified: {', '.join(uncertified)}"
    return (
        "The families of instances, one small diagram of each: in the kernel of a polygon (where "
        "it is small, that part is enlarged), in the plane for segments. Each cell has the colour "
        f"of the segment that is seen from it under the smallest angle. Counts: {certified}."
    )


def _window(diagram: PlanarMap) -> tuple[float, float, float, float]:
    """The whole, or a kernel much smaller than its polygon with some of what is around."""
    whole = natural_window(diagram)
    if diagram.corners is None:
        return framed(diagram.instance.segments.reshape(-1, 2), 0.45)
    part = framed(diagram.corners, 0.2)
    is_small = part[2] - part[0] < 0.6 * (whole[2] - whole[0])
    return part if is_small else whole


def _colours(diagram: PlanarMap, name: str) -> Callable[[int], tuple[str, str]]:
    """The colours of a segment's cells and of the segment itself."""
    if name in WEAVES:

        def of_weave(segment: int) -> tuple[str, str]:
            fill = weave_colour(segment, diagram.instance.n)
            return fill, dark(fill)

        return of_weave
    looks = styles(
        diagram.instance.n,
        (edge.segments for edge in diagram.edges),
        (cell.segment for cell in diagram.cells),
    )
    return lambda segment: (looks[segment].fill, looks[segment].line)


def _draw(axes: Axes, diagram: PlanarMap, colours: Callable[[int], tuple[str, str]]) -> None:
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    shapes = PrintShapes(diagram, (x0, y0, x1, y1))
    if diagram.corners is not None:
        draw_ground(axes, diagram.instance.floats)
    fill_cells(axes, shapes, lambda segment: colours(segment)[0])
    draw_edges(axes, shapes, linewidth=0.4)
    segments = diagram.instance.segments
    draw_segments(axes, segments, [colours(k)[1] for k in range(len(segments))], 1.5)
    kinds = ("triple", "crossing", "saddle")
    points = np.array([n.point for n in diagram.nodes if n.kind in kinds]).reshape(-1, 2)
    axes.plot(*points.T, "o", color=INK, ms=1.7, mew=0, zorder=8)
