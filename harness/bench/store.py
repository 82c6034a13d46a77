"""The directory of a benchmark: ``rows.csv`` and ``manifest.json``, as a study has them.

A row stays until its instance is measured again.  Each row has the number of its run, and the
manifest keeps every run that a row is left of, with machine, versions and commit.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import harness
from harness.bench.rows import NAME, columns_of
from harness.errors import UserError
from harness.files import replace
from harness.study.manifest import (
    MANIFEST,
    git_commit,
    machine,
    read_manifest,
    versions,
    write_manifest,
)
from harness.study.schema import SCHEMA, Record
from harness.study.store import ROWS

if TYPE_CHECKING:
    from harness.bench.benchmark import Benchmark

BENCH_SCHEMA = 1
"""The version of the benchmark's own columns and manifest keys; ``SCHEMA`` is the study's."""


class Store:
    """The rows and the manifest of a directory during one run; hold the directory's lock.

    ``run``: the number of this run.
    """

    def __init__(self, directory: Path, benchmark: Benchmark, settings: Mapping[str, Any]) -> None:
        """Read what is there and open an entry for this run, with ``settings`` in it.

        Raises:
            UserError: the directory holds something else, or rows of another version.
        """
        self._directory = directory
        self._columns = columns_of(benchmark)
        self._order = [case.name for case in (*benchmark.cases, *benchmark.quick)]
        earlier = self._read_runs(benchmark)
        self.rows = {row[NAME]: row for row in self._read_rows()}
        self.run = 1 + max((run["run"] for run in earlier), default=0)
        self._entry: dict[str, Any] = {
            "run": self.run,
            "start": _now(),
            "end": None,
            **settings,
            "avd": harness.__version__,
            "commit": git_commit(),
            "versions": versions(),
            "machine": machine(),
            "interrupted": False,
        }
        self._runs = [*earlier, self._entry]
        self._manifest: dict[str, Any] = {
            "schema": SCHEMA,
            "benchmark": benchmark.name,
            "bench_schema": BENCH_SCHEMA,
            **{key: self._entry[key] for key in ("avd", "commit", "versions", "machine")},
            **settings,
        }
        self._write_manifest()

    def put(self, row: Record) -> None:
        """Add a row, in place of an earlier one of its instance; on return it is on the disk."""
        self.rows[row[NAME]] = row
        names = sorted(self.rows, key=self._rank)
        text = io.StringIO()
        writer = csv.DictWriter(text, self._columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(self.rows[name] for name in names)
        replace(self._directory / ROWS, text.getvalue().encode())

    def note(self, **what: Any) -> None:
        """Add facts about this run to its entry in the manifest."""
        self._entry |= what
        self._write_manifest()

    def end(self, *, interrupted: bool) -> None:
        """Write that the run is over; forget the runs of which no row is left."""
        left = {row["run"] for row in self.rows.values()} | {str(self.run)}
        self._runs = [run for run in self._runs if str(run["run"]) in left]
        self.note(end=_now(), interrupted=interrupted)

    def _rank(self, name: str) -> int:
        """The place of an instance in the benchmark; those no longer in it come last."""
        return self._order.index(name) if name in self._order else len(self._order)

    def _write_manifest(self) -> None:
        write_manifest(self._directory, {**self._manifest, "runs": self._runs})

    def _read_runs(self, benchmark: Benchmark) -> list[dict[str, Any]]:
        """The runs in the manifest; those without an end were killed."""
        manifest = read_manifest(self._directory)
        if manifest is None:
            if any(entry.name != ".lock" for entry in self._directory.iterdir()):
                raise UserError(f"{self._directory}: not empty, and holds no benchmark")
            return []
        if manifest.get("benchmark") != benchmark.name:
            raise UserError(f"{self._directory}: holds no rows of the benchmark {benchmark.name}")
        if manifest.get("bench_schema") != BENCH_SCHEMA:
            raise UserError(
                f"{self._directory / MANIFEST}: written with benchmark schema "
                f"{manifest.get('bench_schema')!r}, this avd has {BENCH_SCHEMA}; store elsewhere"
            )
        runs: list[dict[str, Any]] = manifest.get("runs", [])
        for run in runs:
            if type(run.get("run")) is not int:
                raise UserError(f"{self._directory / MANIFEST}: a run without a number")
            run["interrupted"] = run["interrupted"] or run["end"] is None
        return runs

    def _read_rows(self) -> list[Record]:
        path = self._directory / ROWS
        if not path.exists():
            return []
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            if tuple(reader.fieldnames or ()) != self._columns:
                raise UserError(f"{path}: other columns than this avd writes; store elsewhere")
            return list(reader)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
