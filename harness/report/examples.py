"""One small instance of every family, drawn: what the curves count."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from harness.analysis import GroupGrowth
from harness.report.slim import slim
from harness.report.style import inline

if TYPE_CHECKING:
    from harness.diagram.planar_map import PlanarMap

#: Segments at most, so that the reference builder takes about a second.
MOST = {"kernel": 12, "interior": 8, "plane": 6}
#: Inches.
WIDTH = 3.4


@dataclass(frozen=True)
class Example:
    """The picture of one instance: the document, the same inline, and a caption."""

    path: str
    document: str
    svg: str
    caption: str


def example(groups: Sequence[GroupGrowth]) -> Example | None:
    """The picture of an instance among the rows of a family's groups; None if none is small.

    The largest small one, and of those the first in order of seeds.  It is generated and built
    anew; if it does not have the counts that its row has (the row is of another version of the
    family), there is no picture.
    """
    for analysed in groups:
        row = _small_row(analysed)
        diagram = row and _built(analysed, row)
        if row and diagram:
            return _drawn(analysed, row, diagram)
    return None


def _small_row(analysed: GroupGrowth) -> dict[str, Any] | None:
    rows = analysed.group.rows
    small = rows[(rows["status"] == "ok") & (rows["segments"] <= MOST[analysed.group.key.domain])]
    if small.empty:
        return None
    first = small.sort_values(["n", "seed"], ascending=[False, True], kind="stable").iloc[0]
    return {str(name): value for name, value in first.items()}


def _built(analysed: GroupGrowth, row: dict[str, Any]) -> PlanarMap | None:
    """The diagram of a row, if it has the row's counts."""
    import generators
    from harness.diagram import build
    from harness.errors import UserError
    from harness.geometry.instance import Instance
    from harness.geometry.validation import validate

    key = analysed.group.key
    try:
        made = generators.generate(
            key.family, int(row["n"]), seed=int(row["seed"]), **key.parameters
        )
        instance = Instance.from_generated(made)
        validate(instance)
        diagram = build(instance, key.domain, key.objective)  # type: ignore[arg-type]  # as stored
    except (generators.GeneratorError, UserError):
        return None
    counts = diagram.counts
    found = (counts.cells, counts.edges, counts.vertices)
    return diagram if found == tuple(int(row[c]) for c in ("cells", "edges", "vertices")) else None


def _drawn(analysed: GroupGrowth, row: dict[str, Any], diagram: PlanarMap) -> Example:
    from harness.report.drawing import counts_line, render

    document = _coarse(render(diagram, width=WIDTH, caption="").decode())
    key = analysed.group.key
    caption = f"n = {row['segments']}, seed {row['seed']}: {counts_line(diagram)}"
    name = f"example-{re.sub(r'[^a-z0-9]+', '-', key.family.lower())}"
    words = f"A diagram of the family {key.family}, {caption}"
    return Example(f"figures/{name}.svg", document, inline(document, name, words), caption)


def _coarse(svg: str) -> str:
    """The document with the paths' coordinates to a tenth of a point: nobody sees more."""
    return slim(re.sub(r'\bd="([^"]*)"', lambda path: f'd="{_coarse_path(path[1])}"', svg))


def _coarse_path(path: str) -> str:
    """The path, without the lines that are then of no length."""
    commands = re.sub(r"(\.\d)\d+", r"\1", path).split("\n")
    kept: list[str] = []
    last: list[str] = []
    for command in commands:
        if not (command.startswith("L") and command[1:].split() == last):
            kept.append(command)
        last = command[1:].split()
    return "\n".join(kept)
