"""The part of a report on weaves: counts against the exact prediction, and noise that scales."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from harness.analysis import GroupGrowth
from harness.analysis.smoothed import HYPOTHESES, Collapse, Estimate, collapse, curves, seed_of
from harness.analysis.weave import predict
from harness.analysis.weave_noise import SAFE
from harness.analysis.weave_rows import FINDINGS, SHAPES, compare
from harness.report import tables, weave_figures
from harness.report.labels import bracket, number, plural
from harness.report.sections import Cell, Download, Table, cell
from harness.report.style import inline, render
from harness.report.weave_picture import ideal, weave_picture

#: A study is about weaves if it has so many shapes of one family …
LEAST_SHAPES = 3
#: … and about noise if it has so many noises at each of two sizes.
LEAST_NOISES = 4


@dataclass(frozen=True)
class Figure:
    """A drawing in the page and beside it."""

    path: str
    document: str
    description: str

    @property
    def svg(self) -> str:
        """The drawing as an element of the page."""
        name = self.path.rpartition("/")[2].removesuffix(".svg")
        return inline(self.document, name, self.description)


@dataclass(frozen=True)
class Part:
    """A section of the page of its own: a template, what it shows, and the files beside it."""

    slug: str
    title: str
    template: str
    shown: Mapping[str, Any]
    figures: Sequence[Figure] = ()
    downloads: Sequence[Download] = field(default_factory=tuple)

    @property
    def files(self) -> dict[str, str]:
        """Path and text of everything beside the page."""
        found = {figure.path: figure.document for figure in self.figures}
        found.update({download.path: download.text for download in self.downloads})
        return found


def parts(groups: Sequence[GroupGrowth]) -> list[Part]:
    """The sections on weaves that a study's rows give rise to; none for most studies."""
    rows = [analysed.group.rows for analysed in groups if analysed.group.key.family in SHAPES]
    if not rows:
        return []
    compared = compare(pd.concat(rows))
    download = Download("weaves", "data/weaves.csv", tables.to_csv(compared))
    table = tables.from_csv(download.text)
    found = []
    if not table.empty and (table.groupby("family")["shape"].nunique() >= LEAST_SHAPES).any():
        found.append(_prediction(table, download))
    noisy = list(collapses(table))
    if noisy:
        found.append(_smoothed(noisy, download))
    return found


# --- counts against the prediction ----------------------------------------------------------------


def _prediction(table: pd.DataFrame, download: Download) -> Part:
    generic = table[table["noise"] > 0]
    figures = [
        Figure(
            f"figures/weave-{family}.svg",
            render(
                partial(
                    weave_figures.against_prediction, table=part, curves=predicted(family, part)
                ),
                8.6,
                3.6,
            ),
            f"Vertices and cells of {family} over n², beside their exact prediction",
        )
        for family, part in generic.groupby("family", sort=True)
    ]
    picture = Figure(
        "figures/weave-ideal.svg",
        render(weave_picture, 8.6, 4.3),
        "The ideal kernel of a zigzag star, and the same diagram unrolled",
    )
    shape = ideal().weave
    return Part(
        "weave",
        "The weave against its prediction",
        "weave.html",
        {
            "summary": _summary(table),
            "unexplained": int((table["finding"] == "unexplained").sum()),
            "findings": _findings_table(table),
            "largest": _largest_table(generic),
            "deviations": _deviation_table(table),
            "figures": figures,
            "picture": picture,
            "ideal": shape,
            "download": download,
            "safe": number(SAFE),
        },
        [*figures, picture],
        [download],
    )


