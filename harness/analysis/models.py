"""The candidate growth models, and how one of them is fitted to counts.

A model says that the count C(n) is *led* by m(n), one of 1, log n, n, n log n, n².  Small
instances never show the leading term alone, so every model carries one term of lower order:

    C(n) = a·m(n) + b·l(n),      l(n) = 1/n, 1, 1, n, n   for the five models in turn.

With b free a faster model could always imitate a slower one (take a ≈ 0), and nothing would ever
be rejected.  The leading term therefore has to lead: at the largest size of the fit, a·m is at
least a quarter and at most twice the whole count.  These two limits span a cone; its two extreme
curves are the basis in which a model is fitted, with two coefficients that must not be negative.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.float64]
Curve: TypeAlias = Callable[[Floats], Floats]

#: The leading term is at least this share of the count at the largest fitted size …
LEAST_SHARE = 0.25
#: … and at most this share (more than all of it: the lower-order term may be negative).
GREATEST_SHARE = 2.0


@dataclass(frozen=True)
class Model:
    """One candidate: its name as families declare it, its symbol for people, its two terms."""

    name: str
    symbol: str
    word: str
    leading: Curve
    lower: Curve


#: Slowest first; "slower" and "faster" below always mean this order.
MODELS: tuple[Model, ...] = (
    Model("1", "1", "constant", np.ones_like, lambda n: 1.0 / n),
    Model("log n", "log n", "logarithmic", np.log, np.ones_like),
    Model("n", "n", "linear", lambda n: n, np.ones_like),
    Model("n log n", "n log n", "n log n", lambda n: n * np.log(n), lambda n: n),
    Model("n^2", "n²", "quadratic", lambda n: n * n, lambda n: n),
)
BY_NAME: dict[str, Model] = {model.name: model for model in MODELS}
LINEAR = next(rank for rank, model in enumerate(MODELS) if model.name == "n")


def extreme_curves(model: Model, n: Floats, reference: float) -> Floats:
    """The two curves that span the model's cone, as columns of a (k, 2) array.

    Both are 1/share at ``n = reference`` when their leading term is scaled to 1 there; the first
    has the least allowed share of leading term, the second the greatest.  ``n`` are k sizes > 1.
    """
    at = np.array([reference])
    leading = model.leading(n) / model.leading(at)
    lower = model.lower(n) / model.lower(at)
    return np.stack(
        [leading + (1 / share - 1) * lower for share in (LEAST_SHARE, GREATEST_SHARE)], axis=1
    )


def fit(columns: Floats, values: Floats, weights: Floats) -> Floats:
    """Least squares with two non-negative coefficients, for many data sets at once.

    ``columns`` is (k, 2), ``values`` (B, k), ``weights`` (k,); returns the (B, 2) minimisers of
    Σ (w·(values − columns·c))² over c ≥ 0.  Closed form: the unconstrained minimum if it is
    allowed, otherwise the better of the two edges of the quadrant.  O(Bk).
    """
    weighted = columns * weights[:, None]
    gram = weighted.T @ weighted
    moments = (values * weights) @ weighted
    # The inverse of a 2×2 matrix, written out: this is the innermost step of every resampling.
    adjugate = np.array([[gram[1, 1], -gram[0, 1]], [-gram[1, 0], gram[0, 0]]])
    determinant = gram[0, 0] * gram[1, 1] - gram[0, 1] * gram[1, 0]
    independent = determinant > 1e-12 * gram[0, 0] * gram[1, 1]
    free = moments @ adjugate / determinant if independent else np.full_like(moments, -1.0)
    edges = np.maximum(moments / gram.diagonal(), 0.0)
    gains = edges * moments  # how much each single column lowers the sum of squares
    better = gains[:, 0] >= gains[:, 1]
    on_edge = np.where(np.stack([better, np.logical_not(better)], axis=1), edges, 0.0)
    allowed = (free[:, 0] >= 0) & (free[:, 1] >= 0)
    return np.where(allowed[:, np.newaxis], free, on_edge)


def relative_weights(columns: Floats, values: Floats) -> Floats:
    """Weights with which least squares minimise the sum of squares of ``relative_miss``.

    That is 1/max(observed, fitted, 1), found by reweighting; three rounds settle.  With the
    observed count alone, one that happens to be low would gain weight by it; with the fitted one
    alone, a hopeless fit near zero would.  ``values`` is (k,).
    """
    weights = 1.0 / np.maximum(values, 1.0)
    for _ in range(3):
        fitted = columns @ fit(columns, values[None, :], weights)[0]
        weights = 1.0 / np.maximum(np.maximum(values, fitted), 1.0)
    return weights


def relative_miss(observed: Floats, predicted: Floats) -> Floats:
    """(observed − predicted) / max(observed, predicted, 1): between −1 and 1 for counts ≥ 0.

    A whole object is the unit below which a count has no meaning, hence the 1; it also makes
    counts of zero ordinary values instead of a special case.
    """
    scale: Floats = np.maximum(np.maximum(observed, predicted), 1.0)
    return (observed - predicted) / scale
