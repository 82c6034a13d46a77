"""Compiling with Numba: hot kernels that call each other across files, kept on disk.

Numba renews the machine code it keeps when the file of a function changes, not when a function
that it calls does.  So each kernel is stamped with the newest of all files of this project that
its own file imports, directly or not.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba

_ROOT = Path(__file__).parents[2]
_IMPORT = re.compile(r"^from (harness(?:\.\w+)+) import", re.MULTILINE)


@cache
def _imported(path: Path) -> frozenset[Path]:
    """The files of this project that a file imports, directly or not, and itself."""
    found, todo = {path}, [path]
    while todo:
        for name in _IMPORT.findall(todo.pop().read_text(encoding="utf-8")):
            other = _ROOT.joinpath(*name.split(".")).with_suffix(".py")
            if other not in found and other.is_file():
                found.add(other)
                todo.append(other)
    return frozenset(found)


@cache
def _stamp(path: Path) -> tuple[int, int]:
    """The newest change of these files, and their size."""
    states = [other.stat() for other in _imported(path)]
    return max(state.st_mtime_ns for state in states), sum(state.st_size for state in states)


def compiled(function: Callable[..., Any], *, parallel: bool = False) -> Any:
    """``function`` compiled without the interpreter's lock; kept where that is possible."""
    options = {"nogil": True, "error_model": "numpy", "parallel": parallel}
    try:
        dispatcher = numba.njit(cache=True, **options)(function)
    except RuntimeError:  # no directory to keep it in can be written to
        return numba.njit(**options)(function)
    _take_numbers_as_such(dispatcher)
    stamp = _stamp(Path(function.__code__.co_filename).resolve())
    locator = dispatcher._cache._impl._locator
    locator.get_source_stamp = lambda: stamp
    dispatcher._cache._cache_file._source_stamp = stamp
    return dispatcher


def is_compiled(dispatcher: Any) -> bool:
    """Whether the machine code of a kernel is there, in memory or kept on disk."""
    if dispatcher.signatures:
        return True
    kept = getattr(dispatcher._cache, "_cache_file", None)
    return kept is not None and bool(kept._load_index())


def _take_numbers_as_such(dispatcher: Any) -> None:
    """Compile a callee once for all numbers, not anew for each constant it is called with."""
    template = dispatcher.get_call_template

    def get_call_template(args: Any, kws: Any) -> Any:
        plain = {key: numba.types.unliteral(value) for key, value in dict(kws).items()}
        return template(tuple(map(numba.types.unliteral, args)), plain)

    dispatcher.get_call_template = get_call_template
