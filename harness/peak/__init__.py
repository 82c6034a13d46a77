"""Peaks: the points of best visual angle in the kernel of a star-shaped polygon (paper, section 3).

:func:`peaks` takes many small polygons at once.  Everything is imported when first asked for, as
compiled code takes a moment to load.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from harness.peak.batch import Peaks as Peaks
    from harness.peak.batch import peaks as peaks

__all__ = ["Peaks", "peaks"]

_HOMES = {"Peaks": "batch", "peaks": "batch"}


def __getattr__(name: str) -> Any:
    """Import a name of this door on first use (PEP 562)."""
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(f"harness.peak.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
