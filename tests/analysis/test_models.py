"""Fitting one model: the cone, the constrained least squares, the relative miss."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import nnls

from harness.analysis.models import (
    GREATEST_SHARE,
    LEAST_SHARE,
    MODELS,
    Model,
    extreme_curves,
    fit,
    relative_miss,
    relative_weights,
)

counts = st.lists(st.integers(0, 10**6), min_size=5, max_size=5)
every_model = pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
SIZES = np.array([6.0, 8.0, 12.0, 16.0, 24.0])


@every_model
@given(observed=counts, seed=st.integers(0, 10**6))
def test_fit_agrees_with_an_independent_solver(
    model: Model, observed: list[int], seed: int
) -> None:
    values = np.array(observed, dtype=np.float64)
    weights = np.random.default_rng(seed).uniform(0.1, 2.0, len(SIZES))
    columns = extreme_curves(model, SIZES, SIZES[-1])
    ours = fit(columns, values[None, :], weights)[0]
    _, residual = nnls(columns * weights[:, None], values * weights)
    assert (ours >= 0).all()
    misfit = np.linalg.norm((columns @ ours - values) * weights)
    assert misfit == pytest.approx(residual, rel=1e-6, abs=1e-6 * (1 + max(observed)))


@every_model
@given(first=st.floats(0, 1e4), second=st.floats(0, 1e4))
def test_leading_term_leads_everywhere_in_the_cone(
    model: Model, first: float, second: float
) -> None:
    # Each extreme curve has leading term 1 at the reference, so their sum has first + second.
    value = extreme_curves(model, SIZES, SIZES[-1])[-1] @ [first, second]
    leading = first + second
    assert value * LEAST_SHARE <= leading * (1 + 1e-12)
    assert leading <= value * GREATEST_SHARE * (1 + 1e-12)


@every_model
@given(
    scale=st.floats(0.5, 1e4),
    correction=st.floats(-0.9, 2.9),
)
def test_counts_of_the_model_are_fitted_exactly(
    model: Model, scale: float, correction: float
) -> None:
    # correction = lower-order term over leading term at the largest size, inside the cone's limits
    correction = max(correction, 1 / GREATEST_SHARE - 1)
    leading = model.leading(SIZES) / model.leading(SIZES[-1:])
    lower = model.lower(SIZES) / model.lower(SIZES[-1:])
    values = scale * (leading + correction * lower)
    columns = extreme_curves(model, SIZES, SIZES[-1])
    curve = columns @ fit(columns, values[None, :], np.ones(len(SIZES)))[0]
    assert curve == pytest.approx(values, rel=1e-6, abs=1e-6 * scale)


@given(observed=counts, factor=st.integers(1, 1000))
def test_fit_is_equivariant_under_scaling(observed: list[int], factor: int) -> None:
    values = np.array(observed, dtype=np.float64)
    columns = extreme_curves(MODELS[2], SIZES, SIZES[-1])
    weights = np.ones(len(SIZES))
    once = fit(columns, values[None, :], weights)
    assert fit(columns, factor * values[None, :], weights) == pytest.approx(
        factor * once, rel=1e-9, abs=1e-6
    )


@given(observed=counts, predicted=st.lists(st.floats(0, 1e7), min_size=5, max_size=5))
def test_relative_miss_is_bounded_antisymmetric_and_zero_only_at_equality(
    observed: list[int], predicted: list[float]
) -> None:
    a, b = np.array(observed, dtype=np.float64), np.array(predicted)
    miss = relative_miss(a, b)
    assert (np.abs(miss) <= 1).all()
    assert (miss == -relative_miss(b, a)).all()
    assert ((miss == 0) == (a == b)).all()


@every_model
@given(observed=counts)
def test_weights_never_blow_up_on_zeros(model: Model, observed: list[int]) -> None:
    values = np.array(observed, dtype=np.float64)
    weights = relative_weights(extreme_curves(model, SIZES, SIZES[-1]), values)
    assert ((weights > 0) & (weights <= 1)).all()
