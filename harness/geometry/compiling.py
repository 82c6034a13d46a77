"""Hot loops that run as plain Python on small input and compiled (Numba) on large input.

A loop is written once, as plain functions on indexable sequences; lists serve the one way and
arrays the other.  Numba takes a third of a second to import, more than small inputs need, so it
is imported only when something large turns up.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

#: From how many segments on compiling pays.
LARGE = 1000


@cache
def compiled(main: Callable[..., Any], *helpers: Callable[..., Any]) -> Any:
    """``main`` compiled, with the plain ``helpers`` it calls; kept on disk where that is possible.

    The kept machine code is renewed when the file that holds ``main`` changes, and only then:
    helpers belong into the same file.
    """
    import numba
    from numba.extending import register_jitable

    for helper in helpers:
        register_jitable(helper)
    try:
        return numba.njit(cache=True)(main)
    except RuntimeError:  # no directory to keep it in can be written to
        return numba.njit(main)
