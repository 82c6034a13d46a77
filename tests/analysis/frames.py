"""Synthetic study rows: the columns of a real study, with counts whose growth was planted."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable

import numpy as np
import pandas as pd

NODE_KINDS = ("triple", "crossing", "saddle", "endpoint", "boundary", "infinity")
COLUMNS = (
    "task",
    "schema",
    "family",
    "n",
    "segments",
    "params",
    "replicate",
    "seed",
    "domain",
    "objective",
    "builder",
    "status",
    "message",
    "cells",
    "edges",
    "vertices",
    "regions",
    "loops",
    "components",
    "unbounded",
    "boundary_points",
    *NODE_KINDS,
    "degrees",
    "certified",
    "seconds",
    "peak_mib",
)

GROWTHS: dict[str, Callable[[float], float]] = {
    "1": lambda n: 1.0,
    "log n": lambda n: float(np.log(n)),
    "n": lambda n: float(n),
    "n log n": lambda n: float(n * np.log(n)),
    "n^2": lambda n: float(n * n),
}


def rows(
    family: str,
    vertices: Callable[[int, np.random.Generator], float],
    *,
    sizes: Iterable[int] = (6, 8, 12, 16, 24, 32),
    replicates: int = 1,
    domain: str = "kernel",
    params: dict[str, object] | None = None,
    seed: int = 0,
) -> pd.DataFrame:
    """One group: ``vertices(n, rng)`` says how many vertices a replicate has."""
    rng = np.random.default_rng(seed)
    records = []
    for n in sizes:
        for replicate in range(replicates):
            count = max(0, round(vertices(n, rng)))
            records.append(
                {
                    **dict.fromkeys(COLUMNS, 0),
                    "task": f"{family}-{domain}-{n}-{replicate}",
                    "schema": 1,
                    "family": family,
                    "n": n,
                    "segments": n,
                    "params": json.dumps(params or {}, sort_keys=True, separators=(",", ":")),
                    "replicate": replicate,
                    "seed": 1000 * n + replicate,
                    "domain": domain,
                    "objective": "smallest",
                    "builder": "reference",
                    "status": "ok",
                    "message": "",
                    "vertices": count,
                    "edges": count + n + 3,
                    "cells": n + 4,
                    "triple": count,
                    "degrees": json.dumps({"3": count} if count else {}),
                    "certified": True,
                    "seconds": 0.001 * n * n,
                    "peak_mib": 100.0,
                }
            )
    return pd.DataFrame.from_records(records, columns=list(COLUMNS))


def fail(frame: pd.DataFrame, where: pd.Series, status: str = "timeout") -> pd.DataFrame:
    """The same rows, those at ``where`` failed: their counts were never seen."""
    frame = frame.copy()
    counts = list(COLUMNS[COLUMNS.index("cells") : COLUMNS.index("degrees")])
    frame = frame.astype(dict.fromkeys(["segments", *counts, "certified", "seconds"], object))
    frame.loc[where, ["segments", *counts, "degrees", "certified", "seconds"]] = None
    frame.loc[where, "status"] = status
    frame.loc[where, "message"] = "stopped after 60 s"
    return frame
