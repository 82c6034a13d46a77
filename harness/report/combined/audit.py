"""What becomes of the paper's statements, one by one: from the verdicts of ``avd audit``."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

from harness.errors import UserError
from harness.report.combined.parts import Chapter, Picture, Workshop
from harness.report.labels import plural
from harness.report.sections import Cell, Table
from harness.report.style import inline

SLUG, QUESTION = "audit", "Which statements of the paper hold?"
DIRECTORY = "audit"
OUTCOMES = ("holds", "fails", "undecided", "outside")


def audit_chapter(shop: Workshop) -> Chapter:
    """A line for each statement, and the smallest example that was found, drawn."""
    directory = shop.results / DIRECTORY
    records = _records(directory / "verdicts.json")
    if not records:
        missing = "No audit is stored here yet (avd audit makes it)."
        return Chapter(SLUG, QUESTION, missing=missing)
    failing = [name for name, record in records.items() if record["tally"].get("fails")]
    rows = [_row(name, record) for name, record in records.items()]
    tried = sum(int(r["tally"].get(o, 0)) for r in records.values() for o in OUTCOMES[:2])
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["claim", "verdict", *OUTCOMES])
    for name, record in records.items():
        tally = record["tally"]
        writer.writerow([name, record["verdict"], *(tally.get(o, 0) for o in OUTCOMES)])
    return Chapter(
        SLUG,
        QUESTION,
        f"{len(records) - len(failing)} of {len(records)} readings survive",
        "",
        [
            f"{plural(len(records), 'reading')} of the paper’s statements as executable checks, "
            f"{tried} verdicts on single instances. A failure is a counterexample, or, for a "
            "statement that something exists, an instance without it; what survives is not "
            "thereby proved."
        ],
        _pictures(directory, records),
        [Table("Statements, as tested", ["statement", "verdict", *OUTCOMES], rows)],
        downloads=[shop.download("audit", text.getvalue())],
        sources=[DIRECTORY],
    )


def _records(path: Path) -> dict[str, Any]:
    if not path.exists():
        return {}
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise UserError(f"{path}: cannot be read: {error}") from None
    if not isinstance(found, dict) or not all(
        isinstance(record, dict) and {"verdict", "tally"} <= set(record)
        for record in found.values()
    ):
        raise UserError(f"{path}: not the verdicts of an audit")
    return found


def _row(name: str, record: dict[str, Any]) -> list[Cell]:
    verdict = str(record["verdict"])
    kind = "bad" if verdict.startswith("fails") else "good"
    if verdict.startswith(("nothing", "no example")):
        kind = "warn"
    counts = [str(record["tally"].get(outcome, 0)) for outcome in OUTCOMES]
    return [
        Cell(str(record.get("title", name))),
        Cell(verdict, verdict, kind),
        *(Cell("" if count == "0" else count, count) for count in counts),
    ]


def _pictures(directory: Path, records: dict[str, Any]) -> list[Picture]:
    """The drawings that the audit left, of the examples it found."""
    found = []
    for name, record in records.items():
        for path in sorted(directory.glob(f"*/{name}.svg")):
            example = record.get("example") or {}
            caption = f"{record['verdict']}. {example.get('message', '')}".strip()
            document = path.read_text(encoding="utf-8")
            where = f"{DIRECTORY}/{path.parent.name}/{path.name}"
            title = str(record.get("title", name))
            shown = inline(document, f"audit-{name}", f"{title}. {caption}")
            found.append(Picture(f"audit-{name}", title, caption, shown, where))
    return found
