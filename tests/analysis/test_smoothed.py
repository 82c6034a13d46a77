"""Scaling by collapse: planted exponents come back, and what is no scaling is seen as such."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from harness.analysis import smoothed
from harness.analysis.smoothed import HYPOTHESES, Curve, best_exponent, collapse, crosses, curves

SIZES = (32, 64, 128, 256)
NOISES = 10.0 ** np.arange(-8.0, -0.9, 1 / 3)


@pytest.fixture(autouse=True)
def few_resamples(monkeypatch) -> None:
    monkeypatch.setattr(smoothed, "RESAMPLES", 60)


def planted(exponent, scatter=0.05, seed=0, bend=0.0) -> list[Curve]:
    """Shares 1/(1 + z^p) of z = c·ε·nᵃ; with ``bend`` the power p depends on n: no scaling."""
    rng = np.random.default_rng(seed)
    found = []
    for n in SIZES:
        z = NOISES * (n / 32.0) ** exponent * 1e4
        share = 1 / (1 + z ** (0.8 + bend * np.log(n / 32)))
        samples = tuple(y * rng.lognormal(0, scatter, 30) for y in share)
        found.append(Curve(n, NOISES, samples))
    return found


@pytest.mark.parametrize("exponent", [1.5, 2.0, 3.0, 4.0])
def test_a_planted_exponent_is_recovered(exponent) -> None:
    result = collapse(planted(exponent))
    assert result is not None
    assert result.transition_exponent is not None
    assert result.exponent.value == pytest.approx(exponent, abs=0.03)
    assert result.exponent.low <= exponent <= result.exponent.high
    assert result.exponent.high - result.exponent.low < 0.1
    assert result.transition_exponent.value == pytest.approx(exponent, abs=0.06)
    assert result.drift[0] <= exponent <= result.drift[1]


def test_wrong_exponents_spread_the_curves() -> None:
    result = collapse(planted(3.0))
    assert result is not None
    spreads = dict(zip(HYPOTHESES, result.spreads, strict=True))
    assert spreads[3.0] < 1.1 * result.spread
    assert min(spreads[2.0], spreads[4.0]) > 5 * result.spread


def test_what_does_not_scale_leaves_a_spread() -> None:
    straight, bent = collapse(planted(3.0)), collapse(planted(3.0, bend=0.5))
    assert straight is not None
    assert bent is not None
    assert bent.spread > 3 * straight.spread


@pytest.mark.parametrize("level", [0.3, 0.5, 0.8])
def test_the_crossing_is_where_the_share_was_planted(level) -> None:
    share = 1 - (np.log10(NOISES) + 8) / 7.5  # straight: interpolation is exact
    noise = crosses(NOISES, share, level)
    assert noise is not None
    assert 1 - (np.log10(noise) + 8) / 7.5 == pytest.approx(level)


def test_no_crossing_is_no_transition() -> None:
    assert crosses(NOISES, np.ones(len(NOISES))) is None
    assert crosses(NOISES, np.zeros(len(NOISES))) is None
    calm = [Curve(n, NOISES, tuple(np.ones(3) for _ in NOISES)) for n in SIZES]
    result = collapse(calm)
    assert result is not None
    assert result.transition == ()
    assert result.transition_exponent is None


def test_one_size_has_no_scaling() -> None:
    assert collapse(planted(3.0)[:1]) is None


def test_the_exponent_does_not_depend_on_units_of_noise() -> None:
    given = planted(2.5)
    scaled = [Curve(curve.n, curve.noise * 7.0, curve.samples) for curve in given]
    medians = [curve.median for curve in given]
    assert best_exponent(given, medians) == pytest.approx(best_exponent(scaled, medians), abs=1e-6)


def test_curves_are_read_from_rows() -> None:
    rows = [
        {"n": n, "noise": noise, "share": share}
        for n in (16, 8)
        for noise in (0.0, 1e-3, 1e-5, 1e-4, 1e-2)
        for share in (0.25, 1.0, 0.5)
    ]
    rows.append({"n": 4, "noise": 1e-3, "share": 1.0})  # one noise is no curve
    found = curves(pd.DataFrame(rows))
    assert [curve.n for curve in found] == [8, 16]
    assert found[0].noise.tolist() == [1e-5, 1e-4, 1e-3, 1e-2]
    assert found[1].median.tolist() == [0.5] * 4


def powers(power: float) -> list[Curve]:
    """Curves of which ever less is left, like a power of the noise beyond the transition."""
    rng = np.random.default_rng(4)
    found = []
    for n in SIZES:
        share = np.minimum(1.0, (NOISES * n**2) ** -power)
        samples = tuple(y * rng.lognormal(0, 0.05, 30) for y in share)
        found.append(Curve(n, NOISES, samples))
    return found


@pytest.mark.parametrize("power", [0.6, 1.0])
def test_the_power_by_which_the_last_vertices_go_is_recovered(power) -> None:
    result = collapse(powers(power))
    assert result is not None
    assert result.decay is not None
    assert result.decay.low <= power <= result.decay.high
    assert result.decay.high - result.decay.low < 0.1


def test_no_power_is_read_off_few_noises_or_no_vertices() -> None:
    curves = planted(3.0)
    kept = [Curve(c.n, c.noise[:4], c.samples[:4]) for c in curves]  # none leaves so little
    assert min(curve.median.min() for curve in kept) > smoothed.REMNANT
    result = collapse(kept)
    assert result is not None
    assert result.decay is None
    gone = [
        Curve(
            c.n,
            c.noise,
            tuple(np.where(c.median[k] < 0.5, 0.0, s) for k, s in enumerate(c.samples)),
        )
        for c in curves
    ]
    result = collapse(gone)
    assert result is not None
    assert result.decay is None


def drifting() -> list[Curve]:
    """The exponents of neighbouring sizes are 2, 3 and 4."""
    found = []
    for curve, shift in zip(planted(0.0), (0, 2, 5, 9), strict=True):
        found.append(Curve(curve.n, curve.noise / 2.0**shift, curve.samples))
    return found


def test_sizes_that_disagree_widen_what_is_possible() -> None:
    steady, drifts = collapse(planted(3.0)), collapse(drifting())
    assert steady is not None
    assert drifts is not None
    assert steady.is_consistent
    assert not drifts.is_consistent
    for result in (steady, drifts):
        (low, high), (least, most) = result.drift, result.possible
        assert low - least == pytest.approx(high - low)
        assert most - high == pytest.approx(high - low)
