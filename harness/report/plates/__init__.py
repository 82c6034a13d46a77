"""The plates: the paper's figures and the project's own, for print; see :mod:`.plate`."""

from __future__ import annotations

from harness.report.plates.families import draw_gallery
from harness.report.plates.families import height as gallery_height
from harness.report.plates.meshes import draw_figure_5, draw_figure_6
from harness.report.plates.paper import draw_figure_1, draw_figure_2, draw_figure_3, draw_figure_4
from harness.report.plates.parts import recipe_of
from harness.report.plates.peaks import draw_peaks, draw_star
from harness.report.plates.plate import Plate, printed
from harness.report.plates.studies import (
    GROWTH,
    SMOOTHED,
    WEAVE,
    collapse_table,
    constants_table,
    draw_collapse,
    draw_constants,
    draw_growth,
    growth_table,
)
from harness.report.plates.weaves import SEED, N, draw_convex_weave, draw_woven_kernel

__all__ = ["PLATES", "Plate", "printed"]

_ALL = (
    Plate("figure-1", "Points of equal visual angle", (7.0, 3.75), draw_figure_1),
    Plate(
        "figure-2",
        "A diagram of three segments",
        (5.0, 5.0),
        draw_figure_2,
        recipe_of("figure-2", 3),
    ),
    Plate(
        "figure-3",
        "The worst case in the plane",
        (5.5, 5.5),
        draw_figure_3,
        recipe_of("grid", 12),
    ),
    Plate("figure-4", "Two circles of one visual angle", (5.6, 4.2), draw_figure_4),
    Plate("figure-5", "A mesh improved", (7.2, 2.3), draw_figure_5),
    Plate("figure-6", "An ear cut off", (7.2, 2.3), draw_figure_6),
    Plate("star", "A star, its interior and its kernel", (7.0, 3.75), draw_star),
    Plate("peaks", "Level sets and peaks", (7.0, 3.6), draw_peaks),
    Plate(
        "woven-kernel",
        "The woven kernel",
        (7.3, 5.5),
        draw_woven_kernel,
        recipe_of("zigzag", N, SEED),
    ),
    Plate(
        "convex-weave",
        "The weave in a convex polygon",
        (7.0, 8.5),
        draw_convex_weave,
        recipe_of("convex-weave", N, SEED),
    ),
    Plate("families", "The families of instances", (7.3, gallery_height()), draw_gallery),
    Plate("growth", "How the counts grow", (7.0, 4.6), draw_growth, (), GROWTH, growth_table),
    Plate(
        "constants",
        "The constant of the weave",
        (7.2, 3.6),
        draw_constants,
        (),
        WEAVE,
        constants_table,
    ),
    Plate(
        "collapse",
        "Noise unravels the weave",
        (7.0, 5.6),
        draw_collapse,
        (),
        SMOOTHED,
        collapse_table,
    ),
)

#: The plates by name, the paper's first.
PLATES = {plate.name: plate for plate in _ALL}
