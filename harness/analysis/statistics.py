"""The statistics whose growth is judged, their resampling, and what unseen tasks do to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, SupportsFloat, TypeAlias, get_args

import numpy as np

from harness.analysis.models import Floats

Statistic: TypeAlias = Literal["maximum", "median", "mean"]
STATISTICS: tuple[Statistic, ...] = get_args(Statistic)

#: Resamples behind every interval.
RESAMPLES = 2000


def evaluate(statistic: Statistic, samples: Floats) -> Floats:
    """The statistic along the last axis."""
    if statistic == "maximum":
        return np.asarray(samples.max(axis=-1))
    if statistic == "median":
        return np.asarray(np.median(samples, axis=-1))
    return np.asarray(samples.mean(axis=-1))


def resample(
    samples: Sequence[Floats], seed: int, rounds: int = RESAMPLES
) -> Mapping[Statistic, Floats]:
    """Bootstrap: each statistic of resampled replicates, (rounds, k) arrays for k sizes.

    The replicates of each size are drawn with replacement, as many as there are (Efron).  The
    maximum of such a draw never exceeds the largest count seen, so its interval ends there: it
    shows how much the maximum owes to single instances, not how much larger it could be.
    Deterministic in ``seed``.  O(rounds · replicates).
    """
    rng = np.random.default_rng(seed)
    draws: dict[Statistic, list[Floats]] = {statistic: [] for statistic in STATISTICS}
    for counts in samples:
        chosen = counts[rng.integers(0, len(counts), (rounds, len(counts)))]
        for statistic in STATISTICS:
            draws[statistic].append(evaluate(statistic, chosen))
    return {statistic: np.stack(columns, axis=1) for statistic, columns in draws.items()}


def is_noise_free(samples: Sequence[Floats]) -> bool:
    """Whether at every size all replicates agree (a single one agrees with itself)."""
    return all(bool((counts == counts[0]).all()) for counts in samples)


@dataclass(frozen=True)
class Bounds:
    """What the statistic of *all* tasks can be when some were not seen to their end."""

    low: float
    high: float


def bounds(statistic: Statistic, counts: Floats, unseen: int) -> Bounds:
    """The range the statistic can lie in if ``unseen`` more counts, each ≥ 0, were known.

    For the maximum: at least the largest count seen.  For the median and the mean: as if every
    unseen count were 0, and as if every one were infinite.
    """
    if unseen == 0:
        value = float(evaluate(statistic, counts))
        return Bounds(value, value)
    everything_low = np.concatenate([counts, np.zeros(unseen)])
    everything_high = np.concatenate([counts, np.full(unseen, np.inf)])
    low = float(evaluate(statistic, everything_low))
    return Bounds(low, float(evaluate(statistic, everything_high)))


def interval(draws: Floats, level: float = 0.95) -> tuple[Floats, Floats]:
    """The percentile interval of bootstrap draws along the first axis.

    Its ends are draws themselves (order statistics, the outer ones), not interpolated.
    """
    ordered = np.sort(draws, axis=0)
    outside = int((1 - level) / 2 * len(ordered))
    return ordered[outside], ordered[len(ordered) - 1 - outside]


def without_noise(value: SupportsFloat) -> float:
    """A number of the order of one, to a millionth: without digits that processors disagree on.

    Sums of logarithms and products of matrices end in digits that depend on the order of the
    additions, hence on the processor.  What ought to be zero would consist of nothing else, and
    the same counts would be reported differently on another machine.
    """
    return round(float(value), 6) + 0.0  # + 0.0: no negative zero
