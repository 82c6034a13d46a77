"""Plates of weaves beside their prediction, and of what noise leaves of them."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from harness.analysis.weave_rows import compare
from harness.report import tables, weave_figures
from harness.report.labels import bracket, number
from harness.report.plates.studies import rows_of
from harness.report.smoothed import collapses, points_of
from harness.report.weave_picture import ideal, weave_picture
from harness.report.weaves import predicted

WEAVE = ("weave", "weave-small")
SMOOTHED = ("smoothed", "smoothed-small")


def draw_tips(figure: Figure, _: Path) -> str:
    """The ideal weave, in its kernel and unrolled."""
    weave_picture(figure)
    weave = ideal().weave
    return (
        f"How the weave comes about. Left: the kernel of the zigzag star with n = {weave.n} edges "
        "and its ideal diagram (black); the two families of edges and the paths of their tips, "
        "where the level circles come nearest to the centre, are blue and vermillion. Right: the "
        "same unrolled, with the turn of the tips upwards and the direction to the right. Tips of "
        f"the two families pass each other {weave.passings} times in the open kernel."
    )


def weave_table(results: Path, family: str) -> pd.DataFrame:
    """The noisy weaves of a family beside their predictions; see ``weave_rows.compare``."""
    _, rows = rows_of(results, WEAVE)
    table = compare(rows[rows["family"] == family])
    return table[table["noise"] > 0].reset_index(drop=True)


def draw_weaves(figure: Figure, results: Path, family: str) -> str:
    """Vertices and cells over n², counted and predicted."""
    table = weave_table(results, family)
    directory, _ = rows_of(results, WEAVE)
    weave_figures.against_prediction(figure, table, predicted(family, table))
    exact = int((table["finding"] == "as predicted").sum())
    return (
        f"Vertices and cells of {family} over n²: certified counts (marks), their exact prediction "
        "for each n (lines) and its limit (dashed). Of "
        f"{len(table)} weaves {exact} have exactly the predicted vertices, edges, cells and "
        f"degrees. Rows: results/{directory.name}."
    )


def smoothed_table(results: Path, family: str) -> pd.DataFrame:
    """Median and quartiles of the share of vertices left, at every n and noise."""
    _, rows = rows_of(results, SMOOTHED)
    return points_of(compare(rows[rows["family"] == family]))


def draw_collapse(figure: Figure, results: Path, family: str) -> str:
    """The share that noise leaves, over the noise, and over the noise scaled by a power of n."""
    directory, rows = rows_of(results, SMOOTHED)
    compared = tables.from_csv(tables.to_csv(compare(rows[rows["family"] == family])))
    found = next((collapse for *_, collapse in collapses(compared)), None)
    exponent = found.exponent if found else None
    transition = {n: estimate.value for n, estimate in found.transition} if found else {}
    power = exponent.value if exponent else 0.0
    weave_figures.collapse(figure, points_of(compared), power, transition)
    scaled = ""
    if exponent:
        interval = bracket(exponent.low, exponent.high)
        scaled = f"; right, over ε·nᵃ with a = {number(power)} {interval}, they become one"
    return (
        f"Noise unravels the weave ({family}). Left: the share of the predicted vertices that is "
        "left, median and quartiles, when every vertex of the polygon is moved by a relative noise "
        f"of at most ε{scaled}. {len(compared)} polygons. Rows: results/{directory.name}."
    )
