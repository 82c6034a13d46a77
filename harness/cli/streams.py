"""Standard streams that were closed before the command began (``avd … >&-``)."""

from __future__ import annotations

import errno
import io
import os
import sys
from typing import NoReturn


class Closed(io.TextIOBase):
    """In place of a stream that is closed: whoever uses it gets an OSError that says which."""

    def __init__(self, name: str) -> None:
        """``name``: what the user calls the stream."""
        self._name = name

    def read(self, *_: object) -> NoReturn:
        """Raise OSError."""
        raise OSError(errno.EBADF, "is closed", self._name)

    def write(self, *_: object) -> NoReturn:
        """Raise OSError."""
        self.read()

    @property
    def buffer(self) -> Closed:
        """The same for bytes."""
        return self


def occupy_closed() -> None:
    """Put something in the places of closed streams.

    Python has None there, and the system gives their numbers to the next files that are opened:
    what a library prints would end up in those.
    """
    if sys.stdin is None:
        os.open(os.devnull, os.O_RDONLY)
        sys.stdin = Closed("standard input")
    if sys.stdout is None:
        os.open(os.devnull, os.O_WRONLY)
        sys.stdout = Closed("standard output")
    if sys.stderr is None:  # nobody wants to know
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (for the whole run)


def abandon_output() -> None:
    """Drop what is still to be written to standard output, which takes no more.

    Python flushes it once more at exit, so give it somewhere to flush to.
    """
    if not isinstance(sys.stdout, Closed):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def flush_or_abandon_output() -> None:
    """Write what was printed if that is possible, and else drop it."""
    try:
        sys.stdout.flush()
    except OSError:
        abandon_output()


def read_input() -> str:
    """All of standard input, which is UTF-8 whatever the locale.  Raises UnicodeDecodeError."""
    return sys.stdin.buffer.read().decode("utf-8")
