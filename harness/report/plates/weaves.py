"""The woven kernels: a star and a convex polygon whose diagrams are checkerboards."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, ConnectionPatch, Patch, PathPatch

from harness.diagram.planar_map import PlanarMap
from harness.report.drawing_layers import compound
from harness.report.drawing_shapes import Points, Shapes, natural_window
from harness.report.labels import number
from harness.report.plates.colours import weave_colour
from harness.report.plates.curves import PrintShapes, thinned
from harness.report.plates.parts import (
    INK,
    SOFT,
    canvas,
    counted,
    diagram_of,
    draw_edges,
    draw_ground,
    fill_cells,
    square,
    write,
)

N = 24
SEED = 1
BAND = 0.035  # how far the coloured bands reach beyond the edges they stand for
#: The lower and the upper rim of the unrolled picture, as distances from the polygon's rim.
STRIP = (1.0, 0.004)


class Lens(Shapes):
    """A window as small as an opened tie: only what is at its vertices is followed, and shown."""

    def __init__(self, whole: Shapes, nodes: tuple[int, ...], reach: float) -> None:
        """``whole``: the diagram as drawn without a lens, whose curves do for edges far away.

        ``nodes``: the vertices to be seen; ``reach`` of the window around their middle.
        """
        self.whole, self.ends = whole, set(nodes)
        diagram = whole.diagram
        middle = np.mean([diagram.nodes[k].point for k in nodes], axis=0)
        super().__init__(diagram, square(reach, (float(middle[0]), float(middle[1]))))
        near = [edge for edge in diagram.edges if self.ends & {edge.start, edge.end}]
        self.cells = {cell for edge in near for cell in (edge.left, edge.right)}

    @cached_property
    def curves(self) -> list[Points]:
        """As of any window; edges that end elsewhere are only as true as the outlines need."""
        return [
            edge.polyline(2e-3 * self.extent) if self.ends & {edge.start, edge.end} else curve
            for edge, curve in zip(self.diagram.edges, self.whole.curves, strict=True)
        ]

    def outlines(self, cell: int) -> list[Points]:
        """The outlines of a cell at one of the vertices; of others, none."""
        return super().outlines(cell) if cell in self.cells else []


def opened_ties(diagram: PlanarMap) -> list[tuple[float, tuple[int, int], int]]:
    """(length, its two ends, family) of the short edges between cells of one family.

    Half-way between two passings of tips four edges tie, but for noise, which opens the tie into
    two vertices with such an edge between them.  Those that are as near to the centre as they are
    long, where all tips start, are left out.
    """
    found = []
    for edge in diagram.edges:
        i, j = edge.segments
        if (i - j) % 2 == 0 and edge.start is not None and edge.end is not None:
            ends = np.array([diagram.nodes[k].point for k in (edge.start, edge.end)])
            if np.hypot(*ends.T).min() > 0.01:
                length = float(np.hypot(*(ends[1] - ends[0])))
                found.append((length, (edge.start, edge.end), i % 2))
    return found


def draw_woven_kernel(figure: Figure, _: Path) -> str:
    """The kernel of a zigzag star with 12 spikes; two opened ties and the centre under the lens."""
    diagram = diagram_of("zigzag", N, SEED)
    axes = canvas(figure, (0.0, 0.0, 5.5, 5.5), square(1.12))
    whole = PrintShapes(diagram, natural_window(diagram))
    _draw_star(axes, whole)
    found = opened_ties(diagram)
    middle = [k for k, node in enumerate(diagram.nodes) if np.hypot(*node.point) < 0.01]
    extent = max(np.hypot(*diagram.nodes[k].point) for k in middle)
    lenses = [
        *(_lens_at(whole, found, parity, place) for parity, place in ((0, 0.45), (1, -0.1))),
        Lens(whole, tuple(middle), 1.25 * float(extent)),
    ]
    for k, lens in enumerate(lenses):
        _draw_lens(figure, axes, lens, (5.72, 3.95 - 1.88 * k, 1.5, 1.5), "abc"[k])
    _legend(figure)
    return (
        f"The kernel of a zigzag star with {N // 2} spikes (n = {N}) is woven into "
        f"{counted(diagram)}. Light cells belong to one family of edges, dark cells to its "
        "mirror image; each cell has the colour of its edge on the rim. Every second crossing of "
        "the weave is a tie of four edges, and what looks like one point is two triple points, "
        f"joined by an edge between two cells of one family: {len(found)} such edges outside the "
        f"centre, none longer than {number(max(found)[0], 2)} of the star’s radius. At the other "
        "crossings, where a tip of one family passes a tip of the other, noise has joined two "
        "cells into one, and there is no vertex. (a), (b) two ties under the lens; (c) the centre, "
        f"where all tips start: {len(middle)} triple points."
    )


def _lens_at(
    whole: Shapes, found: list[tuple[float, tuple[int, int], int]], parity: int, height: float
) -> Lens:
    """The lens on the opened tie of one family that is nearest to a place on the right."""
    nodes_of = whole.diagram.nodes
    length, nodes, _ = min(
        (each for each in found if each[2] == parity),
        key=lambda each: np.hypot(*np.subtract(nodes_of[each[1][0]].point, (0.6, height))),
    )
    return Lens(whole, nodes, 1.4 * length)


def _draw_star(axes: Axes, shapes: Shapes) -> None:
    """The cells, and outside each edge of the polygon a band in its colour."""
    diagram = shapes.diagram
    draw_ground(axes, diagram.instance.floats)
    fill_cells(axes, shapes, lambda segment: weave_colour(segment, N))
    draw_edges(axes, shapes, color="white", linewidth=0.5)
    colours = [weave_colour(k, N) for k in range(N)]
    ends = diagram.instance.segments
    bands = np.concatenate([ends, (1 + BAND) * ends[:, ::-1]], axis=1)
    axes.add_collection(
        PolyCollection(list(bands), facecolors=colours, edgecolors="white", linewidths=0.5)
    )
    for k, (a, b) in enumerate(ends):
        write(axes, str(k), 1.085 * (a + b) / 2, fontsize=6.5, color=SOFT)


def _draw_lens(
    figure: Figure, axes: Axes, lens: Lens, place: tuple[float, float, float, float], name: str
) -> None:
    """The window of a lens as a disc, and where it lies in the picture."""
    view = canvas(figure, place, lens.window)
    fill_cells(view, lens, lambda segment: weave_colour(segment, N))
    draw_edges(view, lens, color="white", linewidth=1.1)
    middle = (float(lens.middle[0]), float(lens.middle[1]))
    reach = lens.extent / 2
    rim = Circle(middle, reach, transform=view.transData)
    for artist in (*view.patches, *view.collections):
        artist.set_clip_path(rim)
    view.add_patch(Circle(middle, 0.99 * reach, fill=False, ec=INK, lw=0.9, zorder=8))
    points = np.array([lens.diagram.nodes[k].point for k in sorted(lens.ends)])
    size = 4.5 if len(points) == 2 else 2.6
    view.plot(*points.T, "o", color=INK, markersize=size, mec="white", mew=0.4, zorder=9)
    axes.plot(*middle, "o", markersize=6, mfc="none", mec=INK, mew=0.9, zorder=9)
    figure.add_artist(
        ConnectionPatch(
            middle, (0.0, 0.5), axes.transData, view.transAxes, lw=0.6, color=INK, shrinkA=3
        )
    )
    text = f"({name}) radius {number(reach, 2)}"
    view.text(0.5, -0.1, text, transform=view.transAxes, ha="center", fontsize=8, color=INK)


def _legend(figure: Figure) -> None:
    handles = [
        Patch(facecolor=weave_colour(parity, N), label=text)
        for parity, text in ((4, "edges tilted one way"), (1, "their mirror images"))
    ]
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 0.0), borderpad=0.3)


def draw_convex_weave(figure: Figure, _: Path) -> str:
    """The convex polygon, and its cells unrolled around the centre."""
    diagram = diagram_of("convex-weave", N, SEED)
    axes = canvas(figure, (0.75, 2.9, 5.6, 5.6), square(1.1))
    shapes = PrintShapes(diagram, natural_window(diagram))
    _draw_star(axes, shapes)
    wide, high = figure.get_size_inches()
    strip = figure.add_axes((0.62 / wide, 0.32 / high, (wide - 0.87) / wide, 2.4 / high))
    _draw_strip(strip, shapes)
    return (
        f"A convex polygon will do as well: its {N} vertices lie on two circles in turn, its "
        f"kernel is all of it, and its diagram has {counted(diagram)}. Most of them crowd at the "
        "rim. Below, the same cells unrolled: from left to right once around the centre, upwards "
        "from the centre to the rim, on a logarithmic scale of the distance from the rim (r from "
        "the centre, where the rim is at R)."
    )


def _draw_strip(axes: Axes, shapes: Shapes) -> None:
    """Cells in the coordinates (angle, distance from the rim in parts of the radius there)."""
    polygon = shapes.diagram.instance.floats
    for k, cell in enumerate(shapes.diagram.cells):
        fill = weave_colour(cell.segment, N)
        for outline in shapes.outlines(k):
            unrolled = _unrolled(outline, polygon)
            for shift in (-360.0, 0.0, 360.0):
                moved = unrolled + np.array([shift, 0.0])
                if moved[:, 0].max() > 0 and moved[:, 0].min() < 360:
                    patch = PathPatch(compound([moved]), fc=fill, ec="white", linewidth=0.4)
                    axes.add_patch(patch)
    axes.set_xlim(0, 360)
    axes.set_ylim(*np.log10(STRIP))
    axes.set_xticks(range(0, 361, 45), [f"{angle}°" for angle in range(0, 361, 45)])
    ticks = (1.0, 0.3, 0.1, 0.03, 0.01)
    axes.set_yticks(np.log10(ticks), [f"{tick:g}" for tick in ticks])
    axes.set_ylabel("1 − r/R")


def _unrolled(outline: Points, polygon: Points) -> Points:
    """Polar angle in degrees, and log₁₀(1 − r/R) with R the polygon's radius in that direction."""
    following = np.roll(outline, -1, axis=0)
    parts = np.linspace(0, 1, 12, endpoint=False)[:, None]
    pairs = zip(outline, following, strict=True)
    fine = np.concatenate([(1 - parts) * a + parts * b for a, b in pairs])
    middle = fine.mean(axis=0)
    start = float(np.arctan2(middle[1], middle[0]))
    cos, sin = np.cos(start), np.sin(start)
    turn = np.arctan2(cos * fine[:, 1] - sin * fine[:, 0], cos * fine[:, 0] + sin * fine[:, 1])
    height = np.log10(np.clip(1 - _share_of_rim(fine, polygon), 1e-4, 1))
    flat = np.column_stack([np.degrees(start + turn), height])
    scale = np.array([1.0, 100.0])  # about as many points of print for a unit of either
    kept: Points = thinned(scale * np.concatenate([flat, flat[:1]]), 0.1)[:-1] / scale
    return kept


def _share_of_rim(points: Points, polygon: Points) -> Points:
    """How far out the points (m, 2) of a convex polygon around the origin are: 1 on its rim."""
    along = np.roll(polygon, -1, axis=0) - polygon
    offsets = along[:, 1] * polygon[:, 0] - along[:, 0] * polygon[:, 1]
    heights = along[:, 1] * points[:, :1] - along[:, 0] * points[:, 1:]
    share: Points = (heights / offsets).max(axis=1)
    return share
