"""The work of one task, inside its own process: make the instance, build, check, count."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import generators
from harness.diagram import build
from harness.diagram.identities import broken_identity
from harness.geometry.instance import Instance
from harness.geometry.validation import validate
from harness.study.outcome import Measurement
from harness.study.task import Task

if TYPE_CHECKING:
    from harness.diagram.planar_map import PlanarMap

MOST_EDGES = 20_000
"""A map with more edges is checked by its counts alone: its objects cost more than building it."""


class SanityError(Exception):
    """The builder returned a map that contradicts itself."""


def execute(task: Task) -> Measurement:
    """Build the diagram of a task and count it; only the building is timed.

    A map of at most ``MOST_EDGES`` edges is checked object by object, with an exact contest at a
    witness point in every cell; of any other the identities of its counts are checked (Euler's
    formula, the ends of edges), in which no count of the fast builder comes from another.

    Raises GeneratorError or UserError if the input is refused, SanityError if the map fails its
    own check, and whatever else goes wrong in the builder.
    """
    instance = instance_of(task)
    start = time.perf_counter()
    planar_map = build(instance, task.domain, task.objective, task.builder, workers=1)
    seconds = time.perf_counter() - start
    _check(planar_map)
    return Measurement(planar_map.counts, seconds)


def instance_of(task: Task) -> Instance:
    """The instance of a task, validated.  Raises GeneratorError or UserError."""
    generated = generators.generate(task.family, task.n, seed=task.seed, **dict(task.params))
    instance = Instance.from_generated(generated)
    validate(instance)
    return instance


def _check(planar_map: PlanarMap) -> None:
    """Raise SanityError if a map contradicts itself."""
    try:
        counts = planar_map.counts
        if counts.edges <= MOST_EDGES:
            planar_map.sanity_check()
        broken = broken_identity(counts)
    except Exception as error:  # whatever class it has, it is never the input's fault
        raise SanityError(f"sanity check: {error}") from error
    if broken is not None:
        raise SanityError(f"{broken.key}: {broken.stated}, but {broken.implied}")
