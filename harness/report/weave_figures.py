"""Figures of the weaves: counts beside their prediction, and the collapse of noisy ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from harness.report.figures import STYLES
from harness.report.style import BLACK, GREY

#: Names of the shape parameters in figures.
SYMBOL = {"zigzag": "tilt τ (radians)", "convex-weave": "δ"}


def against_prediction(figure: Figure, table: pd.DataFrame, curves: pd.DataFrame) -> None:
    """Counted vertices and cells over n² (marks) on the exact prediction for each n (lines).

    ``table`` holds the generic rows of one family, ``curves`` the prediction on a fine grid of
    shapes: ``n``, ``shape``, ``vertices``, ``cells``.
    """
    for place, count in enumerate(("vertices", "cells")):
        axes = figure.add_axes((0.075 + 0.5 * place, 0.14, 0.41, 0.76))
        for index, (n, part) in enumerate(table.groupby("n", sort=True)):
            colour, marker, _ = STYLES[index % len(STYLES)]
            size = float(str(n))
            of_size = curves[curves["n"] == n].sort_values("shape")
            axes.plot(of_size["shape"], of_size[count] / size**2, color=colour, lw=0.8)
            axes.plot(
                part["shape"], part[count] / size**2, marker, color=colour, ms=3.6, label=f"n = {n}"
            )
        family = str(table["family"].iloc[0])
        _limit(axes, family, count, (float(curves["shape"].min()), float(curves["shape"].max())))
        axes.set_xlabel(SYMBOL[family])
        axes.set_title(f"{count} / n²")
        axes.set_ylim(bottom=0)
        axes.grid(True)
        axes.set_axisbelow(True)
        if not place:
            axes.legend(loc="best", handlelength=1.2, ncols=2)


def _limit(axes: Axes, family: str, count: str, span: tuple[float, float]) -> None:
    """The limit for n → ∞, dashed."""
    shape = np.linspace(*span, 60)
    part = 1.0 if count == "vertices" else 0.5
    limit = 0.5 - shape / np.pi if family == "zigzag" else np.full_like(shape, 0.5)
    axes.plot(shape, part * limit, "--", color=BLACK, lw=1.2, label="n → ∞", zorder=1)


def collapse(
    figure: Figure, points: pd.DataFrame, exponent: float, transition: Mapping[int, float]
) -> None:
    """Median share of the predicted vertices against the noise, and against noise · nᵃ.

    ``points``: ``n``, ``noise``, ``median``, ``lower`` and ``upper`` (quartiles).
    """
    for place, scaled in enumerate((False, True)):
        axes = figure.add_axes((0.075 + 0.5 * place, 0.155, 0.41, 0.745))
        for index, (n, part) in enumerate(points.groupby("n", sort=True)):
            colour, marker, _ = STYLES[index % len(STYLES)]
            factor = float(str(n)) ** exponent if scaled else 1.0
            x = part["noise"] * factor
            axes.fill_between(x, part["lower"], part["upper"], color=colour, alpha=0.15, lw=0)
            axes.plot(x, part["median"], marker=marker, color=colour, ms=3.6, label=f"n = {n}")
            if not scaled and n in transition:
                axes.plot([transition[int(str(n))]], [0.5], "|", color=colour, ms=16, mew=1.5)
        axes.axhline(0.5, color=GREY, lw=0.6, ls=":")
        axes.set_xscale("log")
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_ylim(0, 1.08)
        axes.grid(True)
        axes.set_axisbelow(True)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.0f} %"))
        axes.set_title("collapsed" if scaled else "vertices / prediction, median and quartiles")
        symbol = f"noise ε · n^{exponent:.2f}" if scaled else "relative noise ε"
        axes.set_xlabel(symbol)
        if not scaled:
            axes.legend(loc="lower left", handlelength=1.4)


def heat_map(
    figure: Figure,
    points: pd.DataFrame,
    exponents: Sequence[float],
    through: Mapping[int, float],
) -> None:
    """The median share over n and noise; lines of constant ε·nᵃ for some exponents a.

    ``through``: the transition, noise by n, in whose middle the lines meet.
    """
    axes = figure.add_axes((0.13, 0.14, 0.7, 0.76))
    shown = axes.scatter(
        points["n"],
        points["noise"],
        c=points["median"],
        cmap="cividis",
        vmin=0.0,
        vmax=1.0,
        marker="s",
        s=90,
    )
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    sizes = np.array(sorted(set(points["n"])), dtype=np.float64)
    axes.set_xticks(sizes, [f"{n:g}" for n in sizes])
    if through:
        centre = np.exp(np.log(list(through)).mean())
        middle = np.exp(np.log(list(through.values())).mean())
        for exponent, line in zip(exponents, ("-", "--", ":"), strict=False):
            scaled = middle * (sizes / centre) ** -exponent
            axes.plot(sizes, scaled, line, color=BLACK, lw=1.0, label=f"ε ~ n^−{exponent:.2g}")
        axes.legend(loc="lower left")
    axes.set_xlim(sizes[0] / 1.4, sizes[-1] * 1.4)
    axes.set_xlabel("segments n")
    axes.set_ylabel("relative noise ε")
    axes.set_title("share of the predicted vertices")
    bar = figure.colorbar(shown, cax=figure.add_axes((0.86, 0.14, 0.03, 0.76)))
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.0f} %"))
