"""What one task may use, and how a process is kept to it from within."""

from __future__ import annotations

import multiprocessing
import os
import resource
import signal
import sys
import threading
from dataclasses import dataclass

import psutil

MIB = 2**20

GRACE = 20.0
"""Seconds after which a process whose supervisor failed to stop it in time ends by itself."""


@dataclass(frozen=True)
class Limits:
    """Wall-clock ``seconds`` and resident memory ``mib`` (MiB) of one task's process."""

    seconds: float
    mib: int


def confine(limits: Limits) -> None:
    """Bind the present process, which is to run one task and nothing else.

    * SIGTERM and SIGALRM kill at once, by the kernel: a handler in Python would wait for as long
      as a call into C holds the interpreter.  The alarm ends an orphan of a killed run.
    * Private memory may grow by what the limit leaves above the present resident size, where the
      system counts such memory (Linux); beyond, an allocation fails.  The supervisor watches the
      resident size as well.
    * When the process that started this one is gone, this one goes too.
    """
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, limits.seconds + GRACE)
    _limit_data(limits.mib * MIB)
    threading.Thread(target=_follow_parent, daemon=True).start()


def _limit_data(budget: int) -> None:
    memory = psutil.Process().memory_info()
    data = getattr(memory, "data", 0)
    if data:  # only Linux tells
        _set_soft_data_limit(data + max(budget - memory.rss, 0))


def lift_data_limit() -> None:
    """Take the limit on private memory back, so a result can be sent after a failed allocation."""
    _set_soft_data_limit(resource.getrlimit(resource.RLIMIT_DATA)[1])


def _set_soft_data_limit(value: int) -> None:
    hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
    if hard != resource.RLIM_INFINITY and (value > hard or value == resource.RLIM_INFINITY):
        value = hard
    resource.setrlimit(resource.RLIMIT_DATA, (value, hard))


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def peak_mib() -> float:
    """The greatest resident size this process has had, in MiB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / MIB if sys.platform == "darwin" else peak / 1024
