"""The sections of a report that depend on what its study is about."""

from __future__ import annotations

from collections.abc import Sequence

from harness.analysis import GroupGrowth
from harness.report import weaves
from harness.report.parts import Part

__all__ = ["Part", "chapters"]


def chapters(groups: Sequence[GroupGrowth]) -> list[Part]:
    """The sections that these groups give rise to, in the order of the page; often none."""
    return weaves.parts(groups)
