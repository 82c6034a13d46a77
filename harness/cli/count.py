"""``avd count``: what the diagram of each file contains."""

from __future__ import annotations

import argparse
import json
import sys
import time
from typing import TYPE_CHECKING, Any

from harness.cli.options import FORMATS, add_diagram_options, load
from harness.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from harness.diagram.counts import Counts

DESCRIPTION = """\
Build the diagram of every file, exactly, and count its cells, edges and vertices.  A file that
cannot be used is named on standard error and the others are counted all the same; the exit status
is then 1."""

#: The columns of the table for people; everything is in the JSON.
HEADLINES = ("domain", "n", "cells", "edges", "vertices", "regions", "loops", "unbounded")
KINDS = ("triple", "crossing", "saddle")


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``count``."""
    parser = subparsers.add_parser(
        "count",
        help="count cells, edges and vertices of diagrams",
        description=DESCRIPTION,
        allow_abbrev=False,
    )
    parser.add_argument("files", metavar="FILE", nargs="+", help=FORMATS)
    add_diagram_options(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object a line for each file")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Count every file; exit status 0, or 1 if a file could not be used."""
    failed = False
    rows: list[Sequence[str]] = []
    for path in args.files:
        try:
            record = count(path, args)
        except UserError as error:
            print(f"avd: {error}", file=sys.stderr)
            failed = True
            continue
        if args.json:
            print(json.dumps(record, ensure_ascii=False), flush=True)
        else:
            rows.append(_row(record))
    if rows:
        _print_table(rows)
    return 1 if failed else 0


def count(path: str, args: argparse.Namespace) -> dict[str, Any]:
    """The record of one file: the counts, ``seconds`` for building alone, and the file."""
    from harness.diagram import build

    instance = load(path)
    begin = time.perf_counter()
    diagram = build(instance, args.domain, args.objective, args.builder)
    counts: Counts = diagram.counts
    seconds = time.perf_counter() - begin
    named = {} if instance.name is None else {"name": instance.name}
    return {"file": path, **named, **counts.as_dict(), "seconds": round(seconds, 6)}


def _row(record: dict[str, Any]) -> list[str]:
    kinds = [str(record["nodes"][kind]) for kind in KINDS]
    return [record["file"], *(str(record[key]) for key in HEADLINES), *kinds]


def _print_table(rows: Sequence[Sequence[str]]) -> None:
    """Columns aligned: words to the left, numbers to the right."""
    header = ("file", *HEADLINES, *KINDS)
    widths = [max(map(len, column)) for column in zip(header, *rows, strict=True)]
    for row in (header, *rows):
        cells = [
            text.ljust(width) if name in ("file", "domain") else text.rjust(width)
            for name, text, width in zip(header, row, widths, strict=True)
        ]
        print("  ".join(cells).rstrip())
