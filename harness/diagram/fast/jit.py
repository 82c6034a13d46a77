"""Compiling with Numba: every hot kernel of the fast builder, kept on disk.

Numba renews the machine code it keeps when the file of a function changes, not when a function
that it calls does.  The kernels here call each other across files, so each is stamped with the
newest of all files that its own file imports, directly or not.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba

_HERE = Path(__file__).parent
_IMPORT = re.compile(r"^from harness\.diagram\.fast\.(\w+) import", re.MULTILINE)


@cache
def _imported(path: Path) -> frozenset[Path]:
    """The files of this folder that a file imports, directly or not, and itself."""
    found, todo = {path}, [path]
    while todo:
        for name in _IMPORT.findall(todo.pop().read_text(encoding="utf-8")):
            other = _HERE / f"{name}.py"
            if other not in found:
                found.add(other)
                todo.append(other)
    return frozenset(found)


@cache
def _stamp(path: Path) -> tuple[int, int]:
    """The newest change of these files, and their size."""
    states = [other.stat() for other in _imported(path)]
    return max(state.st_mtime_ns for state in states), sum(state.st_size for state in states)


def compiled(function: Callable[..., Any]) -> Any:
    """``function`` compiled without the interpreter's lock; kept where that is possible."""
    try:
        dispatcher = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    except RuntimeError:  # no directory to keep it in can be written to
        return numba.njit(nogil=True, error_model="numpy")(function)
    stamp = _stamp(Path(function.__code__.co_filename).resolve())
    locator = dispatcher._cache._impl._locator
    locator.get_source_stamp = lambda: stamp
    dispatcher._cache._cache_file._source_stamp = stamp
    return dispatcher
