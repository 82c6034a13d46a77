"""Is the complexity linear in the kernel and in the interior?  From the rows of ``conjecture``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from harness.analysis import GroupGrowth
from harness.analysis.weave_rows import SHAPES
from harness.report.build import StudyGrowth, read
from harness.report.combined.parts import Chapter, Workshop, absent, share
from harness.report.labels import bracket, number, plural, spread
from harness.report.plates.studies import GROWTH, first_of
from harness.report.sections import Cell, Table, cell
from harness.report.summary import control_sentence
from harness.report.tables import to_csv

SLUG = "linear"
QUESTION = "Is the complexity linear for star-shaped polygons?"
DOMAINS = ("kernel", "interior", "plane")
#: Why a count of a weave stands for more than itself.
DERIVED = (
    " One count refutes no greater c; that the vertices of weaves outgrow every linear bound is "
    "proved below, by a derivation for all even n."
)
#: What that verdict says, and what it does not.
FASTER_THAN_SQUARE = (
    "“Faster than n²” means that n², fitted to the smaller sizes, falls short at the larger ones: "
    "a rise of the count over n² by a few per cent is enough for that, also one that ends before "
    "the largest size; no other order is claimed."
)
KNOWN = " (Of control families the growth is known in the kernel, and only there.)"
CLAIMS = {
    "faster": "faster than linear",
    "possible": "linear possible",
    "slower": "slower than linear",
    "undecided": "not decided",
}


def linear_chapter(shop: Workshop) -> Chapter:
    """Certified counts against linear bounds, and how the families grow."""
    directory = first_of(shop.results, GROWTH)
    if directory is None:
        return absent(SLUG, QUESTION, GROWTH[:1])
    study = read(directory)
    curves = list(zip(study.groups, study.labels, strict=True))
    star_shaped = [pair for pair in curves if pair[0].group.key.domain != "plane"]
    records = record_table(study.groups, study.labels)
    faster = [label for analysed, label in star_shaped if _claim(analysed) == "faster"]
    answer, tone = ("No", "faster") if faster else ("Not refuted by these rows", "")
    return Chapter(
        SLUG,
        QUESTION,
        answer,
        tone,  # type: ignore[arg-type]  # one of the two literals above
        list(_sentences(study, star_shaped, faster, records)),
        [
            *shop.shelved(["woven-kernel"], wide=["woven-kernel"]),
            shop.plate("growth"),
            *shop.shelved(["convex-weave"]),
        ],
        [_record_view(records), _verdict_view(curves)],
        [
            "“Faster”, “slower”: which of the growth models 1, log n, n, n log n, n² the counts of "
            "the larger sizes reject, when the models are fitted to the smaller sizes. That is a "
            "statement about the sizes that were run.",
            FASTER_THAN_SQUARE,
            "Where one instance stands at the largest n, the interval of the exponent does not "
            "know its scatter (“repl.”: the fewest and the most replicates at a size).",
            "The families are what was tried, not the worst there can be: polygons of few edges "
            "with as many vertices as possible were not searched for.",
        ],
        [
            shop.download("largest-counts", to_csv(records)),
            shop.download("growth-verdicts", to_csv(_verdict_table(curves))),
        ],
        [directory.name],
    )


def _is_control(analysed: GroupGrowth) -> bool:
    """Whether the family is there as a control, in whatever domain."""
    return analysed.group.key.family.startswith("control-")


def _claim(analysed: GroupGrowth) -> str:
    return analysed.curves["vertices", "maximum"].verdict.linear_claim


def _sentences(
    study: StudyGrowth,
    star_shaped: Sequence[tuple[GroupGrowth, str]],
    faster: Sequence[str],
    records: pd.DataFrame,
) -> Iterator[str]:
    for domain in DOMAINS[:2]:
        part = records[records["domain"] == domain]
        if len(part):
            best = part.iloc[0]
            yield (
                f"In the {domain}, a polygon of the family {best['family']} with n = {best['n']} "
                f"edges has {best['vertices']:,} vertices, certified: {number(best['per_edge'])} "
                f"for each edge, {number(best['per_square'])}·n². No bound of c·n vertices holds "
                f"for all polygons with c below {math.floor(10 * best['per_edge']) / 10:,.1f}."
                f"{DERIVED if best['family'] in SHAPES else ''}"
            )
    if faster:
        yield (
            f"Over the sizes of this study {len(faster)} of {len(star_shaped)} curves of polygons "
            f"grow faster than linearly in the maximum: {'; '.join(faster)}. That they go on "
            "doing so beyond these sizes no count can prove; for the weaves it is derived (below)."
            f"{KNOWN if any(_is_control(analysed) for analysed, _ in star_shaped) else ''}"
        )
    random = [
        label
        for analysed, label in star_shaped
        if _claim(analysed) != "faster" and not _is_control(analysed)
    ]
    if random:
        yield (
            f"{plural(len(random), 'other curve')}, controls apart, do not show it at these sizes; "
            "a study on random polygons in kernels alone would have confirmed the expectation."
        )
    plane = records[records["domain"] == "plane"]
    if len(plane):
        counted = "; ".join(
            f"{row['curve']}, n = {row['n']}: {number(row['per_square'])}·n²"
            for row in plane.to_dict("records")
        )
        yield f"In the plane, the most vertices for each edge were, curve by curve: {counted}."
    yield f"{study.name}: {_tasks(study)} {control_sentence(study.groups)}"


def _tasks(study: StudyGrowth) -> str:
    counted = sum(len(size.counted) for g in study.groups for size in g.group.sizes)
    uncertified = sum(size.uncertified for g in study.groups for size in g.group.sizes)
    rows = sum(len(analysed.group.rows) for analysed in study.groups)
    text = f"{plural(rows, 'task')}, {share(counted, rows)} counted, "
    text += f"{share(counted - uncertified, counted)} of the counts certified."
    planned = study.planned
    if planned is not None and planned > rows:
        text += f" The study is not complete: it has {planned} tasks."
    return text


def record_table(groups: Sequence[GroupGrowth], labels: Sequence[str]) -> pd.DataFrame:
    """For each curve the certified row with the most vertices for each edge."""
    records = []
    for analysed, label in zip(groups, labels, strict=True):
        rows = analysed.group.rows
        sure = rows[(rows["status"] == "ok") & rows["certified"].fillna(value=False).astype(bool)]
        if sure.empty:
            continue
        ratio = sure["vertices"].astype(float) / sure["segments"].astype(float)
        best = sure.iloc[int(ratio.to_numpy().argmax())]
        n, vertices = int(best["segments"]), int(best["vertices"])
        records.append(
            {
                "curve": label,
                "family": analysed.group.key.family,
                "domain": analysed.group.key.domain,
                "n": n,
                "cells": int(best["cells"]),
                "edges": int(best["edges"]),
                "vertices": vertices,
                "per_edge": vertices / n,
                "per_square": vertices / n**2,
                "seed": int(best["seed"]),
                "task": str(best["task"]),
            }
        )
    columns = [
        "curve",
        "family",
        "domain",
        "n",
        "cells",
        "edges",
        "vertices",
        "per_edge",
        "per_square",
    ]
    table = pd.DataFrame.from_records(records, columns=[*columns, "seed", "task"])
    ranks = table["domain"].map(DOMAINS.index)
    order = table.assign(rank=ranks).sort_values(
        ["rank", "per_edge"], ascending=[True, False], kind="stable", ignore_index=True
    )
    return order.drop(columns="rank")


def _record_view(records: pd.DataFrame) -> Table:
    head = ["curve", "domain", "n", "cells", "edges", "vertices", "vertices / n", "vertices / n²"]
    rows = [
        [
            Cell(str(row["curve"])),
            Cell(str(row["domain"])),
            *(cell(float(row[name])) for name in ("n", "cells", "edges", "vertices")),
            cell(float(row["per_edge"])),
            cell(float(row["per_square"])),
        ]
        for row in records.to_dict("records")
    ]
    caption = "Certified counts with the most vertices for each edge, curve by curve"
    return Table(
        caption,
        [*head, "seed"],
        [[*cells, Cell(str(seed))] for cells, seed in zip(rows, records["seed"], strict=True)],
    )


def _verdict_table(curves: Sequence[tuple[GroupGrowth, str]]) -> pd.DataFrame:
    records: list[dict[str, Any]] = []
    for analysed, label in curves:
        maximum, median = (analysed.curves["vertices", s] for s in ("maximum", "median"))
        replicates = [len(size.rows) for size in analysed.group.sizes]
        records.append(
            {
                "curve": label,
                "domain": analysed.group.key.domain,
                "sizes": len(maximum.n),
                "largest_n": int(maximum.n[-1]) if len(maximum.n) else None,
                "fewest_replicates": min(replicates, default=0),
                "replicates": max(replicates, default=0),
                "maximum": maximum.verdict.label,
                "median": median.verdict.label,
                "exponent": maximum.power.exponent,
                "exponent_low": maximum.power.low,
                "exponent_high": maximum.power.high,
                "linear": _claim(analysed),
            }
        )
    return pd.DataFrame.from_records(records)


def _verdict_view(curves: Sequence[tuple[GroupGrowth, str]]) -> Table:
    head = [
        "curve",
        "domain",
        "n ≤",
        "repl.",
        "vertices, max.",
        "median",
        "exponent, max.",
        "linear?",
    ]
    rows = []
    for row in _verdict_table(curves).to_dict("records"):
        power = number(row["exponent"]) if row["exponent"] is not None else "–"
        interval = bracket(row["exponent_low"], row["exponent_high"])
        exponent = row["exponent"]
        rows.append(
            [
                Cell(str(row["curve"])),
                Cell(str(row["domain"])),
                cell(float(row["largest_n"])),
                Cell(spread(row["fewest_replicates"], row["replicates"]), str(row["replicates"])),
                Cell(str(row["maximum"]), kind="verdict"),
                Cell(str(row["median"]), kind="verdict"),
                Cell(f"{power} {interval}".strip(), "" if exponent is None else f"{exponent:.9g}"),
                Cell(CLAIMS[row["linear"]], row["linear"], row["linear"]),
            ]
        )
    return Table("How the number of vertices grows, curve by curve", head, rows)
