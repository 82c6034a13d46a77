"""How every page is made and written: the templates' environment, all files in one step each."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from harness.files import replace

REPORT = "report.html"


def environment() -> Environment:
    """Where the templates of the pages are found; a name that is missing is an error."""
    return Environment(
        loader=PackageLoader("harness.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def write_files(directory: Path, files: Mapping[str, str]) -> Path:
    """Write a report's files, by their paths in ``directory``; returns the page's path.

    Each is there whole or not at all, and the page comes last: when it is there, so is
    everything it links to.
    """
    for relative, text in files.items():
        if relative != REPORT:
            path = directory / relative
            path.parent.mkdir(parents=True, exist_ok=True)
            replace(path, text.encode())
    replace(directory / REPORT, files[REPORT].encode())
    return directory / REPORT
