"""Many instances judged at a time, each within a limit of time."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pebble

from harness.audit.claim import Finding
from harness.errors import UserError
from harness.geometry.instance import Instance

LIMIT = 120.0
"""Seconds for one instance, with more than one job."""

Check = Callable[[Instance], Finding]


def judged(check: Check, instance: Instance) -> Finding:
    """The finding of a check; undecided where the program itself gives up, with its reason."""
    try:
        return check(instance)
    except (UserError, ArithmeticError) as error:
        return Finding("undecided", str(error))


class Workers:
    """``jobs`` processes that judge instances, or this process itself for one job."""

    def __init__(self, jobs: int) -> None:
        """Processes start when they are first needed."""
        self._jobs = jobs
        self._pool: Any = None

    def __enter__(self) -> Workers:
        """Start."""
        if self._jobs > 1:
            self._pool = pebble.ProcessPool(
                max_workers=self._jobs,
                initializer=_ignore_interrupts,
                context=multiprocessing.get_context("spawn"),
            )
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        """Stop at once if something went wrong, else when all is done."""
        if self._pool is not None:
            if kind is None:
                self._pool.close()
            else:
                self._pool.stop()
            self._pool.join()

    def findings(self, check: Check, instances: Sequence[Instance]) -> Iterator[Finding]:
        """The findings, in the order of the instances."""
        if self._pool is None:
            yield from (judged(check, instance) for instance in instances)
            return
        futures = [
            self._pool.schedule(judged, args=(check, instance), timeout=LIMIT)
            for instance in instances
        ]
        for future in futures:
            try:
                yield future.result()
            except TimeoutError:
                yield Finding("undecided", f"not finished in {LIMIT:g} s")
            except pebble.ProcessExpired as death:
                yield Finding("undecided", f"the process ended with exit code {death.exitcode}")


def _ignore_interrupts() -> None:
    """Ctrl-C goes to all processes; only the one that started them answers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
