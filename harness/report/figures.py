"""The figures of the report, drawn from the tables of ``tables.py`` and from nothing else."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.markers import CARETUPBASE
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from harness.analysis import MODELS
from harness.report.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE,
    PURPLE,
    SKY,
    VERMILLION,
)

SHOWN = {"maximum": (BLUE, "o", "-"), "median": (VERMILLION, "s", "--")}
#: More single counts than this are not drawn one by one.
DOTS = 3000


def growth(
    figure: Figure, curves: pd.DataFrame, trials: pd.DataFrame, rows: pd.DataFrame, declared: str
) -> None:
    """One count of one group: its curves above, the models' misses below.

    ``curves``, ``trials`` and ``rows`` are the tables of the group, cut down to the count;
    ``declared`` is the symbol of the declared model or empty.
    """
    # Fixed margins, not a layout engine: faster, and the frames of all panels line up.
    upper = figure.add_axes((0.13, 0.465, 0.82, 0.495))
    lower = figure.add_axes((0.13, 0.115, 0.82, 0.235))
    shown = _shown(curves)
    _complexity(upper, curves, rows, declared, shown)
    _misses(lower, trials, shown)


def _shown(curves: pd.DataFrame) -> dict[str, str]:
    """The statistics to draw and their labels: one is enough where they do not differ."""
    maximum, median = (
        curves[curves["statistic"] == statistic]["value"].tolist() for statistic in SHOWN
    )
    if maximum == median:
        return {"maximum": "maximum = median"}
    return {statistic: statistic for statistic in SHOWN}


def _complexity(
    axes: Axes, curves: pd.DataFrame, rows: pd.DataFrame, declared: str, shown: dict[str, str]
) -> None:
    count = str(curves["count"].iloc[0])
    maximum = curves[curves["statistic"] == "maximum"]
    challenged = maximum["n"][~maximum["fitted"].astype(bool)]
    if len(challenged) < len(maximum):
        edge = np.sqrt(challenged.min() * maximum["n"][maximum["fitted"].astype(bool)].max())
        axes.axvspan(edge, maximum["n"].max() * 1.12, color=PALE, zorder=0)
        axes.annotate(
            "shaded: challenge",
            (1.0, 1.015),
            xycoords="axes fraction",
            ha="right",
            va="bottom",
            color=GREY,
            fontsize=8,
        )
    dots = rows[["n", count]].drop_duplicates()
    if len(dots) <= DOTS:
        axes.plot(dots["n"], dots[count], ".", color=GREY, alpha=0.5, ms=3, zorder=1)
    for statistic, label in shown.items():
        colour, marker, line = SHOWN[statistic]
        part = curves[curves["statistic"] == statistic]
        if part["lower"].notna().any():
            axes.fill_between(
                part["n"], part["lower"], part["upper"], color=colour, alpha=0.16, lw=0, zorder=2
            )
        face = colour if statistic == "maximum" else "white"
        axes.plot(
            part["n"],
            part["value"],
            line,
            marker=marker,
            mfc=face,
            color=colour,
            label=label,
            zorder=4,
        )
        above = part[part["at_most"] > part["value"]]
        if len(above):
            axes.plot(
                above["n"],
                above["value"],
                marker=CARETUPBASE,
                color=colour,
                ms=8,
                ls="none",
                label=f"{label}: lower bound",
                zorder=5,
            )
    if declared and maximum["declared"].notna().all():
        axes.plot(
            maximum["n"],
            maximum["declared"],
            ":",
            color=BLACK,
            lw=1.6,
            label=f"declared: {declared}",
            zorder=6,
        )
    _log_axes(axes, curves, rows[count])
    axes.set_title(count)
    axes.legend(loc="upper left", handlelength=2.2, borderaxespad=0.2)


def _log_axes(axes: Axes, curves: pd.DataFrame, counts: pd.Series) -> None:
    """Logarithmic axes; a count of zero sits on a linear stretch below one."""
    axes.set_xscale("log")
    _size_ticks(axes, sorted(set(curves["n"])))
    lowest = float(min(counts.min(), curves["value"].min()))
    if lowest < 1:
        axes.set_yscale("symlog", linthresh=1.0, linscale=0.4)
        axes.set_ylim(bottom=-0.15)
    else:
        axes.set_yscale("log")
    highest = float(max(counts.max(), curves["value"].max(), 2.0))
    bottom = max(lowest, 0.0)
    if bottom >= 1:
        axes.set_ylim(bottom / 1.25, max(highest, bottom * 4) * 1.6)
    else:
        axes.set_ylim(top=highest * 1.8)
    axes.yaxis.set_major_locator(FixedLocator(_count_ticks(bottom, max(highest, bottom * 4))))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.grid(True)
    axes.set_axisbelow(True)
    axes.set_xlabel("segments n")


def _count_ticks(low: float, high: float) -> list[float]:
    steps = (1, 2, 5) if high / max(low, 1) < 300 else (1,)
    ticks = [float(step * 10**power) for power in range(10) for step in steps]
    return [0.0] * (low < 1) + [tick for tick in ticks if low / 1.25 <= tick <= high * 1.6]


def _size_ticks(axes: Axes, sizes: list[float]) -> None:
    """Ticks at the study's own sizes, thinned until their labels fit."""
    gap = np.log(sizes[-1] / sizes[0]) / 9 if len(sizes) > 1 else 0.0
    chosen = [sizes[-1]]
    for size in reversed(sizes[:-1]):
        if np.log(chosen[-1] / size) >= gap:
            chosen.append(size)
    axes.xaxis.set_major_locator(FixedLocator(chosen[::-1]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlim(sizes[0] / 1.12, sizes[-1] * 1.12)


def _misses(axes: Axes, trials: pd.DataFrame, shown: dict[str, str]) -> None:
    """For every model: how far the larger sizes lie from its prediction, with the interval."""
    axes.axvline(0, color=BLACK, lw=0.8)
    axes.set_title("larger sizes against each model's prediction")
    axes.set_ylim(len(MODELS) - 0.4, -0.6)
    axes.set_yticks(range(len(MODELS)), [model.symbol for model in MODELS])
    axes.set_xlim(-1.04, 1.04)
    axes.set_xticks([-1, -0.5, 0, 0.5, 1], ["−100 %", "−50 %", "0", "+50 %", "+100 %"])
    axes.grid(True, axis="x")
    axes.set_axisbelow(True)
    for text, place, side in (
        ("← model too fast", 0.0, "left"),
        ("model too slow →", 1.0, "right"),
    ):
        axes.annotate(text, (place, -0.27), xycoords="axes fraction", ha=side, va="top", color=GREY)
    if trials.empty:
        axes.annotate(
            "too few sizes", (0.5, 0.5), xycoords="axes fraction", ha="center", color=GREY
        )
        return
    offsets = (-0.17, 0.17) if len(shown) > 1 else (0.0,)
    for offset, statistic in zip(offsets, shown, strict=True):
        colour, marker, _ = SHOWN[statistic]
        part = trials[trials["statistic"] == statistic].drop_duplicates("model")
        for rank, model in enumerate(MODELS):
            row = part[part["model"] == model.name].iloc[0]
            height = rank + offset
            axes.plot([row["miss_low"], row["miss_high"]], [height, height], "-", color=colour)
            kept = row["finding"] in ("kept", "withheld", "fragile")
            axes.plot(
                [row["miss"]],
                [height],
                marker if kept else "x",
                color=colour,
                mfc=colour if statistic == "maximum" else "white",
            )


COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY)
MARKERS = ("o", "s", "^", "D", "v")
LINES = ("-", "--", "-.", ":")
#: Distinct pairs of colour and marker: no curve is known by its colour alone.
STYLES = [
    (COLOURS[index % 8], MARKERS[index % 5], LINES[index // 40]) for index in range(8 * 5 * 4)
]


#: More curves than this are told apart by family only; the table below the figure names each.
NAMED = 16


def _names(labels: Iterable[str]) -> dict[str, str]:
    """What the legend calls each curve: its label, or its family where there are very many."""
    names = {label: label for label in labels}
    if len(names) <= NAMED:
        return names
    curves = Counter(map(_family, names))
    return {
        label: f"{family}: {curves[family]} curves, named in the table"
        if curves[family := _family(label)] > 1
        else label
        for label in names
    }


def _family(label: str) -> str:
    return label.split(",")[0]


def overview_height(labels: Iterable[str]) -> float:
    """Inches: the axes, and the lines of the legend."""
    return 3.3 + 0.17 * len(set(_names(labels).values()))


def overview(figure: Figure, table: pd.DataFrame) -> None:
    """Vertices per segment against n, for one domain: linear growth is a level line."""
    height = figure.get_size_inches()[1]
    bottom = (height - 2.75) / height
    axes = figure.add_axes((0.135, bottom, 0.845, 2.55 / height))
    positive = table[table["per_n"] > 0]
    axes.set_xscale("log")
    axes.set_yscale("log")
    names = _names(table["curve"])
    entries = sorted(set(names.values()))
    shown: dict[str, Line2D] = {}
    for label, curve in positive.groupby("curve", sort=True):
        name = names[str(label)]
        colour, marker, line = STYLES[entries.index(name) % len(STYLES)]
        (drawn,) = axes.plot(curve["n"], curve["per_n"], line, marker=marker, color=colour, ms=4)
        shown.setdefault(name, drawn)
    _size_ticks(axes, sorted(set(table["n"])))
    if len(positive):
        low, high = positive["per_n"].min(), positive["per_n"].max()
        axes.set_ylim(low / 1.4, high * 1.4)
        axes.yaxis.set_major_locator(FixedLocator(_ratio_ticks(low / 1.4, high * 1.4)))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.grid(True)
    axes.set_axisbelow(True)
    axes.set_xlabel("segments n")
    axes.set_ylabel("maximum vertices / n")
    if shown:
        top = -0.42 / 2.55
        axes.legend(
            list(shown.values()),
            list(shown),
            loc="upper left",
            bbox_to_anchor=(0, top),
            handlelength=2.6,
            borderaxespad=0,
        )


def _ratio_ticks(low: float, high: float) -> list[float]:
    ticks = [step * 10.0**power for power in range(-6, 7) for step in (1, 2, 5)]
    return [tick for tick in ticks if low <= tick <= high]
