"""Smoothed complexity: how noise takes the vertices of a weave away, and how that scales with n.

A curve holds, for one n, the share y = vertices / predicted vertices at several noises ε.  The
scaling hypothesis says that all curves are one function of ε·nᵃ.  Its exponent is found by
*collapse*: shift each curve by a·ln n along ln ε, and measure how far every point lies from the
others' curves, interpolated at its place (Bhattacharjee and Seno).  To the left of its range a
curve that begins with nearly all vertices is continued with the share 1, which is exact for small
noise; beyond that no curve is continued.

The exponent's interval is a percentile bootstrap over the replicates.  It knows nothing of the
hypothesis being false or of sizes too small: the exponents of neighbouring sizes alone are
there to show a drift.  So a whole exponent is ruled out only if it lies outside all these intervals
by more than they extend together.  Besides, the transition σ(n), the noise that leaves half of
the vertices, has an exponent of its own, from least squares of ln σ on ln n; and so has the decay
of the share with the noise where little is left.

References
----------
S. M. Bhattacharjee, F. Seno: A measure of data collapse for scaling.  Journal of Physics A 34
(2001), 6375–6380.

J. Houdayer, A. K. Hartmann: Low-temperature behavior of two-dimensional Gaussian Ising spin
glasses.  Physical Review B 70 (2004), 014418 (its appendix: a weighted measure).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from scipy.optimize import minimize_scalar

from harness.analysis.models import Floats
from harness.analysis.statistics import interval

#: Exponents outside are not looked for.
RANGE = (0.0, 8.0)
#: Whole exponents with which the best one is compared.
HYPOTHESES = (1.0, 2.0, 3.0, 4.0, 5.0)
#: Bootstrap resamples of a collapse.
RESAMPLES = 300
#: Fewer noises at one n, or fewer sizes, make no curve and no scaling.
LEAST_NOISES, LEAST_SIZES = 4, 2
#: A curve that begins above this share of the predicted vertices has all of them further left.
PLATEAU = 0.95
#: The share of the predicted vertices that defines the transition.
HALF = 0.5
#: Where less of the predicted vertices is left, their decay is measured, at so many noises or more.
REMNANT, LEAST_REMNANTS = 0.2, 3


@dataclass(frozen=True)
class Curve:
    """One n: ``noise`` (k,) ascending and positive; ``samples``: k arrays of shares."""

    n: int
    noise: Floats
    samples: tuple[Floats, ...]

    @cached_property
    def median(self) -> Floats:
        """The median share at each noise, (k,)."""
        return np.array([np.median(sample) for sample in self.samples])

    def resampled(self, rng: np.random.Generator) -> Floats:
        """The medians of replicates drawn with replacement, (k,)."""
        return np.array([np.median(rng.choice(sample, len(sample))) for sample in self.samples])


@dataclass(frozen=True)
class Estimate:
    """A number and its 95 % bootstrap interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Collapse:
    """The scaling of one weave's curves.

    ``spread`` is the root mean square distance of the curves at the best exponent, in units of
    the share; ``spreads`` that at each of ``HYPOTHESES``.  ``neighbours`` are the exponents
    from two neighbouring sizes alone, as (n, next n, estimate).  ``transition`` has, for each n
    whose curve crosses one half, the noise there; ``transition_exponent`` is a in σ ~ n^(−a), or
    None if fewer than two do.  ``decay`` is a in share ~ ε^(−a) at the largest n, where the share
    is below ``REMNANT``, or None if too few noises leave so little.
    """

    curves: tuple[Curve, ...]
    exponent: Estimate
    spread: float
    spreads: tuple[float, ...]
    neighbours: tuple[tuple[int, int, Estimate], ...]
    transition: tuple[tuple[int, Estimate], ...]
    transition_exponent: Estimate | None
    decay: Estimate | None

    @property
    def drift(self) -> tuple[float, float]:
        """The least and the greatest end of the neighbours' intervals, and of the joint one."""
        every = [self.exponent, *(estimate for _, _, estimate in self.neighbours)]
        return min(one.low for one in every), max(one.high for one in every)

    @property
    def possible(self) -> tuple[float, float]:
        """The drift, widened on either side by its own width: exponents that are not ruled out."""
        low, high = self.drift
        return 2 * low - high, 2 * high - low

    @property
    def is_consistent(self) -> bool:
        """Whether the intervals of all pairs of neighbouring sizes have a number in common."""
        low = max((one.low for *_, one in self.neighbours), default=0.0)
        return low <= min((one.high for *_, one in self.neighbours), default=0.0)


def curves(table: pd.DataFrame) -> list[Curve]:
    """The curves of one weave from rows with ``n``, ``noise`` and ``share``.

    Rows without noise have no place on a logarithmic axis and are left out, and so are sizes
    with fewer than ``LEAST_NOISES`` noises.
    """
    noisy = table[table["noise"] > 0]
    found = []
    for n, part in noisy.groupby("n", sort=True):
        cells = [(float(str(noise)), rows) for noise, rows in part.groupby("noise", sort=True)]
        if len(cells) >= LEAST_NOISES:
            noise = np.array([noise for noise, _ in cells])
            samples = tuple(rows["share"].to_numpy(dtype=np.float64) for _, rows in cells)
            found.append(Curve(int(str(n)), noise, samples))
    return found


