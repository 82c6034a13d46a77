"""The rows of a study on disk: appended one by one, never half, never lost.

``rows.csv`` holds one row for each finished task of the study beside it (``study.toml``) and no
other row, so one ``pandas.read_csv`` reads it right.  Rows that leave it (their task left the
study, or is to be run again) go to ``rows-aside.csv``; they are never deleted.
"""

from __future__ import annotations

import csv
import io
import os
import shutil
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from harness.errors import UserError
from harness.files import replace
from harness.study.checks import check_row
from harness.study.outcome import COLUMNS
from harness.study.schema import Record, migrate_row

ROWS = "rows.csv"
ASIDE = "rows-aside.csv"


def read_rows(path: Path) -> list[Record]:
    """The whole rows of a file, as the present schema has them; none if there is no file.

    A last line that was torn (a run was killed while writing it) is left out.  Raises UserError
    naming the file and the line of a damaged row, or if a newer program wrote it.
    """
    if not path.exists():
        return []
    lines = _cells(path)
    header = next(lines, list(COLUMNS))
    rows = []
    for number, cells in enumerate(lines, start=2):
        where = f"{path} line {number}"
        if len(cells) != len(header):
            raise UserError(f"{where}: {len(cells)} cells under {len(header)} columns")
        record = migrate_row(dict(zip(header, cells, strict=True)), where)
        missing = [column for column in COLUMNS if column not in record]
        if missing:
            raise UserError(f"{where}: no column {missing[0]!r}")
        check_row(record, where)
        rows.append({column: record[column] for column in COLUMNS})
    return rows


def _cells(path: Path) -> Iterator[list[str]]:
    """The cells of every whole line; a spreadsheet's byte order mark is no part of them."""
    lines = csv.reader(io.StringIO(_whole_lines(path).decode("utf-8-sig", errors="replace")))
    try:
        yield from lines
    except csv.Error as error:
        raise UserError(f"{path} line {lines.line_num}: not CSV: {error}") from None


def _whole_lines(path: Path) -> bytes:
    content = path.read_bytes()
    return content[: content.rfind(b"\n") + 1]


class RowFile:
    """A rows file open for appending; use it as a context manager, under the study's lock."""

    def __init__(self, path: Path) -> None:
        """Open ``path``; drop a torn last line, write the header if there is none.

        A file of an older schema is migrated; the original stays beside it, as ``*.old``.
        Raises UserError (see ``read_rows``).
        """
        self.rows = read_rows(path)
        if path.exists() and not _is_current(path):
            shutil.copy2(path, path.with_name(path.name + ".old"))
            replace_rows(path, self.rows)
        self._file = open(path, "ab")  # noqa: SIM115 (closed by __exit__)
        self._file.truncate(len(_whole_lines(path)))
        if self._file.seek(0, os.SEEK_END) == 0:
            self._write(dict(zip(COLUMNS, COLUMNS, strict=True)))

    def append(self, row: Record) -> None:
        """Add a row; on return it is on the disk."""
        self._write(row)
        self.rows.append(row)

    def _write(self, row: Record) -> None:
        self._file.write(as_lines([row]))
        self._file.flush()
        os.fsync(self._file.fileno())

    def __enter__(self) -> Self:
        """The file, open."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the file."""
        self._file.close()


def _is_current(path: Path) -> bool:
    """Whether the header is the present one, or not yet there."""
    header = _whole_lines(path).split(b"\n", 1)[0].decode("utf-8", errors="replace")
    return header in ("", ",".join(COLUMNS))


def as_lines(rows: Iterable[Record]) -> bytes:
    """The rows as CSV lines (no header)."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writerows(rows)
    return text.getvalue().encode()


def set_aside(directory: Path, leaving: Sequence[Record], staying: Sequence[Record]) -> None:
    """Move rows out of ``rows.csv``: first they are safe in the other file, then they leave."""
    if leaving:
        with RowFile(directory / ASIDE) as aside:
            for row in leaving:
                aside.append(row)
        replace_rows(directory / ROWS, staying)


def replace_rows(path: Path, rows: Iterable[Record]) -> None:
    """Write a rows file anew, in one step."""
    header = dict(zip(COLUMNS, COLUMNS, strict=True))
    replace(path, as_lines([header, *rows]))
