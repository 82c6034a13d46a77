"""A task counted again in another way: what ``avd verify`` does for a row.

Where it is feasible the other builder counts.  Elsewhere the fast builder has to take another way
to the same diagram: the instance is turned by a quarter and its segments are listed from another
one on (both exact in doubles, and the counts do not change), the domain is cut into other
triangles, and the work is split among another number of threads.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from harness.diagram import build
from harness.diagram.counts import Domain
from harness.errors import UserError
from harness.geometry.coordinates import Floats
from harness.geometry.instance import Instance
from harness.study.outcome import Measurement
from harness.study.task import Task
from harness.study.worker import instance_of

if TYPE_CHECKING:
    from harness.diagram.planar_map import PlanarMap

Choice = Literal["auto", "fast", "reference"]
"""Who counts again; ``auto``: another builder than before, where that is feasible."""

CHOICES: tuple[Choice, ...] = get_args(Choice)

FEASIBLE: dict[Domain, int] = {"kernel": 14, "interior": 10, "plane": 8}
"""So many segments at most take the reference builder a second or two."""
WORKERS = 2
"""Threads of a recount; a study counts on one."""
WAYS = ((True, 1), (False, 2), (True, 3))
"""Of the fast builder, in the order in which they are tried: whether the instance is turned, and
the subdivision; a study counts with (False, 0).  Very symmetric input defeats some of them."""


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
    start = time.perf_counter()
    if builder == "fast":
        made = _built_in_another_way(instance, task)
    else:
        made = build(instance, task.domain, task.objective, builder)
    return Measurement(made.counts, time.perf_counter() - start)


def _built_in_another_way(instance: Instance, task: Task) -> PlanarMap:
    """The fast builder's map by the first of ``WAYS`` that it can certify.  Raises UserError."""
    problem: UserError | None = None
    for turned, subdivision in WAYS:
        view = another_view(instance) if turned else instance
        try:
            return build(view, task.domain, task.objective, "fast", WORKERS, subdivision)
        except UserError as error:
            problem = error
    assert problem is not None
    raise problem


def another_view(instance: Instance) -> Instance:
    """The instance turned by a quarter, (x, y) ↦ (−y, x), and listed from its middle on.

    Exact: no coordinate is rounded, for a change of sign and of place rounds nothing.
    """
    points: Floats = instance.floats
    turned = np.stack([-points[..., 1], points[..., 0]], axis=-1)
    return Instance(instance.kind, np.roll(turned, len(turned) // 2, axis=0), name=instance.name)
