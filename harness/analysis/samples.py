"""From rows to samples: which tasks belong together, and what each size of a group holds.

A *group* is one curve of the study: all tasks that share family, parameters, domain, objective and
builder.  Within it, tasks with the same requested n are one *size*.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from harness.analysis.models import Floats
from harness.errors import UserError

HEADLINES = ("vertices", "edges", "cells")
IDENTITY = ("family", "params", "domain", "objective", "builder")
COLUMNS = (*IDENTITY, "n", "segments", "replicate", "seed", "status", "message", "certified")

#: Statuses of tasks whose diagram exists but was not counted: what they would have shown is
#: unknown, and most likely large.  (``invalid``: the family made no valid instance; no diagram.)
UNSEEN = ("timeout", "memory", "error")


@dataclass(frozen=True, order=True)
class Key:
    """What identifies a group; ``params`` is JSON with sorted keys."""

    family: str
    params: str
    domain: str
    objective: str
    builder: str

    @property
    def parameters(self) -> dict[str, object]:
        """The generator's parameters as a dictionary."""
        loaded = json.loads(self.params) if self.params else {}
        return dict(loaded)

    @property
    def slug(self) -> str:
        """A name for files: readable, and unique by a digest of the whole identity."""
        digest = hashlib.sha256("\x1f".join(self.fields).encode()).hexdigest()[:8]
        readable = re.sub(r"[^a-z0-9]+", "-", f"{self.family} {self.domain}".lower()).strip("-")
        return f"{readable}-{digest}"

    @property
    def fields(self) -> tuple[str, ...]:
        """The identity in the order of ``IDENTITY``."""
        return (self.family, self.params, self.domain, self.objective, self.builder)

    def seed(self, *use: str) -> int:
        """A seed that depends on the group and on what the numbers are used for, on nothing else.

        Neither the order of rows nor other groups of the study can change a bootstrap interval.
        """
        text = "\x1f".join((*self.fields, *use))
        return int.from_bytes(hashlib.sha256(text.encode()).digest()[:16], "big")


@dataclass(frozen=True)
class Size:
    """The tasks of one group with one requested n."""

    n: int
    rows: pd.DataFrame

    @cached_property
    def counted(self) -> pd.DataFrame:
        """The rows whose task came to its end."""
        return self.rows[self.rows["status"] == "ok"]

    @cached_property
    def failures(self) -> Mapping[str, int]:
        """How many tasks ended with each status other than ok."""
        statuses = self.rows["status"][self.rows["status"] != "ok"]
        return {str(status): int((statuses == status).sum()) for status in sorted(set(statuses))}

    @property
    def unseen(self) -> int:
        """Tasks whose count exists but is unknown (see ``UNSEEN``)."""
        return sum(self.failures.get(status, 0) for status in UNSEEN)

    @property
    def measure(self) -> float:
        """The size on the n axis: the number of segments (their median where it varies)."""
        segments = self.counted["segments"].to_numpy(dtype=np.float64)
        return float(np.median(segments)) if len(segments) else float(self.n)

    @property
    def uncertified(self) -> int:
        """Counted diagrams whose builder did not vouch for every decision."""
        return int((~self.counted["certified"].astype(bool)).sum())

    def counts(self, headline: str) -> Floats:
        """The counts of this size, one per task that came to its end."""
        return self.counted[headline].to_numpy(dtype=np.float64)


@dataclass(frozen=True)
class Group:
    """One curve: its identity and its sizes, smallest first."""

    key: Key
    sizes: tuple[Size, ...]

    @cached_property
    def seen(self) -> tuple[Size, ...]:
        """The sizes with at least one counted diagram: the ones statistics can be taken of."""
        return tuple(size for size in self.sizes if len(size.counted))

    @property
    def rows(self) -> pd.DataFrame:
        """All rows of the group, failed ones included."""
        return pd.concat([size.rows for size in self.sizes])


def split(frame: pd.DataFrame) -> Iterator[Group]:
    """The groups of a study's rows, in the order of their identity.

    Raises UserError if there are no rows or a needed column is missing.
    """
    missing = [name for name in (*COLUMNS, *HEADLINES) if name not in frame.columns]
    if missing:
        raise UserError(f"the rows lack the column {missing[0]!r}")
    if frame.empty:
        raise UserError("the study has no rows yet")
    ordered = frame.sort_values([*IDENTITY, "n", "replicate"], kind="stable")
    for identity, rows in ordered.groupby(list(IDENTITY), sort=True, dropna=False):
        key = Key(*(str(field) for field in identity))
        sizes = tuple(Size(int(np.int64(str(n))), part) for n, part in rows.groupby("n", sort=True))
        yield Group(key, sizes)
