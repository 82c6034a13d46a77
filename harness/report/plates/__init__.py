"""The plates: the paper's figures and the project's own, for print; see :mod:`.plate`."""

from __future__ import annotations

from functools import partial

from harness.analysis.weave_rows import SHAPES
from harness.report.plates.comparisons import (
    SMOOTHED,
    WEAVE,
    draw_collapse,
    draw_tips,
    draw_weaves,
    smoothed_table,
    weave_table,
)
from harness.report.plates.families import draw_gallery
from harness.report.plates.families import height as gallery_height
from harness.report.plates.meshes import draw_figure_5, draw_figure_6, draw_meshes
from harness.report.plates.paper import draw_figure_1, draw_figure_2, draw_figure_3, draw_figure_4
from harness.report.plates.parts import recipe_of
from harness.report.plates.peaks import draw_peaks, draw_star
from harness.report.plates.plate import Plate, printed
from harness.report.plates.studies import GROWTH, draw_growth, growth_table
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
    Plate("meshes", "A mesh and what becomes of it", (9.6, 2.6), draw_meshes),
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
    Plate("tips", "How the weave comes about", (8.6, 4.3), draw_tips),
    Plate("growth", "How the counts grow", (7.0, 4.6), draw_growth, (), GROWTH, growth_table),
    *(
        Plate(
            f"counts-{family}",
            f"Counts and prediction: {family}",
            (8.6, 3.6),
            partial(draw_weaves, family=family),
            (),
            WEAVE,
            partial(weave_table, family=family),
        )
        for family in SHAPES
    ),
    *(
        Plate(
            f"collapse-{family}",
            f"Noise unravels the weave: {family}",
            (8.6, 3.4),
            partial(draw_collapse, family=family),
            (),
            SMOOTHED,
            partial(smoothed_table, family=family),
        )
        for family in SHAPES
    ),
)

#: The plates by name, the paper's first.
PLATES = {plate.name: plate for plate in _ALL}
