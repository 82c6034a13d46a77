"""The page: everything the template needs, and all files of the report as text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import pandas as pd

from harness.analysis import MODELS, Check, GroupGrowth, check, design_of
from harness.analysis import challenge as challenging
from harness.analysis import planted as planting
from harness.analysis.models import GREATEST_SHARE, LEAST_SHARE
from harness.analysis.statistics import RESAMPLES
from harness.report import figures, provenance, summary, tables
from harness.report.build import StudyGrowth
from harness.report.chapters import Part, chapters
from harness.report.examples import Example, example
from harness.report.labels import number, percent, plain, sizes
from harness.report.pages import REPORT, environment
from harness.report.sections import Cell, Download, Section, Table, section
from harness.report.style import inline, render
from harness.report.verdicts import domain_rank, domains, verdict_cell
from harness.study.worker import MOST_EDGES


def outputs(study: StudyGrowth) -> dict[str, str]:
    """Every file of the report: its path relative to the study's directory, and its text."""
    sections = [
        section(analysed, label) for analysed, label in zip(study.groups, study.labels, strict=True)
    ]
    checks = _checks(study)
    downloads = {
        "verdicts": _download("verdicts", tables.verdicts(study.groups)),
        "overview": _download("overview", tables.overview(study.groups, study.labels)),
        "failures": _download("failures", tables.failures([g.group for g in study.groups])),
        "planted": _download("planted", _planted_table(checks)),
    }
    overviews = list(_overviews(downloads["overview"]))
    examples = _examples(study)
    files = {figure["path"]: figure["document"] for figure in overviews}
    files.update({shown.path: shown.document for shown in examples.values() if shown})
    for part in sections:
        files.update({panel.figure_path: panel.document for panel in part.panels})
        files.update({download.path: download.text for download in part.downloads})
    files.update({download.path: download.text for download in downloads.values()})
    special = chapters(study.groups)
    for chapter in special:
        files.update(chapter.files)
    files[REPORT] = _page(study, sections, checks, downloads, overviews, examples, special)
    return files


def _page(
    study: StudyGrowth,
    sections: list[Section],
    checks: list[tuple[tuple[Check, ...], list[str]]],
    downloads: dict[str, Download],
    overviews: list[dict[str, str]],
    examples: Mapping[str, Example | None],
    special: list[Part],
) -> str:
    manifest = study.manifest or {}
    return (
        environment()
        .get_template("report.html")
        .render(
            name=study.name,
            description=str(manifest.get("description") or ""),
            tasks=summary.tasks_sentence(study.groups, study.planned),
            domains=domains(study.groups),
            control_sentence=summary.control_sentence(study.groups),
            overviews={figure["slug"]: figure for figure in overviews},
            controls=_control_table(study),
            checks=[_check_view(check, labels) for check, labels in checks],
            families=list(_families(study, sections, examples)),
            failures=_failure_table(study),
            special=special,
            downloads=downloads,
            method=method_facts(),
            provenance=provenance.entries(study.manifest),
            study_file=study.study_file,
        )
        + "\n"
    )


def _download(title: str, table: pd.DataFrame) -> Download:
    return Download(title, f"data/{title}.csv", tables.to_csv(table))


def method_facts() -> dict[str, str]:
    """The numbers that the text about the method names."""
    return {
        "level": percent(challenging.LEVEL),
        "confirming": percent(challenging.CONFIRMING_LEVEL),
        "least_sizes": str(challenging.LEAST_SIZES),
        "span": number(challenging.LEAST_SPAN),
        "least_share": number(LEAST_SHARE),
        "greatest_share": number(GREATEST_SHARE),
        "resamples": str(RESAMPLES),
        "trials": str(planting.TRIALS),
        "most_edges": f"{MOST_EDGES:,}",
    }


# --- overview --------------------------------------------------------------------------------


def _overviews(download: Download) -> Iterator[dict[str, str]]:
    table = tables.from_csv(download.text)
    for (domain, objective), part in table.groupby(["domain", "objective"], sort=True):
        short = part.assign(curve=part["curve"].str.replace(f", {domain}", ""))  # all are
        document = render(
            partial(figures.overview, table=short), 4.8, figures.overview_height(short["curve"])
        )
        name = f"overview-{domain}-{objective}"
        text = f"Maximum number of vertices per segment, {domain}, {objective} visual angle"
        yield {
            "slug": f"{domain}-{objective}",
            "path": f"figures/{name}.svg",
            "document": document,
            "svg": inline(document, name, text),
            "title": f"{domain}, {objective} visual angle",
        }


# --- tables of the whole study -----------------------------------------------------------------


