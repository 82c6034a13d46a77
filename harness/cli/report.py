"""``avd report``: write the report of a study or of all studies, and print its verdicts."""

from __future__ import annotations

import argparse
from pathlib import Path

DESCRIPTION = """\
Analyse the rows of a study and write DIR/report.html, one file that needs nothing else, with its
figures (DIR/figures) and derived tables (DIR/data) beside it.  Prints the path of the report, then
the growth verdicts.  The same rows give the same bytes.

Of a directory that holds studies, such as results, the report is one page about all of them: the
answers, the evidence, the method.  It takes figures from DIR/figures (avd figures)."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``report``."""
    parser = subparsers.add_parser(
        "report",
        help="write the report of a study, or of all studies",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "directory",
        metavar="DIR",
        type=Path,
        help="a study's directory, such as results/quick, or results",
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write the report; exit status 0, or 1 (UserError) if there is no study to report on."""
    from harness.report import report_with_lines

    path, lines = report_with_lines(args.directory)
    print(path)
    print("\n".join(lines))
    return 0
