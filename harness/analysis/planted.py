"""Planted controls: could this study have told the models apart at all?

For a design — the study's own sizes, replicates, spread and level of counts — samples are drawn
whose growth is known because it was planted, and go through the same code as the study's rows.
A model that is then hardly ever rejected when another was planted is one this design cannot rule
out; and a planted model that is rejected counts against the method.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from harness.analysis.challenge import Series, challenge
from harness.analysis.declared import DECLARED_COUNT
from harness.analysis.models import BY_NAME, MODELS, Floats
from harness.analysis.samples import Group
from harness.analysis.statistics import Statistic, evaluate, is_noise_free, resample
from harness.analysis.verdict import judge

TRIALS = 25
#: Resamples per planted sample; fewer than for a verdict, there are many of them.
ROUNDS = 300
JUDGED: tuple[Statistic, ...] = ("maximum", "median")

#: Spreads and levels are rounded to these, so that like groups share one check.
SPREADS = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8)


@dataclass(frozen=True, order=True)
class Design:
    """Sizes, replicates per size, relative spread of the counts, and the count at the least n."""

    n: tuple[float, ...]
    replicates: tuple[int, ...]
    spread: float
    level: float


@dataclass(frozen=True)
class Check:
    """Result for one design and statistic.

    ``rejected[planted, candidate]`` is the share of planted samples in which the candidate was
    rejected: on the diagonal it should be 0, elsewhere 1.  ``named`` is the share in which the
    planted model was the only one left.
    """

    design: Design
    statistic: Statistic
    rejected: Mapping[tuple[str, str], float]
    named: Mapping[str, float]


def design_of(group: Group) -> Design:
    """The design of a group, as its number of vertices shows it."""
    samples = [size.counts(DECLARED_COUNT) for size in group.seen]
    relative = [
        float(counts.std(ddof=1) / counts.mean())
        for counts in samples
        if len(counts) > 1 and counts.mean() > 0
    ]
    spread = float(np.sqrt(np.mean(np.square(relative)))) if relative else 0.0
    if not is_noise_free(samples):
        spread = max(spread, SPREADS[1])
    first = max(1.0, float(np.median(samples[0]))) if samples else 1.0
    return Design(
        tuple(size.measure for size in group.seen),
        tuple(len(counts) for counts in samples),
        min(SPREADS, key=lambda step: abs(step - spread)),
        float(2.0 ** round(np.log2(first))),
    )


def check(design: Design) -> tuple[Check, ...]:
    """Plant every model in the design and challenge them all; one result per statistic.

    Without scatter all statistics are the same, and there is one result, called maximum.

    The planted curve is level·m(n)/m(n₁), its level varied by up to a factor of two so that
    rounding falls differently; each replicate is multiplied by log-normal noise of the design's
    spread and rounded.  Deterministic in the design.
    """
    n = np.array(design.n)
    judged = JUDGED if design.spread else JUDGED[:1]
    tally = {
        statistic: {(p.name, c.name): 0 for p in MODELS for c in MODELS} for statistic in judged
    }
    named = {statistic: dict.fromkeys(BY_NAME, 0) for statistic in judged}
    for model in MODELS:
        for trial in range(TRIALS):
            seed = _seed(design, model.name, trial)
            level = design.level * (1 + trial / TRIALS)
            curve = level * model.leading(n) / model.leading(n[:1])
            samples = plant(curve, design.replicates, design.spread, seed)
            for statistic in judged:
                verdict = judge(challenge(_series(n, samples, statistic, seed), seed, ROUNDS))
                for candidate in (*verdict.too_slow, *verdict.too_fast):
                    tally[statistic][model.name, candidate.name] += 1
                named[statistic][model.name] += verdict.kept == (model,)
    return tuple(
        Check(
            design,
            statistic,
            {pair: count / TRIALS for pair, count in tally[statistic].items()},
            {name: count / TRIALS for name, count in named[statistic].items()},
        )
        for statistic in judged
    )


def plant(curve: Floats, replicates: tuple[int, ...], spread: float, seed: int) -> list[Floats]:
    """Whole counts scattered around ``curve`` (its mean), one array per size."""
    rng = np.random.default_rng(seed)
    sigma = np.sqrt(np.log1p(spread**2))
    return [
        np.rint(mean * np.exp(sigma * rng.standard_normal(count) - sigma**2 / 2))
        for mean, count in zip(curve, replicates, strict=True)
    ]


def _series(n: Floats, samples: list[Floats], statistic: Statistic, seed: int) -> Series:
    values = np.array([float(evaluate(statistic, counts)) for counts in samples])
    draws = None if is_noise_free(samples) else resample(samples, seed, ROUNDS)[statistic]
    return Series(n, values, draws, (False,) * len(n))


def _seed(design: Design, planted: str, trial: int) -> int:
    text = repr((design.n, design.replicates, design.spread, design.level, planted, trial))
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:16], "big")
