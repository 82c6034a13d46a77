"""Star-shaped polygons: the kernel and its diagram, level sets, and where the peak may lie."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from harness.diagram import build
from harness.diagram.counts import Domain
from harness.diagram.planar_map import PlanarMap
from harness.geometry.instance import Instance
from harness.geometry.visual_angle import visual_angle
from harness.peak import Peak, peak
from harness.report.drawing_colours import Style, styles
from harness.report.drawing_layers import PEAK_MARK
from harness.report.drawing_shapes import Points, framed
from harness.report.plates.curves import PrintShapes
from harness.report.plates.parts import (
    INK,
    canvas,
    counted,
    draw_edges,
    draw_ground,
    draw_segments,
    fill_cells,
    letter,
)

#: A star of eight edges with a large kernel, in small integers.
STAR = ((0, 0), (5, 1), (9, -1), (8, 4), (10, 9), (5, 7), (1, 9), (2, 4))
#: Its peak is a vertex of the diagram …
PENTAGON = ((0, 0), (6, 0), (9, 4), (5, 8), (-1, 5))
#: … and that of this one lies inside an edge.
HEXAGON = ((0, 0), (5, -1), (10, 0), (10, 3), (5, 4), (0, 3))
LEVELS = 7
GRID = 260
KERNEL: dict[str, Any] = {"edgecolor": INK, "linewidth": 0.9, "linestyle": (0, (4, 2))}


def draw_star(figure: Figure, _: Path) -> str:
    """A star polygon: its diagram in the interior, and in the kernel."""
    captions = []
    for k, domain in enumerate[Domain](("interior", "kernel")):
        diagram = _diagram(STAR, domain)
        left = 0.1 + 3.45 * k
        shown = np.array(STAR, dtype=float) if domain == "interior" else _corners(diagram)
        axes = canvas(figure, (left, 0.35, 3.3, 3.3), framed(shown))
        _draw(axes, diagram)
        if domain == "interior":
            kernel = _corners(_diagram(STAR, "kernel"))
            axes.add_patch(Polygon(kernel, fill=False, zorder=4, **KERNEL))
        letter(figure, f"({'ab'[k]}) {domain}", left + 1.3, 0.12)
        captions.append(f"in the {domain} {counted(diagram)}")
    return (
        f"A star-shaped polygon of {len(STAR)} edges and its angular Voronoi diagrams: "
        f"(a) {captions[0]}, the edges being transparent (dashed: the kernel, from whose points "
        f"all of the polygon is seen); (b) enlarged, {captions[1]}. Every cell has the colour of "
        "the edge that is seen from it under the smallest angle."
    )


def draw_peaks(figure: Figure, _: Path) -> str:
    """Level sets of the smallest visual angle, and a peak that is a vertex and one that is not."""
    words = []
    for k, polygon in enumerate((PENTAGON, HEXAGON)):
        left = 0.1 + 3.45 * k
        diagram, best = _diagram(polygon, "kernel"), peak(polygon)
        axes = canvas(figure, (left, 0.35, 3.3, 3.1), framed(np.array(polygon, dtype=float)))
        _draw(axes, diagram)
        _draw_levels(axes, diagram, best)
        axes.plot(best.x, best.y, zorder=10, **PEAK_MARK)
        letter(figure, f"({'ab'[k]})", left + 1.55, 0.12)
        degrees = np.degrees(best.angle)
        names = ", ".join(str(edge) for edge in best.basis)
        words.append(
            f"({'ab'[k]}) {degrees:.2f}°, where edges {names} tie, "
            + ("a Voronoi vertex" if _is_vertex(diagram, best) else "inside a Voronoi edge")
        )
    return (
        "The smallest visual angle inside two convex polygons. Its superlevel sets (white lines) "
        f"are convex; its peak (star) is at {'; '.join(words)}. So "
        "a search among the Voronoi vertices alone can miss it."
    )


def _diagram(polygon: tuple[tuple[int, int], ...], domain: Domain) -> PlanarMap:
    return build(Instance.from_arrays("polygon", [list(vertex) for vertex in polygon]), domain)


def _corners(diagram: PlanarMap) -> Points:
    """The corners (k, 2) of a domain that is not the plane."""
    assert diagram.corners is not None, "only the plane has no corners"
    return diagram.corners


def _is_vertex(diagram: PlanarMap, best: Peak) -> bool:
    """Whether a vertex of the diagram has the very edges of the peak's basis."""
    return any(set(best.basis) <= set(node.segments) for node in diagram.nodes) and (
        len(best.basis) >= 3
    )


def _styles(diagram: PlanarMap) -> list[Style]:
    return styles(
        diagram.instance.n,
        (edge.segments for edge in diagram.edges),
        (cell.segment for cell in diagram.cells),
    )


def _draw(axes: Axes, diagram: PlanarMap) -> None:
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    shapes = PrintShapes(diagram, (x0, y0, x1, y1))
    looks = _styles(diagram)
    draw_ground(axes, diagram.instance.floats)
    fill_cells(axes, shapes, lambda segment: looks[segment].fill)
    draw_edges(axes, shapes, linewidth=0.8)
    if diagram.domain == "kernel" and diagram.corners is not None:
        axes.add_patch(Polygon(diagram.corners, fill=False, zorder=4, **KERNEL))
    draw_segments(axes, diagram.instance.segments, [look.line for look in looks], 2.8)
    points = np.array([n.point for n in diagram.nodes if n.kind == "triple"]).reshape(-1, 2)
    axes.plot(*points.T, "o", color=INK, ms=3.6, zorder=8)


def _draw_levels(axes: Axes, diagram: PlanarMap, best: Peak) -> None:
    """Lines of equal smallest visual angle, from the vertices' least to the peak."""
    corners = _corners(diagram)
    low, high = corners.min(axis=0), corners.max(axis=0)
    x, y = np.meshgrid(np.linspace(low[0], high[0], GRID), np.linspace(low[1], high[1], GRID))
    points: Points = np.stack([x, y], axis=-1)
    angles = visual_angle(points[:, :, None, :], diagram.instance.segments).min(axis=-1)
    levels = best.angle * np.linspace(0, 1, LEVELS + 2)[1:-1]
    lines = axes.contour(x, y, angles, levels=levels, colors="white", linewidths=0.9, zorder=4)
    lines.set_clip_path(Polygon(corners, transform=axes.transData))
