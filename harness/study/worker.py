"""The work of one task, inside its own process: make the instance, build, check, count."""

from __future__ import annotations

import time

import generators
from harness.diagram import build
from harness.geometry.instance import Instance
from harness.geometry.validation import validate
from harness.study.outcome import Measurement
from harness.study.task import Task


class SanityError(Exception):
    """The builder returned a map that contradicts itself."""


def execute(task: Task) -> Measurement:
    """Build the diagram of a task and count it; only the building is timed.

    Raises GeneratorError or UserError if the input is refused, SanityError if the map fails its
    own check, and whatever else goes wrong in the builder.
    """
    generated = generators.generate(task.family, task.n, seed=task.seed, **dict(task.params))
    instance = Instance.from_generated(generated)
    validate(instance)
    start = time.perf_counter()
    planar_map = build(instance, task.domain, task.objective, task.builder, workers=1)
    seconds = time.perf_counter() - start
    try:
        planar_map.sanity_check()
    except Exception as error:  # whatever class it has, it is never the input's fault
        raise SanityError(f"sanity check: {error}") from error
    return Measurement(planar_map.counts, seconds)
