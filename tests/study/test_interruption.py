"""Interrupted politely or killed at any moment, a study goes on as if nothing had happened."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from tests.study.run_slowly import TEXT
from tests.study.studies import invariant_rows, study

ROOT = Path(__file__).parents[2]
JOBS = 2


def _start(
    directory: Path, log: Path, mode: str, work: str = "slow_and_logged"
) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "tests.study.run_slowly", str(directory), str(log), mode]
    return subprocess.Popen(
        [*command, str(JOBS), work],
        cwd=ROOT,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def _rows(directory: Path) -> bytes:
    path = directory / "rows.csv"
    return path.read_bytes() if path.exists() else b""


def _wait_for_rows(process: subprocess.Popen[str], directory: Path, rows: int) -> None:
    """Until the file has so many rows, or the process has ended."""
    deadline = time.monotonic() + 60
    while process.poll() is None and _rows(directory).count(b"\n") <= rows:
        assert time.monotonic() < deadline
        time.sleep(0.005)


def _runs(directory: Path) -> list[dict[str, object]]:
    runs = json.loads((directory / "manifest.json").read_text())["runs"]
    assert isinstance(runs, list)
    return runs


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, str]]:
    """The rows of a run that nobody disturbs."""
    folder = tmp_path_factory.mktemp("uninterrupted")
    process = _start(folder / "results", folder / "log", "new")
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    rows = invariant_rows(folder / "results")
    assert len(rows) == len(study(TEXT).tasks)
    assert {row["status"] for row in rows} == {"ok", "error"}
    return rows


def test_killed_at_random_moments_a_study_ends_with_the_same_rows(
    tmp_path: Path, uninterrupted: list[dict[str, str]]
) -> None:
    """SIGKILL, again and again, early and late, before, in and after rows.

    After every kill the whole rows are those that were there before and more; no task is done
    again whose row was kept; at the end all is as if there had been no kill.
    """
    directory, log = tmp_path / "results", tmp_path / "log"
    chance = random.Random(20_061_1)
    kept = b""
    kills = 0
    while True:
        process = _start(directory, log, "resume")
        more = chance.choice([0, 0, 1, 3, 6, 10])
        _wait_for_rows(process, directory, kept.count(b"\n") - 1 + more)
        time.sleep(chance.uniform(0.0, 0.05))
        if process.poll() is not None:
            break
        process.kill()
        process.communicate()
        kills += 1
        rows = _rows(directory)
        whole = rows[: rows.rfind(b"\n") + 1]
        if whole.count(b"\n") <= len(uninterrupted):
            assert whole.startswith(kept)
        else:  # complete: the rows may be in the study's order by now
            assert set(kept.splitlines()) <= set(whole.splitlines())
        kept = whole
        # The worst that a kill can do to the last line:
        if kept and chance.random() < 0.5:
            with open(directory / "rows.csv", "ab") as file:
                file.write(b'0123456789abcdef,1,star,5,,"{""r_')
    assert process.returncode == 0
    process.communicate()
    assert kills >= 5
    assert invariant_rows(directory) == uninterrupted
    done = Counter(log.read_text().split())
    assert done.keys() == {row["task"] for row in uninterrupted}
    assert sum(done.values()) <= len(uninterrupted) + JOBS * kills
    runs = _runs(directory)
    assert all(run["interrupted"] for run in runs[:-1])
    assert (runs[-1]["interrupted"], runs[-1]["end"] is None) == (False, False)


def test_what_a_killed_run_left_running_ends(tmp_path: Path) -> None:
    directory, log = tmp_path / "results", tmp_path / "log"
    process = _start(directory, log, "new", "endless_and_logged")
    deadline = time.monotonic() + 60
    while not (log.exists() and log.read_text().count("\n") == JOBS):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    children = psutil.Process(process.pid).children(recursive=True)
    process.kill()
    assert len(children) >= JOBS
    _, alive = psutil.wait_procs(children, timeout=15)
    assert not alive
    process.communicate()


INTERRUPTIONS: list[tuple[signal.Signals, Callable[[int, int], None]]] = [
    (signal.SIGINT, os.kill),
    (signal.SIGINT, os.killpg),  # as Ctrl-C in a terminal does
    (signal.SIGTERM, os.kill),
    (signal.SIGHUP, os.kill),
]


def test_politely_interrupted_a_study_keeps_every_row_and_says_so(
    tmp_path: Path, uninterrupted: list[dict[str, str]]
) -> None:
    """One run after the other is interrupted, each by another signal; the last one is not."""
    directory, log = tmp_path / "results", tmp_path / "log"
    kept = b""
    for number, send in INTERRUPTIONS:
        done = log.read_text().count("\n") if log.exists() else 0
        (tmp_path / "full").write_text(str(done + 6))
        process = _start(directory, log, "resume", "logged_until_full")
        _wait_for_rows(process, directory, kept.count(b"\n") + 4)
        send(process.pid, number)
        _, errors = process.communicate(timeout=30)
        assert process.returncode == 130, errors
        assert "Traceback" not in errors
        rows = _rows(directory)
        assert rows.startswith(kept)
        assert rows.endswith(b"\n")
        run = _runs(directory)[-1]
        assert run["interrupted"] is True
        assert run["end"] is not None
        assert run["tasks"] == rows.count(b"\n") - max(kept.count(b"\n"), 1)
        kept = rows
    process = _start(directory, log, "resume")
    process.communicate(timeout=60)
    assert process.returncode == 0
    assert invariant_rows(directory) == uninterrupted
