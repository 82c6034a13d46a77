"""A first build reads tables and compiled code that later ones find ready."""

from __future__ import annotations

import os
import subprocess
import sys


def warm_up() -> None:
    """Build small diagrams with the default builder."""
    from harness.diagram import BUILDERS
    from harness.study.task import Task
    from harness.study.worker import execute

    for domain in ("kernel", "plane"):
        execute(Task("convex-circle", 3, (), 0, 0, domain, "smallest", BUILDERS[0]))


def compile_apart() -> None:
    """Compile what is not compiled yet in a process of its own, whose memory goes with it."""
    from harness.diagram.fast.subdivide import subdivide
    from harness.geometry.jit import is_compiled

    if is_compiled(subdivide):
        return
    subprocess.run(
        [sys.executable, "-c", "from harness.study.warming import warm_up; warm_up()"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        stdin=subprocess.DEVNULL,
        check=True,
    )
