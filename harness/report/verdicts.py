"""What the page says first: the verdicts, domain by domain, with the counts that bear them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from harness.analysis import MODELS, GroupGrowth
from harness.analysis.verdict import LinearClaim
from harness.diagram.counts import DOMAINS, OBJECTIVES
from harness.report import summary
from harness.report.labels import bracket, curve_labels, number, sizes, spread
from harness.report.sections import Cell, Table, cell

#: What becomes of linear growth, short enough for a table.
SHORT: dict[LinearClaim, str] = {
    "faster": "faster",
    "possible": "possible",
    "slower": "slower",
    "undecided": "not decided",
}
_PLACES = {
    "kernel": "In the kernel",
    "interior": "In the interior",
    "plane": "In the plane",
}


@dataclass(frozen=True)
class DomainView:
    """The verdicts on one domain and objective.

    ``claims``: words about linear growth, and the curves they are true of; ``table``: a row for
    each curve; ``slug``: names the figure of all curves.
    """

    title: str
    slug: str
    claims: Sequence[tuple[str, Sequence[str]]]
    table: Table


def domains(groups: Sequence[GroupGrowth]) -> list[DomainView]:
    """The views of a study, in the order kernel, interior, plane."""
    keys = {(each.group.key.domain, each.group.key.objective) for each in groups}
    objectives = {objective for _, objective in keys}
    views = []
    for domain, objective in sorted(keys, key=_order):
        part = [
            each
            for each in groups
            if (each.group.key.domain, each.group.key.objective) == (domain, objective)
        ]
        labels = curve_labels([each.group.key for each in part])
        title = _PLACES.get(domain, domain)
        if len(objectives) > 1:
            title += f", {objective} visual angle"
        claims = summary.by_linear_claim(part, labels)
        views.append(DomainView(title, f"{domain}-{objective}", claims, _table(part, labels)))
    return views


def domain_rank(domain: str) -> int:
    """The place of a domain in the order in which the page has them."""
    return [*DOMAINS, domain].index(domain)


def _order(key: tuple[str, str]) -> tuple[int, int]:
    """Of a domain and an objective, both checked when the rows were read."""
    domain, objective = key
    return domain_rank(domain), [*OBJECTIVES, objective].index(objective)


def _table(groups: Sequence[GroupGrowth], labels: Sequence[str]) -> Table:
    head = ["curve", "n", "most vertices", "per segment", "vertices, max.", "vertices, median"]
    head += ["exponent, max.", "linear?", "edges, max.", "cells, max.", "replicates"]
    failing = any(_failed(each) for each in groups)
    if failing:
        head.append("failed")
    rows = []
    for analysed, label in zip(groups, labels, strict=True):
        maximum = analysed.curves["vertices", "maximum"]
        power, claim = maximum.power, maximum.verdict.linear_claim
        failed = _failed(analysed)
        row = [
            Cell(label, label, f"#{analysed.group.key.slug}"),
            Cell(_range(maximum.n), number(float(maximum.n[-1])) if len(maximum.n) else ""),
            *_most(analysed),
            verdict_cell(analysed, "vertices", "maximum"),
            verdict_cell(analysed, "vertices", "median"),
            Cell(
                f"{number(power.exponent)} {bracket(power.low, power.high)}".strip(),
                "" if power.exponent is None else f"{power.exponent:.9g}",
            ),
            Cell(SHORT[claim], claim, claim),
            verdict_cell(analysed, "edges", "maximum"),
            verdict_cell(analysed, "cells", "maximum"),
            _replicates(analysed),
        ]
        if failing:
            row.append(Cell(str(failed) if failed else "", str(failed), "warn" if failed else ""))
        rows.append(row)
    return Table(
        "Most vertices: at the largest n. Maximum and median: over the replicates at each n",
        head,
        rows,
    )


def _range(n: Any) -> str:
    if not len(n):
        return "–"
    return sizes([float(n[0]), float(n[-1])]).replace(", ", " … ")


def _most(analysed: GroupGrowth) -> list[Cell]:
    """The maximum at the largest size, and what that is for each segment."""
    curve = analysed.curves["vertices", "maximum"]
    if not len(curve.n):
        return [Cell("–"), Cell("–")]
    most, n = float(curve.observed[-1]), float(curve.n[-1])
    before = "≥ " if curve.censored[-1] else ""
    return [Cell(f"{before}{most:,.0f}".replace(",", "\u202f"), f"{most:.9g}"), cell(most / n)]


def _replicates(analysed: GroupGrowth) -> Cell:
    counts = [len(size.rows) for size in analysed.group.sizes]
    return Cell(spread(min(counts), max(counts)), str(max(counts)))


def _failed(analysed: GroupGrowth) -> int:
    return sum(len(size.rows) - len(size.counted) for size in analysed.group.sizes)


def verdict_cell(analysed: GroupGrowth, headline: str, statistic: Any) -> Cell:
    """A verdict, sorted by the slowest model it keeps."""
    verdict = analysed.curves[headline, statistic].verdict
    kept = [model for model in MODELS if model in verdict.kept]
    rank = MODELS.index(kept[0]) if kept else len(MODELS)
    return Cell(verdict.label, str(rank), f"verdict {verdict.kind}")
