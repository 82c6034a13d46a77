"""A plate of stored rows: how the counts grow; and where the rows of such plates come from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from harness.report.figures import STYLES
from harness.report.labels import number, plain, plural
from harness.report.plates.parts import INK, SOFT
from harness.study import load

#: Where the rows come from: the first of these studies that is there.
GROWTH = ("conjecture", "conjecture-small", "quick")


def first_of(results: Path, names: tuple[str, ...]) -> Path | None:
    """The directory of the first of these studies that has rows."""
    return next((results / name for name in names if (results / name / "rows.csv").exists()), None)


def kernel_rows(directory: Path) -> pd.DataFrame:
    """The rows of a study that have counts, in the kernel, for the smallest angle."""
    table = load(directory)
    counted = table[table["status"] == "ok"].astype({"segments": int, "vertices": int})
    return counted[(counted["domain"] == "kernel") & (counted["objective"] == "smallest")]


def rows_of(results: Path, names: tuple[str, ...]) -> tuple[Path, pd.DataFrame]:
    """The first of the studies and its rows in the kernel; a plate is drawn only if it is there."""
    directory = first_of(results, names)
    assert directory is not None, "a plate without its rows is not drawn"
    return directory, kernel_rows(directory)


def growth_table(results: Path) -> pd.DataFrame:
    """For each curve and size the greatest number of vertices: columns curve, n, vertices."""
    _, rows = rows_of(results, GROWTH)
    curves = rows[["family", "params"]].drop_duplicates()
    names = {
        (family, params): _curve_name(str(family), json.loads(params), variants)
        for family, of_family in curves.groupby("family")
        for variants in [[json.loads(params) for params in of_family["params"]]]
        for params in of_family["params"]
    }
    named = [names[key] for key in zip(rows["family"], rows["params"], strict=True)]
    grouped = rows.assign(curve=named, n=rows["segments"]).groupby(["curve", "n"], sort=True)
    return grouped["vertices"].max().reset_index()


def _curve_name(family: str, params: dict[str, Any], variants: list[dict[str, Any]]) -> str:
    """The family, and the parameters in which its curves differ."""
    differing = [k for k, v in params.items() if any(other.get(k) != v for other in variants)]
    return ", ".join([family, *(f"{k} {plain(params[k])}" for k in differing)])


def draw_growth(figure: Figure, results: Path) -> str:
    """The largest number of vertices of every family in the kernel, against n."""
    directory, rows = rows_of(results, GROWTH)
    table = growth_table(results)
    axes = figure.add_axes((0.1, 0.11, 0.62, 0.86))
    curves = {str(name): part[part["vertices"] > 0] for name, part in table.groupby("curve")}
    order = sorted(curves, key=lambda name: -int(curves[name]["vertices"].max()))
    for index, name in enumerate(order):
        curve = curves[name]
        colour, marker, line = STYLES[index % len(STYLES)]
        look: dict[str, Any] = {
            "marker": marker,
            "color": colour,
            "ms": 4,
            "lw": 1.2,
            "label": name,
        }
        axes.plot(curve["n"], curve["vertices"], line, **look)
    _guides(axes, table)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xlabel("edges n")
    axes.set_ylabel("Voronoi vertices in the kernel (maximum)")
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.grid(True)
    axes.set_axisbelow(True)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0)
    certified = int(rows["certified"].sum())
    return (
        "The largest number of Voronoi vertices in the kernel against the number of edges: "
        f"{plural(len(curves), 'curve')}, {len(rows)} polygons of up to "
        f"{number(float(rows['segments'].max()), 6)} edges, {certified} of the counts certified. "
        "Dotted: slopes of n and n². A certified count is a proof for its instance; a slope is "
        f"an observation. Rows: results/{directory.name}."
    )


def _guides(axes: Axes, table: pd.DataFrame) -> None:
    """Lines of slope one and two from a common point on the left."""
    n = np.array([table["n"].min(), table["n"].max()], dtype=float)
    lowest = max(1.0, float(table["vertices"].min()))
    for power, label in ((1, " n"), (2, " n²")):
        line = 0.6 * lowest * (n / n[0]) ** power
        axes.plot(n, line, ":", color=SOFT, lw=1.3, zorder=1)
        axes.annotate(label, (n[1], line[1]), ha="left", va="center", fontsize=9, color=INK)
