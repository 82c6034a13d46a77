"""A plate: one figure for print, its title, its caption and the commands that make it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from harness.errors import UserError
from harness.report.slim import slim
from harness.report.style import FORMATS, in_style, saved


@dataclass(frozen=True)
class Plate:
    """A figure that ``avd figures`` makes.

    ``size``: width and height in inches.  ``draw`` fills a figure of that size and returns the
    caption, with every number in it taken from what was drawn; its argument is the directory of
    results, from which only plates with ``studies`` read.  ``studies``: the studies there whose
    rows it shows, any one of which will do; ``data`` makes of them the table that is plotted.
    ``recipe``: commands that reproduce what it shows.
    """

    name: str
    title: str
    size: tuple[float, float]
    draw: Callable[[Figure, Path], str]
    recipe: tuple[str, ...] = ()
    studies: tuple[str, ...] = ()
    data: Callable[[Path], pd.DataFrame] | None = None

    def lacks(self, results: Path) -> str:
        """Why it cannot be drawn from these results; empty if it can."""
        if not self.studies or any((results / s / "rows.csv").exists() for s in self.studies):
            return ""
        return f"no rows of {' or '.join(self.studies)} in {results}"

    def entry(self, caption: str) -> dict[str, object]:
        """What is said about it, for ``captions.json``."""
        commands = (*self.recipe, f"avd figures {self.name}")
        return {"title": self.title, "caption": caption, "recipe": list(commands)}


def printed(plate: Plate, results: Path, form: str = "svg") -> tuple[bytes, str]:
    """The bytes of a plate in one of the ``FORMATS``, and its caption.

    The same bytes for the same rows, with the same versions of numpy and matplotlib.  Raises
    UserError for another format or if the rows it shows are missing.
    """
    if form not in FORMATS:
        raise UserError(f"cannot draw {form!r}: choose from {', '.join(FORMATS)}")
    if lacking := plate.lacks(results):
        raise UserError(f"figure {plate.name}: {lacking}")
    with in_style({"path.simplify": False}):
        figure = Figure(figsize=plate.size)
        caption = plate.draw(figure, results)
        picture = saved(figure, form)
    return (slim(picture.decode()).encode() if form == "svg" else picture), caption
