"""What people look at: the report of a study, one HTML file that needs nothing else; drawings."""

from __future__ import annotations

from pathlib import Path

__all__ = ["report_with_lines", "summary_lines", "write_report"]


def write_report(directory: Path) -> Path:
    """Write ``report.html``, its figures and derived tables into a study's directory.

    The same rows and manifest give the same bytes (with the same numpy and matplotlib).  Raises
    UserError if ``directory`` is no study, has no rows, or was written by a newer program.
    """
    return report_with_lines(directory)[0]


def summary_lines(directory: Path) -> list[str]:
    """The verdicts of a study, for a terminal.  Raises UserError as ``write_report`` does."""
    from harness.report.build import read

    return read(directory).lines


def report_with_lines(directory: Path) -> tuple[Path, list[str]]:
    """Both of the above from one analysis; also of meshes, of an audit, and of all of these.

    Of a directory that holds studies and is none, one page about all of them.
    """
    from harness.audit.store import is_audit
    from harness.report.combined import is_collection
    from harness.study.mesh_rows import is_mesh_study

    if is_collection(directory):
        from harness.report.combined import write_collection

        return write_collection(directory)
    if is_audit(directory):
        from harness.report.audit_page import write_audit_page

        return write_audit_page(directory)
    if is_mesh_study(directory):
        from harness.report.mesh_report import write_mesh_report

        return write_mesh_report(directory)
    from harness.report.build import read, write

    study = read(directory)
    return write(study, directory), study.lines
