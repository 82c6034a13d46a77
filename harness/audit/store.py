"""What an audit leaves behind: rows, verdicts, instance files, a manifest.

``rows.csv`` has one row for every instance tried, ``verdicts.json`` one record for every finished
claim, ``instances/NAME.json`` the example of a claim.  All of them are rewritten in one step
whenever a claim is finished, so an interrupted audit keeps its finished claims.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import harness
from harness.audit.claim import OUTCOMES, Row
from harness.errors import UserError
from harness.files import read_object, replace

ROWS, VERDICTS, MANIFEST, INSTANCES = "rows.csv", "verdicts.json", "manifest.json", "instances"
COLUMNS = ("claim", "family", "n", "params", "seed", "outcome", "message", "facts")

Record = dict[str, Any]


def read_verdicts(directory: Path) -> dict[str, Record]:
    """The records of the finished claims, by name; none where there is no audit.

    Raises UserError if the file is damaged.
    """
    path = directory / VERDICTS
    records = read_object(path, "the verdicts of an audit")
    if records is None:
        return {}
    if not all(
        isinstance(record, dict) and {"claim", "count", "seed", "tally", "verdict"} <= set(record)
        for record in records.values()
    ):
        raise UserError(f"{path}: not the verdicts of an audit")
    return records


def read_rows(directory: Path) -> list[Row]:
    """All rows; none where there is no audit.  Raises UserError for other files."""
    path = directory / ROWS
    if not path.exists():
        return []
    reader = csv.DictReader(io.StringIO(path.read_text(encoding="utf-8")))
    if tuple(reader.fieldnames or ()) != COLUMNS:
        raise UserError(f"{path}: not the rows of an audit")
    return [_row(record, f"{path}: line {reader.line_num}") for record in reader]


def is_audit(directory: Path) -> bool:
    """Whether a directory holds an audit, going by the head of its rows."""
    try:
        with open(directory / ROWS, encoding="utf-8") as file:
            return file.readline().rstrip("\n") == ",".join(COLUMNS)
    except (OSError, UnicodeDecodeError):
        return False


def write_claim(
    directory: Path,
    record: Record,
    rows: Sequence[Row],
    example: str | None,
    order: Sequence[str],
) -> None:
    """Store a finished claim in place of an earlier run of it.

    ``example``: the text of its instance file, or None; ``order``: of all claims.  The verdict
    comes last: where it is, everything else is.
    """
    name = record["claim"]
    kept = [row for row in read_rows(directory) if row.claim != name] + list(rows)
    kept.sort(key=lambda row: order.index(row.claim) if row.claim in order else len(order))
    replace(directory / ROWS, as_csv(kept).encode())
    path = directory / INSTANCES / f"{name}.json"
    if example is None:
        path.unlink(missing_ok=True)
    else:
        path.parent.mkdir(exist_ok=True)
        replace(path, example.encode())
    records = {**read_verdicts(directory), name: record}
    ordered = {key: records[key] for key in (*order, *records) if key in records}
    replace(directory / VERDICTS, as_json(ordered).encode())


def write_manifest(directory: Path, command: str, seed: int, replaced: Sequence[str]) -> None:
    """Say what made the rows: this run, and earlier ones of whose claims some are kept.

    ``replaced``: the claims that this run tries anew.
    """
    from harness.study.manifest import git_commit, machine, versions
    from harness.study.task import SEED_RULE

    earlier = _runs(directory) if set(read_verdicts(directory)) - set(replaced) else []
    commit = git_commit()
    run = {"command": command, "base_seed": seed, "avd": harness.__version__, "commit": commit}
    manifest = {
        "study": "audit",
        "description": "The paper's statements as executable checks",
        "avd": harness.__version__,
        "commit": commit,
        "versions": versions(),
        "machine": machine(),
        "seeds": SEED_RULE,
        "runs": [*earlier, run],
    }
    replace(directory / MANIFEST, as_json(manifest).encode())


def _runs(directory: Path) -> list[Any]:
    """The runs that a manifest knows; none if it cannot be read."""
    try:
        manifest = read_object(directory / MANIFEST, "a manifest") or {}
    except UserError:
        return []
    runs = manifest.get("runs")
    return runs if isinstance(runs, list) else []


def as_json(value: Mapping[str, Any]) -> str:
    """Indented JSON with a line end."""
    return json.dumps(value, indent=1, ensure_ascii=False) + "\n"


def as_csv(rows: Sequence[Row]) -> str:
    """The rows as text."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        facts = json.dumps(dict(row.facts), separators=(",", ":"))
        writer.writerow(
            (row.claim, row.family, row.n, row.params, row.seed, row.outcome, row.message, facts)
        )
    return text.getvalue()


def _row(record: dict[str, str], where: str) -> Row:
    try:
        outcome = record["outcome"]
        if outcome not in OUTCOMES:
            raise ValueError(f"unknown outcome {outcome!r}")
        return Row(
            record["claim"],
            record["family"],
            int(record["n"]),
            record["params"],
            int(record["seed"]),
            outcome,
            record["message"],
            json.loads(record["facts"]),
        )
    except (TypeError, ValueError) as error:
        raise UserError(f"{where}: not the row of an audit: {error}") from None
