"""A small study on disk, and in memory: rows, manifest and study file as a run leaves them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd

from tests.analysis.frames import fail, rows

MANIFEST: dict[str, Any] = {
    "schema": 1,
    "study": "sample",
    "description": "Planted growth, a failure and a control",
    "avd": "0.1.0",
    "commit": {"hash": "0123abc", "dirty": False},
    "versions": {"python": "3.12.0", "numpy": "2.1.0"},
    "command": "/home/somebody/.venv/bin/avd study '/home/some body/sample.toml' --jobs 2",
    "limits": {"time": 60.0, "memory_mib": 2048},
    "tasks": 0,
    "statuses": {},
    "runs": [{"start": "2026-01-01T00:00:00+00:00", "end": None, "interrupted": False}],
}
STUDY_FILE = 'name = "sample"  # <b>not bold</b>\n'


def defaults(family: str) -> dict[str, object]:
    from generators import FAMILIES

    return {parameter.name: parameter.default for parameter in FAMILIES[family].parameters}


def sample() -> pd.DataFrame:
    """Three groups: a control without scatter, scatter with zeros, and one with failures."""
    linear = rows(
        "control-linear", lambda n, _: n / 2 - 2, replicates=2, params=defaults("control-linear")
    )
    noisy = rows("star", lambda n, rng: rng.poisson(2), replicates=5, params={"r_min": 0.25})
    broken = rows(
        "segments", lambda n, rng: 0.3 * n * n * rng.lognormal(0, 0.1), replicates=4, domain="plane"
    )
    broken = fail(broken, (broken["n"] == 32) & (broken["replicate"] < 2), "timeout")
    broken = fail(broken, (broken["n"] == 24) & (broken["replicate"] == 0), "invalid")
    parts = [part.astype(object) for part in (linear, noisy, broken)]
    return pd.concat(parts, ignore_index=True)


def store(directory: Path, frame: pd.DataFrame, manifest: dict[str, Any] | None = None) -> Path:
    """Write a study's directory; the rows in an order of completion."""
    directory.mkdir(parents=True, exist_ok=True)
    mixed = frame.sample(frac=1.0, random_state=3) if len(frame) else frame
    text = mixed.to_csv(index=False, lineterminator="\n")
    text = text.replace(",True,", ",true,").replace(",False,", ",false,")
    (directory / "rows.csv").write_text(text, encoding="utf-8")
    manifest = {**MANIFEST, "tasks": len(frame)} if manifest is None else manifest
    (directory / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    (directory / "study.toml").write_text(STUDY_FILE, encoding="utf-8")
    return directory
