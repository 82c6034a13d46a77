"""From a study's directory to its report: read, analyse, render, write."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from harness.analysis import GroupGrowth, analyse_group, split
from harness.errors import UserError
from harness.report import summary
from harness.report.labels import curve_labels


@dataclass(frozen=True)
class StudyGrowth:
    """A study's rows, analysed, with what is known about their origin.

    ``study_file`` is the text of ``study.toml``, ``manifest`` the manifest; either may be missing.
    """

    name: str
    groups: tuple[GroupGrowth, ...]
    labels: tuple[str, ...]
    manifest: Mapping[str, Any] | None = None
    study_file: str = ""

    @property
    def planned(self) -> int | None:
        """How many tasks the study has, if the manifest says so."""
        tasks = (self.manifest or {}).get("tasks")
        return tasks if isinstance(tasks, int) else None

    @property
    def lines(self) -> list[str]:
        """The verdicts for a terminal."""
        return summary.lines(self.groups, self.labels, self.planned)


def analyse(
    frame: pd.DataFrame,
    name: str,
    manifest: Mapping[str, Any] | None = None,
    study_file: str = "",
) -> StudyGrowth:
    """Analyse a study's rows.  Raises UserError if there are none, or columns are missing."""
    groups = tuple(analyse_group(group) for group in split(frame))
    labels = tuple(curve_labels([analysed.group.key for analysed in groups]))
    return StudyGrowth(name, groups, labels, manifest, study_file)


def read(directory: Path, load: Callable[[Path], pd.DataFrame] | None = None) -> StudyGrowth:
    """Read and analyse the study in ``directory``.

    Raises UserError if it is not a study's directory, has no rows, is damaged, or was written by
    a newer program.
    """
    from harness.study.manifest import read_manifest

    if not directory.is_dir():
        raise UserError(f"{directory}: no such directory")
    if not (directory / "rows.csv").exists():
        raise UserError(f"{directory}: not a study's directory (no rows.csv)")
    if load is None:
        from harness.study import load as load_rows

        load = load_rows
    frame = load(directory)
    if frame.empty:
        raise UserError(f"{directory}: the study has no rows yet")
    manifest = read_manifest(directory)
    name = str((manifest or {}).get("study") or directory.resolve().name)
    source = directory / "study.toml"
    text = source.read_text(encoding="utf-8", errors="replace") if source.exists() else ""
    return analyse(frame, name, manifest, text)


def write(study: StudyGrowth, directory: Path) -> Path:
    """Write the report of an analysed study.  Returns the page's path."""
    from harness.report.page import outputs
    from harness.report.pages import write_files

    return write_files(directory, outputs(study))