def predicted(family: object, part: pd.DataFrame) -> pd.DataFrame:
    """The prediction on a fine grid of shapes, for the sizes that were counted."""
    name = str(family)
    low, high = float(part["shape"].min()), float(part["shape"].max())
    records = []
    for n in sorted(set(part["n"])):
        for shape in np.linspace(low, high, 200):
            weave = predict(n // 2, 1.0, SHAPES[name][1](int(n), float(shape)))
            records.append(
                {"n": n, "shape": shape, "vertices": weave.vertices, "cells": weave.cells}
            )
    return pd.DataFrame.from_records(records)


def _summary(table: pd.DataFrame) -> str:
    found = table["finding"].value_counts()
    sentence = f"Of {plural(len(table), 'certified count')}"
    sentence += f", {found.get('as predicted', 0)} are exactly as predicted"
    if found.get("symmetric", 0):
        sentence += f", {found['symmetric']} are as predicted for a rounded symmetric polygon"
    if found.get("noise", 0):
        sentence += f", {found['noise']} differ because the noise was too large for them"
    wrong = int(found.get("unexplained", 0))
    return f"{sentence}; {f'{wrong} contradict' if wrong else 'none contradicts'} the prediction."


def _findings_table(table: pd.DataFrame) -> Table:
    kinds = {"as predicted": "good", "symmetric": "good", "noise": "warn", "unexplained": "bad"}
    found = table.groupby(["family", "finding"]).size()
    body = [
        [
            Cell(finding, finding, kinds[finding]),
            *(cell(float(found.get((family, finding), 0))) for family in SHAPES),
            Cell(meaning),
        ]
        for finding, meaning in FINDINGS.items()
    ]
    return Table("Counts of weaves", ["finding", *SHAPES, "meaning"], body)


def _largest_table(generic: pd.DataFrame) -> Table:
    """The largest n of every shape."""
    last = generic.sort_values("n").groupby(["family", "shape"], sort=True).tail(1)
    head = ["family", "τ or δ", "n", "ν", "passings", "vertices", "predicted", "÷ n²"]
    head += ["limit", "cells", "predicted", "finding"]
    body = []
    for row in last.sort_values(["family", "shape"]).to_dict("records"):
        zigzag = row["family"] == "zigzag"
        limit = 0.5 - row["shape"] / np.pi if zigzag else 0.5
        body.append(
            [
                Cell(str(row["family"])),
                cell(row["shape"]),
                cell(row["n"]),
                cell(row["tilt"]),
                cell(row["passings"]),
                cell(row["vertices"]),
                cell(row["generic_vertices"]),
                _decimal(row["vertices"] / row["n"] ** 2),
                _decimal(limit),
                cell(row["cells"]),
                cell(row["predicted_cells"]),
                Cell(str(row["finding"]), str(row["finding"])),
            ]
        )
    return Table("The largest n of each shape", head, body)


def _decimal(value: float) -> Cell:
    return Cell(f"{value:.4f}", f"{value:.9g}")


def _deviation_table(table: pd.DataFrame) -> Table:
    """Every count that is not exactly the generic or the wholly symmetric prediction."""
    head = ["family", "τ or δ", "n", "noise", "vertices", "predicted", "cells", "predicted"]
    head += ["gap to rim", "noise ÷ tolerance", "reason"]
    body = []
    for row in table[table["finding"] != "as predicted"].to_dict("records"):
        low, high = row["vertices_low"], row["vertices_high"]
        body.append(
            [
                Cell(str(row["family"])),
                cell(row["shape"]),
                cell(row["n"]),
                cell(row["noise"]),
                cell(row["vertices"]),
                Cell(number(low) if low == high else f"{low:.0f} … {high:.0f}", f"{low:.0f}"),
                cell(row["cells"]),
                cell(row["predicted_cells"]),
                cell(row["gap"]),
                cell(row["strain"]),
                Cell(str(row["finding"]), str(row["finding"])),
            ]
        )
    return Table("Counts that are not simply the predicted ones", head, body)


# --- noise ----------------------------------------------------------------------------------------


def collapses(table: pd.DataFrame) -> Iterator[tuple[str, float, pd.DataFrame, Collapse]]:
    """(family, shape, its rows, how they scale) of each weave with noises enough at two sizes."""
    for (family, shape), part in table.groupby(["family", "shape"], sort=True):
        noises = part[part["noise"] > 0].groupby("n")["noise"].nunique()
        if (noises >= LEAST_NOISES).sum() >= 2:
            found = collapse(curves(part), seed_of("collapse", family, shape))
            if found is not None:
                yield str(family), float(str(shape)), part, found


def _smoothed(
    noisy: Sequence[tuple[str, float, pd.DataFrame, Collapse]], download: Download
) -> Part:
    views, figures, downloads = [], [], [download]
    for family, shape, rows, found in noisy:
        name = f"smoothed-{family}-{shape:.3g}"
        points = Download(f"{name}", f"data/{name}.csv", tables.to_csv(points_of(rows)))
        table = tables.from_csv(points.text)
        transition = {n: estimate.value for n, estimate in found.transition}
        title = f"{family}, {SHAPES[family][0]} = {shape:.4g}"
        drawn = [
            Figure(
                f"figures/{name}.svg",
                render(
                    partial(
                        weave_figures.collapse,
                        points=table,
                        exponent=found.exponent.value,
                        transition=transition,
                    ),
                    8.6,
                    3.4,
                ),
                f"Vertices of {title} over the predicted number, against the noise, and collapsed",
            ),
            Figure(
                f"figures/{name}-map.svg",
                render(
                    partial(
                        weave_figures.heat_map,
                        points=table,
                        exponents=(found.exponent.value, 2.0),
                    ),
                    4.8,
                    3.6,
                ),
                f"Share of the predicted vertices of {title} over n and noise",
            ),
        ]
        figures += drawn
        downloads.append(points)
        views.append(
            {
                "title": title,
                "family": family,
                "exponent": found.exponent,
                "sentences": list(_sentences(found)),
                "figures": drawn,
                "download": points,
                "tables": [_transition_table(found), _exponent_table(found)],
            }
        )
    return Part(
        "smoothed",
        "Smoothed complexity",
        "smoothed.html",
        {"views": views, "download": download},
        figures,
        downloads,
    )


def points_of(rows: pd.DataFrame) -> pd.DataFrame:
    """Median and quartiles of the share at every n and noise."""
    records = []
    for (n, noise), part in rows[rows["noise"] > 0].groupby(["n", "noise"], sort=True):
        lower, median, upper = np.quantile(part["share"].to_numpy(), [0.25, 0.5, 0.75])
        records.append(
            {
                "n": n,
                "noise": noise,
                "replicates": len(part),
                "lower": lower,
                "median": median,
                "upper": upper,
            }
        )
    return pd.DataFrame.from_records(records)


def _shown(estimate: Estimate) -> str:
    return f"{number(estimate.value)} {bracket(estimate.low, estimate.high)}"


def _sentences(found: Collapse) -> Iterator[str]:
    yield (
        f"The curves of n = {', '.join(str(curve.n) for curve in found.curves)} collapse best as "
        f"functions of ε·n^a with a = {_shown(found.exponent)}; what then remains between them is "
        f"{number(100 * found.spread)} % of the predicted vertices (root mean square)."
    )
    low, high = found.drift
    pairs = "; ".join(f"{n} and {other}: {_shown(e)}" for n, other, e in found.neighbours)
    yield f"From neighbouring sizes alone, a is, for {pairs}."
    outside = [f"{a:g}" for a in HYPOTHESES if not low <= a <= high]
    inside = [f"{a:g}" for a in HYPOTHESES if low <= a <= high]
    yield (
        f"All these intervals lie between {number(low)} and {number(high)}. Of the whole exponents "
        f"{', '.join(f'{a:g}' for a in HYPOTHESES)} that rules out {', '.join(outside) or 'none'}"
        f" on these sizes and leaves {', '.join(inside) or 'none'}."
    )
    if found.transition_exponent is not None:
        yield (
            "The noise that leaves half of the vertices falls like n^−a with a = "
            f"{_shown(found.transition_exponent)}."
        )


def _transition_table(found: Collapse) -> Table:
    body = [
        [cell(float(n)), cell(e.value), Cell(bracket(e.low, e.high), f"{e.low:.9g}")]
        for n, e in found.transition
    ]
    return Table("The noise that leaves half of the vertices", ["n", "σ(n)", "95 %"], body)


def _exponent_table(found: Collapse) -> Table:
    rows = [("best", found.exponent.value, found.spread)]
    rows += [("hypothesis", a, s) for a, s in zip(HYPOTHESES, found.spreads, strict=True)]
    body = [
        [Cell(what), cell(a), cell(100 * s), cell(s / found.spread if found.spread else np.nan)]
        for what, a, s in rows
    ]
    head = ["exponent", "a", "spread, % of the prediction", "÷ best"]
    return Table("How well the curves collapse", head, body)
