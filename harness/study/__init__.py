"""Studies: from a study file to stored rows, in parallel, within limits, resumable.

``load(directory)`` reads the rows of a study as a pandas table; ``read_study`` and ``run_study``
(imported on first use: they bring in the builders) run one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from harness.study.results import load

if TYPE_CHECKING:
    from harness.study.builtin import builtin_studies, find_study
    from harness.study.runner import Summary, run_study
    from harness.study.study_file import Study, read_study

_LAZY = {
    "Study": "study_file",
    "Summary": "runner",
    "builtin_studies": "builtin",
    "find_study": "builtin",
    "read_study": "study_file",
    "run_study": "runner",
}

__all__ = [
    "Study",
    "Summary",
    "builtin_studies",
    "find_study",
    "load",
    "read_study",
    "run_study",
]


def __getattr__(name: str) -> Any:
    """Import what running a study needs only when it is asked for."""
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(f"{__name__}.{_LAZY[name]}"), name)
