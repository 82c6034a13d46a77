"""Rows of weaves beside the prediction: a wrong count is called wrong, and a right one right."""

from __future__ import annotations

import json

import pandas as pd
import pytest

from harness.analysis.weave_rows import compare
from tests.analysis.weaves import count


def row(family: str, n: int, noise: float, **changed: object) -> dict[str, object]:
    """A row as a study stores it, counted here."""
    shape = {"zigzag": ("tilt", 0.5), "convex-weave": ("delta", 0.7)}[family]
    counts = count(family, n, shape[1], 0, noise)
    return {
        "family": family,
        "n": n,
        "params": json.dumps({shape[0]: shape[1], "noise": noise * n**2, "noise_power": 2}),
        "replicate": 0,
        "domain": "kernel",
        "objective": "smallest",
        "status": "ok",
        "certified": True,
        "vertices": counts.vertices,
        "edges": counts.edges,
        "cells": counts.cells,
        "degrees": json.dumps({str(degree): k for degree, k in counts.degrees.items()}),
        **changed,
    }


def findings(*rows: dict[str, object]) -> list[str]:
    return compare(pd.DataFrame(rows))["finding"].tolist()


@pytest.mark.parametrize("family", ["zigzag", "convex-weave"])
def test_counts_of_slightly_noisy_weaves_are_as_predicted(family) -> None:
    assert findings(*(row(family, n, 1e-7) for n in (4, 6, 10, 16))) == ["as predicted"] * 4


@pytest.mark.parametrize("family", ["zigzag", "convex-weave"])
def test_counts_without_noise_are_those_of_the_axes_that_are_exact(family) -> None:
    found = findings(*(row(family, n, 0.0) for n in (4, 6, 8, 10, 12)))
    assert found == ["as predicted" if n in (4, 8) else "symmetric" for n in (4, 6, 8, 10, 12)]


@pytest.mark.parametrize(
    "fault",
    [{"vertices": 53}, {"cells": 35}, {"edges": 88}, {"degrees": '{"3": 51, "4": 1}'}],
    ids=lambda fault: next(iter(fault)),
)
def test_a_planted_fault_is_unexplained(fault) -> None:
    """The zigzag of 12 edges has 52 vertices, 87 edges, 36 cells, and all its degrees are 3."""
    assert findings(row("zigzag", 12, 1e-6)) == ["as predicted"]
    assert findings(row("zigzag", 12, 1e-6, **fault)) == ["unexplained"]


@pytest.mark.parametrize("fault", [{"cells": 45}, {"vertices": 52}, {"vertices": 42}])
def test_a_planted_fault_without_noise_is_unexplained(fault) -> None:
    assert findings(row("zigzag", 12, 0.0)) == ["symmetric"]
    assert findings(row("zigzag", 12, 0.0, **fault)) == ["unexplained"]


def test_a_noise_above_the_tolerance_is_the_reason() -> None:
    table = compare(pd.DataFrame([row("zigzag", 20, 1e-2)]))
    assert table["finding"].tolist() == ["noise"]
    assert table["strain"].iloc[0] > 1
    assert table["share"].iloc[0] < 1


def test_only_counted_weaves_in_their_kernel_are_compared() -> None:
    rows = [
        row("zigzag", 12, 1e-6, status="timeout"),
        row("zigzag", 12, 1e-6, domain="interior"),
        row("zigzag", 12, 1e-6, objective="largest"),
        row("zigzag", 12, 1e-6, certified=False),
        {**row("zigzag", 12, 1e-6), "family": "star"},
    ]
    assert compare(pd.DataFrame(rows)).empty
