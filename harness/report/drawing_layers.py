"""The layers of a picture, from the ground up: cells, edges, kernel, segments, nodes, words."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path as Outline

from harness.diagram.counts import NodeKind
from harness.diagram.planar_map import PlanarMap, Window
from harness.report.drawing_colours import Style, dark, styles
from harness.report.drawing_shapes import Points, Shapes, roomiest_point

INK = "#202020"
GROUND = "#f2f2f0"  # inside the polygon, outside the domain

EDGE_LINE: dict[str, Any] = {"color": INK, "linewidth": 0.9}
KERNEL_LINE: dict[str, Any] = {"color": INK, "linewidth": 0.9, "linestyle": (0, (4, 2))}
SEGMENT_WIDTH, CASING = 2.6, 1.6

#: What a node of each kind is called, and how it is marked.  Infinite ends are not drawn.
NODE_MARKS: dict[NodeKind, tuple[str, dict[str, Any]]] = {
    "triple": ("triple point", {"marker": "o", "markersize": 4.4, "markerfacecolor": INK}),
    "crossing": ("crossing", {"marker": "D", "markersize": 4.4, "markerfacecolor": "white"}),
    "saddle": ("saddle", {"marker": "s", "markersize": 5.0, "markerfacecolor": "#ffd92f"}),
    "endpoint": ("endpoint", {"marker": "o", "markersize": 3.4, "markerfacecolor": "white"}),
    "boundary": ("boundary end", {"marker": "v", "markersize": 3.6, "markerfacecolor": "white"}),
}

PEAK_MARK: dict[str, Any] = {
    "marker": "*",
    "markersize": 11,
    "markerfacecolor": "#e31a1c",
    "markeredgecolor": "white",
    "markeredgewidth": 0.8,
    "linestyle": "none",
    "label": "peak",
}

# Bottom to top.
_GROUND, _CELLS, _EDGES, _DOMAIN, _SEGMENTS, _NODES, _PEAK, _WORDS = range(1, 9)


class Layers:
    """Draws one diagram into any number of windows; colours are the same in all of them."""

    def __init__(self, diagram: PlanarMap, peak: tuple[float, float] | None = None) -> None:
        """O(n²) for the colours; curves are followed when a window is drawn."""
        self.diagram = diagram
        self.peak = peak
        self.styles: list[Style] = styles(
            diagram.instance.n,
            (edge.segments for edge in diagram.edges),
            (cell.segment for cell in diagram.cells),
        )

    @cached_property
    def kernel(self) -> Points | None:
        """The corners (k, 2) of the kernel, if it has an interior and is not the whole polygon."""
        from harness.geometry.kernel import kernel

        if self.diagram.instance.kind != "polygon":
            return None
        found = kernel(self.diagram.instance)
        if not found.has_interior:
            return None
        corners = np.array([[float(x), float(y)] for x, y in found.corners])
        polygon = self.diagram.instance.floats
        return None if _area(corners) > (1 - 1e-12) * abs(_area(polygon)) else corners

    def draw(self, axes: Axes, window: Window, *, nodes: bool, labels: bool) -> None:
        """Draw everything into ``axes``, whose limits are ``window`` already."""
        shapes = Shapes(self.diagram, window)
        scale = _points_per_unit(axes, window)
        if self.diagram.instance.kind == "polygon":
            ground = self.diagram.instance.floats
            axes.add_patch(Polygon(ground, fc=GROUND, ec="none", zorder=_GROUND))
        self._draw_cells(axes, shapes, scale, labels)
        curves = list(shapes.visible_curves())
        axes.add_collection(
            LineCollection(curves, capstyle="round", zorder=_EDGES, **EDGE_LINE), autolim=False
        )
        if self.kernel is not None:
            axes.add_patch(Polygon(self.kernel, fill=False, zorder=_DOMAIN, **KERNEL_LINE))
        self._draw_segments(axes, scale, window)
        if nodes:
            self._draw_nodes(axes)
        if self.peak is not None:
            x, y = self.peak
            axes.add_line(Line2D([x], [y], zorder=_PEAK, **PEAK_MARK))

    def _draw_cells(self, axes: Axes, shapes: Shapes, scale: float, labels: bool) -> None:
        for k, cell in enumerate(self.diagram.cells):
            rings = shapes.outlines(k)
            if not rings:
                continue
            style = self.styles[cell.segment]
            patch = PathPatch(
                compound(rings),
                facecolor=style.fill,
                edgecolor=style.line,  # colours the hatching; the outline itself has no width
                hatch=style.hatch or None,
                linewidth=0,
                zorder=_CELLS,
            )
            axes.add_patch(patch)
            if labels:
                point, room = roomiest_point(rings, self.diagram.instance.segments)
                if room * scale > 5.0:
                    _write(axes, str(cell.segment), point, style.line, (0.0, 0.0))

    def _draw_segments(self, axes: Axes, scale: float, window: Window) -> None:
        instance = self.diagram.instance
        # White casings first, all of them, so that none cuts a neighbour.
        shades = [style.line for style in self.styles]
        for colours, width in (("white", SEGMENT_WIDTH + CASING), (shades, SEGMENT_WIDTH)):
            lines = LineCollection(
                list(instance.segments), colors=colours, linewidths=width, capstyle="round"
            )
            lines.set_zorder(_SEGMENTS)
            axes.add_collection(lines, autolim=False)
        for k, (a, b) in enumerate(instance.segments):
            length = float(np.hypot(*(b - a)))
            middle = (a + b) / 2
            if length * scale > 14 and _contains(window, middle):
                # Outside a polygon, that is, to the right; beside a segment it does not matter.
                away = np.array([b[1] - a[1], a[0] - b[0]]) / length
                _write(axes, str(k), middle, self.styles[k].line, tuple(8.5 * away))

    def _draw_nodes(self, axes: Axes) -> None:
        for kind in self.kinds:
            points = np.array([n.point for n in self.diagram.nodes if n.kind == kind])
            axes.add_line(_marks(kind, points[:, 0].tolist(), points[:, 1].tolist()))

    @property
    def kinds(self) -> list[NodeKind]:
        """The kinds of node to be drawn."""
        present = {node.kind for node in self.diagram.nodes}
        return [kind for kind in NODE_MARKS if kind in present]

    def legend(self, nodes: bool) -> list[Line2D]:
        """What the legend explains."""
        shade = dark("#b8ceaa")
        entries = [
            Line2D([], [], color=shade, linewidth=SEGMENT_WIDTH, label="segment"),
            Line2D([], [], label="Voronoi edge", **EDGE_LINE),
        ]
        if self.kernel is not None:
            entries.append(Line2D([], [], label="kernel", **KERNEL_LINE))
        if nodes:
            entries += [_marks(kind, [], []) for kind in self.kinds]
        return entries + ([] if self.peak is None else [Line2D([], [], **PEAK_MARK)])


def compound(rings: list[Points]) -> Outline:
    """One path of several closed rings (m, 2), oriented so that it fills by the even–odd rule.

    Renderers fill by the rule of non-zero winding; outer walks run counter-clockwise and holes
    clockwise, for which both rules agree.
    """
    vertices = np.concatenate([np.concatenate([ring, ring[:1]]) for ring in rings])
    codes = np.concatenate(
        [[Outline.MOVETO, *[Outline.LINETO] * (len(ring) - 1), Outline.CLOSEPOLY] for ring in rings]
    )
    return Outline(vertices, codes)


def _area(polygon: Points) -> float:
    """The signed area of a polygon (m, 2), from its first vertex so that nothing large cancels."""
    x, y = (polygon - polygon[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _marks(kind: NodeKind, x: list[float], y: list[float]) -> Line2D:
    name, mark = NODE_MARKS[kind]
    style = {"linestyle": "none", "markeredgecolor": INK, "markeredgewidth": 0.8, **mark}
    return Line2D(x, y, label=name, zorder=_NODES, **style)


def _write(axes: Axes, text: str, point: Points, colour: str, offset: tuple[float, ...]) -> None:
    """Write ``text`` at a point, moved by ``offset`` in points, with a white halo."""
    axes.annotate(
        text,
        (float(point[0]), float(point[1])),
        xytext=(offset[0], offset[1]),
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=8,
        color=colour,
        zorder=_WORDS,
        path_effects=[patheffects.withStroke(linewidth=2.0, foreground="white")],
    )


def _points_per_unit(axes: Axes, window: Window) -> float:
    """How many typographic points a unit of the plane takes in ``axes``."""
    figure = axes.get_figure(root=True)
    assert figure is not None, "the axes belong to a figure"
    place = axes.get_position(original=True)
    wide, high = 72 * figure.get_size_inches() * (place.width, place.height)
    x0, y0, x1, y1 = window
    return float(min(wide / (x1 - x0), high / (y1 - y0)))


def _contains(window: Window, point: Points) -> bool:
    x0, y0, x1, y1 = window
    return bool(x0 < point[0] < x1 and y0 < point[1] < y1)
