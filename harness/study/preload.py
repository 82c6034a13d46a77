"""Imported once by the server from which every task's process is forked, so forks start warm.

A first build reads tables and compiled code that later ones find ready; done here, it is not
timed in anybody's row.
"""

import contextlib


def _warm_up() -> None:
    from harness.diagram import BUILDERS
    from harness.study.task import Task
    from harness.study.worker import execute

    for domain in ("kernel", "plane"):
        execute(Task("convex-circle", 3, (), 0, 0, domain, "smallest", BUILDERS[0]))


# A builder that fails must fail in the tasks, with a row each, and not take the server down.
with contextlib.suppress(Exception):
    _warm_up()
