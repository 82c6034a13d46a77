"""How many tasks may run at a time without getting into each other's way."""

from __future__ import annotations

import math
import os
from pathlib import Path

_QUOTA = Path("/sys/fs/cgroup/cpu.max")


def default_jobs() -> int:
    """The processors this process may use: those it is bound to, or its container's share.

    Time limits are by the clock on the wall, so a task must not wait for a processor.
    """
    if hasattr(os, "sched_getaffinity"):
        count = len(os.sched_getaffinity(0))
    else:  # macOS
        count = os.cpu_count() or 1
    try:
        share = container_share(_QUOTA.read_text())
    except (OSError, ValueError):  # no container, or none that says
        share = math.inf
    return max(1, math.floor(min(count, share)))


def container_share(cpu_max: str) -> float:
    """The processors granted by the text of a control group's ``cpu.max``, as "150000 100000".

    Raises ValueError if it is malformed.
    """
    quota, period = cpu_max.split()
    return math.inf if quota == "max" else int(quota) / int(period)
