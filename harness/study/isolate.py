"""One task in one process of its own, under limits that hold whatever the task does.

Every task is forked from a clean server (``forkserver``; never from this process, which has
threads).  A fork costs some milliseconds, and buys that no task sees what another left behind:
memory is the task's own, and a crash takes nothing with it.  Pebble starts the process, waits,
and stops it at the time limit; the supervisor watches its memory.
"""

from __future__ import annotations

import contextlib
import dataclasses
import faulthandler
import functools
import multiprocessing
import os
import re
import signal
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from multiprocessing import forkserver, resource_tracker
from pathlib import Path
from typing import Any, Generic

import pebble
import psutil

import generators
from harness.errors import UserError
from harness.study.limits import MIB, Limits, confine, lift_data_limit, peak_mib
from harness.study.outcome import Outcome
from harness.study.task import AnyTask

Work = Callable[[AnyTask], Any]
"""What is done for a task; must be importable in another process."""

TICK = 0.1
"""Seconds between two looks at the memory of the running tasks."""

THREAD_VARIABLES = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "NUMBA_NUM_THREADS",
)
"""Each set to 1 for the tasks: the parallelism is that of the tasks, not within one."""

_OUT_OF_MEMORY = re.compile(r"allocate memory|bad_alloc|out of memory", re.IGNORECASE)
"""What C and C++ libraries (GMP, FLINT, the C++ runtime) say before they abort for memory."""


class Attempt(Generic[AnyTask]):
    """A task being run in a process of its own.

    ``future`` is done when the process has ended; ``watch`` must be called every ``TICK`` until
    then.  After that ``outcome`` says how it went.
    """

    def __init__(self, work: Work[AnyTask], task: AnyTask, limits: Limits, scratch: Path) -> None:
        """Start the process; ``scratch`` is a directory for what the task prints."""
        self.task = task
        self._limits = limits
        self._peak: float | None = None
        self._over = False
        self._process: psutil.Process | None = None
        self._oom_kills = _oom_kills()
        descriptor, name = tempfile.mkstemp(dir=scratch, prefix=task.key)
        os.close(descriptor)
        self._log = Path(name)
        start = pebble.concurrent.process(
            daemon=True, timeout=limits.seconds, context=_server_context()
        )(run_confined)
        self.future: Any = start(work, task, limits, name)

    def watch(self) -> None:
        """Kill the process if its resident memory is over the limit."""
        process = self._find_process()
        if process is None or self.future.done():
            return
        with contextlib.suppress(psutil.Error):  # it may end at any moment
            resident = process.memory_info().rss / MIB
            self._peak = max(resident, self._peak or 0.0)
            if resident > self._limits.mib:
                self._over = True
                process.kill()

    def stop(self) -> None:
        """Kill the process, if it is still there; its outcome is lost.

        The future is left alone: Pebble completes it, and would trip over a cancelled one.
        """
        while not self.future.done() and self._find_process() is None:
            time.sleep(TICK / 10)
        if self._process is not None:
            with contextlib.suppress(psutil.Error):
                self._process.kill()

    def outcome(self) -> Outcome:
        """How the task ended; ask once, when ``future`` is done."""
        outcome = self._outcome()
        self._log.unlink()
        return outcome

    def _outcome(self) -> Outcome:
        try:
            outcome: Outcome = self.future.result()
        except TimeoutError:
            return self._timed_out()
        except pebble.ProcessExpired as death:
            return self._died(death.exitcode)
        except Exception as error:  # the answer could not be read: a row too, never silence
            return Outcome("error", f"lost the task's answer: {error}", peak_mib=self._peak)
        if outcome.status == "memory":
            self._peak = outcome.peak_mib
            return self._out_of_memory()
        return outcome

    def _find_process(self) -> psutil.Process | None:
        """The process, once it has introduced itself on the first line of its log."""
        if self._process is None:
            first, newline, _ = self._printed().partition("\n")
            if newline:
                with contextlib.suppress(psutil.Error):  # it may have ended already
                    self._process = psutil.Process(int(first))
        return self._process

    def _printed(self) -> str:
        return self._log.read_text(errors="replace")

    def _timed_out(self) -> Outcome:
        return Outcome(
            "timeout", f"time limit of {self._limits.seconds:g} s reached", peak_mib=self._peak
        )

    def _out_of_memory(self) -> Outcome:
        return Outcome(
            "memory", f"memory limit of {self._limits.mib} MiB reached", peak_mib=self._peak
        )

    def _died(self, code: int) -> Outcome:
        """Why a process that left no answer has ended, from its last words and its exit code."""
        _, _, words = self._printed().partition("\n")
        if self._over or _OUT_OF_MEMORY.search(words):
            return self._out_of_memory()
        if code == -signal.SIGALRM:
            return self._timed_out()
        if code == -signal.SIGKILL and _oom_kills() > self._oom_kills:
            return Outcome("memory", "the system ran out of memory", peak_mib=self._peak)
        if code < 0:
            reason = f"the process was killed by {_signal_name(-code)}"
        else:
            reason = f"the process ended with exit code {code}"
        # Python adds the list of all loaded modules, on one line of many kilobytes.
        words = re.sub(r"^Extension modules: .*$", "", words, flags=re.MULTILINE).strip()
        return Outcome("error", reason, peak_mib=self._peak, detail=words)


