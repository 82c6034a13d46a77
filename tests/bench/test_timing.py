"""Repeats are independent; first calls see a fresh interpreter and leave nothing behind."""

from __future__ import annotations

import itertools
import os
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from harness.bench import timing
from harness.bench.timing import UnsteadyResult, first_call, seconds_of, timed
from tests.bench import fakes


@pytest.mark.parametrize("repeat", [1, 2, 5])
def test_every_run_has_a_subject_of_its_own(repeat: int) -> None:
    fresh = itertools.count()
    seen: list[int] = []

    def run(subject: int) -> int:
        seen.append(subject)
        return subject

    timings, last = timed(lambda: next(fresh), run, lambda _: "same", repeat)
    assert seen == list(range(repeat))
    assert last == repeat - 1
    assert len(timings) == repeat
    assert min(timings) >= 0


def test_only_running_is_timed(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a clock that moves when it is told to."""
    now = 0.0

    def take(seconds: float) -> float:
        nonlocal now
        now += seconds
        return now

    monkeypatch.setattr(timing, "time", SimpleNamespace(perf_counter=lambda: now))
    timings, _ = timed(lambda: take(100.0), lambda _: take(2.0), lambda _: take(1000.0) < 0, 3)
    assert timings == (2.0, 2.0, 2.0)
    assert seconds_of(take, 3.0) == 3.0


def test_runs_that_differ_are_refused() -> None:
    """At the first difference, wherever it is."""
    results = iter([1, 1, 2, 2])
    with pytest.raises(UnsteadyResult, match="run 3"):
        timed(lambda: None, lambda _: next(results), lambda found: found, 4)
    assert next(results) == 2


def test_an_earlier_result_is_gone_when_the_next_run_begins() -> None:
    alive = 0

    class Large:
        def __init__(self) -> None:
            nonlocal alive
            alive += 1
            assert alive == 1

        def __del__(self) -> None:
            nonlocal alive
            alive -= 1

    timed(lambda: None, lambda _: Large(), lambda _: 0, 3)


@pytest.fixture
def stop() -> threading.Event:
    return threading.Event()


@pytest.mark.parametrize("before", [None, "elsewhere"])
def test_a_first_call_anew_has_an_empty_cache(
    before: str | None, stop: threading.Event, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if before is None:
        monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    else:
        before = str(tmp_path)
        monkeypatch.setenv("NUMBA_CACHE_DIR", before)
    told = tmp_path / "told"
    assert first_call(fakes.report_cache, str(told), anew=True, stop=stop) is not None
    directory, there = told.read_text().split("\n")
    assert (there, Path(directory).exists(), directory != before) == ("[]", False, True)
    assert os.environ.get("NUMBA_CACHE_DIR") == before
    assert first_call(fakes.report_cache, str(told), anew=False, stop=stop) is not None
    assert told.read_text().split("\n")[0] == (before or "")


def test_a_first_call_measures_the_call(stop: threading.Event) -> None:
    found = first_call(time.sleep, 0.3, anew=False, stop=stop)
    assert found is not None
    assert found >= 0.3


@pytest.mark.parametrize("call", [fakes.fail, fakes.die])
def test_a_first_call_that_fails_tells_nothing(call, stop, capfd) -> None:
    assert first_call(call, anew=False, stop=stop) is None
    assert capfd.readouterr().err == ""


def test_a_stop_ends_a_first_call(stop: threading.Event) -> None:
    stop.set()
    assert first_call(fakes.rest, anew=False, stop=stop) is None
