"""Sections only some studies have: a template, what it shows, and the files beside the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from harness.report.sections import Download
from harness.report.style import inline


@dataclass(frozen=True)
class Figure:
    """A drawing in the page and beside it."""

    path: str
    document: str
    description: str

    @property
    def svg(self) -> str:
        """The drawing as an element of the page."""
        name = self.path.rpartition("/")[2].removesuffix(".svg")
        return inline(self.document, name, self.description)


@dataclass(frozen=True)
class Part:
    """A section of the page of its own: a template, what it shows, and the files beside it."""

    slug: str
    title: str
    template: str
    shown: Mapping[str, Any]
    figures: Sequence[Figure] = ()
    downloads: Sequence[Download] = field(default_factory=tuple)

    @property
    def files(self) -> dict[str, str]:
        """Path and text of everything beside the page."""
        found = {figure.path: figure.document for figure in self.figures}
        found.update({download.path: download.text for download in self.downloads})
        return found
