"""The counts of a study's weaves beside the exact prediction; every deviation gets its reason."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import pandas as pd

from generators.weaves import convex_inner_radius, zigzag_inner_radius
from harness.analysis.weave import Weave, predict
from harness.analysis.weave_noise import ROUNDING, SAFE, tolerance

#: The families that are weaves: their shape parameter, and the inner radius it stands for.
SHAPES: Mapping[str, tuple[str, Callable[[int, float], float]]] = {
    "zigzag": ("tilt", zigzag_inner_radius),
    "convex-weave": ("delta", convex_inner_radius),
}

#: What a comparison can find, and what that means.
FINDINGS: Mapping[str, str] = {
    "as predicted": "vertices, edges, cells and degrees are the predicted ones",
    "symmetric": (
        "no noise: as predicted for a polygon rounded to doubles, but for how the centre resolved"
    ),
    "noise": "too much noise for the smallest gap between two passings of this weave",
    "unexplained": "the counts contradict the prediction",
}

COLUMNS = (
    *("family", "n", "shape", "noise", "replicate", "tilt", "passings", "gap", "tolerance"),
    *("strain", "vertices", "vertices_low", "vertices_high", "edges", "cells"),
    *("predicted_cells", "generic_vertices", "generic_cells", "share", "degrees"),
    "finding",
)


def compare(frame: pd.DataFrame) -> pd.DataFrame:
    """One row for each certified count of a weave in its kernel, beside what was predicted.

    ``frame`` has the columns of a study's rows.  ``shape`` is the tilt or δ that was asked for,
    ``tilt`` is ν in radians; ``noise`` is relative; ``gap`` is the distance of the passing
    nearest to rim or centre from it, in spacings; ``strain`` is noise and rounding over the
    ``tolerance``; ``share`` is vertices over the generic prediction; ``degrees`` reads
    “28×3, 19×4”; ``finding`` is one of ``FINDINGS``.  Rows of other families, domains and
    objectives, and failures, are left out.
    """
    rows = frame[frame["family"].isin(list(SHAPES)) & (frame["status"] == "ok")]
    rows = rows[(rows["domain"] == "kernel") & (rows["objective"] == "smallest")]
    rows = rows[rows["certified"].astype(bool)]
    records = [_record(row) for row in rows.to_dict("records")]
    table = pd.DataFrame.from_records(records, columns=list(COLUMNS))
    return table.sort_values(
        ["family", "shape", "noise", "n", "replicate"], kind="stable", ignore_index=True
    )


def _record(row: Mapping[Any, Any]) -> dict[str, object]:
    family, n = str(row["family"]), int(row["n"])
    parameters = json.loads(str(row["params"]))
    shape = float(parameters[SHAPES[family][0]])
    noise = float(parameters["noise"]) / float(n ** int(parameters["noise_power"]))
    weave, bears = _ideal(family, n, shape)
    strain = (noise + ROUNDING) / bears if bears > 0 else math.inf
    vertices, edges, cells = (int(row[name]) for name in ("vertices", "edges", "cells"))
    degrees = {int(degree): int(count) for degree, count in json.loads(row["degrees"]).items()}
    expected = expectation(weave, noise)
    return {
        "family": family,
        "n": n,
        "shape": shape,
        "noise": noise,
        "replicate": int(row["replicate"]),
        "tilt": weave.tilt,
        "passings": weave.passings,
        "gap": weave.rim_gap,
        "tolerance": bears,
        "strain": strain,
        "vertices": vertices,
        "vertices_low": expected.low,
        "vertices_high": expected.high,
        "edges": edges,
        "cells": cells,
        "predicted_cells": expected.cells,
        "generic_vertices": weave.vertices,
        "generic_cells": weave.cells,
        "share": vertices / weave.vertices,
        "degrees": ", ".join(f"{count}×{degree}" for degree, count in sorted(degrees.items())),
        "finding": _finding(expected, vertices, edges, cells, degrees, strain),
    }


@lru_cache(maxsize=4096)
def _ideal(family: str, n: int, shape: float) -> tuple[Weave, float]:
    inner = SHAPES[family][1](n, shape)
    return predict(n // 2, 1.0, inner), tolerance(n // 2, 1.0, inner)


@dataclass(frozen=True)
class Expectation:
    """The counts to be expected: vertices between ``low`` and ``high``, cells exactly.

    ``degrees`` are the vertices by degree where they are determined, else None.
    """

    low: int
    high: int
    cells: int
    degrees: Mapping[int, int] | None


def expectation(weave: Weave, noise: float) -> Expectation:
    """What the polygon in doubles is expected to show, with noise or without.

    Without noise the vertices are those of the ideal weave, rounded, and rounding is a noise like
    any other except on the *exact* mirror axes of the rounded polygon: the coordinate axes and
    the diagonals, as far as they are axes of the ideal one.  There are gcd(n, 8)/2 of them.  On
    these a saddle stays a saddle (one vertex and one cell more than generic), a tie of four stays
    one (one vertex less), and no triple point comes out of a corner.  The centre has
    d ≤ n − 3 vertices less than generic, d depending on the rounding: the axes pass through
    cells of its subdivision that are no triangles, and if there are a ≥ 2 axes at least 2a edges
    tie in the very centre.  If all m axes are exact, d = n − 3.  O(1).
    """
    if noise > 0:
        return Expectation(weave.vertices, weave.vertices, weave.cells, {3: weave.vertices})
    axes = math.gcd(weave.n, 8) // 2
    if axes == weave.m:
        whole = weave.symmetric_vertices
        return Expectation(whole, whole, weave.symmetric_cells, weave.symmetric_degrees)
    step = weave.m // axes
    parities = [ray * step % 2 for ray in range(2 * axes)]
    saddles = sum(_of_parity(weave.last - weave.saddles + 1, weave.last, 1 - p) for p in parities)
    ties = sum(_of_parity(weave.last - weave.ties + 1, weave.last, p) for p in parities)
    corners = sum(parities) * weave.corner
    most = weave.vertices + saddles - ties - corners
    return Expectation(
        most - (weave.n - 3), most - max(1, 2 * axes - 3), weave.cells + saddles, None
    )


def _of_parity(first: int, last: int, parity: int) -> int:
    """How many of first … last have the parity."""
    return len(range(first + (first + parity) % 2, last + 1, 2))


def _finding(
    expected: Expectation,
    vertices: int,
    edges: int,
    cells: int,
    degrees: Mapping[int, int],
    strain: float,
) -> str:
    right = expected.low <= vertices <= expected.high and cells == expected.cells
    right = right and edges == cells + vertices - 1
    right = right and expected.degrees in (None, degrees)
    if right:
        return "as predicted" if expected.degrees is not None else "symmetric"
    return "noise" if strain > SAFE else "unexplained"
