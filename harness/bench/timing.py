"""Timing: repeats that do not see each other, and first calls in a fresh interpreter."""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import tempfile
import threading
import time
from collections.abc import Callable, Hashable, Iterator
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from typing import Any, TypeVar

Subject = TypeVar("Subject")
Result = TypeVar("Result")

TICK = 0.1
"""Seconds between two looks at whether to stop."""


class UnsteadyResult(ArithmeticError):
    """The same call gave two different results."""


def seconds_of(function: Callable[..., object], *arguments: Any) -> float:
    """The seconds that one call takes."""
    start = time.perf_counter()
    function(*arguments)
    return time.perf_counter() - start


def timed(
    prepare: Callable[[], Subject],
    run: Callable[[Subject], Result],
    essence: Callable[[Result], Hashable],
    repeat: int,
) -> tuple[tuple[float, ...], Result]:
    """Run ``repeat`` ≥ 1 times; return the seconds of each run and the last result.

    Every run gets a new subject, so nothing that an earlier run has cached on it helps, and
    begins when the result before is gone.  Preparing is not timed.

    Raises:
        UnsteadyResult: two results differ in ``essence``.
    """
    timings: list[float] = []
    essences: set[Hashable] = set()
    while True:
        subject = prepare()
        gc.collect()
        start = time.perf_counter()
        result = run(subject)
        timings.append(time.perf_counter() - start)
        essences.add(essence(result))
        if len(essences) > 1:
            raise UnsteadyResult(f"run {len(timings)} gave another result than those before")
        if len(timings) == repeat:
            return tuple(timings), result
        del subject, result


def first_call(
    function: Callable[..., object], *arguments: Any, anew: bool, stop: threading.Event
) -> float | None:
    """Seconds of a first call in a fresh interpreter; None if stopped, or if the call fails.

    With ``anew``, Numba finds an empty cache and compiles everything; otherwise it loads what it
    has kept and compiles (and keeps) what is missing or outdated.  ``function`` must be
    importable.  That a call fails is for those to tell who need its result.
    """
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_send_seconds, args=(sender, function, arguments), daemon=True)
    with _empty_cache() if anew else contextlib.nullcontext():
        try:
            with _interrupts_blocked():
                process.start()
            sender.close()  # or its end would go unnoticed
            while not receiver.poll(TICK):
                if stop.is_set():
                    return None
            found: float | None = receiver.recv()
            return found
        except EOFError:  # it died
            return None
        finally:
            process.kill()
            process.join()
            receiver.close()


def _send_seconds(
    sender: Connection, function: Callable[..., object], arguments: tuple[Any, ...]
) -> None:
    try:
        found = seconds_of(function, *arguments)
    except Exception:
        sender.send(None)
    else:
        sender.send(found)


@contextlib.contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Let processes that start meanwhile be deaf to Ctrl-C, which the terminal sends to all."""
    resource_tracker.ensure_running()  # before: starting it would undo the block
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _empty_cache() -> Iterator[None]:
    """Let processes that start meanwhile keep compiled code in a directory that goes away."""
    name = "NUMBA_CACHE_DIR"
    before = os.environ.get(name)
    with tempfile.TemporaryDirectory(prefix="avd-bench-") as directory:
        os.environ[name] = directory
        try:
            yield
        finally:
            if before is None:
                del os.environ[name]
            else:
                os.environ[name] = before
