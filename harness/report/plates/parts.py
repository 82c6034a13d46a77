"""What the plates share: diagrams of families, bare axes, cells in given colours."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Polygon

from generators import generate
from harness.diagram import build
from harness.diagram.planar_map import PlanarMap, Window
from harness.geometry.instance import Instance
from harness.report.drawing_layers import compound
from harness.report.drawing_shapes import Points, Shapes
from harness.report.labels import plural

INK = "#1c2430"
SOFT = "#5a6472"
GROUND = "#f3f2ee"
EDGE_WIDTH = 0.55


def diagram_of(family: str, n: int, seed: int = 0, **options: Any) -> PlanarMap:
    """The diagram of a family's instance; ``options``: ``domain``, and the family's parameters."""
    domain = options.pop("domain", None)
    made = generate(family, n, seed=seed, **options)
    return build(Instance.from_generated(made), domain)


def recipe_of(family: str, n: int, seed: int = 0, **parameters: Any) -> tuple[str, ...]:
    """The commands that make that instance and count its diagram."""
    given = "".join(f" --param {name}={value}" for name, value in parameters.items())
    file = f"{family}-{n}.json"
    return f"avd generate {family} -n {n} --seed {seed}{given} -o {file}", f"avd count {file}"


def counted(diagram: PlanarMap) -> str:
    """Its headline counts in words, and whether they are certified."""
    counts = diagram.counts
    vertices = plural(counts.vertices, "vertex", "vertices")
    words = f"{plural(counts.cells, 'cell')}, {plural(counts.edges, 'edge')} and {vertices}"
    return f"{words} ({'certified' if counts.certified else 'NOT certified'})"


def canvas(figure: Figure, place: Sequence[float], window: Window) -> Axes:
    """Axes with equal scales and no frame at ``place`` (left, bottom, width, height in inches)."""
    wide, high = figure.get_size_inches()
    left, bottom, width, height = place
    axes = figure.add_axes((left / wide, bottom / high, width / wide, height / high))
    x0, y0, x1, y1 = window
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)
    axes.set_aspect("equal")
    axes.axis("off")
    return axes


def square(reach: float, middle: tuple[float, float] = (0.0, 0.0)) -> Window:
    """The window within ``reach`` of a point, in both coordinates."""
    x, y = middle
    return x - reach, y - reach, x + reach, y + reach


def fill_cells(axes: Axes, shapes: Shapes, colour: Callable[[int], str]) -> None:
    """Every cell in the colour of its segment."""
    for k, cell in enumerate(shapes.diagram.cells):
        rings = shapes.outlines(k)
        if rings:
            fill = colour(cell.segment)
            # A hair of its own colour: no ground shines through between neighbours.
            patch = PathPatch(compound(rings), facecolor=fill, edgecolor=fill, linewidth=0.15)
            axes.add_patch(patch)


def draw_edges(axes: Axes, shapes: Shapes, **style: Any) -> None:
    """The Voronoi edges, as true curves."""
    look = {"color": INK, "linewidth": EDGE_WIDTH, "capstyle": "round", "zorder": 3, **style}
    axes.add_collection(LineCollection(list(shapes.visible_curves()), **look), autolim=False)


def draw_segments(
    axes: Axes, segments: Points, colours: Sequence[str] | str = INK, width: float = 2.2
) -> None:
    """The segments (n, 2, 2), on a white casing."""
    for shade, line in (("white", width + 1.2), (colours, width)):
        lines = LineCollection(list(segments), colors=shade, linewidths=line, capstyle="round")
        lines.set_zorder(5)
        axes.add_collection(lines, autolim=False)


def draw_ground(axes: Axes, polygon: Points, colour: str = GROUND) -> None:
    """The inside of a polygon (n, 2)."""
    axes.add_patch(Polygon(polygon, facecolor=colour, edgecolor="none", zorder=0))


def write(axes: Axes, text: str, at: Sequence[float] | Points, **style: Any) -> None:
    """Words at a point of the plane, with a white halo."""
    look = {"ha": "center", "va": "center", "fontsize": 9, "color": INK, "zorder": 9, **style}
    halo = [patheffects.withStroke(linewidth=2.2, foreground="white")]
    axes.text(float(at[0]), float(at[1]), text, path_effects=halo, **look)


def letter(figure: Figure, text: str, left: float, bottom: float) -> None:
    """A panel's label at a place in inches."""
    wide, high = figure.get_size_inches()
    figure.text(left / wide, bottom / high, text, fontsize=9, color=INK, va="baseline")


def ring(points: Points) -> Points:
    """A closed polyline through the points (m, 2)."""
    return np.concatenate([points, points[:1]])
