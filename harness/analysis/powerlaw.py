"""A power law C(n) ≈ c·n^p: the exponent, its bootstrap interval, and the local slopes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.analysis.models import Floats
from harness.analysis.statistics import interval, without_noise

#: Fewer sizes make a slope, not a fit.
LEAST_SIZES = 3


@dataclass(frozen=True)
class PowerLaw:
    """The fitted exponent; ``low``/``high`` is its 95 % bootstrap interval, None if there is none.

    All three are given to a millionth: see ``without_noise``.
    ``start`` is the smallest size in the fit.  ``reason`` says why a number is missing.
    """

    exponent: float | None
    low: float | None
    high: float | None
    start: float | None
    reason: str


def local_slopes(n: Floats, values: Floats) -> list[float | None]:
    """log(C₂/C₁)/log(n₂/n₁) for each size and the one before it; None where undefined."""
    slopes: list[float | None] = [None]
    for step in range(1, len(n)):
        before, after = values[step - 1], values[step]
        if before > 0 and after > 0 and n[step] > n[step - 1]:
            slopes.append(float(np.log(after / before) / np.log(n[step] / n[step - 1])))
        else:
            slopes.append(None)
    return slopes


def power_law(n: Floats, values: Floats, draws: Floats | None) -> PowerLaw:
    """Least squares of log C on log n, from the smallest size after which no count is zero.

    A count of zero has no logarithm.  Adding one to every count would hide that and bend the
    slope of small counts, so sizes up to the last zero are left out instead, and the result says
    where the fit starts.  ``draws`` are the (B, k) bootstrap values of the statistic, or None
    where the replicates agree and there is nothing to resample; draws with a zero in the fitted
    range are left out, and more than one in twenty of them means no interval.
    """
    zeros = np.flatnonzero(values <= 0)
    start = int(zeros[-1]) + 1 if len(zeros) else 0
    if len(np.unique(n[start:])) < LEAST_SIZES:
        why = "counts of zero" if start else f"fewer than {LEAST_SIZES} sizes"
        return PowerLaw(None, None, None, None, f"undefined: {why}")
    x = np.log(n[start:])
    x = (x - x.mean()) / ((x - x.mean()) ** 2).sum()
    exponent = without_noise(np.log(values[start:]) @ x)
    note = "" if start == 0 else f"fitted from n = {n[start]:g}, after the last count of zero"
    if draws is None:
        note = "; ".join(filter(None, [note, "no bootstrap: the replicates agree"]))
        return PowerLaw(exponent, None, None, float(n[start]), note)
    usable = draws[(draws[:, start:] > 0).all(axis=1)][:, start:]
    if len(usable) < 0.95 * len(draws):
        note = "; ".join(filter(None, [note, "no interval: resamples reach zero"]))
        return PowerLaw(exponent, None, None, float(n[start]), note)
    low, high = interval(np.log(usable) @ x)
    return PowerLaw(exponent, without_noise(low), without_noise(high), float(n[start]), note)
