"""Pictures of diagrams: cells coloured by segment, true curves, nodes by kind.

:func:`plot` draws into axes of the caller's, :func:`picture` makes a figure with a legend and a
caption, :func:`render` gives the bytes of an SVG, PNG or PDF file: the same bytes for the same
diagram, whatever the user's settings of matplotlib are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from harness.diagram.planar_map import PlanarMap, Window
from harness.errors import UserError
from harness.report.drawing_layers import Layers
from harness.report.drawing_shapes import checked_window, framed, natural_window
from harness.report.style import FORMATS, in_style, saved

#: A kernel that is smaller than this part of its polygon is shown once more, enlarged.
SMALL_KERNEL = 0.5
#: Inches: around the panels, for a line of the caption or the title, for the legend's lines.
PAD, TEXT_LINE, LEGEND_LINE = 0.08, 0.26, 0.19
LEGEND_COLUMN = 1.3


@dataclass(frozen=True)
class Panel:
    """One window on the diagram, with a frame if the plane goes on outside.

    ``inset`` is the part of it that the next panel enlarges.
    """

    window: Window
    has_frame: bool = True
    inset: Window | None = None

    @property
    def aspect(self) -> float:
        """Height over width."""
        x0, y0, x1, y1 = self.window
        return (y1 - y0) / (x1 - x0)


def plot(
    diagram: PlanarMap,
    axes: Axes,
    *,
    window: Sequence[float] | None = None,
    nodes: bool = True,
    labels: bool = False,
) -> None:
    """Draw a diagram into ``axes``, with equal scales and without ticks.

    ``window``: (xmin, ymin, xmax, ymax), by default everything that is not far away.  ``nodes``:
    whether to mark nodes by kind.  ``labels``: whether to write the index of its segment into
    every cell that has room for it.  Raises UserError for an empty window.
    """
    panel = _whole(diagram) if window is None else Panel(checked_window(window))
    _fill(axes, Layers(diagram), panel, nodes=nodes, labels=labels)


def _printable(text: str | None) -> str:
    """The text without what no file format can hold: control characters and lone surrogates."""
    return "".join(c for c in text or "" if c.isprintable())


def picture(
    diagram: PlanarMap,
    *,
    width: float = 7.0,
    window: Sequence[float] | None = None,
    nodes: bool = True,
    labels: bool = False,
    title: str | None = None,
    caption: str | None = None,
    peak: tuple[float, float] | None = None,
) -> Figure:
    """A figure of a diagram, ``width`` inches wide, with a legend; see :func:`plot`.

    If the domain is a kernel much smaller than the polygon and no window is given, a second panel
    enlarges it.  ``caption`` is by default a line with the counts; give "" for none.  ``peak``: a
    point to be marked as the peak.
    """
    if not (math.isfinite(width) and 1 <= width <= 100):
        raise UserError(f"the width must be between 1 and 100 inches, not {width:g}")
    panels = _panels(diagram) if window is None else [Panel(checked_window(window))]
    layers = Layers(diagram, peak)
    legend = layers.legend(nodes)
    lines = math.ceil(len(legend) * LEGEND_COLUMN / (width - 2 * PAD))
    columns = math.ceil(len(legend) / lines)
    text = _printable(counts_line(diagram, panels) if caption is None else caption)
    title = _printable(title)

    # Fixed places in inches, not a layout engine: what is known needs no search.
    frame = (width - PAD * (len(panels) + 1)) / len(panels)
    bottom = PAD + LEGEND_LINE * lines + TEXT_LINE * bool(text)
    tall = max(min(frame * panel.aspect, 1.6 * frame) for panel in panels)
    height = bottom + PAD + tall + PAD + TEXT_LINE * bool(title)
    figure = Figure(figsize=(width, height))
    for k, panel in enumerate(panels):
        left = PAD + k * (frame + PAD)
        place = (left / width, (bottom + PAD) / height, frame / width, tall / height)
        _fill(figure.add_axes(place), layers, panel, nodes=nodes, labels=labels)
    if text:
        figure.text(
            0.5, (bottom - TEXT_LINE / 2) / height, text, ha="center", va="center", parse_math=False
        )
    if title:
        middle = (height - PAD - TEXT_LINE / 2) / height
        figure.text(0.5, middle, title, ha="center", va="center", weight="bold", parse_math=False)
    figure.legend(
        handles=legend,
        loc="lower center",
        bbox_to_anchor=(0.5, 0.0),
        ncols=columns,
        handlelength=1.6,
        borderpad=0.2,
        borderaxespad=0.2,
        columnspacing=1.4,
    )
    return figure


def render(diagram: PlanarMap, form: str = "svg", **options: Any) -> bytes:
    """The bytes of a picture in one of the ``FORMATS``; ``options`` are those of ``picture``."""
    if form not in FORMATS:
        raise UserError(f"cannot draw {form!r}: choose from {', '.join(FORMATS)}")
    # Curves are as fine as they need to be already.
    with in_style({"path.simplify": False, "hatch.linewidth": 0.6}):
        return saved(picture(diagram, **options), form)


def counts_line(diagram: PlanarMap, panels: Sequence[Panel] = ()) -> str:
    """One line saying what the diagram contains, and what of it the panels leave outside."""
    counts = diagram.counts
    words = [
        f"{value} {one if value == 1 else many}"
        for value, one, many in (
            (counts.cells, "cell", "cells"),
            (counts.edges, "edge", "edges"),
            (counts.vertices, "vertex", "vertices"),
        )
    ]
    line = f"{', '.join(words)} — {counts.objective} visual angle, {_place(diagram)}"
    hidden = _hidden(diagram, panels)
    return line + (f"; {hidden} node{'s' if hidden > 1 else ''} not shown" if hidden else "")


def _place(diagram: PlanarMap) -> str:
    return "whole plane" if diagram.domain == "plane" else f"{diagram.domain} of the polygon"


def _hidden(diagram: PlanarMap, panels: Sequence[Panel]) -> int:
    """How many finite nodes lie outside every panel."""
    points = np.array([n.point for n in diagram.nodes if n.kind != "infinity"]).reshape(-1, 2)
    shown = np.zeros(len(points), dtype=bool) if panels else np.ones(len(points), dtype=bool)
    for panel in panels:
        x0, y0, x1, y1 = panel.window
        shown |= ((points >= (x0, y0)) & (points <= (x1, y1))).all(axis=1)
    return int((~shown).sum())


def _whole(diagram: PlanarMap) -> Panel:
    return Panel(natural_window(diagram), has_frame=diagram.corners is None)


def _panels(diagram: PlanarMap) -> list[Panel]:
    """The whole, and a small kernel enlarged."""
    whole = _whole(diagram)
    if diagram.domain != "kernel" or diagram.corners is None:
        return [whole]
    part = framed(diagram.corners)
    x0, y0, x1, y1 = whole.window
    if max(part[2] - part[0], part[3] - part[1]) > SMALL_KERNEL * max(x1 - x0, y1 - y0):
        return [whole]
    return [replace(whole, inset=part), Panel(part)]


def _fill(axes: Axes, layers: Layers, panel: Panel, *, nodes: bool, labels: bool) -> None:
    x0, y0, x1, y1 = panel.window
    axes.set_aspect("equal")
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(panel.has_frame)
        spine.set(linewidth=0.6, color="#9a9a9a")
    layers.draw(axes, panel.window, nodes=nodes and panel.inset is None, labels=labels)
    if panel.inset is not None:
        a0, b0, a1, b1 = panel.inset
        axes.plot([a0, a1, a1, a0, a0], [b0, b0, b1, b1, b0], color="#555555", lw=0.7, zorder=9)
