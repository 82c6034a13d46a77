"""A directory of plates: one file for each, and their captions beside them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from harness.files import read_object, replace
from harness.report.plates.plate import Plate, printed
from harness.report.tables import to_csv

CAPTIONS = "captions.json"


@dataclass(frozen=True)
class Shown:
    """A plate as it lies there: its SVG document and what is said about it."""

    name: str
    title: str
    caption: str
    recipe: tuple[str, ...]
    document: str


def put(plate: Plate, directory: Path, results: Path, form: str = "svg") -> Path:
    """Draw a plate into a directory, with the table behind it and its caption; its path.

    Raises UserError if the rows it shows are missing, or the captions there are damaged.
    """
    entries = captions(directory)
    picture, caption = printed(plate, results, form)
    directory.mkdir(parents=True, exist_ok=True)
    path = directory / f"{plate.name}.{form}"
    replace(path, picture)
    if plate.data is not None:
        replace(directory / f"{plate.name}.csv", to_csv(plate.data(results)).encode())
    entries[plate.name] = plate.entry(caption)
    ordered = {name: entries[name] for name in sorted(entries)}
    text = json.dumps(ordered, indent=2, ensure_ascii=False) + "\n"
    replace(directory / CAPTIONS, text.encode())
    return path


def captions(directory: Path) -> dict[str, Any]:
    """The entries of a directory's ``captions.json``; none if there is no such file."""
    return read_object(directory / CAPTIONS, "a list of captions") or {}


def shelf(directory: Path) -> dict[str, Shown]:
    """The plates that lie in a directory as SVG with a caption, by name.

    Raises UserError if the captions are damaged.
    """
    found = {}
    for name, entry in captions(directory).items():
        path = directory / f"{name}.svg"
        if path.exists() and isinstance(entry, Mapping):
            found[name] = Shown(
                name,
                str(entry.get("title", name)),
                str(entry.get("caption", "")),
                tuple(str(command) for command in entry.get("recipe", ())),
                path.read_text(encoding="utf-8"),
            )
    return found
