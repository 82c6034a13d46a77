"""Figures of the mesh study, and the paper's Figures 5 and 6 with meshes of our own."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from harness.mesh.apex import greedy
from harness.mesh.mesh import Mesh
from harness.mesh.quality import corner_angles, quality_of
from harness.peak import peak
from harness.report.style import BLUE, GREEN, GREY, PALE, VERMILLION

Floats = npt.NDArray[np.float64]

HULL = [(0, 0), (5, -1.2), (9, 0.5), (10, 5), (6.5, 8), (1.5, 7), (-1.5, 3.5)]
INNER = [(1.6, 6.0), (8.2, 2.0), (4.4, 1.2)]
STAR = [(0, 0), (4, -2), (7.5, 0), (7, 3.5), (10.5, 6), (4.6, 5.2), (-0.6, 5.4)]
EAR = 4
"""The vertex of the star that a chord cuts off."""
SHOWN = 120
"""Inner vertices of the mesh in the picture."""


def plain(axes: Axes, points: Any, triangles: Any, label: str) -> None:
    """A mesh as lines."""
    xy = np.asarray(points, dtype=np.float64)
    if len(triangles):
        axes.triplot(xy[:, 0], xy[:, 1], np.asarray(triangles), color=GREY, linewidth=0.8)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.text(0.5, -0.06, label, transform=axes.transAxes, ha="center", fontsize=8)


def draw_figure_5(figure: Figure) -> None:
    """The paper's Figure 5: a mesh, after one step of the greedy, and after the next."""
    from scipy.spatial import Delaunay

    points = np.array(HULL + INNER, dtype=np.float64)
    mesh = Mesh.of(points, Delaunay(points).simplices.astype(np.int64))
    x, y = np.ldexp(mesh.points, -4).T.copy()
    waiting, free = ~mesh.fixed, ~mesh.fixed
    shots = [points]
    for _ in range(2):
        greedy(waiting, *mesh.stars, free, x, y, False, False, 10**6, 1)
        shots.append(np.ldexp(np.column_stack([x, y]), 4))
    for k, (axes, shot) in enumerate(zip(figure.subplots(1, 3), shots, strict=True)):
        angles = corner_angles(shot, mesh.triangles)[np.isin(mesh.triangles, mesh.free)]
        label = f"({'abc'[k]}) least angle at inner vertices {angles.min():.1f}°"
        plain(axes, shot, mesh.triangles, label)
        if k:
            moved = (shot != shots[k - 1]).any(axis=1)
            axes.plot(
                *shots[k - 1][moved].T, "o", color=GREY, markersize=4, markerfacecolor="white"
            )
            axes.plot(*shot[moved].T, "o", color=VERMILLION, markersize=5)


def draw_figure_6(figure: Figure) -> None:
    """The paper's Figure 6: the kernel of a star, its triangulation, and one without an ear."""
    from harness.geometry.instance import Instance
    from harness.geometry.kernel import kernel

    rim = np.array(STAR, dtype=np.float64)
    n = len(rim)
    best = peak(rim.tolist())
    points = np.concatenate([rim, [[best.x, best.y]]])
    fan = np.array([(i, (i + 1) % n, n) for i in range(n)])
    first, second, third = figure.subplots(1, 3)
    plain(first, rim, fan[:0], "(a) the kernel")
    first.fill(*rim.T, color=PALE)
    first.plot(*np.concatenate([rim, rim[:1]]).T, color=GREY, linewidth=0.9)
    found = kernel(Instance.from_arrays("polygon", STAR)).corners
    corners = np.array([[float(value) for value in corner] for corner in found])
    first.fill(*corners.T, color=GREEN, alpha=0.5)
    plain(second, points, fan, f"(b) from the peak: {corner_angles(points, fan).min():.1f}°")
    inner = [i for i in range(n) if i != EAR]
    other = peak(rim[inner].tolist())
    now = np.concatenate([rim, [[other.x, other.y]]])
    ear = ((EAR - 1) % n, EAR, (EAR + 1) % n)
    sides = zip(inner, [*inner[1:], inner[0]], strict=True)
    cut = np.array([*((a, b, n) for a, b in sides), ear])
    plain(third, now, cut, f"(c) an ear cut off: {corner_angles(now, cut).min():.1f}°")
    for axes, place in ((first, points[n]), (second, points[n]), (third, now[n])):
        axes.plot(*place, "o", color=VERMILLION, markersize=5)


