"""Where tasks run: on this machine, or on the workers of a Dask cluster.

An engine yields ``(task, outcome)`` pairs in the order of completion and ends early when ``stop``
is set; what is running then is stopped and will be run again.  Both engines run each task in
``isolate.Attempt``, so limits, statuses and rows are the same.
"""

from __future__ import annotations

import contextlib
import importlib.util
import multiprocessing
import tempfile
import threading
import time
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from pathlib import Path
from typing import Any

from harness.errors import UserError
from harness.study.isolate import TICK, Attempt, Work
from harness.study.limits import Limits
from harness.study.outcome import Outcome
from harness.study.task import AnyTask

Results = Generator[tuple[AnyTask, Outcome]]


def run_local(
    tasks: Sequence[AnyTask],
    work: Work[AnyTask],
    limits: Limits,
    jobs: int,
    stop: threading.Event,
) -> Results[AnyTask]:
    """Run tasks in the order given, ``jobs`` at a time, each in a process of its own."""
    waiting = iter(tasks)
    running: list[Attempt[AnyTask]] = []
    with tempfile.TemporaryDirectory(prefix="avd-study-") as scratch:
        try:
            while not stop.is_set():
                while len(running) < jobs and (task := next(waiting, None)) is not None:
                    running.append(Attempt(work, task, limits, Path(scratch)))
                if not running:
                    return
                wait([attempt.future for attempt in running], TICK, FIRST_COMPLETED)
                yield from _harvest(running)
            yield from _harvest(running)
        finally:
            for attempt in running:
                attempt.stop()
            wait([attempt.future for attempt in running])


def _harvest(running: list[Attempt[AnyTask]]) -> Results[AnyTask]:
    """Look after every attempt; take out and yield those that have ended."""
    for attempt in tuple(running):
        attempt.watch()
        if attempt.future.done():
            running.remove(attempt)
            yield attempt.task, attempt.outcome()


def check_dask() -> None:
    """Raise UserError if the Dask engine is not installed."""
    if importlib.util.find_spec("distributed") is None:
        raise UserError(
            "--engine dask needs the package distributed: pip install 'angular-voronoi[dask]'"
        )


def run_dask(
    tasks: Sequence[AnyTask],
    work: Work[AnyTask],
    limits: Limits,
    jobs: int,
    stop: threading.Event,
    scheduler: str | None = None,
) -> Results[AnyTask]:
    """Run tasks on a Dask cluster: the one at ``scheduler``, or a local one of ``jobs`` threads.

    A Dask worker only supervises; each task still has its own process.  On a stop, tasks that
    run on a remote worker end there, at the latest at their time limit, and their results are
    dropped.  Raises UserError if the scheduler does not answer, or the workers may not start
    processes; call ``check_dask`` first.
    """
    with _dask_client(jobs, scheduler) as (client, as_completed):
        _halt.clear()
        futures = {
            client.submit(supervise, work, task, limits, key=f"avd-{task.key}", pure=False): task
            for task in tasks
        }
        arriving = as_completed(futures)
        try:
            while arriving.count() and not stop.is_set():
                if arriving.has_ready():
                    future = next(arriving)
                    yield futures[future], _arrived(future)
                else:
                    time.sleep(TICK / 2)
        finally:
            _halt.set()
            client.cancel(list(futures), force=True)


_halt = threading.Event()
"""Tells ``supervise`` to give up, where it runs in this process (the local cluster)."""


def supervise(work: Work[AnyTask], task: AnyTask, limits: Limits) -> Outcome:
    """Run one task in a process of its own and wait for it: what a Dask worker does.

    Raises UserError if the worker may not start processes.
    """
    if multiprocessing.current_process().daemon:
        raise UserError(
            "the Dask workers may not start processes; start them with --no-nanny, "
            "or with DASK_DISTRIBUTED__WORKER__DAEMON=False in their environment"
        )
    with tempfile.TemporaryDirectory(prefix="avd-study-") as scratch:
        attempt = Attempt(work, task, limits, Path(scratch))
        while not attempt.future.done():
            if _halt.is_set():
                attempt.stop()
                return Outcome("error", "given up: the study was stopped")  # nobody reads this
            wait([attempt.future], TICK)
            attempt.watch()
        return attempt.outcome()


def _arrived(future: Any) -> Outcome:
    """The outcome a finished Dask future holds."""
    if future.status == "finished":
        outcome: Outcome = future.result()
        return outcome
    if future.status == "error":
        error = future.exception()
        if isinstance(error, UserError):
            raise error
        return Outcome("error", f"lost by Dask: {type(error).__name__}: {error}")
    raise UserError(f"the Dask cluster dropped a task ({future.status}); is the scheduler alive?")


@contextlib.contextmanager
def _dask_client(jobs: int, scheduler: str | None) -> Iterator[tuple[Any, Any]]:
    """A client of the scheduler, or of a local cluster of threads that ends with it."""
    import distributed

    with contextlib.ExitStack() as stack:
        address: Any = scheduler
        if scheduler is None:
            cluster = distributed.LocalCluster(
                n_workers=1,
                threads_per_worker=jobs,
                processes=False,  # its threads only wait: every task has its own process
                memory_limit=0,
                dashboard_address=None,
            )
            address = stack.enter_context(cluster)
        try:
            client = distributed.Client(address, timeout="15s")
        except (OSError, ValueError) as error:
            raise UserError(f"no Dask scheduler at {scheduler}: {error}") from None
        yield stack.enter_context(client), distributed.as_completed
