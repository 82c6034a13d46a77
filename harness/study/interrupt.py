"""Ending a run when asked to, at a moment when nothing is half done."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from types import FrameType

#: What asks a program to end, from outside.
ENDING = (signal.SIGTERM, signal.SIGHUP)


@contextlib.contextmanager
def interruptible() -> Iterator[threading.Event]:
    """Turn the first SIGINT (Ctrl-C), SIGTERM or SIGHUP into an event; the next acts as usual.

    Where signals are not caught (:func:`handled`) the event is never set.
    """
    stop = threading.Event()

    def ask(restore: Callable[[], None]) -> None:
        restore()
        stop.set()

    with handled((signal.SIGINT, *ENDING), ask):
        yield stop


@contextlib.contextmanager
def handled(
    numbers: Sequence[signal.Signals], act: Callable[[Callable[[], None]], None]
) -> Iterator[None]:
    """Answer signals by ``act``, which is given what restores the handlers that were there.

    A signal that is ignored (``nohup``) stays ignored; outside the main thread, where signals
    cannot be caught, nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {
        number: handler
        for number in numbers
        if (handler := signal.getsignal(number)) not in (signal.SIG_IGN, None)
    }

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    def answer(_number: int, _frame: FrameType | None) -> None:
        act(restore)

    for number in before:
        signal.signal(number, answer)
    try:
        yield
    finally:
        restore()
