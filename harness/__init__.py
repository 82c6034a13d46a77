"""Exact angular Voronoi diagrams and the experimental study of their complexity.

``harness.AngularVoronoi`` is the way in from Python; it is imported when first asked for, so
that ``import harness`` and ``avd --help`` stay quick.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from harness.voronoi import AngularVoronoi as AngularVoronoi

__all__ = ["AngularVoronoi"]


def __getattr__(name: str) -> Any:
    """Import ``AngularVoronoi`` and look up ``__version__`` on first use (PEP 562)."""
    if name == "AngularVoronoi":
        from harness.voronoi import AngularVoronoi

        return AngularVoronoi
    if name == "__version__":
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("angular-voronoi")
        except PackageNotFoundError:  # run from a checkout that was never installed
            return "unknown (not installed)"
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
