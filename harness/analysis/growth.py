"""One curve of a study, analysed: a headline count and a statistic of a group, over its sizes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from harness.analysis.challenge import Challenge, Series, challenge
from harness.analysis.declared import Declared, declared_growth
from harness.analysis.models import MODELS, Floats
from harness.analysis.powerlaw import PowerLaw, local_slopes, power_law
from harness.analysis.samples import HEADLINES, Group
from harness.analysis.statistics import (
    STATISTICS,
    Bounds,
    Statistic,
    bounds,
    evaluate,
    interval,
    is_noise_free,
    resample,
)
from harness.analysis.verdict import Verdict, judge


@dataclass(frozen=True)
class Growth:
    """The evidence on one curve and its verdict.

    ``n``, ``observed``, ``low`` and ``high`` (95 % bootstrap interval of the statistic) have one
    entry per size with counts; ``low`` and ``high`` are None where nothing can be resampled.
    ``ratios`` maps a model's name to observed/m(n); ``bounds`` says what unseen tasks leave open.
    """

    headline: str
    statistic: Statistic
    n: Floats
    observed: Floats
    low: Floats | None
    high: Floats | None
    bounds: tuple[Bounds, ...]
    slopes: tuple[float | None, ...]
    ratios: Mapping[str, Floats]
    power: PowerLaw
    challenge: Challenge
    verdict: Verdict

    @property
    def censored(self) -> tuple[bool, ...]:
        """Where the true value may lie above the one shown."""
        return tuple(
            bound.high > value for bound, value in zip(self.bounds, self.observed, strict=True)
        )


@dataclass(frozen=True)
class GroupGrowth:
    """All curves of one group, by (headline, statistic), and what its family declares."""

    group: Group
    curves: Mapping[tuple[str, Statistic], Growth]
    noise_free: bool
    declared: Declared | None


def analyse_group(group: Group) -> GroupGrowth:
    """Every headline count under every statistic.  Deterministic in the group's rows."""
    curves: dict[tuple[str, Statistic], Growth] = {}
    quiet = True
    for headline in HEADLINES:
        samples = [size.counts(headline) for size in group.seen]
        noise_free = is_noise_free(samples)
        quiet = quiet and noise_free
        draws = None
        if not noise_free:
            draws = resample(samples, group.key.seed(headline, "replicates"))
        for statistic in STATISTICS:
            of_statistic = None if draws is None else draws[statistic]
            curves[headline, statistic] = _growth(group, headline, statistic, of_statistic)
    return GroupGrowth(group, curves, quiet, declared_growth(group.key))


def _growth(group: Group, headline: str, statistic: Statistic, draws: Floats | None) -> Growth:
    sizes = group.seen
    n = np.array([size.measure for size in sizes])
    samples = [size.counts(headline) for size in sizes]
    values = np.array([float(evaluate(statistic, counts)) for counts in samples])
    limits = tuple(
        bounds(statistic, counts, size.unseen) for counts, size in zip(samples, sizes, strict=True)
    )
    censored = tuple(bool(limit.high > value) for limit, value in zip(limits, values, strict=True))
    series = Series(n, values, draws, censored, whole=statistic != "mean")
    # Without draws all statistics are one series: one seed, so that they get one verdict.
    name = statistic if draws is not None else "maximum"
    tried = challenge(series, group.key.seed(headline, name))
    low, high = interval(draws) if draws is not None else (None, None)
    return Growth(
        headline,
        statistic,
        n,
        values,
        low,
        high,
        limits,
        tuple(local_slopes(n, values)),
        _ratios(n, values),
        power_law(n, values, draws),
        tried,
        judge(tried),
    )


def _ratios(n: Floats, values: Floats) -> dict[str, Floats]:
    """C(n)/m(n) for every model; NaN where m(n) is 0 (log 1)."""
    ratios = {}
    for model in MODELS:
        leading = model.leading(n)
        ratios[model.name] = np.divide(
            values, leading, out=np.full_like(values, np.nan), where=leading > 0
        )
    return ratios
