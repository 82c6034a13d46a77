"""One group of the study as the page shows it: figures, verdicts, tables, and their data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from urllib.parse import quote

import numpy as np
import pandas as pd

from harness.analysis import HEADLINES, MODELS, STATISTICS, GroupGrowth, Growth, Statistic
from harness.report import figures, tables
from harness.report.labels import bracket, number, parameters, plural, signed_percent, sizes
from harness.report.style import inline, render

#: A table is embedded in the page unless it is larger than this (bytes): then it is only linked.
EMBEDDED = 200_000


@dataclass(frozen=True)
class Download:
    """A table behind a figure: a file beside the page, and a copy inside it if small enough."""

    title: str
    path: str
    text: str

    @property
    def name(self) -> str:
        """The file's name without its directory."""
        return self.path.rpartition("/")[2]

    @property
    def uri(self) -> str:
        """The table as a data URI; empty if it is too large to be embedded."""
        if len(self.text) > EMBEDDED:
            return ""
        return "data:text/csv;charset=utf-8," + quote(self.text, safe=",.:;_+-")


@dataclass(frozen=True)
class Cell:
    """A table cell: what it shows, and the number by which its column is sorted."""

    text: str
    key: str = ""
    kind: str = ""


@dataclass(frozen=True)
class Table:
    """A table of the page."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]


@dataclass(frozen=True)
class Reading:
    """What is said about one statistic under its figure."""

    title: str
    label: str
    claim: str
    sentence: str
    exponent: str


@dataclass(frozen=True)
class Panel:
    """One headline count of a group."""

    headline: str
    svg: str
    figure_path: str
    document: str
    readings: Sequence[Reading]
    tables: Sequence[Table]


@dataclass(frozen=True)
class Section:
    """One group."""

    slug: str
    label: str
    domain: str
    parameters: str
    facts: Sequence[tuple[str, str]]
    panels: Sequence[Panel]
    downloads: Sequence[Download]
    notes: Sequence[str]
    warnings: Sequence[str]


def section(analysed: GroupGrowth, label: str) -> Section:
    """Everything about one group; figures are drawn from the very text that is stored."""
    slug = analysed.group.key.slug
    downloads = [
        Download("rows", f"data/{slug}-rows.csv", tables.to_csv(tables.raw_rows(analysed.group))),
        Download("curves", f"data/{slug}-curves.csv", tables.to_csv(tables.curves(analysed))),
        Download("models", f"data/{slug}-models.csv", tables.to_csv(tables.trials(analysed))),
    ]
    rows, curves, trials = (tables.from_csv(download.text) for download in downloads)
    panels = []
    if analysed.group.seen:
        panels = [_panel(analysed, label, headline, rows, curves, trials) for headline in HEADLINES]
    return Section(
        slug,
        label,
        analysed.group.key.domain,
        parameters(analysed.group.key),
        list(_facts(analysed)),
        panels,
        downloads,
        list(_notes(analysed)),
        list(_warnings(analysed)),
    )


def _panel(
    analysed: GroupGrowth,
    label: str,
    headline: str,
    rows: pd.DataFrame,
    curves: pd.DataFrame,
    trials: pd.DataFrame,
) -> Panel:
    slug = f"{analysed.group.key.slug}-{headline}"
    declared = ""
    if analysed.declared is not None and headline == "vertices":
        declared = analysed.declared.model.symbol
    of_count = curves[curves["count"] == headline]
    of_trials = trials[trials["count"] == headline]
    counted = rows[rows["status"] == "ok"]
    document = render(
        lambda figure: figures.growth(figure, of_count, of_trials, counted, declared), 4.3, 5.3
    )
    shown = _distinct(analysed, headline)
    maximum = analysed.curves[headline, "maximum"].verdict
    description = f"Number of {headline} of {label} against n. Maximum: {maximum.sentence}"
    return Panel(
        headline,
        inline(document, slug, description),
        f"figures/{slug}.svg",
        document,
        [
            _reading(analysed.curves[headline, statistic], title)
            for statistic, title in shown.items()
        ],
        [
            table(part, statistic, title)
            for table, part in ((_curve_table, of_count), (_trial_table, of_trials))
            for statistic, title in shown.items()
        ],
    )


def _distinct(analysed: GroupGrowth, headline: str) -> dict[Statistic, str]:
    """The statistics to show and their titles: a single one where all of them are the same."""
    curves = [analysed.curves[headline, statistic] for statistic in STATISTICS]
    if all(curve.observed.tolist() == curves[0].observed.tolist() for curve in curves):
        return {STATISTICS[0]: "every statistic"}
    return {statistic: statistic for statistic in STATISTICS}


def _reading(curve: Growth, title: str) -> Reading:
    power = curve.power
    interval = bracket(power.low, power.high)
    text = f"exponent {number(power.exponent)} {interval}".strip()
    text += _why_another(curve)
    if power.reason:
        text += f" ({power.reason})"
    return Reading(
        title,
        curve.verdict.label,
        curve.verdict.linear_claim,
        curve.verdict.sentence,
        text,
    )


def _why_another(curve: Growth) -> str:
    """Why a pure power has another exponent than the one model that survived, if it has."""
    known = {"1": 0.0, "n": 1.0, "n^2": 2.0}
    kept, exponent = curve.verdict.kept, curve.power.exponent
    if len(kept) != 1 or kept[0].name not in known or exponent is None:
        return ""
    power = known[kept[0].name]
    if abs(exponent - power) < 0.05:
        return ""
    return (
        f", not {power:g}: a pure power has no lower-order term, "
        f"and that of {kept[0].symbol} still counts at these sizes"
    )


def _curve_table(curves: pd.DataFrame, statistic: str, title: str) -> Table:
    part = curves[curves["statistic"] == statistic]
    head = ["n", "counted", "value", "95 %", "slope"]
    head += [f"÷ {model.symbol}" for model in MODELS]
    body = []
    for row in part.to_dict("records"):
        open_end = row["at_most"] > row["value"]
        tasks, counted = int(row["tasks"]), int(row["counted"])
        missing = counted < tasks
        body.append(
            [
                cell(row["n"]),
                Cell(
                    f"{counted}/{tasks}" if missing else f"{counted}",
                    f"{counted}",
                    "warn" if missing else "",
                ),
                cell(row["value"], "≥ " if open_end else "", "warn" if open_end else ""),
                Cell(bracket(row["lower"], row["upper"]), f"{row['lower']:.9g}"),
                cell(row["slope"]),
                *(cell(row[tables.RATIO[model.name]]) for model in MODELS),
            ]
        )
    return Table(f"{title}: value at each size, and its ratio to each model", head, body)


def _trial_table(trials: pd.DataFrame, statistic: str, title: str) -> Table:
    part = trials[trials["statistic"] == statistic]
    challenged = sorted(set(part["n"]))
    head = ["model", "finding", "miss", "99 %"]
    head += [f"n = {n:g}: predicted" for n in challenged]
    body = []
    for rank, model in enumerate(MODELS):
        of_model = part[part["model"] == model.name]
        if of_model.empty:
            continue
        first = of_model.iloc[0]
        body.append(
            [
                Cell(model.symbol, str(rank)),
                Cell(str(first["finding"]), str(first["finding"]), _kind(str(first["finding"]))),
                Cell(signed_percent(first["miss"]), f"{first['miss']:.9g}"),
                Cell(
                    f"[{signed_percent(first['miss_low'])}, {signed_percent(first['miss_high'])}]",
                    f"{first['miss_low']:.9g}",
                ),
                *(
                    Cell(
                        f"{number(row['predicted'])} "
                        f"{bracket(row['predicted_low'], row['predicted_high'])}",
                        f"{row['predicted']:.9g}",
                    )
                    for row in of_model.to_dict("records")
                ),
            ]
        )
    return Table(f"{title}: models fitted on the smaller sizes, challenged", head, body)


def _kind(finding: str) -> str:
    return {"kept": "good", "withheld": "warn", "fragile": "warn"}.get(finding, "bad")


def cell(value: float, before: str = "", kind: str = "") -> Cell:
    """A number as a table cell."""
    missing = value is None or np.isnan(value)
    return Cell(before + number(value), "" if missing else f"{value:.9g}", kind)


def _facts(analysed: GroupGrowth) -> Iterator[tuple[str, str]]:
    group, key = analysed.group, analysed.group.key
    yield "domain", key.domain
    yield "objective", f"{key.objective} visual angle"
    yield "builder", key.builder
    yield "sizes n", sizes([size.measure for size in group.seen])
    replicates = sorted({len(size.rows) for size in group.sizes})
    yield "replicates", " … ".join(str(count) for count in {replicates[0]: 0, replicates[-1]: 0})
    if analysed.declared is not None:
        yield "declared growth", f"vertices ~ {analysed.declared.model.symbol}"


def _warnings(analysed: GroupGrowth) -> Iterator[str]:
    """What a reader must know before believing the figures."""
    group = analysed.group
    unseen = sum(size.unseen for size in group.sizes)
    if unseen:
        yield (
            f"{plural(unseen, 'task')} did not reach a count (time, memory or error): at such a "
            "size the maximum is a lower bound (marked ≥), and rejections that could rest on it "
            "are withheld."
        )
    empty = [f"{size.n}" for size in group.sizes if not len(size.counted)]
    if empty:
        yield f"No task was counted at n = {', '.join(empty)}: left out of every curve."
    refused = sum(size.failures.get("invalid", 0) for size in group.sizes)
    if refused:
        yield f"Refused as invalid, so without a diagram: {plural(refused, 'instance')}."
    uncertified = sum(size.uncertified for size in group.sizes)
    if uncertified:
        yield f"Not certified: {plural(uncertified, 'count')}."


def _notes(analysed: GroupGrowth) -> Iterator[str]:
    """What helps to read the figures."""
    if analysed.noise_free:
        single = all(len(size.counted) <= 1 for size in analysed.group.seen)
        why = "There is one count per size" if single else "All replicates agree"
        yield (
            f"{why}: there is nothing to bootstrap, and the intervals come from the scatter "
            "around the best model alone."
        )
    if analysed.declared is not None and not analysed.declared.defaults:
        changed = ", ".join(analysed.declared.changed)
        yield (
            f"The declared growth is for the family's default parameters; {changed} differ here, "
            "so this is no control."
        )
    if any(size.measure != size.n for size in analysed.group.seen):
        yield "The number of segments differs from the requested n; n is the number of segments."
