"""How counts grow with n: rows of one claim to series with a verdict each."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from harness.audit.claim import Row, Series

Ratio = Callable[[int, Mapping[str, int | float]], float]

LATTICE = "lattice-"
"""Families of small instances, which are there for the counterexamples."""
LEAST = 4
"""Families with fewer sizes have no growth."""


def series_of(rows: Sequence[Row], fact: str, ratios: Mapping[str, Ratio]) -> list[Series]:
    """One series for each family and parameters: the largest ``fact`` at each size.

    Only sizes that were counted take part.  The verdict is that of
    :func:`harness.analysis.verdict.judge` on the counts as they are, without resampling: one
    instance at each size, or the largest of several.
    """
    groups: dict[tuple[str, str], dict[int, Row]] = {}
    for row in rows:
        if fact not in row.facts or row.family.startswith(LATTICE):
            continue
        of_size = groups.setdefault((row.family, row.params), {})
        best = of_size.get(row.n)
        if best is None or row.facts[fact] > best.facts[fact]:
            of_size[row.n] = row
    return [
        _series(family, params, fact, [of_size[n] for n in sorted(of_size)], ratios)
        for (family, params), of_size in groups.items()
        if len(of_size) >= LEAST
    ]


def _series(
    family: str, params: str, fact: str, rows: list[Row], ratios: Mapping[str, Ratio]
) -> Series:
    from harness.analysis.challenge import Series as Curve
    from harness.analysis.challenge import challenge
    from harness.analysis.verdict import judge

    n = tuple(row.n for row in rows)
    counts = tuple(int(row.facts[fact]) for row in rows)
    curve = Curve(
        np.array(n, dtype=np.float64),
        np.array(counts, dtype=np.float64),
        None,
        (False,) * len(n),
    )
    verdict = judge(challenge(curve, seed=0))
    return Series(
        family=family if params in ("", "{}") else f"{family} {params}",
        title=fact,
        n=n,
        counts=counts,
        ratios={
            title: tuple(float(ratio(row.n, row.facts)) for row in rows)
            for title, ratio in ratios.items()
        },
        verdict=verdict.label,
        is_single=verdict.kind == "single",
        sentence=verdict.sentence,
    )
