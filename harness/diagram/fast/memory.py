"""Arrays without reference counts, for the innermost loops.

Numba counts references to arrays whenever one is passed in a tuple or a row is taken, atomically
and so on cache lines that threads share: that took most of the time.  A *borrowed* array is a view
that owns nothing and is not counted.  Whoever borrows keeps the owner: an array's life ends with
the last line that names it, so a function that allocates ends with :func:`release`.
"""

from __future__ import annotations

from typing import Any

from numba.extending import intrinsic

from harness.diagram.fast.jit import compiled


@intrinsic  # type: ignore[untyped-decorator]  # numba has no types
def borrowed(typing_context: Any, array: Any) -> Any:
    """The same array, not counted."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        view = context.make_array(signature.return_type)(context, builder, arguments[0])
        view.meminfo = view.meminfo.type(None)
        view.parent = view.parent.type(None)
        return view._getvalue()

    del typing_context
    return array(array), generate


@compiled
def release(*owners):
    """The end of the lives of some arrays: until here, borrowed views of them are valid."""
