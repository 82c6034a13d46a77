"""Peaks: the points of best visual angle in the kernel of a star-shaped polygon (paper, section 3).

* :func:`peak`: one polygon, by any method and for either objective, with a proof.
* :func:`peaks`: many small polygons at once, arrays in and arrays out.
* :func:`meet`: the intersection of discs, by divide and conquer (Lemma 6).

Everything is imported when first asked for, as compiled code takes a moment to load.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from harness.peak.batch import Peaks as Peaks
    from harness.peak.batch import peaks as peaks
    from harness.peak.discs import Meet as Meet
    from harness.peak.discs import meet as meet
    from harness.peak.door import peak as peak
    from harness.peak.result import Peak as Peak

__all__ = ["Meet", "Peak", "Peaks", "meet", "peak", "peaks"]

_HOMES = {
    "Meet": "discs",
    "Peak": "result",
    "Peaks": "batch",
    "meet": "discs",
    "peak": "door",
    "peaks": "batch",
}


def __getattr__(name: str) -> Any:
    """Import a name of this door on first use (PEP 562)."""
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(f"harness.peak.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
