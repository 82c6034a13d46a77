"""Imported once by the server from which every task's process is forked, so forks start warm.

What a first build reads and compiles is not timed in anybody's row then, nor does the memory that
compiling takes count against the limit of a task.
"""

import contextlib

from harness.study.warming import compile_apart, warm_up

# A builder that fails must fail in the tasks, with a row each, and not take the server down.
with contextlib.suppress(Exception):
    compile_apart()
    warm_up()
