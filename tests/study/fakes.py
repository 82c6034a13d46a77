"""Work that costs nothing, and work that goes wrong in every way, for tests of the runner."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from pathlib import Path

import generators
from harness.diagram.counts import Counts
from harness.errors import UserError
from harness.study.limits import lift_data_limit
from harness.study.outcome import Measurement
from harness.study.task import Task

_left_behind: list[int] = []


def quick(task: Task) -> Measurement:
    """Counts that depend on the task and on nothing else."""
    digest = int(task.key, 16)
    counts = Counts(
        domain=task.domain,
        objective=task.objective,
        builder=task.builder,
        n=task.n,
        cells=digest % 97,
        edges=digest % 89,
        vertices=digest % 83,
        regions=1,
        loops=0,
        components=1,
        unbounded=0,
        boundary_points=0,
        nodes={"triple": digest % 83},
        degrees={3: digest % 83},
        certified=digest % 2 == 0,
    )
    return Measurement(counts, time.perf_counter() % 1.0)


def delayed_by_seed(task: Task) -> Measurement:
    """As ``quick``, in up to 60 milliseconds: tasks overtake one another."""
    time.sleep((task.seed % 13) * 0.005)
    return quick(task)


def slow_and_logged(log: Path, task: Task) -> Measurement:
    """As ``quick``, in up to 60 milliseconds, adding the task's key to ``log``; some fail."""
    time.sleep((task.seed % 13) * 0.005)
    with open(log, "a") as file:
        file.write(task.key + "\n")
    if task.seed % 5 == 0:
        raise ValueError("planned\nfailure")
    return quick(task)


def stateful(task: Task) -> Measurement:
    """Fails if an earlier task was done in this process."""
    _left_behind.append(task.n)
    if len(_left_behind) > 1:
        raise AssertionError("this process has done a task before")
    return quick(task)


def surroundings(task: Task) -> Measurement:
    """Fails, telling what the process finds around it."""
    blocked = signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ())
    threads = os.environ["OMP_NUM_THREADS"] + os.environ["NUMBA_NUM_THREADS"]
    raise RuntimeError(f"parent {os.getppid()} blocked {blocked} threads {threads}")


def _hold_interpreter() -> None:
    pow(3, 3**30)


def _fill_memory() -> None:
    hoard = []
    while True:
        hoard.append(bytearray(1 << 20))


def _allocate_at_once() -> None:
    import numpy as np

    np.ones(1 << 34)


def _reserve() -> None:
    import numpy as np

    np.empty(1 << 30, dtype=np.uint8)  # never touched: the resident size stays small


def _wrap_memory_error() -> None:
    try:
        _fill_memory()
    except MemoryError:
        raise RuntimeError("something else") from None


def _abort_for_memory() -> None:
    import flint

    flint.fmpz(3) ** (1 << 34)


def _refuse() -> None:
    raise UserError("polygon is\nnot star-shaped")


def _refuse_in_generator() -> None:
    raise generators.GeneratorError("star: n = 1 is too small")


def _raise() -> None:
    raise ValueError(f"line one\nline two {object()}")


MISDEEDS = {
    "hold": (_hold_interpreter, "timeout", "time limit of 1 s reached"),
    "sleep": (lambda: time.sleep(3600), "timeout", "time limit of 1 s reached"),
    "fill": (_fill_memory, "memory", "memory limit of 300 MiB reached"),
    "allocate": (_allocate_at_once, "memory", "memory limit of 300 MiB reached"),
    "wrap": (_wrap_memory_error, "memory", "memory limit of 300 MiB reached"),
    "abort for memory": (_abort_for_memory, "memory", "memory limit of 300 MiB reached"),
    "segfault": (lambda: ctypes.string_at(0), "error", "the process was killed by SIGSEGV"),
    "abort": (os.abort, "error", "the process was killed by SIGABRT"),
    "kill": (
        lambda: os.kill(os.getpid(), signal.SIGKILL),
        "error",
        "the process was killed by SIGKILL",
    ),
    "exit": (lambda: os._exit(7), "error", "the process ended with exit code 7"),
    "sys.exit": (lambda: sys.exit(0), "error", "SystemExit: 0 (fakes.py:"),
    "raise": (_raise, "error", "ValueError: line one line two <object object at 0x…> (fakes.py:"),
    "refuse": (_refuse, "invalid", "polygon is not star-shaped"),
    "refuse early": (_refuse_in_generator, "invalid", "star: n = 1 is too small"),
}
"""What to do, and the status and (the beginning of) the message that must come of it."""

if sys.platform == "linux":  # elsewhere the system does not count reserved memory
    MISDEEDS["reserve"] = (_reserve, "memory", "memory limit of 300 MiB reached")

ENDLESS = ("hold", "sleep")
"""The misdeeds that only a time limit ends."""


def misbehave(task: Task) -> Measurement:
    """Do the misdeed that the builder's name calls for; otherwise as ``quick``."""
    if task.builder in MISDEEDS:
        MISDEEDS[task.builder][0]()
    return quick(task)


def endless_and_logged(log: Path, task: Task) -> Measurement:
    """Adds the task's key to ``log`` and then sleeps for an hour."""
    with open(log, "a") as file:
        file.write(task.key + "\n")
    time.sleep(3600)
    return quick(task)


def logged_until_full(log: Path, task: Task) -> Measurement:
    """As ``slow_and_logged``, but endless once ``log`` has the lines that ``full`` beside it says.

    So the study is under way until it is interrupted, however slow the one who interrupts it is.
    """
    done = log.read_text().count("\n") if log.exists() else 0
    if done >= int((log.parent / "full").read_text()):
        time.sleep(3600)
    return slow_and_logged(log, task)


def fail_until_mended(mended: Path, task: Task) -> Measurement:
    """Fails for n > 4 while the file ``mended`` is missing."""
    if task.n > 4 and not mended.exists():
        raise ValueError("not mended")
    return quick(task)


def lift_and_fill(task: Task) -> Measurement:
    """Take back the limit on private memory, then fill it slowly enough to be seen."""
    lift_data_limit()
    hoard = []
    for _ in range(200):
        hoard.append(bytearray(b"x" * (8 << 20)))
        time.sleep(0.02)
    return quick(task)