def _control_table(study: StudyGrowth) -> Table:
    labels = dict(zip((id(group) for group in study.groups), study.labels, strict=True))
    kinds = {"right": "good", "possible": "", "wrong": "bad", "undecided": ""}
    rows = [
        [
            Cell(labels[id(analysed)], labels[id(analysed)], f"#{analysed.group.key.slug}"),
            Cell(analysed.declared.model.symbol if analysed.declared else ""),
            verdict_cell(analysed, "vertices", "maximum"),
            Cell(summary.CALLS[maximum], maximum, kinds[maximum]),
            verdict_cell(analysed, "vertices", "median"),
            Cell(summary.CALLS[median], median, kinds[median]),
        ]
        for analysed, maximum, median in summary.controls(study.groups)
    ]
    head = ["curve", "known growth of vertices", "maximum", "call", "median", "call"]
    return Table("Families of known growth", head, rows)


def _failure_table(study: StudyGrowth) -> Table:
    table = tables.failures([analysed.group for analysed in study.groups])
    rows = [
        [
            Cell(str(row["family"])),
            Cell(str(row["params"])),
            Cell(str(row["n"]), str(row["n"])),
            Cell(str(row["replicate"]), str(row["replicate"])),
            Cell(f"{row['domain']}, {row['objective']}"),
            Cell(str(row["status"]), str(row["status"]), "warn"),
            Cell("" if pd.isna(row["message"]) else str(row["message"])),
        ]
        for row in table.to_dict("records")
    ]
    head = ["family", "parameters", "n", "replicate", "diagram", "status", "message"]
    return Table("Tasks without a count", head, rows)


def _examples(study: StudyGrowth) -> dict[str, Example | None]:
    """A picture for each family, in the order of the page."""
    groups: dict[str, list[GroupGrowth]] = {}
    for analysed in study.groups:
        groups.setdefault(analysed.group.key.family, []).append(analysed)
    for of_family in groups.values():
        of_family.sort(key=lambda analysed: domain_rank(analysed.group.key.domain))
    return {name: example(of_family) for name, of_family in groups.items()}


def _families(
    study: StudyGrowth, sections: list[Section], examples: Mapping[str, Example | None]
) -> Iterator[dict[str, Any]]:
    from generators import FAMILIES

    for name in examples:
        family = FAMILIES.get(name)
        yield {
            "name": name,
            "summary": family.summary[:1].upper() + family.summary[1:] if family else "",
            "source": family.source if family else "",
            "example": examples[name],
            "sections": sorted(
                (
                    part
                    for part, analysed in zip(sections, study.groups, strict=True)
                    if analysed.group.key.family == name
                ),
                key=lambda part: domain_rank(part.domain),
            ),
        }


# --- planted controls --------------------------------------------------------------------------


def _checks(study: StudyGrowth) -> list[tuple[tuple[Check, ...], list[str]]]:
    """One check per design, with the labels of the curves that share it."""
    users: dict[Any, list[str]] = {}
    for analysed, label in zip(study.groups, study.labels, strict=True):
        design = design_of(analysed.group)
        if len(design.n) >= challenging.LEAST_SIZES and design.n[0] > 1:
            users.setdefault(design, []).append(label)
    return [(check(design), users[design]) for design in sorted(users)]


def _planted_table(checks: list[tuple[tuple[Check, ...], list[str]]]) -> pd.DataFrame:
    columns = ["sizes", "replicates", "spread", "level", "statistic", "planted", "candidate"]
    records = [
        {
            "sizes": " ".join(f"{n:g}" for n in result.design.n),
            "replicates": " ".join(str(count) for count in result.design.replicates),
            "spread": result.design.spread,
            "level": result.design.level,
            "statistic": result.statistic,
            "planted": planted,
            "candidate": candidate,
            "rejected": share,
        }
        for results, _ in checks
        for result in results
        for (planted, candidate), share in result.rejected.items()
    ]
    return pd.DataFrame.from_records(records, columns=[*columns, "rejected"])


def _check_view(results: tuple[Check, ...], labels: list[str]) -> dict[str, Any]:
    design = results[0].design
    replicates = sorted(set(design.replicates))
    matrices: list[dict[str, Any]] = [
        {
            "statistic": result.statistic,
            "rows": [
                {
                    "planted": planted.symbol,
                    "cells": [
                        {
                            "share": result.rejected[planted.name, candidate.name],
                            "text": percent(result.rejected[planted.name, candidate.name]),
                            "own": planted is candidate,
                        }
                        for candidate in MODELS
                    ],
                    "named": percent(result.named[planted.name]),
                }
                for planted in MODELS
            ],
        }
        for result in results
    ]
    if len(results) == 1:
        matrices[0]["statistic"] = "maximum = median"
    return {
        "sizes": sizes(design.n),
        "replicates": " … ".join(
            str(count) for count in replicates[:: max(1, len(replicates) - 1)]
        ),
        "spread": percent(design.spread) if design.spread else "none",
        "level": plain(design.level),
        "labels": labels,
        "matrices": matrices,
        "models": [model.symbol for model in MODELS],
    }
