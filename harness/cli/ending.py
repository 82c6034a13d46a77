"""Ending in the middle of writing a file, with nothing left behind."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from harness.study.interrupt import ENDING, handled


def tidily() -> contextlib.AbstractContextManager[None]:
    """Let SIGTERM and SIGHUP interrupt as Ctrl-C does, so that scratch files are removed."""
    return handled(ENDING, _interrupt)


def _interrupt(_restore: Callable[[], None]) -> None:
    raise KeyboardInterrupt
