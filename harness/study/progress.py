"""How a run tells how far it is: a bar on a terminal, a line now and then in a log."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self

from tqdm import tqdm

from harness.study.outcome import STATUSES

INTERVAL = 30.0
"""Seconds between two lines where standard error is not a terminal."""


class Progress:
    """Progress of ``total`` tasks on standard error; use it as a context manager."""

    def __init__(self, name: str, total: int, statuses: Mapping[str, int]) -> None:
        """``statuses``: how many rows of each status there are already."""
        self._name = name
        self._total = total
        self._start = self._last = time.monotonic()
        self._bar: tqdm[Any] | None = None
        done = sum(statuses.values())
        if sys.stderr.isatty():
            self._bar = tqdm(
                total=total, initial=done, desc=name, unit="task", file=sys.stderr, leave=True
            )
        self._show(statuses)

    def update(self, statuses: Mapping[str, int]) -> None:
        """Show the present counts, one task further."""
        if self._bar is not None:
            self._bar.set_postfix_str(tally(statuses), refresh=False)
            self._bar.update()
        elif time.monotonic() - self._last >= INTERVAL:
            self._show(statuses)

    def _show(self, statuses: Mapping[str, int]) -> None:
        if self._bar is not None:
            self._bar.set_postfix_str(tally(statuses))
            return
        self._last = time.monotonic()
        done = f"{sum(statuses.values())}/{self._total} tasks"
        counts = tally(statuses)
        elapsed = f"{self._last - self._start:.0f} s"
        line = ", ".join(part for part in (done, counts, elapsed) if part)
        print(f"{self._name}: {line}", file=sys.stderr, flush=True)

    def __enter__(self) -> Self:
        """The progress, shown."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the bar."""
        if self._bar is not None:
            self._bar.close()


def tally(statuses: Mapping[str, int]) -> str:
    """The counts in words, as "57 ok, 2 timeout"."""
    return ", ".join(f"{statuses[s]} {s}" for s in STATUSES if statuses.get(s))
