"""The paper's Figures 1 to 4: level sets, a diagram, the worst case, two circles."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

from harness.diagram import build
from harness.diagram.planar_map import PlanarMap, Window
from harness.geometry.instance import Instance
from harness.report.drawing_colours import styles
from harness.report.drawing_shapes import Points
from harness.report.plates.colours import oklch, weave_colour
from harness.report.plates.curves import PrintShapes
from harness.report.plates.parts import (
    INK,
    SOFT,
    canvas,
    counted,
    diagram_of,
    draw_edges,
    draw_segments,
    fill_cells,
    letter,
    ring,
    square,
    write,
)
from harness.report.style import BLUE, VERMILLION

GRID = 12
EXTENSION: dict[str, Any] = {
    "color": INK,
    "linewidth": 0.7,
    "linestyle": (0, (1, 2.2)),
    "zorder": 4,
}


def draw_figure_1(figure: Figure, _: Path) -> str:
    """Points that see a segment under the same angle."""
    for k, (angles, bold, reach) in enumerate(
        (((50, 60, 70, 80), 60, 2.3), ((100, 120, 135, 150), 120, 1.35))
    ):
        left = 0.1 + 3.45 * k
        axes = canvas(figure, (left, 0.35, 3.3, 3.3), square(reach))
        for angle in angles:
            arcs = [_arc(angle, side) for side in (1, -1)]
            chosen = angle == bold
            if chosen:
                axes.add_patch(Polygon(np.concatenate(arcs), fc=oklch(0.93, 0.04, 70), ec="none"))
            for arc in arcs:
                axes.plot(*arc.T, color=VERMILLION if chosen else SOFT, lw=1.5 if chosen else 0.7)
            colour = VERMILLION if chosen else SOFT
            write(axes, f"{angle}°", arcs[1][len(arcs[1]) // 2], fontsize=7, color=colour)
        _draw_view(axes, _arc(bold, 1)[56 if k == 0 else 34], 0.16 * reach)
        draw_segments(axes, np.array([[(-1.0, 0.0), (1.0, 0.0)]]), width=2.6)
        write(axes, "s", (0.0, -0.085 * reach), style="italic")
        letter(figure, f"({'ab'[k]}) α {'<>'[k]} π/2", left + 1.25, 0.12)
    return (
        "The points from which a segment s is seen under the angle α form two arcs over s: major "
        "arcs of their circles if α < π/2 (a), minor arcs if α > π/2 (b). From the shaded "
        "region s is seen under at least α: it is convex in (b) and not in (a)."
    )


def _arc(angle: float, side: int) -> Points:
    """The arc (81, 2) above (side 1) or below (−1) the segment from (−1, 0) to (1, 0)."""
    alpha = math.radians(angle)
    middle, radius = 1 / math.tan(alpha), 1 / math.sin(alpha)
    turn = np.linspace(-(math.pi - alpha), math.pi - alpha, 81)
    return np.column_stack([side * radius * np.sin(turn), side * (middle + radius * np.cos(turn))])


def _draw_view(axes: Axes, point: Points, radius: float) -> None:
    """The point, its rays to the ends of the segment, and the angle between them."""
    for end in (-1.0, 1.0):
        axes.plot([point[0], end], [point[1], 0.0], color=INK, lw=0.8)
    first, last = (math.atan2(-point[1], end - point[0]) for end in (-1.0, 1.0))
    turn = np.linspace(first, last, 30)
    arc = point + radius * np.column_stack([np.cos(turn), np.sin(turn)])
    axes.plot(*arc.T, color=INK, lw=0.8)
    middle = (first + last) / 2
    inside = point + 0.66 * radius * np.array([math.cos(middle), math.sin(middle)])
    axes.text(
        float(inside[0]), float(inside[1]), "α", fontsize=8, ha="center", va="center", zorder=9
    )
    axes.plot(*point, "o", color=VERMILLION, ms=5, mec="white", mew=0.6, zorder=8)
    write(axes, "p", point + 0.35 * radius, style="italic")


def draw_figure_2(figure: Figure, _: Path) -> str:
    """The diagram of three segments in the plane."""
    diagram = diagram_of("figure-2", 3)
    nodes = np.array([n.point for n in diagram.nodes if n.kind != "infinity"])
    seen = np.concatenate([nodes, diagram.instance.segments.reshape(-1, 2)])
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    reach = 0.62 * float(np.ptp(seen, axis=0).max())
    axes = canvas(figure, (0.1, 0.1, 4.8, 4.8), square(reach, (middle[0], middle[1])))
    _draw_plane(axes, diagram)
    return (
        f"The angular Voronoi diagram of three segments: {counted(diagram)}. Every point has the "
        "colour of the segment that it sees under the smallest angle; the dotted extensions of a "
        "segment, from which it is seen under the angle 0, lie in its cells."
    )


def _draw_plane(axes: Axes, diagram: PlanarMap) -> None:
    """Cells, edges, extensions, vertices and segments of a diagram of few segments."""
    window = _window(axes)
    shapes = PrintShapes(diagram, window)
    looks = styles(
        diagram.instance.n,
        (edge.segments for edge in diagram.edges),
        (cell.segment for cell in diagram.cells),
    )
    fill_cells(axes, shapes, lambda segment: looks[segment].fill)
    draw_edges(axes, shapes)
    for segment in diagram.instance.segments:
        _extend(axes, segment, window)
    draw_segments(axes, diagram.instance.segments, [look.line for look in looks], 3.0)
    _mark_vertices(axes, diagram)


def _window(axes: Axes) -> Window:
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    return x0, y0, x1, y1


def _extend(axes: Axes, segment: Points, window: Window) -> None:
    """Both extensions of a segment, to beyond the window."""
    along = (segment[1] - segment[0]) / np.hypot(*(segment[1] - segment[0]))
    far = 2 * max(window[2] - window[0], window[3] - window[1])
    for end, sense in zip(segment, (-1, 1), strict=True):
        tip = end + sense * far * along
        axes.add_line(Line2D([end[0], tip[0]], [end[1], tip[1]], **EXTENSION))


def _mark_vertices(axes: Axes, diagram: PlanarMap, size: float = 4.0) -> None:
    """Triple points filled, crossings of extensions open."""
    for kind, face in (("triple", INK), ("crossing", "white"), ("saddle", "white")):
        points = np.array([n.point for n in diagram.nodes if n.kind == kind]).reshape(-1, 2)
        axes.plot(*points.T, "o", ls="none", ms=size, mfc=face, mec=INK, mew=0.8, zorder=8)


def draw_figure_3(figure: Figure, _: Path) -> str:
    """Horizontal and vertical segments whose extensions form a grid."""
    diagram = diagram_of("grid", GRID)
    nodes = np.array([n.point for n in diagram.nodes if n.kind == "crossing"])
    seen = np.concatenate([nodes, diagram.instance.segments.reshape(-1, 2)])
    low, high = seen.min(axis=0), seen.max(axis=0)
    middle = (low + high) / 2
    reach = 0.57 * float((high - low).max())
    axes = canvas(figure, (0.1, 0.1, 5.3, 5.3), square(reach, (middle[0], middle[1])))
    shapes = PrintShapes(diagram, _window(axes))
    vertical = np.abs(np.diff(diagram.instance.segments, axis=1)[:, 0, 0]) < 1e-9
    colours = _by_family(vertical.tolist())
    fill_cells(axes, shapes, lambda segment: colours[segment])
    draw_edges(axes, shapes, color="white", linewidth=0.5)
    draw_segments(axes, diagram.instance.segments, width=2.6)
    counts = diagram.counts
    return (
        f"The paper’s worst case for segments in the plane, here with n = {GRID}: the extensions "
        f"of {GRID // 2} horizontal and {GRID // 2} vertical segments (black) cross in "
        f"{counts.nodes['crossing']} points, and around each of them two cells of either kind "
        f"meet. In all {counted(diagram)}. Light: cells of horizontal segments; "
        "dark: of vertical ones."
    )


def _by_family(odd: list[bool]) -> list[str]:
    """Colours of the weave for two families: light where ``odd`` is false, dark elsewhere."""
    seen, colours = [0, 0], []
    for flag in odd:
        colours.append(weave_colour(2 * seen[flag] + flag, len(odd)))
        seen[flag] += 1
    return colours


def draw_figure_4(figure: Figure, _: Path) -> str:
    """Two circles of the same visual angle over two segments, and where they meet."""
    half, middle, slope, alpha = 0.75, np.array([2.6, 1.25]), math.radians(62), math.radians(48)
    first = np.array([(-1.0, 0.0), (1.0, 0.0)])
    along = half * np.array([math.cos(slope), math.sin(slope)])
    second = np.array([middle - along, middle + along])
    diagram = build(Instance.from_arrays("segments", [first.tolist(), second.tolist()]))
    axes = canvas(figure, (0.1, 0.1, 5.4, 4.0), (-1.75, -0.85, 3.75, 3.22))
    draw_edges(axes, PrintShapes(diagram, _window(axes)), color=BLUE, linewidth=1.1)
    height = 1 / math.tan(alpha)
    centres = [np.array([0.0, height]), middle + height * np.array([-along[1], along[0]])]
    radii = [1 / math.sin(alpha), half / math.sin(alpha)]
    for centre, radius, (a, b), name in zip(
        centres, radii, (first, second), ("(0, h)", "C₂"), strict=True
    ):
        axes.add_patch(Circle(tuple(centre), radius, fill=False, ec=VERMILLION, lw=1.0))
        axes.plot(*ring(np.array([centre, a, (a + b) / 2, b])).T, color=SOFT, lw=0.6)
        axes.plot(*np.array([centre, (a + b) / 2]).T, color=SOFT, lw=0.6, ls="--")
        axes.plot(*centre, "o", color=SOFT, ms=3.5)
        if name != "C₂":
            write(axes, name, centre + np.array([0.0, 0.16]), fontsize=8)
    draw_segments(axes, np.array([first, second]), width=3.0)
    labels = (("(x, y)", (-0.2, 0.17)), ("(x′, y′)", (0.28, -0.1)))
    for point, (label, offset) in zip(_meetings(centres, radii), labels, strict=True):
        for end in (*first, *second):
            axes.plot(*np.array([point, end]).T, color=INK, lw=0.5, ls=(0, (1, 2)))
        axes.plot(*point, "o", color=INK, ms=5, mec="white", mew=0.6, zorder=9)
        write(axes, label, point + offset, fontsize=8)
    for text, at in (
        ("(−1, 0)", (-1.0, -0.2)),
        ("(1, 0)", (1.0, -0.2)),
        ("s₁", (0.0, -0.2)),
        ("s₂", middle + np.array([0.2, -0.08])),
        ("h", (0.1, height / 2)),
    ):
        write(axes, text, at, fontsize=8)
    return (
        "Two segments are seen under the same angle from the points where two circles over them "
        "meet whose inscribed angles agree (red; here 48°, the triangles are similar). As the "
        "angle varies these points run along the Voronoi edges (blue): pieces of curves of "
        f"degree three. The diagram of the two segments has {counted(diagram)}."
    )


def _meetings(centres: list[Points], radii: list[float]) -> list[Points]:
    """The two points where two circles meet."""
    across = centres[1] - centres[0]
    apart = float(np.hypot(*across))
    part = (apart**2 + radii[0] ** 2 - radii[1] ** 2) / (2 * apart)
    aside = math.sqrt(radii[0] ** 2 - part**2)
    unit = across / apart
    foot = centres[0] + part * unit
    return [foot + sense * aside * np.array([-unit[1], unit[0]]) for sense in (1, -1)]
