"""What a chapter of the combined report is made of; all of it comes from rows on the disk."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from harness.report.parts import Part
from harness.report.plates import PLATES, printed
from harness.report.plates.shelf import shelf
from harness.report.sections import Download, Table
from harness.report.style import inline
from harness.report.tables import to_csv

#: The look of an answer: against the paper's expectation, with it, or neither.
Tone = Literal["faster", "slower", ""]


@dataclass(frozen=True)
class Picture:
    """A figure, its caption, its file, and the table behind it, if any; wide ones stand alone."""

    name: str
    title: str
    caption: str
    svg: str
    path: str
    recipe: Sequence[str] = ()
    download: Download | None = None
    is_wide: bool = False


@dataclass(frozen=True)
class Chapter:
    """One question, its answer in a word and in a few sentences, and the evidence.

    ``missing`` says which rows there are none of; then there is no answer.  ``sources`` are the
    studies it was made from, as directories relative to the page.  ``part`` has a template of
    its own, which comes last.  ``is_small``: many small pictures, after the tables.
    """

    slug: str
    question: str
    answer: str = ""
    tone: Tone = ""
    sentences: Sequence[str] = ()
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()
    notes: Sequence[str] = ()
    downloads: Sequence[Download] = ()
    sources: Sequence[str] = ()
    missing: str = ""
    part: Part | None = None
    is_small: bool = False


@dataclass
class Workshop:
    """The directory of results, and the files of the report as they are made."""

    results: Path
    files: dict[str, str] = field(default_factory=dict)

    def plate(self, name: str) -> Picture:
        """A plate of stored rows, drawn anew from them, with its table."""
        plate = PLATES[name]
        document, caption = printed(plate, self.results)
        path = f"figures/{name}.svg"
        self.files[path] = document.decode()
        download = None
        if plate.data is not None:
            download = self.download(name, to_csv(plate.data(self.results)), f"figures/{name}.csv")
        shown = inline(document.decode(), name, f"{plate.title}. {caption}")
        return Picture(name, plate.title, caption, shown, path, (), download)

    def shelved(self, names: Sequence[str], wide: Sequence[str] = ()) -> list[Picture]:
        """Those of these plates that ``avd figures`` has put into the directory."""
        there = shelf(self.results / "figures")
        return [
            Picture(
                name,
                there[name].title,
                there[name].caption,
                inline(there[name].document, name, there[name].title),
                f"figures/{name}.svg",
                there[name].recipe,
                is_wide=name in wide,
            )
            for name in names
            if name in there
        ]

    def download(self, title: str, text: str, path: str = "") -> Download:
        """A table of the page, as a file beside it and a copy inside."""
        made = Download(title, path or f"data/{title}.csv", text)
        self.files[made.path] = text
        return made


#: Makes a chapter from the results; never fails because rows are missing.
Maker = Callable[[Workshop], Chapter]


def absent(slug: str, question: str, studies: Sequence[str]) -> Chapter:
    """A chapter without rows: it says so, and how to get them."""
    commands = " or ".join(f"avd study {name}" for name in studies)
    return Chapter(slug, question, missing=f"No rows are stored here yet ({commands} makes them).")


def share(part: int, whole: int) -> str:
    """all 12, or 11 of 12."""
    return f"all {whole}" if part == whole else f"{part} of {whole}"


def view(chapter: Chapter) -> Mapping[str, Any]:
    """The chapter as the template wants it."""
    return {name: getattr(chapter, name) for name in Chapter.__dataclass_fields__}
