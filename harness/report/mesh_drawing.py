"""Pictures of triangulations: every triangle coloured by its smallest angle."""

from __future__ import annotations

import io

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from harness.mesh.quality import least_angles, quality_of

BEST = 60.0
"""Degrees: no triangle has a greater smallest angle."""
COLOURS = "cividis"
MANY = 20_000
"""With more triangles, SVG and PDF hold them as an image, and edges are not drawn."""


def render_mesh(
    points: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.int64],
    form: str,
    *,
    width: float = 7.0,
    title: str = "",
) -> bytes:
    """The picture of a mesh as the bytes of an SVG, PNG or PDF file.

    ``points``: (n, 2); ``triangles``: (m, 3), counter-clockwise; ``width``: in inches.
    """
    with plt.rc_context({"svg.hashsalt": "avd", "svg.fonttype": "none"}):
        figure, axes = plt.subplots(figsize=(width, width), layout="constrained")
        try:
            shown = draw_mesh(axes, points, triangles, width)
            figure.colorbar(shown, ax=axes, shrink=0.7, label="smallest angle of the triangle (°)")
            found = quality_of(points, triangles)
            axes.set_title(title)
            axes.set_xlabel(
                f"{len(triangles)} triangles, smallest angle {found.smallest:.2f}°, "
                f"mean of the smallest angles {found.mean:.2f}°"
            )
            out = io.BytesIO()
            metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(form)
            figure.savefig(out, format=form, dpi=200, metadata=metadata)
            return out.getvalue()
        finally:
            plt.close(figure)


def draw_mesh(
    axes: Axes,
    points: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.int64],
    width: float = 7.0,
) -> PolyCollection:
    """Draw the triangles into axes of about ``width`` inches; returns what is coloured."""
    low = points[triangles].min(axis=(0, 1))
    places = (points - low) / (points[triangles].max(axis=(0, 1)) - low).max()
    line = min(0.8, 20 * width / np.sqrt(len(triangles)) / 72)
    shown = PolyCollection(
        list(places[triangles]),
        array=least_angles(points, triangles),
        cmap=COLOURS,
        edgecolor="white" if len(triangles) <= MANY else "face",
        linewidth=line,
        rasterized=len(triangles) > MANY,
    )
    shown.set_clim(0, BEST)
    axes.add_collection(shown)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)
    return shown