def run_confined(work: Work[AnyTask], task: AnyTask, limits: Limits, log: str) -> Outcome:
    """In the task's process: set up the limits and the log, do the work, tell how it went."""
    _speak_to(log)
    confine(limits)
    try:
        outcome = Outcome("ok", measurement=work(task))
    except BaseException as error:  # SystemExit and the like are failures of the task as well
        lift_data_limit()
        outcome = _failure(error)
    lift_data_limit()
    return dataclasses.replace(outcome, peak_mib=peak_mib())


def _failure(error: BaseException) -> Outcome:
    if _from_memory(error):
        return Outcome("memory")
    if isinstance(error, (UserError, generators.GeneratorError)):
        return Outcome("invalid", str(error))
    detail = "".join(traceback.format_exception(error))
    return Outcome("error", _named(error), detail=detail)


def _from_memory(error: BaseException | None) -> bool:
    """Whether the error, or one it was raised from or while handling, is a failed allocation."""
    while error is not None and not isinstance(error, MemoryError):
        error = error.__cause__ or error.__context__
    return error is not None


def _speak_to(log: str) -> None:
    """Send what the task prints, from Python or C, to its log, after a line with the process id."""
    descriptor = os.open(log, os.O_WRONLY | os.O_APPEND)
    os.write(descriptor, f"{os.getpid()}\n".encode())
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.close(descriptor)
    faulthandler.enable(2, all_threads=False)  # a crash in C then says where Python was


def _named(error: BaseException) -> str:
    """The class, the text and the place of an error (file name and line, no directory)."""
    frames = traceback.extract_tb(error.__traceback__)
    place = f" ({Path(frames[-1].filename).name}:{frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}: {error}{place}"


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _oom_kills() -> int:
    """How many processes the system has killed for want of memory (0 where it does not tell)."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/vmstat").read_text().splitlines():
            if line.startswith("oom_kill "):
                return int(line.split()[1])
    return 0


@functools.cache
def _server_context() -> Any:
    """The context whose processes are forked from a clean, warm server; starts the server."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["pebble", __name__, "harness.study.preload"])
    resource_tracker.ensure_running()  # before: starting it would undo the block on interrupts
    with _one_thread_each(), _interrupts_blocked():
        forkserver.ensure_running()
    return context


@contextlib.contextmanager
def _one_thread_each() -> Iterator[None]:
    before = {name: os.environ.get(name) for name in THREAD_VARIABLES}
    os.environ.update(dict.fromkeys(THREAD_VARIABLES, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextlib.contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block SIGINT here, so the server and all it forks inherit the block.

    A terminal sends Ctrl-C to every process of the group; only the first one is to act on it.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
