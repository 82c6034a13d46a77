"""The paper's Figures 5 and 6 as plates; their meshes are those of the study of meshes."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from harness.report import mesh_figures


def draw_figure_5(figure: Figure, _: Path) -> str:
    """A mesh, and two steps of the greedy."""
    mesh_figures.draw_figure_5(figure)
    _tighten(figure)
    return (
        "Improving a triangular mesh by moving inner points, one at a time: (a) a mesh, (b) after "
        "the inner point with the least angle has moved to its peak (filled; open: where it "
        "was), (c) after the next. Below each, the least angle at an inner point."
    )


def draw_figure_6(figure: Figure, _: Path) -> str:
    """A star's kernel, its triangulation from the peak, and one without an ear."""
    mesh_figures.draw_figure_6(figure)
    _tighten(figure)
    return (
        "A polygon with a small angle at a vertex: (a) its kernel, (b) triangulated from the peak, "
        "which makes the small angle smaller, (c) with the ear cut off by a chord and the peak of "
        "what is left. Below, the least of all angles."
    )


def draw_meshes(figure: Figure, _: Path) -> str:
    """A random mesh, and what becomes of it."""
    figure.set_layout_engine("constrained")
    mesh_figures.draw_meshes(figure)
    return (
        "A random mesh and what becomes of it: moved by the paper’s greedy (apex), by raising all "
        "angles at once (all), and with exchanged, inserted and deleted edges and vertices too "
        "(all, full). Triangles are coloured by their smallest angle; above each mesh, the "
        "smallest of all."
    )


def _tighten(figure: Figure) -> None:
    """The panels side by side, with room for their labels only."""
    figure.subplots_adjust(left=0.01, right=0.99, top=0.99, bottom=0.06, wspace=0.03)
