"""The page of an audit: every claim with its reading, verdict, example and evidence."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from harness.audit.claim import Claim
from harness.audit.registry import CLAIMS
from harness.audit.store import INSTANCES, MANIFEST, read_verdicts
from harness.errors import UserError
from harness.files import read_object
from harness.geometry.formats import read_instance
from harness.geometry.instance import Instance
from harness.report import provenance
from harness.report.audit_drawing import example_svg, growth_svg, profile_svg, short
from harness.report.labels import plain
from harness.report.pages import REPORT, environment, write_files
from harness.report.style import inline

Record = Mapping[str, Any]


def write_audit_page(directory: Path) -> tuple[Path, list[str]]:
    """Write ``report.html`` and ``figures/`` from what an audit left; the page and its verdicts.

    The same rows and verdicts give the same bytes.  Raises UserError if there is no audit.
    """
    records = read_verdicts(directory)
    if not records:
        raise UserError(f"{directory}: no finished claim to report on")
    figures: dict[str, str] = {}
    views = [
        _view(CLAIMS[name], record, directory, figures)
        for name, record in records.items()
        if name in CLAIMS
    ]
    manifest = read_object(directory / MANIFEST, "a manifest")
    page = (
        environment()
        .get_template("audit.html")
        .render(claims=views, provenance=provenance.entries(manifest))
    )
    files = {f"figures/{name}.svg": svg for name, svg in figures.items()}
    return write_files(directory, {**files, REPORT: page + "\n"}), [
        f"{view['name']}: {view['verdict']}" for view in views
    ]


def tone(claim: Claim, record: Record) -> str:
    """The colour of a verdict: "bad" for a refuted claim, "good" for one that held, or "open"."""
    tally = record["tally"]
    if not tally["holds"] + tally["fails"]:
        return "open"
    if claim.kind == "there is":
        return "good" if tally["holds"] else "open"
    if tally["fails"]:
        return "bad"
    return "good"


def _view(claim: Claim, record: Record, directory: Path, figures: dict[str, str]) -> dict[str, Any]:
    """What the template needs of one claim; its figures are added to ``figures``."""
    tally = record["tally"]
    return {
        "name": claim.name,
        "title": claim.title,
        "gloss": claim.gloss,
        "quote": claim.quote,
        "texts": [
            ("Reading tested", claim.reading),
            ("What counts as a failure", claim.failure),
            ("What decides", claim.arithmetic),
            ("What this shows", claim.limits),
        ],
        "kind": claim.kind,
        "verdict": record["verdict"],
        "tone": tone(claim, record),
        "tried": tally["holds"] + tally["fails"],
        "tally": tally,
        "families": [{**row, "label": short(_labelled(row))} for row in record["families"]],
        "example": _example(claim, record, directory, figures),
        "series": [
            {
                **one,
                "family": short(one["family"]),
                "rows": [
                    [n, count, *(f"{values[k]:.4g}" for values in one["ratios"].values())]
                    for k, (n, count) in enumerate(zip(one["n"], one["counts"], strict=True))
                ],
            }
            for one in record["series"]
        ],
        "growth": _growth(claim, record, figures),
    }


def _labelled(row: Record) -> str:
    return f"{row['family']} {row['params']}"


def _growth(claim: Claim, record: Record, figures: dict[str, str]) -> str | None:
    """The growth curves, inline."""
    if not record["series"]:
        return None
    name = f"{claim.name}-growth"
    figures[name] = growth_svg(record["series"])
    return inline(figures[name], name, f"{claim.title}: counts against n")


def _example(
    claim: Claim, record: Record, directory: Path, figures: dict[str, str]
) -> dict[str, Any] | None:
    """The example of a claim, drawn if it is about a diagram."""
    example = record["example"]
    if example is None:
        return None
    path = directory / INSTANCES / f"{claim.name}.json"
    view: dict[str, Any] = {
        "word": "Witness" if claim.kind == "there is" else "Smallest counterexample found",
        "message": example["message"],
        "n": example["n"],
        "coordinates": _coordinates(example) if example["n"] <= 16 else "see the file",
        "path": f"{INSTANCES}/{claim.name}.json",
        "problem": example["problem"],
        "counts": [
            (builder, counts["cells"], counts["edges"], counts["vertices"])
            for builder, counts in example["counts"].items()
        ],
        "pictures": [],
    }
    if claim.kind == "growth":
        view["word"] = "Smallest instance above the bound"
    if example["domain"] is not None:
        instance = read_instance(path)
        for name, svg, text in _pictures(claim, instance, example):
            figures[name] = svg
            view["pictures"].append(
                {"svg": inline(svg, name, text), "path": f"figures/{name}.svg", "text": text}
            )
    return view


def _pictures(claim: Claim, instance: Instance, example: Record) -> list[tuple[str, str, str]]:
    """(name, SVG, caption) of an example's pictures."""
    marked = " The ring marks the place." if example["marks"] else ""
    text = f"The diagram of the {example['domain']}, {instance.n} segments.{marked}"
    found = [(claim.name, example_svg(instance, example), text)]
    if claim.name.startswith("lemma-4"):
        profile = profile_svg(instance, example)
        if profile is not None:
            words = "The visual angle of its two segments along the edge."
            found.append((f"{claim.name}-profile", profile, words))
    return found


def _coordinates(example: Record) -> str:
    """The coordinates as text: points joined by dashes for segments, listed for a polygon."""
    if example["kind"] == "polygon":
        return ", ".join(_point(p) for p in example["coordinates"])
    return "; ".join(f"{_point(a)}–{_point(b)}" for a, b in example["coordinates"])


def _point(p: list[float]) -> str:
    return f"({plain(p[0])}, {plain(p[1])})"
