"""All studies of a directory in one page: answers first, then evidence, then method and limits."""

from __future__ import annotations

from pathlib import Path

__all__ = ["is_collection", "write_collection"]


def is_collection(directory: Path) -> bool:
    """Whether a directory holds studies, and is none itself."""
    return (
        directory.is_dir()
        and not (directory / "rows.csv").exists()
        and next(directory.glob("*/rows.csv"), None) is not None
    )


def write_collection(directory: Path) -> tuple[Path, list[str]]:
    """Write ``report.html`` of a directory of studies; its path, and the answers for a terminal.

    The page is one file that opens offline; beside it go its tables (``data/``) and the plots of
    stored rows (``figures/``).  Chapters whose rows are missing say so.  The same rows, and the
    same files of ``avd figures``, give the same bytes.  Raises UserError for damaged rows.
    """
    from harness.report.combined.page import write

    return write(directory)
