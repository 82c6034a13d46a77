"""``avd report``: write the report of a study, and print its verdicts."""

from __future__ import annotations

import argparse
from pathlib import Path

DESCRIPTION = """\
Analyse the rows of a study and write DIR/report.html, one file that needs nothing else, with its
figures (DIR/figures) and derived tables (DIR/data) beside it.  Prints the path of the report, then
the growth verdicts.  The same rows give the same bytes."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``report``."""
    parser = subparsers.add_parser(
        "report", help="write the report of a study", description=DESCRIPTION, allow_abbrev=False
    )
    parser.add_argument(
        "directory", metavar="DIR", type=Path, help="a study's directory, such as results/quick"
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write the report; exit status 0, or 1 (UserError) if there is no study to report on."""
    from harness.audit.store import is_audit
    from harness.study.meshes import is_mesh_study

    if is_mesh_study(args.directory):
        from harness.report.mesh_report import write_mesh_report as report_with_lines
    elif is_audit(args.directory):
        from harness.report.audit_page import write_audit_page as report_with_lines
    else:
        from harness.report import report_with_lines

    path, lines = report_with_lines(args.directory)
    print(path)
    print("\n".join(lines))
    return 0
