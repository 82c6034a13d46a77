"""The weaves: their constant against the derivation, and how much noise they bear."""

from __future__ import annotations

import math

import pandas as pd

from harness.report.combined.parts import Chapter, Workshop, absent, share
from harness.report.labels import number
from harness.report.plates.studies import (
    SMOOTHED,
    WEAVE,
    WEAVES,
    collapse_table,
    constants_table,
    first_of,
)
from harness.report.sections import Cell, Table, cell

CONSTANT = ("weave", "How many vertices does a weave have?")
NOISE = ("noise", "How much noise does a weave bear?")
#: A weave of which less than this share of the vertices is left has come apart.
APART = 0.5


def constant_chapter(shop: Workshop) -> Chapter:
    """Vertices over n² of unperturbed weaves, beside the limit that the derivation gives."""
    directory = first_of(shop.results, WEAVE)
    table = constants_table(shop.results) if directory else pd.DataFrame()
    if directory is None or table.empty:
        return absent(*CONSTANT, WEAVE[:1])
    last = table.sort_values("n", kind="stable").groupby(["family", "parameter"]).last()
    largest = last.reset_index().assign(off=lambda t: t["ratio"] / t["limit"] - 1)
    worst = largest.iloc[int(largest["off"].abs().to_numpy().argmax())]
    polygons, certified = int(table["polygons"].sum()), int(table["certified"].sum())
    sentences = [
        f"{polygons} unperturbed weaves, {share(certified, polygons)} counts certified. At the "
        f"largest size of each of {len(largest)} shapes the number of vertices over n² differs "
        f"from the limit of the derivation by {abs(worst['off']):.1%} or less (most: "
        f"{worst['family']}, {worst['parameter']}, n = {worst['n']}: {number(worst['ratio'], 4)} "
        f"against {number(worst['limit'], 4)})."
    ]
    rows = [
        [
            Cell(str(row["family"])),
            Cell(str(row["parameter"])),
            cell(float(row["n"])),
            cell(float(row["polygons"])),
            cell(float(row["least"])),
            cell(float(row["greatest"])),
            Cell(number(row["ratio"], 4), f"{row['ratio']:.9g}"),
            Cell(number(row["limit"], 4), f"{row['limit']:.9g}"),
        ]
        for row in table.to_dict("records")
    ]
    head = ["family", "shape", "n", "polygons", "least", "greatest", "÷ n²", "limit"]
    tilts = [f for f in WEAVES if f in set(table["family"])]
    answer = "About n²/2 · (1 − 2τ/π)" if "zigzag" in tilts else "About n²/2"
    return Chapter(
        *CONSTANT,
        answer,
        "faster",
        sentences,
        [shop.plate("constants")],
        [Table("Vertices of unperturbed weaves", head, rows)],
        sources=[directory.name],
    )


def noise_chapter(shop: Workshop) -> Chapter:
    """Vertices that are left when the vertices of the polygon are moved at random."""
    directory = first_of(shop.results, SMOOTHED)
    if directory is None:
        return absent(*NOISE, SMOOTHED[:1])
    table = collapse_table(shop.results)
    polygons, certified = int(table["polygons"].sum()), int(table["certified"].sum())
    halves = _halves(table)
    rows = [
        [
            Cell(family),
            cell(float(n)),
            cell(full),
            Cell("–" if sigma is None else number(sigma), "" if sigma is None else f"{sigma:.9g}"),
            Cell(
                "–" if sigma is None else number(sigma * n**2),
                "" if sigma is None else f"{sigma * n**2:.9g}",
            ),
        ]
        for family, n, full, sigma in halves
    ]
    slopes = _slopes(halves)
    for line, slope in zip(rows, slopes, strict=True):
        line.append(Cell(number(slope), "" if slope is None else f"{slope:.9g}"))
    falls = all(slope is None or slope < 0 for slope in slopes) and any(slopes)
    head = ["family", "n", "vertices at least noise", "σ at which half are left", "σ n²", "slope"]
    return Chapter(
        *NOISE,
        "Less and less as n grows" if falls else "No clear answer from these rows",
        "slower" if falls else "",
        [
            " ".join(_reading(falls, [slope for slope in slopes if slope is not None])),
            f"{polygons} perturbed weaves, {share(certified, polygons)} counts certified.",
        ],
        [shop.plate("collapse")],
        [Table("Where the weave comes apart", head, rows)],
        sources=[directory.name],
    )


def _reading(falls: bool, slopes: list[float]) -> list[str]:
    """What the table says, in a sentence."""
    if not falls:
        return ["Too few sizes, or noises, to say where the weaves come apart."]
    return [
        "The noise at which half of the vertices are left falls as n grows, like n to a power "
        f"between {number(min(slopes))} and {number(max(slopes))} from one size to the next "
        "(interpolated between the noises that were run): the more edges a weave has, the more "
        "carefully its vertices have to be placed."
    ]


def _slopes(halves: list[tuple[str, int, float, float | None]]) -> list[float | None]:
    """Of each line the exponent of σ in n since the size before, where there is one."""
    found: list[float | None] = []
    for k, (family, n, _, sigma) in enumerate(halves):
        before = halves[k - 1] if k and halves[k - 1][0] == family else None
        if before is None or sigma is None or before[3] is None:
            found.append(None)
        else:
            found.append(math.log(sigma / before[3]) / math.log(n / before[1]))
    return found


def _halves(table: pd.DataFrame) -> list[tuple[str, int, float, float | None]]:
    """(family, n, vertices at the least noise, noise at which half of them are left) by size.

    Interpolated in log σ; None if more than half are left at the greatest noise.
    """
    found = []
    for (family, n), part in table.groupby(["family", "n"], sort=True):
        sigma, median = part["sigma"].tolist(), part["median"].tolist()
        full = float(median[0])
        found.append((str(family), int(str(n)), full, _crossing(sigma, median, APART * full)))
    return found


def _crossing(sigma: list[float], median: list[float], level: float) -> float | None:
    """The first noise at which the median falls to a level."""
    for k in range(1, len(sigma)):
        if median[k] <= level < median[k - 1]:
            part = (median[k - 1] - level) / (median[k - 1] - median[k])
            return float(sigma[k - 1] * (sigma[k] / sigma[k - 1]) ** part)
    return None
