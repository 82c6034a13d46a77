"""A task counted again in another way: what ``avd verify`` does for a row.

Where it is feasible the other builder counts.  Elsewhere the fast builder has to take another way
to the same diagram: the instance is turned by a quarter and its segments are listed from another
one on (both exact in doubles, and the counts do not change), the domain is cut into other
triangles, and the work is split among another number of threads.
"""

from __future__ import annotations

import time
from typing import Literal, get_args

import numpy as np

from harness.diagram import build
from harness.diagram.counts import Domain
from harness.geometry.coordinates import Floats
from harness.geometry.instance import Instance
from harness.study.outcome import Measurement
from harness.study.task import Task
from harness.study.worker import instance_of

Choice = Literal["auto", "fast", "reference"]
"""Who counts again; ``auto``: another builder than before, where that is feasible."""

CHOICES: tuple[Choice, ...] = get_args(Choice)

FEASIBLE: dict[Domain, int] = {"kernel": 14, "interior": 10, "plane": 8}
"""So many segments at most take the reference builder a second or two."""
SUBDIVISION, WORKERS = 1, 2
"""Of a recount; a study counts with subdivision 0 on one thread."""


def recounter(task: Task, choice: Choice) -> str:
    """The builder that counts a task again."""
    if choice != "auto":
        return choice
    if task.builder != "fast":
        return "fast"
    return "reference" if task.n <= FEASIBLE[task.domain] else "fast"


def recount(choice: Choice, task: Task) -> Measurement:
    """The counts of a task, found in another way; raises as :func:`harness.study.worker.execute`.

    The counts name the builder that found them.
    """
    instance = instance_of(task)
    builder = recounter(task, choice)
    if builder == "fast":
        instance = another_view(instance)
    start = time.perf_counter()
    made = build(instance, task.domain, task.objective, builder, WORKERS, SUBDIVISION)
    return Measurement(made.counts, time.perf_counter() - start)


def another_view(instance: Instance) -> Instance:
    """The instance turned by a quarter, (x, y) ↦ (−y, x), and listed from its middle on.

    Exact: no coordinate is rounded, for a change of sign and of place rounds nothing.
    """
    points: Floats = instance.floats
    turned = np.stack([-points[..., 1], points[..., 0]], axis=-1)
    return Instance(instance.kind, np.roll(turned, len(turned) // 2, axis=0), name=instance.name)