def draw_meshes(figure: Figure) -> None:
    """A random mesh, and what the paper's greedy, all angles and changes of edges make of it."""
    from generators.triangulations import random_mesh
    from harness.mesh.door import improve
    from harness.report.mesh_drawing import BEST, COLOURS, draw_mesh

    points, triangles = random_mesh(SHOWN, 0)
    results = {
        "apex": improve(points, triangles, objective="apex"),
        "all": improve(points, triangles),
        "all, full": improve(points, triangles, topology="full"),
    }
    shots = [("before", points, triangles, quality_of(points, triangles).smallest)]
    shots += [(name, r.points, r.triangles, r.after.smallest) for name, r in results.items()]
    grid = figure.subplots(1, len(shots))
    for axes, (name, xy, corners, smallest) in zip(grid, shots, strict=True):
        draw_mesh(axes, xy, corners, width=3.0)
        axes.set_title(f"{name}: {smallest:.1f}°")
    scale = ScalarMappable(Normalize(0, BEST), COLOURS)
    figure.colorbar(scale, ax=list(grid), shrink=0.7, label="smallest angle (°)")


def draw_histograms(figure: Figure, panels: list[tuple[str, list[int], list[int]]]) -> None:
    """Shares of all angles before and after, one panel for each method."""
    columns = 5
    rows = -(-len(panels) // columns)
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, (title, before, after) in zip(grid.ravel(), panels, strict=False):
        for counts, colour, label in ((before, GREY, "before"), (after, BLUE, "after")):
            share = np.array(counts) / max(sum(counts), 1)
            edges = np.linspace(0, 180, len(counts) + 1)
            axes.stairs(share, edges, color=colour, fill=colour == GREY, alpha=0.8, label=label)
        axes.set_title(title, fontsize=8)
        axes.set_xticks([0, 60, 120, 180])
    grid[0, 0].legend(fontsize=7)
    for axes in grid[-1]:
        axes.set_xlabel("angle (°)")
    for axes in grid[:, 0]:
        axes.set_ylabel("share")
    figure.tight_layout()


def draw_sweeps(figure: Figure, lines: dict[str, list[list[float]]]) -> None:
    """Smallest angle, percentiles and mean after each sweep, one line for each method."""
    names = ("smallest angle", "1st percentile", "5th percentile", "mean of the least angles")
    for k, axes in enumerate(figure.subplots(1, 4)):
        for number, (method, history) in enumerate(lines.items()):
            style = ("-", "--", ":")[number // 5 % 3]
            values = [sweep[k] for sweep in history]
            axes.plot(range(1, len(values) + 1), values, style, label=method)
        axes.set_title(names[k], fontsize=8)
        axes.set_xlabel("sweep")
        axes.set_xscale("log")
        axes.grid(visible=True)
    figure.axes[0].set_ylabel("degrees")
    figure.axes[-1].legend(fontsize=6, loc="lower right")
    figure.tight_layout()


def draw_times(figure: Figure, times: dict[str, list[tuple[int, float]]]) -> None:
    """Seconds against the number of triangles."""
    axes = figure.subplots()
    for number, (method, places) in enumerate(times.items()):
        style = ("o-", "s--", "^:")[number // 5 % 3]
        axes.loglog(*zip(*places, strict=True), style, label=method, markersize=3)
    axes.set_xlabel("triangles")
    axes.set_ylabel("seconds")
    axes.grid(visible=True)
    axes.legend(fontsize=7, ncols=2)
    figure.tight_layout()
