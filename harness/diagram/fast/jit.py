"""Compiling with Numba: every hot kernel of the fast builder, kept on disk.

Numba renews the machine code it keeps when the file of a function changes, not when a function
that it calls does.  The kernels here call each other across files, so all of them are stamped
with the newest of these files.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

_HERE = Path(__file__).parent
_NEWEST = max(path.stat().st_mtime_ns for path in _HERE.glob("*.py"))
_SIZE = sum(path.stat().st_size for path in _HERE.glob("*.py"))


def compiled(function: Callable[..., Any]) -> Any:
    """``function`` compiled without the interpreter's lock; kept where that is possible."""
    try:
        dispatcher = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    except RuntimeError:  # no directory to keep it in can be written to
        return numba.njit(nogil=True, error_model="numpy")(function)
    locator = dispatcher._cache._impl._locator
    stamp = (_NEWEST, _SIZE)
    locator.get_source_stamp = lambda: stamp
    dispatcher._cache._cache_file._source_stamp = stamp
    return dispatcher
