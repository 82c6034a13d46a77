"""The manifest: where the rows of a study come from.

``manifest.json`` says what was run (study, limits, rule for seeds, number of tasks and of rows
of each status), with what (versions, commit, machine: those of the last run), and when (one
entry for each run: start, end, command, engine, jobs, version and commit, rows added, and
whether it was interrupted; a run that was killed has no end).
"""

from __future__ import annotations

import filecmp
import json
import platform
import subprocess
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import psutil

import harness
from harness.files import read_object, replace
from harness.study.checks import check_manifest
from harness.study.schema import SCHEMA, migrate_manifest
from harness.study.task import SEED_RULE

if TYPE_CHECKING:
    from harness.study.limits import Limits
    from harness.study.task import Keyed

MANIFEST = "manifest.json"

DISTRIBUTIONS = (
    "numpy",
    "scipy",
    "numba",
    "python-flint",
    "pandas",
    "matplotlib",
    "pebble",
    "psutil",
    "distributed",
)
"""The libraries whose versions are recorded, if they are installed."""

PACKAGES = ("harness", "generators")

Manifest = dict[str, Any]


def read_manifest(directory: Path) -> Manifest | None:
    """The manifest of a study's directory, as the present schema has it; None if there is none.

    Raises UserError if it is damaged, or if a newer program wrote it.
    """
    path = directory / MANIFEST
    manifest = read_object(path, "a manifest")
    if manifest is None:
        return None
    manifest = migrate_manifest(manifest, str(path))
    check_manifest(manifest, str(path))
    return manifest


def was_killed(manifest: Manifest | None) -> bool:
    """Whether the last run never came to its end, so that rows may be in no order yet."""
    runs = [] if manifest is None else manifest["runs"]
    return bool(runs) and runs[-1]["end"] is None


def write_manifest(directory: Path, manifest: Manifest) -> None:
    """Write the manifest in one step."""
    text = json.dumps(manifest, indent=2, ensure_ascii=False) + "\n"
    replace(directory / MANIFEST, text.encode())


class Described(Protocol):
    """What the manifest tells of a study."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def description(self) -> str:
        """One line."""

    @property
    def base_seed(self) -> int:
        """What all seeds of instances come from."""

    @property
    def limits(self) -> Limits:
        """Of every task."""

    @property
    def tasks(self) -> Sequence[Keyed]:
        """All of them, also those that have a row."""


class RunRecord:
    """The manifest of a run under way: written when it starts and when it ends."""

    def __init__(
        self,
        directory: Path,
        study: Described,
        *,
        command: str,
        engine: str,
        jobs: int,
        seeds: str = SEED_RULE,
    ) -> None:
        """Open an entry for this run; earlier ones without an end were killed."""
        earlier = (read_manifest(directory) or {}).get("runs", [])
        for run in earlier:
            run["interrupted"] = run["interrupted"] or run["end"] is None
        commit = git_commit()
        self._directory = directory
        self._run: dict[str, Any] = {
            "start": _now(),
            "end": None,
            "command": command,
            "engine": engine,
            "jobs": jobs,
            "avd": harness.__version__,
            "commit": commit,
            "tasks": 0,
            "interrupted": False,
        }
        self._manifest: Manifest = {
            "schema": SCHEMA,
            "study": study.name,
            "description": study.description,
            "avd": harness.__version__,
            "commit": commit,
            "versions": versions(),
            "machine": machine(),
            "command": command,
            "base_seed": study.base_seed,
            "seeds": seeds,
            "limits": {"time": study.limits.seconds, "memory_mib": study.limits.mib},
            "tasks": len(study.tasks),
            "statuses": {},
            "runs": [*earlier, self._run],
        }

    def start(self, statuses: Mapping[str, int]) -> None:
        """Write that the run is under way."""
        self._manifest["statuses"] = dict(statuses)
        write_manifest(self._directory, self._manifest)

    def end(self, statuses: Mapping[str, int], *, tasks: int, interrupted: bool) -> None:
        """Write that the run is over, having added ``tasks`` rows."""
        self._run.update(end=_now(), tasks=tasks, interrupted=interrupted)
        self.start(statuses)


def versions() -> dict[str, str]:
    """The versions of Python and of the libraries."""
    found = {"python": platform.python_version()}
    for name in DISTRIBUTIONS:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def machine() -> dict[str, Any]:
    """What the tasks run on; neither the name of the machine nor of its user."""
    return {
        "cpu": _cpu(),
        "cores": psutil.cpu_count(logical=False),
        "threads": psutil.cpu_count(),
        "memory_gib": round(psutil.virtual_memory().total / 2**30, 1),
        "system": platform.platform(),
    }


def _cpu() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def git_commit() -> dict[str, Any] | None:
    """The commit this package is run from, and whether files differ from it; None if unknown."""
    root = Path(harness.__file__).resolve().parents[1]
    try:
        top = Path(_git(root, "rev-parse", "--show-toplevel"))
        if not (top / "harness" / "study").is_dir():
            return None  # the package is installed inside somebody else's repository
        dirty = _git(top, "status", "--porcelain", "--", *PACKAGES) != "" or _differ(root, top)
        return {"hash": _git(top, "rev-parse", "HEAD"), "dirty": dirty}
    except (OSError, subprocess.SubprocessError):
        return None


def _differ(installed: Path, checkout: Path) -> bool:
    """Whether the installed modules are others than those of the checkout around them."""
    names = [
        module.relative_to(installed)
        for package in PACKAGES
        for module in (installed / package).rglob("*.py")
    ]
    _, mismatch, missing = filecmp.cmpfiles(installed, checkout, names, shallow=False)
    return bool(mismatch or missing)


def _git(directory: Path, *arguments: str) -> str:
    finished = subprocess.run(
        ["git", "-C", str(directory), *arguments],
        capture_output=True,
        text=True,
        timeout=10,
        check=True,
    )
    return finished.stdout.strip()


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
