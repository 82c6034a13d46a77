"""Pictures of an audit: an example's diagram with its marks, θ along an edge, growth curves."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from harness.diagram import build
from harness.diagram.planar_map import Edge, PlanarMap
from harness.geometry.instance import Instance
from harness.geometry.visual_angle import visual_angle
from harness.report.drawing import picture
from harness.report.style import (
    BLACK,
    BLUE,
    FALLBACK,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SETTINGS,
    SKY,
    VERMILLION,
    render,
)

Floats = npt.NDArray[np.float64]
Record = Mapping[str, Any]

WIDTH = 4.6
COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, GREY, BLACK)
MARKERS = "osD^vP*X"


def example_svg(instance: Instance, record: Record) -> str:
    """The example's diagram, its segments numbered, with rings around the marked points."""
    found = build(instance, record["domain"], workers=1)
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(SETTINGS)
        figure = picture(found, width=WIDTH, labels=True, caption="")
        for axes in figure.axes:
            _ring(axes, record["marks"])
        buffer = io.StringIO()
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        figure.savefig(buffer, format="svg", metadata=nothing)
    return _coarse(buffer.getvalue().replace("'DejaVu Sans'", FALLBACK))


def _ring(axes: Any, marks: Sequence[Sequence[float]]) -> None:
    for x, y in marks:
        axes.plot([x], [y], "o", ms=9, mfc="none", mec=VERMILLION, mew=1.6, zorder=20)


def profile_svg(instance: Instance, record: Record) -> str | None:
    """θ along the Voronoi edge that passes the first mark; None if no edge does."""
    if not record["marks"]:
        return None
    mark = np.array(record["marks"][0])
    found = build(instance, record["domain"], workers=1)
    line = _edge_through(found, mark)
    if line is None:
        return None
    edge, points = line
    angles = np.degrees(visual_angle(points, instance.segments[edge.segments[0]]))
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    at = int(np.hypot(*(points - mark).T).argmin())

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        axes.plot(along, angles, color=BLUE)
        axes.plot(along[at], angles[at], "o", ms=9, mfc="none", mec=VERMILLION, mew=1.6)
        axes.set_xlabel(f"way along the edge of segments {edge.segments[0]}, {edge.segments[1]}")
        axes.set_ylabel("visual angle (degrees)")
        axes.grid(visible=True)
        figure.tight_layout()

    return _coarse(render(draw, WIDTH, 2.6))


def _edge_through(found: PlanarMap, mark: Floats) -> tuple[Edge, Floats] | None:
    """The bounded part of the edge that comes nearest to a point, thinned out for a figure."""
    shape = found.instance.segments.reshape(-1, 2)
    size = float(np.ptp(shape, axis=0).max())
    best, nearest = None, 1e-3 * size
    for edge in found.edges:
        points = _denser(edge.polyline(1e-5 * size))
        gap = float(np.hypot(*(points - mark).T).min())
        if gap < nearest:
            best, nearest = (edge, points), gap
    if best is None:
        return None
    edge, points = best
    near = np.hypot(*(points - mark).T) <= 3 * size  # an unbounded edge goes on for ever
    for end in shape:  # where the angle has no value
        near &= np.hypot(*(points - end).T) > 1e-3 * size
    points = points[near]
    return edge, points[:: max(1, len(points) // 400)]


def _denser(points: Floats) -> Floats:
    """A polyline with 20 points for each of its own."""
    place = np.arange(len(points), dtype=np.float64)
    finer = np.linspace(0.0, len(points) - 1.0, 20 * len(points))
    return np.column_stack([np.interp(finer, place, points[:, k]) for k in (0, 1)])


def growth_svg(series: Sequence[Record]) -> str:
    """Counts against n, both on logarithmic axes, beside lines of slope 1 and 2."""

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        top, sizes = 1.0, [n for one in series for n in one["n"]]
        for k, one in enumerate(series):
            n, counts = np.array(one["n"]), np.array(one["counts"], dtype=float)
            there = counts > 0
            top = max(top, float(counts.max()))
            axes.loglog(
                n[there],
                counts[there],
                marker=MARKERS[k % len(MARKERS)],
                color=COLOURS[k % len(COLOURS)],
                label=short(one["family"]),
            )
        low, high = min(sizes), max(sizes)
        for slope, style in ((1, ":"), (2, "--")):
            guide = top * (np.array([low, high]) / high) ** slope
            axes.loglog([low, high], guide, style, color=GREY, lw=0.9, label=f"slope {slope}")
        axes.set_ylim(bottom=0.8)
        ticks = [2**k for k in range(20) if low <= 2**k <= high]
        axes.set_xticks(ticks, [str(tick) for tick in ticks])
        axes.minorticks_off()
        axes.set_xlabel("n")
        axes.set_ylabel(f"{series[0]['title']} (most at each n)")
        axes.grid(visible=True)
        axes.legend(ncols=1, loc="center left", bbox_to_anchor=(1.0, 0.5))
        figure.tight_layout()

    return render(draw, 6.4, 3.4)


def short(family: str) -> str:
    """A family with what parameters tell apart: only words, such as ``generic``."""
    name, _, params = family.partition(" ")
    words = re.findall(r':"(\w+)"|: "(\w+)"', params)
    return " ".join([name, *("".join(word) for word in words)])


def _coarse(svg: str) -> str:
    """The document with the paths' coordinates to a tenth of a point: nobody sees more."""
    return re.sub(r'\bd="[^"]*"', lambda path: re.sub(r"(\.\d)\d+", r"\1", path[0]), svg)
