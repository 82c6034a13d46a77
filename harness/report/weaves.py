"""The part of a report on weaves: counts against the exact prediction, and noise that scales."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd

from harness.analysis import GroupGrowth
from harness.analysis.weave import predict
from harness.analysis.weave_noise import SAFE
from harness.analysis.weave_rows import FINDINGS, SHAPES, compare
from harness.report import tables, weave_figures
from harness.report.labels import number, plural
from harness.report.parts import Figure, Part
from harness.report.sections import Cell, Download, Table, cell
from harness.report.smoothed import collapses, smoothed
from harness.report.style import render
from harness.report.weave_picture import ideal, weave_picture

#: A study is about weaves if it has so many shapes of one family.
LEAST_SHAPES = 3


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
        found.append(smoothed(noisy, download))
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
            "symmetric": _symmetric_table(table[table["noise"] == 0]),
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
        sentence += f", {found['symmetric']} are in the range predicted for a rounded symmetric "
        sentence += "polygon"
    if found.get("noise", 0):
        verb, they = ("differs", "it is") if found["noise"] == 1 else ("differ", "they are")
        sentence += f", {found['noise']} {verb}, with more noise than {they} estimated to bear"
    wrong = int(found.get("unexplained", 0))
    verb = "contradict" if wrong > 1 else "contradicts"
    return f"{sentence}; {wrong or 'none'} {verb} the prediction."


def _findings_table(table: pd.DataFrame) -> Table:
    kinds = {"as predicted": "good", "symmetric": "good", "noise": "warn", "unexplained": "bad"}
    found = table.groupby(["family", "finding"]).size()
    seen = set(table["finding"])
    body = [
        [
            Cell(finding, finding, kinds[finding] if finding in seen else ""),
            *(cell(float(found.get((family, finding), 0))) for family in SHAPES),
            Cell(meaning),
        ]
        for finding, meaning in FINDINGS.items()
    ]
    return Table("Counts of weaves", ["finding", *SHAPES, "meaning"], body)


def _largest_table(generic: pd.DataFrame) -> Table:
    """The largest n of every shape."""
    last = generic.sort_values("n").groupby(["family", "shape"], sort=True).tail(1)
    head = ["family", "τ or δ", "n", "ν", "passings", "vertices", "predicted", "vertices / n²"]
    head += ["its limit", "cells", "predicted", "finding"]
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


def _symmetric_table(calm: pd.DataFrame) -> Table:
    """The polygons without noise whose whole symmetry doubles can hold."""
    head = ["family", "τ or δ", "n", "vertices", "cells", "predicted", "count × degree", "finding"]
    body = [
        [
            Cell(str(row["family"])),
            cell(row["shape"]),
            cell(row["n"]),
            cell(row["vertices"]),
            cell(row["cells"]),
            Cell(f"{row['vertices_low']:.0f}, {row['predicted_cells']:.0f}"),
            Cell(str(row["degrees"])),
            Cell(str(row["finding"]), str(row["finding"])),
        ]
        for row in calm[calm["n"].isin([4, 8])].to_dict("records")
    ]
    return Table("Exactly symmetric weaves", head, body)


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
