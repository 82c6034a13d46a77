"""Fit every candidate model on the smaller sizes, challenge it on the larger ones.

The method of Pushak and Hoos (ESA: fit small, challenge large, bootstrap) with the two-sided
reading of McGeoch et al. (curve bounding): a model whose prediction falls short of the larger
sizes is *too slow*, one whose prediction overshoots them is *too fast*.

For a model, the **miss** is the mean over the challenge sizes of
(observed − predicted)/max(observed, predicted, 1).  Its interval comes from repeating the whole
procedure — resample, refit, predict, compare — and a model is rejected when the interval excludes
zero, with and without the smallest size, and the rejections fit the order of the models.  Two
sources of error are resampled:

* the replicates (bootstrap), where they differ;
* the **wiggle**: what even the best of the candidate models, fitted to all sizes, leaves
  unexplained beyond the replicates' own scatter (steps of parity, rounding, small-n effects).
  It is multiplicative, normal, with its scale drawn anew each time as an estimate on k − 2
  degrees of freedom deserves.  Families without noise have only this; if a model meets all their
  sizes exactly, there is none, and any miss of another model that a whole count can show counts.

A study holds dozens of verdicts, hence intervals of 99 %.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from harness.analysis.models import (
    MODELS,
    Floats,
    Model,
    extreme_curves,
    fit,
    relative_miss,
    relative_weights,
)
from harness.analysis.statistics import RESAMPLES, interval, without_noise

LEVEL = 0.99
#: A rejection has to stand without the smallest size as well, at this level: there are fewer
#: sizes then, and the question is only whether the smallest one decided.
CONFIRMING_LEVEL = 0.8
#: With fewer sizes three would be fitted and one left to challenge: too few for a verdict.
LEAST_SIZES = 5
#: The largest size is at least this multiple of the smallest.
LEAST_SPAN = 2.0
#: Below this, a relative difference is floating-point noise, or far less than one object.
TINY = 1e-6

Finding: TypeAlias = Literal["kept", "too slow", "too fast", "withheld", "fragile"]


@dataclass(frozen=True)
class Trial:
    """One model challenged; predictions and their band are over the challenge sizes.

    ``withheld``: the numbers would reject, but unseen (censored) tasks could turn them around.
    ``fragile``: they would reject, but not without the smallest size; counted as kept.
    """

    model: Model
    finding: Finding
    miss: float
    low: float
    high: float
    predicted: Floats
    predicted_low: Floats
    predicted_high: Floats

    @property
    def direction(self) -> Finding:
        """On which side the model fails, withheld or not; "kept" if it does not."""
        if self.finding in ("kept", "fragile"):
            return "kept"
        return "too slow" if self.low > 0 else "too fast"


@dataclass(frozen=True)
class Challenge:
    """All models challenged on one curve; ``trials`` is empty if there are too few sizes."""

    fitted: Floats
    challenged: Floats
    wiggle: float
    trials: tuple[Trial, ...]
    reason: str = ""


@dataclass(frozen=True)
class Series:
    """One curve to be judged: k sizes and the statistic at each.

    ``draws`` are (B, k) bootstrap values, None where replicates agree.  ``censored`` marks the
    sizes at which the statistic is only a lower bound.  ``whole`` says that the statistic is a
    count itself (maximum, median), so that half an object is the least meaningful difference.
    """

    n: Floats
    observed: Floats
    draws: Floats | None
    censored: tuple[bool, ...]
    whole: bool = True


def fit_sizes(sizes: int) -> int:
    """How many of the smallest sizes are fitted: half, but three at least."""
    return max(3, -(-sizes // 2))


def challenge(series: Series, seed: int, rounds: int = RESAMPLES) -> Challenge:
    """Challenge every model of ``MODELS``; deterministic in ``seed``.  O(rounds · k)."""
    n, k = series.n, len(series.n)
    none = np.array([])
    if k < LEAST_SIZES:
        return Challenge(n, none, 0.0, (), f"only {k} sizes, {LEAST_SIZES} are needed")
    if n[0] <= 1 or n[-1] < LEAST_SPAN * n[0] or not (np.diff(n) > 0).all():
        return Challenge(n, none, 0.0, (), f"the sizes do not span a factor of {LEAST_SPAN:g}")
    cut = fit_sizes(k)
    wiggle, trials = _trials(series, seed, rounds, LEVEL)
    _, again = _trials(_without_smallest(series), seed, rounds, CONFIRMING_LEVEL)
    trials = [_confirmed(trial, other) for trial, other in zip(trials, again, strict=True)]
    return Challenge(n[:cut], n[cut:], wiggle, tuple(_in_order(trials)))


def _trials(series: Series, seed: int, rounds: int, level: float) -> tuple[float, list[Trial]]:
    """Every model challenged on a series, each for itself; and the wiggle."""
    cut = fit_sizes(len(series.n))
    wiggle = _wiggle(series, float(series.n[cut - 1]))
    worlds = _worlds(series, wiggle, seed, rounds)
    return wiggle, [_trial(model, series, worlds, cut, level) for model in MODELS]


def _without_smallest(series: Series) -> Series:
    draws = None if series.draws is None else series.draws[:, 1:]
    return replace(
        series,
        n=series.n[1:],
        observed=series.observed[1:],
        draws=draws,
        censored=series.censored[1:],
    )


def _confirmed(trial: Trial, without: Trial) -> Trial:
    """The smallest instances are the least like large ones: no rejection rests on them alone."""
    if trial.direction not in ("kept", without.direction):
        return replace(trial, finding="fragile")
    return trial


def _in_order(trials: list[Trial]) -> list[Trial]:
    """Keep only rejections that agree with the order of the models.

    Counts for which n log n is too slow cannot be linear: so "too slow" stands only if every
    slower model is too slow as well, and "too fast" only if every faster one is too fast.  What
    survives is therefore always a run of neighbouring models.
    """
    slow = fast = True
    kept: list[Trial] = list(trials)
    for rank, trial in enumerate(trials):
        slow = slow and trial.direction == "too slow"
        if trial.direction == "too slow" and not slow:
            kept[rank] = replace(trial, finding="kept")
    for rank, trial in reversed(list(enumerate(trials))):
        fast = fast and trial.direction == "too fast"
        if trial.direction == "too fast" and not fast:
            kept[rank] = replace(trial, finding="kept")
    return kept


def _wiggle(series: Series, reference: float) -> float:
    """Relative scatter around the best model that the replicates do not account for."""
    residuals = []
    for model in MODELS:
        columns = extreme_curves(model, series.n, reference)
        weights = relative_weights(columns, series.observed)
        fitted = columns @ fit(columns, series.observed[None, :], weights)[0]
        residuals.append(float((relative_miss(series.observed, fitted) ** 2).sum()))
    variance = min(residuals) / (len(series.n) - 2)
    if series.draws is not None:
        scale = np.maximum(series.observed, 1.0)
        variance -= float(((series.draws.std(axis=0) / scale) ** 2).mean())
    return float(np.sqrt(variance)) if variance > TINY**2 else 0.0


def _worlds(series: Series, wiggle: float, seed: int, rounds: int) -> Floats:
    """Values the study could have shown: (rounds, k)."""
    rng = np.random.default_rng(seed)
    k = len(series.n)
    base = np.tile(series.observed, (rounds, 1)) if series.draws is None else series.draws[:rounds]
    scale = wiggle * np.sqrt((k - 2) / rng.chisquare(k - 2, len(base)))
    factor = 1.0 + scale[:, None] * rng.standard_normal((len(base), k))
    return np.maximum(base * factor, 0.0)


def _trial(model: Model, series: Series, worlds: Floats, cut: int, level: float) -> Trial:
    columns = extreme_curves(model, series.n, float(series.n[cut - 1]))
    small, large = columns[:cut], columns[cut:]
    weights = relative_weights(small, series.observed[:cut])
    predicted = np.maximum(large @ fit(small, series.observed[None, :cut], weights)[0], 0.0)
    observed = series.observed[cut:]
    miss = without_noise(relative_miss(observed, predicted).mean())

    predictions = np.maximum(fit(small, worlds[:, :cut], weights) @ large.T, 0.0)
    misses = relative_miss(worlds[:, cut:], predictions).mean(axis=1)
    low, high = (without_noise(end) for end in interval(misses, level))
    band_low, band_high = interval(predictions, level)
    visible = _visible(series, observed, predicted)
    finding = _finding(low, high, visible, series.censored, cut)
    return Trial(model, finding, miss, low, high, predicted, band_low, band_high)


def _visible(series: Series, observed: Floats, predicted: Floats) -> bool:
    """Whether rounding to whole counts could not explain the difference.

    One exception: if every count of the study is the same number, no rounding is at work.
    """
    if not series.whole or np.ptp(series.observed) == 0:
        return True
    return bool(np.abs(observed - predicted).max() > 0.5)


def _finding(
    low: float, high: float, visible: bool, censored: tuple[bool, ...], cut: int
) -> Finding:
    """The reading of the interval.

    A censored size would lie higher if all its tasks had been seen.  If one was fitted, "too
    slow" could be an artefact; if one was challenged, "too fast" could be.
    """
    if not visible:
        return "kept"
    if low > TINY:
        return "withheld" if any(censored[:cut]) else "too slow"
    if high < -TINY:
        return "withheld" if any(censored[cut:]) else "too fast"
    return "kept"
