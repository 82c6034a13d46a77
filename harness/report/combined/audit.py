"""What becomes of the paper's statements, one by one: from the verdicts of ``avd audit``."""

from __future__ import annotations

from collections import Counter
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
    refuted = [claim for claim in _claims(tones, "bad") if claim.kind != "growth"]
    return Chapter(
        SLUG,
        QUESTION,
        f"{len(refuted)} of {len(records)} readings fail" if refuted else "None was refuted",
        "faster" if refuted else "",
        list(_sentences(records, tones)),
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


def _claims(tones: Mapping[str, str], wanted: str) -> list[Claim]:
    return [CLAIMS[name] for name, tone in tones.items() if tone == wanted]


def _sentences(records: Records, tones: Mapping[str, str]) -> Iterator[str]:
    """How many readings held, stayed within bounds or failed, and which did not hold."""
    tried = sum(record["tally"]["holds"] + record["tally"]["fails"] for record in records.values())
    held = Counter(claim.kind for claim in _claims(tones, "good"))
    refuted = [claim for claim in _claims(tones, "bad") if claim.kind != "growth"]
    above = [claim for claim in _claims(tones, "bad") if claim.kind == "growth"]
    yield (
        f"{plural(len(records), 'reading')} of the paper’s statements, {tried:,} checks in all. "
        f"Of {len(refuted) + held['for all']} about every instance, {held['for all']} held "
        "wherever they were tried, which proves nothing, and each of the other "
        f"{len(refuted)} has a counterexample below. Of {len(above) + held['growth']} about "
        f"growth, {held['growth']} stayed within the bound set here and {len(above)} exceeded it. "
        f"Shown by a witness: {held['there is']} of existence. "
        f"Open: {len(_claims(tones, 'open')) or 'none'}."
    )
    for words, claims in (
        ("Not as stated", [claim for claim in refuted if not claim.beyond]),
        (
            "Failing in a reading that says more than the paper’s words must",
            [claim for claim in refuted if claim.beyond],
        ),
        ("Above the bound set here, which is all that single counts refute", above),
    ):
        if claims:
            yield f"{words}: {'; '.join(claim.title for claim in claims)}."


def _table(records: Records, tones: Mapping[str, str]) -> Table:
    rows = []
    for name, record in records.items():
        claim, tally = CLAIMS[name], dict(record["tally"])
        if claim.kind == "there is":
            tally["fails"] = 0  # one without the property is no failure; the verdict says how many
        counts = [str(tally[outcome]) for outcome in OUTCOMES]
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