def spread(curves: Sequence[Curve], medians: Sequence[Floats], exponent: float) -> float:
    """Root mean square distance between the shifted curves; O(curves² · noises)."""
    places = [np.log(curve.noise) + exponent * np.log(curve.n / curves[0].n) for curve in curves]
    total, count = 0.0, 0
    for one, (place, share) in enumerate(zip(places, medians, strict=True)):
        for other, (along, level) in enumerate(zip(places, medians, strict=True)):
            if one != other:
                start = -np.inf if level[0] > PLATEAU else along[0]
                within = (place >= start) & (place <= along[-1])
                distance = share[within] - np.interp(place[within], along, level, left=1.0)
                total += float((distance**2).sum())
                count += int(within.sum())
    return float(np.sqrt(total / count)) if count else float("inf")


def best_exponent(curves: Sequence[Curve], medians: Sequence[Floats]) -> float:
    """The exponent of least spread: a coarse search, then Brent's method."""
    grid = np.linspace(*RANGE, 33)
    values = [spread(curves, medians, float(exponent)) for exponent in grid]
    step = float(grid[1] - grid[0])
    centre = float(grid[int(np.argmin(values))])
    bounds = (max(RANGE[0], centre - step), min(RANGE[1], centre + step))
    found = minimize_scalar(
        lambda exponent: spread(curves, medians, float(exponent)),
        bounds=bounds,
        method="bounded",
        options={"xatol": 1e-4},
    )
    return float(found.x)


def collapse(curves: Sequence[Curve], seed: int = 0) -> Collapse | None:
    """The scaling of the curves; None if there are fewer than two.  Deterministic in ``seed``."""
    if len(curves) < LEAST_SIZES:
        return None
    rng = np.random.default_rng(seed)
    medians = [curve.median for curve in curves]
    draws = [[curve.resampled(rng) for curve in curves] for _ in range(RESAMPLES)]
    exponent = best_exponent(curves, medians)
    return Collapse(
        tuple(curves),
        _estimate(exponent, [best_exponent(curves, draw) for draw in draws]),
        spread(curves, medians, exponent),
        tuple(spread(curves, medians, hypothesis) for hypothesis in HYPOTHESES),
        tuple(_neighbours(curves, draws)),
        *_transition(curves, draws),
        _decay(curves[-1], [draw[-1] for draw in draws]),
    )


def _neighbours(
    curves: Sequence[Curve], draws: Sequence[Sequence[Floats]]
) -> Iterator[tuple[int, int, Estimate]]:
    for k in range(len(curves) - 1):
        pair = curves[k : k + 2]
        value = best_exponent(pair, [curve.median for curve in pair])
        scattered = [best_exponent(pair, draw[k : k + 2]) for draw in draws]
        yield pair[0].n, pair[1].n, _estimate(value, scattered)


def _transition(
    curves: Sequence[Curve], draws: Sequence[Sequence[Floats]]
) -> tuple[tuple[tuple[int, Estimate], ...], Estimate | None]:
    found: dict[int, float] = {}
    scattered: dict[int, list[float]] = {}
    for k, curve in enumerate(curves):
        place = crosses(curve.noise, curve.median)
        if place is not None:
            found[k] = place
            drawn = (crosses(curve.noise, draw[k]) for draw in draws)
            scattered[k] = [np.nan if noise is None else noise for noise in drawn]
    table = tuple((curves[k].n, _estimate(found[k], scattered[k])) for k in found)
    if len(found) < LEAST_SIZES:
        return table, None
    slope = _slope(np.log([curves[k].n for k in found]))
    value = -float(slope @ np.log(list(found.values())))
    return table, _estimate(value, (-slope @ np.log(list(scattered.values()))).tolist())


def _slope(places: Floats) -> Floats:
    """The weights (k,) by which values at the places become the slope of least squares."""
    centred = places - places.mean()
    return np.asarray(centred / (centred**2).sum())


def _decay(curve: Curve, draws: Sequence[Floats]) -> Estimate | None:
    """The power of 1/noise by which the last vertices go; None if that is seen at few noises."""
    some = np.array([sample.min() > 0 for sample in curve.samples])
    remnant = some & (curve.median < REMNANT)
    if remnant.sum() < LEAST_REMNANTS:
        return None
    slope = -_slope(np.log(curve.noise[remnant]))
    scattered = [float(slope @ np.log(draw[remnant])) for draw in draws]
    return _estimate(float(slope @ np.log(curve.median[remnant])), scattered)


def crosses(noise: Floats, share: Floats, level: float = HALF) -> float | None:
    """The noise at which the share first falls below ``level``; None if it does not.

    Linear in the logarithm of the noise, between the last point above and the first below.
    """
    below = np.flatnonzero(share < level)
    if not len(below) or below[0] == 0:
        return None
    k = int(below[0])
    part = (share[k - 1] - level) / (share[k - 1] - share[k])
    low, high = np.log(noise[k - 1]), np.log(noise[k])
    return float(np.exp(low + part * (high - low)))


def _estimate(value: float, draws: Iterable[float]) -> Estimate:
    """With the interval of those draws in which the number exists."""
    scattered = np.array(list(draws))
    scattered = scattered[np.isfinite(scattered)]
    if not len(scattered):
        return Estimate(value, value, value)
    low, high = interval(scattered)
    return Estimate(value, float(low), float(high))


def seed_of(*identity: object) -> int:
    """A seed from what the numbers are about, not from the order in which they are computed."""
    text = "\x1f".join(str(part) for part in identity)
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big")
