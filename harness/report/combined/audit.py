"""What becomes of the paper's statements, one by one: from the verdicts of ``avd audit``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from harness.audit.claim import OUTCOMES, Claim
from harness.audit.registry import CLAIMS
from harness.audit.store import INSTANCES, read_verdicts
from harness.geometry.formats import read_instance
from harness.report.audit_drawing import example_svg
from harness.report.audit_page import tone
from harness.report.combined.parts import Chapter, Picture, Workshop
from harness.report.labels import plural
from harness.report.sections import Cell, Table
from harness.report.style import inline
from harness.report.tables import to_csv

SLUG, QUESTION = "audit", "Which statements of the paper hold?"
DIRECTORY = "audit"
KINDS = {"bad": "bad", "good": "good", "open": "warn"}

Records = Mapping[str, Mapping[str, Any]]


def audit_chapter(shop: Workshop) -> Chapter:
    """A line for each statement, and the smallest example that was found, drawn."""
    directory = shop.results / DIRECTORY
    records = {name: r for name, r in read_verdicts(directory).items() if name in CLAIMS}
    if not records:
        return Chapter(SLUG, QUESTION, missing="No audit is stored here yet (avd audit makes it).")
    tones = {name: tone(CLAIMS[name], record) for name, record in records.items()}
    against = [CLAIMS[name] for name in records if tones[name] == "bad"]
    refuted = [claim.title for claim in against if claim.kind != "growth"]
    above = [claim.title for claim in against if claim.kind == "growth"]
    tried = sum(record["tally"]["holds"] + record["tally"]["fails"] for record in records.values())
    sentences = [
        f"{plural(len(records), 'reading')} of the paper’s statements, tried on {tried} instances "
        f"in all: {sum(t == 'good' for t in tones.values())} held, {len(refuted)} did not, "
        f"{sum(t == 'open' for t in tones.values())} remain open. What held is not thereby proved; "
        "what did not has a counterexample below."
    ]
    if refuted:
        sentences.append(f"Not as stated: {'; '.join(refuted)}.")
    if above:
        sentences[0] += f" {plural(len(above), 'statement')} on growth exceeded the bound set here."
        sentences.append(
            f"Above the bound set here, which is all that single counts refute: {'; '.join(above)}."
        )
    return Chapter(
        SLUG,
        QUESTION,
        f"{len(refuted)} of {len(records)} readings fail" if against else "All that were tried",
        "faster" if against else "",
        sentences,
        list(_pictures(shop, directory, records, tones)),
        [_table(records, tones)],
        [
            "Each statement was tested in the reading that the audit’s own report gives in full, "
            "with what counts as a failure, what decides, and the instance files."
        ],
        [shop.download("statements", to_csv(_frame(records, tones)))],
        [DIRECTORY],
        is_small=True,
    )


def _table(records: Records, tones: Mapping[str, str]) -> Table:
    rows = []
    for name, record in records.items():
        claim, counts = CLAIMS[name], [str(record["tally"][outcome]) for outcome in OUTCOMES]
        rows.append(
            [
                Cell(claim.title),
                Cell(claim.gloss),
                Cell(str(record["verdict"]), tones[name], KINDS[tones[name]]),
                *(Cell("" if count == "0" else count, count) for count in counts),
            ]
        )
    head = ["statement", "what it says", "verdict", *OUTCOMES]
    return Table("Statements, in the order of the paper", head, rows)


def _frame(records: Records, tones: Mapping[str, str]) -> pd.DataFrame:
    return pd.DataFrame.from_records(
        [
            {
                "claim": name,
                "title": CLAIMS[name].title,
                "says": CLAIMS[name].gloss,
                "verdict": record["verdict"],
                "tone": tones[name],
                **{outcome: record["tally"][outcome] for outcome in OUTCOMES},
            }
            for name, record in records.items()
        ]
    )


def _pictures(
    shop: Workshop, directory: Path, records: Records, tones: Mapping[str, str]
) -> Iterator[Picture]:
    """The smallest counterexample of each statement about a diagram that failed."""
    for name, record in records.items():
        example = record.get("example")
        path = directory / INSTANCES / f"{name}.json"
        if tones[name] == "bad" and example and example["domain"] and path.exists():
            document = example_svg(read_instance(path), example)
            where = f"{DIRECTORY}/figures/{name}.svg"
            shop.files[where] = document
            caption = _caption(CLAIMS[name], record)
            shown = inline(document, f"audit-{name}", f"{CLAIMS[name].title}. {caption}")
            title = f"{CLAIMS[name].title} ({CLAIMS[name].gloss})"
            yield Picture(f"audit-{name}", title, caption, shown, where)


def _caption(claim: Claim, record: Mapping[str, Any]) -> str:
    """The verdict, and what the example shows."""
    example = record["example"]
    place = "the plane" if example["domain"] == "plane" else f"the {example['domain']}"
    word = "Smallest instance above the bound" if claim.kind == "growth" else "Counterexample"
    text = f"{str(record['verdict']).capitalize()}. {word}, {example['n']} segments, in {place}"
    text += f": {example['message']}."
    return text + (" Rings mark the place." if example["marks"] else "")
