"""The part of a report on noisy weaves: how many vertices a noise leaves, and how that scales."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
import pandas as pd

from harness.analysis.smoothed import (
    HYPOTHESES,
    REMNANT,
    Collapse,
    Estimate,
    collapse,
    seed_of,
)
from harness.analysis.smoothed import curves as noise_curves
from harness.analysis.weave_rows import SHAPES
from harness.report import tables, weave_figures
from harness.report.labels import bracket, number, percent
from harness.report.parts import Figure, Part
from harness.report.sections import Cell, Download, Table, cell
from harness.report.style import render


def collapses(table: pd.DataFrame) -> Iterator[tuple[str, float, pd.DataFrame, Collapse]]:
    """Family, shape, rows and scaling of every weave with enough noises at enough sizes.

    ``table``: rows as of ``harness.analysis.weave_rows.compare``.
    """
    for (family, shape), part in table.groupby(["family", "shape"], sort=True):
        found = collapse(noise_curves(part), seed_of("collapse", family, shape))
        if found is not None:
            yield str(family), float(str(shape)), part, found


def smoothed(
    noisy: Sequence[tuple[str, float, pd.DataFrame, Collapse]], download: Download
) -> Part:
    """The section on these weaves; ``download`` is the table of all of their counts."""
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
                        through=transition,
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
        f"functions of ε·nᵃ with a = {_shown(found.exponent)}; what then remains between them is "
        f"{number(100 * found.spread)} % of the predicted vertices (root mean square)."
    )
    pairs = "; ".join(f"{n} and {other}: {_shown(e)}" for n, other, e in found.neighbours)
    differ = (
        ""
        if found.is_consistent
        else (
            " These intervals do not agree with each other: they know the scatter of replicates, "
            "but not that at small n the number of passings grows by steps."
        )
    )
    yield f"From neighbouring sizes alone, a is, for {pairs}.{differ}"
    low, high = found.possible
    outside = [f"{a:g}" for a in HYPOTHESES if not low <= a <= high]
    inside = [f"{a:g}" for a in HYPOTHESES if low <= a <= high]
    yield (
        f"All intervals lie between {number(found.drift[0])} and {number(found.drift[1])}. As they "
        "know nothing of larger sizes, that range is widened on either side by its own length: it "
        f"then rules out {', '.join(outside) or 'none'} and leaves {', '.join(inside) or 'none'} "
        f"of the whole exponents from {HYPOTHESES[0]:g} to {HYPOTHESES[-1]:g}."
        f"{trend([estimate for _, _, estimate in found.neighbours])}"
    )
    if found.transition_exponent is not None:
        yield (
            "The noise that leaves half of the vertices falls like n⁻ᵃ with a = "
            f"{_shown(found.transition_exponent)}."
        )
    if found.decay is not None:
        yield (
            f"Where less than {percent(REMNANT)} is left, at n = {found.curves[-1].n}, the "
            f"vertices go like ε⁻ᵃ with a = {_shown(found.decay)}; far beyond the transition the "
            "argument below expects a = 1."
        )


def trend(estimates: Sequence[Estimate]) -> str:
    """That exponents of ever larger sizes go one way, beyond their intervals, if they do."""
    steps = np.diff([estimate.value for estimate in estimates])
    if len(steps) < 2 or not (np.all(steps > 0) or np.all(steps < 0)):
        return ""
    first, last = estimates[0], estimates[-1]
    if first.low <= last.high and last.low <= first.high:
        return ""
    way = "rise" if steps[0] > 0 else "fall"
    return f" But they {way} with n throughout: what a is for large n these sizes do not decide."


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
