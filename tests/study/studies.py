"""Small studies and how to compare what comes of them."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

from harness.study.outcome import VARYING_COLUMNS
from harness.study.study_file import Study, parse_study


def study(body: str = "", *, head: str = "time_limit = 20") -> Study:
    """A study from the text of its sweeps (default: a dozen tasks of one family)."""
    body = body or '[[sweep]]\nfamily = "star"\nn = [3, 4, 5]\nreplicates = 4\n'
    return parse_study(f'name = "small"\n{head}\n{body}', "small.toml")


def sweep(sizes: Sequence[int], replicates: int = 1) -> str:
    """The text of one sweep."""
    return f'[[sweep]]\nfamily = "star"\nn = {list(sizes)}\nreplicates = {replicates}\n'


def invariant_rows(directory: Path) -> list[dict[str, str]]:
    """The rows, read by nothing but ``csv``, sorted, without the columns that may vary."""
    with open(directory / "rows.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for column in VARYING_COLUMNS:
            del row[column]
    return sorted(rows, key=lambda row: row["task"])
