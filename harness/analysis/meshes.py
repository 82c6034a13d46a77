"""Does mesh improvement pay?  What the rows of the study of meshes say, method by method.

Two comparisons: with the mesh as it was, and with smart Laplacian smoothing of the same mesh,
which is the simplest method that makes no star worse.  A method *pays* for a purpose if it is
better than smart Laplacian smoothing there on more than half of the meshes.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from harness.study.meshes import METHODS

Row = Mapping[str, str]
PLAIN = "smart-laplacian"
PAPER = "apex"
SAME = 1e-6
"""Differences that are none: degrees, or shares."""
PURPOSES = {
    "the smallest angle": ("smallest", 1),
    "the solver's iterations": ("iterations", -1),
    "the discretisation error": ("error", -1),
}
"""Purpose → the column, and whether more (1) or less (−1) of it is better."""


@dataclass(frozen=True)
class MethodFindings:
    """What one method did on ``meshes`` meshes.

    ``rose``, ``fell``: on how many the smallest angle did; ``inverted``: on how many triangles
    were; ``failed``: tasks that ended otherwise.  ``smallest_before``, ``smallest``: medians, in
    degrees.  ``iterations``, ``error``: medians of the ratios after/before, None if unknown.
    ``better``: purpose → on how many meshes it is better than smart Laplacian smoothing, of
    ``compared``.  ``slower``: the median ratio of its seconds to that method's.
    """

    method: str
    meshes: int
    failed: int
    rose: int
    fell: int
    inverted: int
    smallest_before: float
    smallest: float
    iterations: float | None
    error: float | None
    better: Mapping[str, int]
    compared: int
    slower: float | None

    @property
    def pays_for(self) -> list[str]:
        """The purposes for which it is better than smart Laplacian smoothing on most meshes."""
        return [name for name, count in self.better.items() if 2 * count > self.compared]

    @property
    def line(self) -> str:
        """All of this in one line."""
        parts = [
            f"{self.method}: smallest angle up on {self.rose} of {self.meshes} meshes, down on "
            f"{self.fell}, median {self.smallest_before:.2f}° → {self.smallest:.2f}°"
        ]
        if self.inverted:
            parts.append(f"triangles inverted on {self.inverted}")
        if self.failed:
            parts.append(f"{self.failed} tasks failed")
        if self.iterations is not None and self.error is not None:
            parts.append(f"iterations × {self.iterations:.2f}, error × {self.error:.2f}")
        if self.method != PLAIN and self.slower is not None:
            shares = ", ".join(f"{name} on {count}" for name, count in self.better.items())
            parts.append(
                f"better than {PLAIN} for {shares} of {self.compared}, in {self.slower:.2g} times "
                "its time"
            )
        return "; ".join(parts) + "."


def findings(rows: Sequence[Row]) -> list[MethodFindings]:
    """What the rows say of each method that has any, in the order of the study."""
    plain = {_mesh(row): row for row in rows if row["method"] == PLAIN and row["status"] == "ok"}
    found = []
    for method in METHODS:
        mine = [row for row in rows if row["method"] == method]
        done = [row for row in mine if row["status"] == "ok"]
        if done:
            found.append(_findings(method, done, len(mine) - len(done), plain))
    return found


def _findings(
    method: str, rows: Sequence[Row], failed: int, plain: Mapping[tuple[str, ...], Row]
) -> MethodFindings:
    gains = [float(row["smallest"]) - float(row["smallest_before"]) for row in rows]
    pairs = [(row, plain[_mesh(row)]) for row in rows if _mesh(row) in plain]
    return MethodFindings(
        method=method,
        meshes=len(rows),
        failed=failed,
        rose=sum(gain > SAME for gain in gains),
        fell=sum(gain < -SAME for gain in gains),
        inverted=sum(int(row["inverted"]) > 0 for row in rows),
        smallest_before=median(rows, "smallest_before"),
        smallest=median(rows, "smallest"),
        iterations=_ratio((row["iterations"], row["iterations_before"]) for row in rows),
        error=_ratio((row["error"], row["error_before"]) for row in rows),
        better={
            purpose: sum(_is_better(row, other, column, sign) for row, other in pairs)
            for purpose, (column, sign) in PURPOSES.items()
        },
        compared=len(pairs),
        slower=_ratio((row["seconds"], other["seconds"]) for row, other in pairs),
    )


def _mesh(row: Row) -> tuple[str, ...]:
    return row["family"], row["n"], row["seed"]


def _is_better(row: Row, other: Row, column: str, sign: int) -> bool:
    """Whether a row is better; where nothing could be solved it is not."""
    if not row[column] or not other[column]:
        return bool(row[column])
    return sign * (float(row[column]) - float(other[column])) > SAME


def median(rows: Sequence[Row], column: str) -> float:
    """The median of a column."""
    return statistics.median(float(row[column]) for row in rows)


def _ratio(pairs: Iterable[tuple[str, str]]) -> float | None:
    """The median of first / second, where both are known."""
    known = [(float(a), float(b)) for a, b in pairs if a and b and float(b) > 0]
    return statistics.median(a / b for a, b in known) if known else None


def answer(found: Sequence[MethodFindings]) -> str:
    """The paper's question, answered in one sentence for each method that goes by angles."""
    said: dict[str, list[str]] = {}
    for each in found:
        if METHODS[each.method].objective in ("apex", "all") and each.compared:
            pays = each.pays_for
            said.setdefault(_listed(pays) or "nothing", []).append(each.method)
    if not said:
        return "Does it pay? These rows do not tell."
    parts = [f"for {purposes}: {'; '.join(methods)}" for purposes, methods in said.items()]
    return (
        "Does it pay, beside smart Laplacian smoothing? "
        + ". ".join(part[0].upper() + part[1:] for part in parts)
        + "."
    )


def _listed(names: Sequence[str]) -> str:
    """As a sentence has them: a, b and c."""
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def lines(found: Sequence[MethodFindings]) -> list[str]:
    """The answer, and what it rests on, for a terminal."""
    return [answer(found), *(each.line for each in found)]
