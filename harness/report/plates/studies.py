"""Plates of the rows that are stored: growth, the constant of the weave, and what noise does."""

from __future__ import annotations

import json
import math
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

#: Where the rows come from: the first study of each list that is there.
GROWTH = ("conjecture", "conjecture-small", "quick")
WEAVE = ("weave", "weave-small", *GROWTH)
SMOOTHED = ("smoothed", "smoothed-small")

WEAVES = ("zigzag", "convex-weave")
#: A weave counts as unperturbed if its noise is at most this, relative to n⁻³.
STILL = 1e-2
HALF = 0.5  # vertices/n² of a convex weave, in the limit: its tilt vanishes like 1/n


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


# --- growth --------------------------------------------------------------------------------------


def growth_table(results: Path) -> pd.DataFrame:
    """For each curve and size the greatest number of vertices: columns curve, n, vertices."""
    _, rows = rows_of(results, GROWTH)
    kinds = rows[["family", "params"]].drop_duplicates()["family"].tolist()
    names = [
        _curve_name(str(family), str(params), kinds.count(family) > 1)
        for family, params in zip(rows["family"], rows["params"], strict=True)
    ]
    grouped = rows.assign(curve=names, n=rows["segments"]).groupby(["curve", "n"], sort=True)
    return grouped["vertices"].max().reset_index()


def _curve_name(family: str, params: str, is_one_of_several: bool) -> str:
    if not is_one_of_several:
        return family
    return f"{family} {', '.join(f'{k} {plain(v)}' for k, v in json.loads(params).items())}"


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


# --- the constant of the weave -------------------------------------------------------------------


def constants_table(results: Path) -> pd.DataFrame:
    """The unperturbed weaves: columns family, parameter, n, polygons, certified, least, greatest
    (vertices), ratio (the greatest over n²), limit (what the derivation gives for n → ∞).
    """
    _, rows = rows_of(results, WEAVE)
    rows = rows[rows["family"].isin(WEAVES)]
    sigma = [
        _sigma(str(p), n) * n**3 for p, n in zip(rows["params"], rows["segments"], strict=True)
    ]
    rows = rows[[value <= STILL for value in sigma]]
    shapes = [_shape(str(f), str(p)) for f, p in zip(rows["family"], rows["params"], strict=True)]
    rows = rows.assign(parameter=[name for name, _ in shapes], limit=[limit for _, limit in shapes])
    grouped = rows.groupby(["family", "parameter", "segments"], sort=True)
    table = grouped.agg(
        polygons=("vertices", "size"),
        certified=("certified", "sum"),
        least=("vertices", "min"),
        greatest=("vertices", "max"),
        limit=("limit", "first"),
    ).reset_index(names=["family", "parameter", "n"])
    return table.assign(ratio=table["greatest"] / table["n"] ** 2)


def _shape(family: str, params: str) -> tuple[str, float]:
    """The parameter that decides a weave's constant, in words, and the constant's limit."""
    given = json.loads(params)
    if family == "zigzag":
        tilt = float(given.get("tilt", math.pi / 6))
        return f"τ = {tilt:.3f}", (1 - 2 * tilt / math.pi) / 2
    return f"δ = {float(given.get('delta', 0.5)):.3f}", HALF


def draw_constants(figure: Figure, results: Path) -> str:
    """Vertices over n² of the weaves, against what the derivation gives."""
    directory, _ = rows_of(results, WEAVE)
    table = constants_table(results)
    for k, family in enumerate(WEAVES):
        axes = figure.add_axes((0.09 + 0.47 * k, 0.14, 0.41, 0.75))
        part = table[table["family"] == family]
        for index, (name, curve) in enumerate(part.groupby("parameter", sort=True)):
            colour, marker, _ = STYLES[index % len(STYLES)]
            axes.axhline(float(curve["limit"].iloc[0]), color=colour, lw=0.8, ls=":")
            axes.plot(
                curve["n"], curve["ratio"], "-", marker=marker, color=colour, label=str(name), ms=4
            )
        axes.set_xscale("log", base=2)
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.set_ylim(bottom=0)
        axes.set_xlabel("edges n")
        axes.set_title(family)
        axes.grid(True)
        axes.set_axisbelow(True)
        if len(part):
            axes.legend(fontsize=7, ncols=2, loc="lower right")
    figure.axes[0].set_ylabel("vertices / n²")
    return (
        "Vertices over n² in the kernels of the unperturbed weaves (points), and the limits of the "
        "derivation (dotted): (1 − 2τ/π)/2 for a zigzag star of tilt τ, 1/2 for a convex weave. "
        f"{int(table['polygons'].sum())} polygons, {int(table['certified'].sum())} of the counts "
        f"certified. Rows: results/{directory.name}."
    )


# --- noise ---------------------------------------------------------------------------------------


def collapse_table(results: Path) -> pd.DataFrame:
    """The weaves with noise: columns family, n, sigma, polygons, certified, median, ratio."""
    _, rows = rows_of(results, SMOOTHED)
    sigma = [_sigma(str(p), n) for p, n in zip(rows["params"], rows["segments"], strict=True)]
    rows = rows.assign(sigma=sigma, n=rows["segments"])
    grouped = rows[rows["sigma"] > 0].groupby(["family", "n", "sigma"], sort=True)
    table = grouped.agg(
        polygons=("vertices", "size"),
        certified=("certified", "sum"),
        median=("vertices", "median"),
    ).reset_index()
    return table.assign(ratio=table["median"] / table["n"] ** 2)


def draw_collapse(figure: Figure, results: Path) -> str:
    """Vertices of noisy weaves over n²: against the noise, and against the noise times n²."""
    directory, _ = rows_of(results, SMOOTHED)
    table = collapse_table(results)
    families = sorted(set(table["family"]))
    grid = figure.subplots(len(families), 2, sharey="row", squeeze=False)
    for family, (left, right) in zip(families, grid, strict=True):
        part = table[table["family"] == family]
        for index, n in enumerate(sorted(set(part["n"]))):
            curve = part[part["n"] == n]
            colour, marker, line = STYLES[index % len(STYLES)]
            for axes, scale in ((left, 1), (right, n**2)):
                look: dict[str, Any] = {"marker": marker, "color": colour, "ms": 3.5, "lw": 1.1}
                axes.plot(curve["sigma"] * scale, curve["ratio"], line, label=f"n = {n}", **look)
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
        "Noise unravels the weave. Left: vertices over n² of weaves whose vertices were moved "
        "by a relative noise of σ, in the median; right: the same against σ n². "
        f"{int(table['polygons'].sum())} polygons, {int(table['certified'].sum())} of the counts "
        f"certified. Rows: results/{directory.name}."
    )


def _sigma(params: str, n: int) -> float:
    """The relative noise of a weave."""
    given = json.loads(params)
    noise, power = float(given.get("noise", 0.0)), float(given.get("noise_power", 0))
    return noise / math.pow(n, power)
