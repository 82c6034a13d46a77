"""Every way a task can go wrong has its status; tasks see neither each other nor the engine."""

from __future__ import annotations

import dataclasses
import os
import threading
import time
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path

import pytest

from harness.errors import UserError
from harness.study.engines import run_dask, run_local, supervise
from harness.study.isolate import Work
from harness.study.limits import Limits
from harness.study.outcome import Outcome, row_of
from harness.study.runner import run_study
from harness.study.task import Task
from tests.study import fakes
from tests.study.studies import study

TASKS = study().tasks

ENGINES = ["local", "dask"] if find_spec("distributed") else ["local"]


def _run(
    engine: str, tasks: Sequence[Task], work: Work, limits: Limits, jobs: int = 2
) -> Iterator[tuple[Task, Outcome]]:
    run = {"local": run_local, "dask": run_dask}[engine]
    return run(tasks, work, limits, jobs, threading.Event())


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("seconds", "names"),
    [(1, fakes.ENDLESS), (60, sorted(fakes.MISDEEDS.keys() - set(fakes.ENDLESS)))],
    ids=["endless", "other"],
)
def test_every_misdeed_has_its_status_and_takes_nothing_with_it(
    engine: str, seconds: int, names: Sequence[str]
) -> None:
    """Each misdeed, with good tasks before, between and after."""
    bad = [dataclasses.replace(TASKS[0], builder=name) for name in names]
    good = [dataclasses.replace(TASKS[0], replicate=100 + k) for k in range(len(bad))]
    tasks = [task for pair in zip(good, bad, strict=True) for task in pair]
    outcomes = dict(_run(engine, tasks, fakes.misbehave, Limits(seconds, mib=300)))
    assert set(outcomes) == set(tasks)
    for task in good:
        assert outcomes[task].status == "ok"
        assert outcomes[task].measurement is not None
        assert outcomes[task].measurement.counts == fakes.quick(task).counts
    for task in bad:
        _, status, message = fakes.MISDEEDS[task.builder]
        row = row_of(task, outcomes[task])
        assert (task.builder, row["status"]) == (task.builder, status)
        assert row["message"].startswith(message), row["message"]
        assert row["cells"] == row["certified"] == row["seconds"] == ""


def test_the_resident_size_is_watched_where_the_system_sets_no_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without the limit on private memory (as on macOS) the supervisor kills in time."""
    task = dataclasses.replace(TASKS[0], builder="lift and fill")
    outcomes = dict(_run("local", [task], fakes.lift_and_fill, Limits(seconds=20, mib=300)))
    assert outcomes[task].status == "memory"
    assert outcomes[task].peak_mib is not None
    assert outcomes[task].peak_mib > 300


def test_tasks_run_apart_in_the_order_given() -> None:
    results = list(_run("local", TASKS, fakes.stateful, Limits(20, 2048), jobs=1))
    assert [task for task, _ in results] == list(TASKS)
    assert {outcome.status for _, outcome in results} == {"ok"}


def test_processes_come_from_a_clean_server() -> None:
    """Not forked from this process, deaf to Ctrl-C, and with one thread each."""
    ((_, outcome),) = _run("local", TASKS[:1], fakes.surroundings, Limits(20, 2048))
    assert "blocked True threads 11" in outcome.message
    assert f"parent {os.getpid()} " not in outcome.message


def test_the_detail_of_a_failure_has_the_traceback() -> None:
    tasks = [dataclasses.replace(TASKS[0], builder=name) for name in ("raise", "segfault")]
    results = dict(_run("local", tasks, fakes.misbehave, Limits(20, 2048)))
    assert "in _raise" in results[tasks[0]].detail
    assert "Segmentation fault" in results[tasks[1]].detail
    assert "in misbehave" in results[tasks[1]].detail
    assert "Extension modules" not in results[tasks[1]].detail


def test_a_stop_ends_what_is_running_at_once() -> None:
    """At once: not in the hour that the tasks have."""
    stop = threading.Event()
    tasks = [dataclasses.replace(TASKS[0], builder="hold", replicate=k) for k in range(4)]
    found: list[tuple[Task, Outcome]] = []
    runner = threading.Thread(
        target=lambda: found.extend(run_local(tasks, fakes.misbehave, Limits(3600, 2048), 2, stop)),
        daemon=True,
    )
    runner.start()
    time.sleep(0.5)
    stop.set()
    runner.join(timeout=30)
    assert not runner.is_alive()
    assert found == []


def test_dask_is_asked_for_by_name_when_it_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    with pytest.raises(UserError, match=r"pip install 'angular-voronoi\[dask\]'"):
        run_study(study(), tmp_path / "new", engine="dask")
    assert not (tmp_path / "new").exists()


def test_a_dask_worker_that_may_not_start_processes_is_told_how(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Daemon:
        daemon = True

    monkeypatch.setattr("multiprocessing.current_process", Daemon)
    with pytest.raises(UserError, match="--no-nanny"):
        supervise(fakes.quick, TASKS[0], Limits(20, 2048))
