"""The page of all studies: chapters, provenance, files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from harness.files import read_object
from harness.report.combined.audit import audit_chapter
from harness.report.combined.growth import linear_chapter
from harness.report.combined.parts import Chapter, Maker, Workshop, view
from harness.report.combined.practice import bench_chapter, mesh_chapter
from harness.report.combined.weaves import constant_chapter, noise_chapter
from harness.report.page import method_facts
from harness.report.pages import REPORT, environment, write_files
from harness.report.provenance import entries
from harness.study.manifest import MANIFEST, read_manifest
from harness.study.store import ROWS

CHAPTERS: tuple[Maker, ...] = (
    linear_chapter,
    constant_chapter,
    noise_chapter,
    audit_chapter,
    mesh_chapter,
    bench_chapter,
)
GALLERY = ("figure-1", "figure-2", "figure-3", "figure-4", "star", "peaks", "families")


def outputs(directory: Path) -> tuple[dict[str, str], list[str]]:
    """Every file of the report, by its path in the directory, and the answers for a terminal."""
    shop = Workshop(directory)
    chapters = [make(shop) for make in CHAPTERS]
    page = _page(shop, chapters)
    return {**shop.files, REPORT: page}, lines(chapters)


def write(directory: Path) -> tuple[Path, list[str]]:
    """Write the report; returns its page and the answers for a terminal."""
    files, answers = outputs(directory)
    return write_files(directory, files), answers


def lines(chapters: Sequence[Chapter]) -> list[str]:
    """Question and answer, chapter by chapter."""
    return [f"{c.question} {c.missing or c.answer + '.'}" for c in chapters]


def _page(shop: Workshop, chapters: Sequence[Chapter]) -> str:
    sources = list(dict.fromkeys(name for chapter in chapters for name in chapter.sources))
    return (
        environment()
        .get_template("combined.html")
        .render(
            chapters=[view(chapter) for chapter in chapters],
            gallery=shop.shelved(GALLERY),
            sources=[_source(shop.results, name) for name in sources],
            method=method_facts(),
        )
        + "\n"
    )


def _source(results: Path, name: str) -> dict[str, Any]:
    """A study as the page lists it: where it lies, its report, what its manifest says."""
    directory = results / name
    manifest = _manifest(directory)
    return {
        "name": name,
        "rows": f"{name}/rows.csv" if (directory / ROWS).exists() else "",
        "report": f"{name}/report.html" if (directory / REPORT).exists() else "",
        "description": str((manifest or {}).get("description") or ""),
        "provenance": entries(manifest),
    }


def _manifest(directory: Path) -> dict[str, Any] | None:
    """The manifest; those of the audit and of meshes have no schema that could be too new."""
    found = read_object(directory / MANIFEST, "a manifest")
    return read_manifest(directory) if found and "schema" in found else found
