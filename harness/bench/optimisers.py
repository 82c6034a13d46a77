"""General-purpose optimisers on the max-min problem: what somebody without this project would use.

Each gets the visual angles as a function (vectorised over the edges) and a box around the kernel,
and nothing else is known to it.  None of them proves anything.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import optimize

from harness.geometry.instance import Instance
from harness.geometry.kernel import kernel

Floats = npt.NDArray[np.float64]

RESTARTS = 10

#: With fewer demands on the shapes of arrays than its stubs have.
minimise: Callable[..., Any] = optimize.minimize


class Reached(NamedTuple):
    """The best point, and how often the angles were evaluated."""

    x: float
    y: float
    evaluations: int


class _Problem:
    """The visual angles of a polygon's edges, signed: negative outside the kernel."""

    def __init__(self, instance: Instance, seed: int) -> None:
        self.a, self.b = instance.segments[:, 0], instance.segments[:, 1]
        corners = kernel(instance).floats
        self.low, self.high = corners.min(axis=0), corners.max(axis=0)
        rng = np.random.default_rng(seed)
        weights = rng.dirichlet(np.ones(len(corners)), RESTARTS)
        self.starts: Floats = weights @ corners
        self.evaluations = 0

    def angles(self, p: Floats) -> Floats:
        """θ where an edge is seen from its inner side, −θ where not."""
        self.evaluations += 1
        u, v = self.a - p, self.b - p
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        return np.asarray(np.arctan2(area, u[:, 0] * v[:, 0] + u[:, 1] * v[:, 1]))

    def gradients(self, p: Floats) -> Floats:
        """∇θ of every edge, (n, 2)."""
        u, v = self.a - p, self.b - p
        uu, vv = (u * u).sum(axis=1), (v * v).sum(axis=1)
        return np.stack([u[:, 1] / uu - v[:, 1] / vv, v[:, 0] / vv - u[:, 0] / uu], axis=1) * -1.0

    def cost(self, p: Floats) -> float:
        """Minus the least angle."""
        return -float(self.angles(p).min())


def nelder_mead(instance: Instance, seed: int = 0) -> Reached:
    """Nelder–Mead from random points of the kernel, the best of ten."""
    problem = _Problem(instance, seed)
    options = {"xatol": 1e-12, "fatol": 1e-14, "maxiter": 2000, "maxfev": 4000}
    found = [
        minimise(problem.cost, start, method="Nelder-Mead", options=options)
        for start in problem.starts
    ]
    best = min(found, key=lambda one: float(one.fun))
    return Reached(float(best.x[0]), float(best.x[1]), problem.evaluations)


def evolution(instance: Instance, seed: int = 0) -> Reached:
    """Differential evolution in the box of the kernel."""
    problem = _Problem(instance, seed)
    box = optimize.Bounds(problem.low, problem.high)
    best = optimize.differential_evolution(problem.cost, box, rng=seed, tol=1e-12, polish=False)
    return Reached(float(best.x[0]), float(best.x[1]), problem.evaluations)


def slsqp(instance: Instance, seed: int = 0) -> Reached:
    """SLSQP on the smooth form: maximise t subject to θ_i(p) ≥ t, from ten points."""
    problem = _Problem(instance, seed)
    ones = np.ones((len(problem.a), 1))
    constraint = {
        "type": "ineq",
        "fun": lambda z: problem.angles(z[:2]) - z[2],
        "jac": lambda z: np.hstack([problem.gradients(z[:2]), -ones]),
    }
    best = (np.inf, problem.starts[0])
    for start in problem.starts:
        found = minimise(
            lambda z: -z[2],
            np.append(start, -problem.cost(start)),
            jac=lambda _z: np.array([0.0, 0.0, -1.0]),
            constraints=[constraint],
            method="SLSQP",
            options={"ftol": 1e-15, "maxiter": 300},
        )
        if np.isfinite(found.x).all():
            best = min(best, (problem.cost(found.x[:2]), found.x[:2]), key=lambda one: one[0])
    return Reached(float(best[1][0]), float(best[1][1]), problem.evaluations)


OPTIMISERS: dict[str, Callable[[Instance], Reached]] = {
    "nelder-mead": nelder_mead,
    "evolution": evolution,
    "slsqp": slsqp,
}
