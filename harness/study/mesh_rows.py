"""The rows of the study of meshes on disk: appended one by one, never half, never lost."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from harness.errors import UserError
from harness.files import replace
from harness.study.meshes import COLUMNS, METHODS
from harness.study.outcome import STATUSES
from harness.study.store import ROWS

if TYPE_CHECKING:
    from harness.study.schema import Record

HEAD = ",".join(COLUMNS)


def read_meshes(directory: Path) -> list[Record]:
    """The rows of a mesh study, as text, in an order of their own; none that was cut off.

    Raises:
        UserError: there are none, or what is there cannot be such rows; it names the line.
    """
    path = directory / ROWS
    if not path.exists():
        raise UserError(f"{directory}: no study of meshes here ({ROWS} is missing)")
    lines = csv.reader(io.StringIO(_whole(path).decode("utf-8-sig", errors="replace")))
    if ",".join(next(lines, [])) != HEAD:
        raise UserError(f"{path}: not the rows of a study of meshes")
    rows = []
    for number, cells in enumerate(lines, start=2):
        if len(cells) != len(COLUMNS):
            raise UserError(
                f"{path} line {number}: {len(cells)} cells under {len(COLUMNS)} columns"
            )
        row = dict(zip(COLUMNS, cells, strict=True))
        _check(row, f"{path} line {number}")
        rows.append(row)
    methods = list(METHODS)
    return sorted(
        rows,
        key=lambda row: (
            row["family"],
            int(row["n"]),
            int(row["seed"]),
            methods.index(row["method"]),
        ),
    )


def _check(row: Record, where: str) -> None:
    """Raise UserError if a cell that is looked at later cannot be."""
    for column in ("n", "seed"):
        if not row[column].isdecimal():
            raise UserError(f"{where}: {column}: {row[column]!r} must be a whole number")
    for column, words in (("method", tuple(METHODS)), ("status", STATUSES)):
        if row[column] not in words:
            raise UserError(f"{where}: {column}: {row[column]!r} must be one of {', '.join(words)}")


def is_mesh_study(directory: Path) -> bool:
    """Whether a directory holds rows of this study, going by their head."""
    try:
        with open(directory / ROWS, encoding="utf-8-sig") as file:
            return file.readline().rstrip("\n") == HEAD
    except (OSError, UnicodeDecodeError):
        return False


def write_rows(path: Path, rows: Iterable[Record]) -> None:
    """Write a rows file anew, in one step."""
    replace(path, (HEAD + "\n").encode() + _lines(rows))


def append_row(path: Path, row: Record) -> None:
    """Add a row to a file of whole rows; on return it is on the disk."""
    with open(path, "ab") as file:
        file.write(_lines([row]))
        file.flush()
        os.fsync(file.fileno())


def _whole(path: Path) -> bytes:
    content = path.read_bytes()
    return content[: content.rfind(b"\n") + 1]


def _lines(rows: Iterable[Record]) -> bytes:
    text = io.StringIO()
    csv.DictWriter(text, COLUMNS, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()
