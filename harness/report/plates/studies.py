"""Plates of the rows that are stored: how the counts grow, and how noise unravels the weave."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from harness.report.figures import STYLES
from harness.report.labels import number, plain, plural
from harness.report.plates.parts import INK, SOFT
from harness.study import load

#: Where the rows come from: the first study of each list that is there.
GROWTH = ("conjecture", "conjecture-small", "quick")
SMOOTHED = ("smoothed", "smoothed-small")


def first_of(results: Path, names: tuple[str, ...]) -> Path:
    """The directory of the first of these studies that has rows; one of them has."""
    return next(results / name for name in names if (results / name / "rows.csv").exists())


def counted_rows(directory: Path) -> pd.DataFrame:
    """The rows of a study that have counts."""
    table = load(directory)
    return table[table["status"] == "ok"].astype({"segments": int, "vertices": int})


def draw_growth(figure: Figure, results: Path) -> str:
    """The largest number of vertices of every family in the kernel, against n."""
    directory = first_of(results, GROWTH)
    rows = counted_rows(directory)
    rows = rows[(rows["domain"] == "kernel") & (rows["objective"] == "smallest")]
    axes = figure.add_axes((0.1, 0.11, 0.62, 0.86))
    curves = dict(_curves(rows))
    order = sorted(curves, key=lambda name: -curves[name].iloc[-1])
    for index, name in enumerate(order):
        curve = curves[name]
        colour, marker, line = STYLES[index % len(STYLES)]
        axes.plot(curve.index, curve, line, marker=marker, color=colour, ms=4, lw=1.2, label=name)
    _guides(axes, rows)
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
        f"The largest number of Voronoi vertices in the kernel against the number of edges, for "
        f"{plural(len(curves), 'family', 'families')}: {len(rows)} polygons of up to "
        f"{number(float(rows['segments'].max()), 6)} edges, {certified} of the counts certified. "
        "Dotted: slopes of n and n². A certified count is a proof for its instance; a slope is "
        f"an observation. Rows: results/{directory.name}."
    )


def _curves(rows: pd.DataFrame) -> Iterator[tuple[str, pd.Series]]:
    """For each family (and parameters, where there are several) the maximum by size."""
    kinds = rows[["family", "params"]].drop_duplicates()["family"].tolist()
    for (family, params), part in rows.groupby(["family", "params"], sort=True):
        name = str(family)
        if kinds.count(name) > 1:
            name += " " + ", ".join(f"{k} {plain(v)}" for k, v in json.loads(str(params)).items())
        curve = part.groupby("segments")["vertices"].max()
        yield name, curve[curve > 0]


def _guides(axes: Axes, rows: pd.DataFrame) -> None:
    """Lines of slope one and two from a common point on the left."""
    n = np.array([rows["segments"].min(), rows["segments"].max()], dtype=float)
    lowest = max(1.0, float(rows["vertices"].min()))
    for power, label in ((1, " n"), (2, " n²")):
        line = 0.6 * lowest * (n / n[0]) ** power
        axes.plot(n, line, ":", color=SOFT, lw=1.3, zorder=1)
        axes.annotate(label, (n[1], line[1]), ha="left", va="center", fontsize=9, color=INK)


def draw_collapse(figure: Figure, results: Path) -> str:
    """Vertices of noisy weaves over n²: against the noise, and against the noise times n²."""
    directory = first_of(results, SMOOTHED)
    rows = counted_rows(directory)
    rows["sigma"] = [_sigma(*pair) for pair in zip(rows["params"], rows["n"], strict=True)]
    rows = rows[rows["sigma"] > 0]
    families = sorted(set(rows["family"]))
    grid = figure.subplots(len(families), 2, sharey="row", squeeze=False)
    for family, (left, right) in zip(families, grid, strict=True):
        part = rows[rows["family"] == family]
        for index, (n, of_size) in enumerate(part.groupby("segments", sort=True)):
            medians = of_size.groupby("sigma")["vertices"].median() / float(str(n)) ** 2
            colour, marker, line = STYLES[index % len(STYLES)]
            for axes, scale in ((left, 1.0), (right, float(str(n)) ** 2)):
                axes.plot(
                    medians.index * scale,
                    medians,
                    line,
                    marker=marker,
                    color=colour,
                    ms=3.5,
                    lw=1.1,
                    label=f"n = {n}",
                )
        left.set_title(family)
        left.set_ylabel("vertices / n² (median)")
        for axes in (left, right):
            axes.set_xscale("log")
            axes.grid(True)
            axes.set_axisbelow(True)
        right.legend(fontsize=7)
    grid[-1][0].set_xlabel("relative noise σ")
    grid[-1][1].set_xlabel("σ n²")
    figure.tight_layout()
    return (
        "Noise unravels the weave. Left: vertices over n² of the weaves whose vertices were moved "
        "by a relative noise of σ, in the median; right: the same against σ n². "
        f"{len(rows)} polygons, {int(rows['certified'].sum())} of the counts certified. Rows: "
        f"results/{directory.name}."
    )


def _sigma(params: str, n: int) -> float:
    """The relative noise of a weave."""
    given = json.loads(params)
    noise, power = float(given.get("noise", 0.0)), float(given.get("noise_power", 0))
    return noise / math.pow(n, power)
