"""The study ``mesh``: does moving vertices by angles pay?  Methods over meshes, row by row.

One row for each mesh and method, added as soon as it is there: a run that was interrupted goes on
with the rows that are missing.  Seeds are 0, 1, …; no row depends on the order, and but for
``seconds`` no value on the machine.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import harness
from generators.triangulations import TRIANGULATIONS
from harness.errors import UserError
from harness.files import replace
from harness.mesh.options import Options
from harness.study.lock import locked
from harness.study.manifest import git_commit, machine, versions

NAME = "mesh"
DESCRIPTION = "Mesh improvement: does moving vertices by their angles pay in practice?"
ROWS, MANIFEST = "rows.csv", "manifest.json"
METHODS = {
    "laplacian": Options("laplacian"),
    "smart-laplacian": Options("smart-laplacian"),
    "combined": Options("combined"),
    "apex": Options("apex"),
    "apex, bisector": Options("apex", remedy="bisector"),
    "apex, chord": Options("apex", remedy="chord"),
    "apex, both": Options("apex", remedy="both"),
    "all": Options(),
    "all, flips": Options(topology="flip"),
    "all, full": Options(topology="full"),
}
"""What is compared; the first of the angle methods, ``apex``, is the paper's greedy."""
SIZES = {"random-mesh": ((250, 10), (1000, 10), (4000, 5)), "distorted-grid": ((20, 5), (40, 5))}
"""Family → (n, number of seeds)."""
BINS = 36
"""Of the histograms: 5° each."""
FIGURES = ("smallest", "percentile_1", "percentile_5", "mean")
COLUMNS = (
    *("family", "n", "seed", "method", "triangles", "triangles_after"),
    *(f"{name}_before" for name in FIGURES),
    *FIGURES,
    *("visits", "moves", "flips", "inverted", "seconds", "angles_before", "angles", "history"),
)


@dataclass(frozen=True)
class MeshTask:
    """One mesh and one method."""

    family: str
    n: int
    seed: int
    method: str

    @property
    def key(self) -> tuple[str, ...]:
        """What tells its row from others."""
        return self.family, str(self.n), str(self.seed), self.method


def tasks() -> list[MeshTask]:
    """All tasks, small meshes first."""
    found = [
        MeshTask(family, n, seed, method)
        for family, sizes in SIZES.items()
        for n, seeds in sizes
        for seed in range(seeds)
        for method in METHODS
    ]
    return sorted(found, key=lambda task: task.n)


def run_meshes(
    directory: Path,
    *,
    mode: str = "new",
    command: str = "avd study mesh",
    todo: list[MeshTask] | None = None,
    tell: Callable[[int], None] | None = None,
) -> int:
    """Run the tasks without a row and store each row at once; how many rows were added.

    ``mode``: "new" refuses a directory with rows, "resume" and "retry" go on with them, "fresh"
    puts them aside.  ``tell(done)`` is called after each task.

    Raises:
        UserError: the directory is in use, or not this study's.
    """
    directory.mkdir(parents=True, exist_ok=True)
    with locked(directory):
        path = directory / ROWS
        if mode == "new" and path.exists():
            raise UserError(f"{directory}: there are rows; --resume goes on, --fresh begins anew")
        if mode == "fresh" and path.exists():
            path.replace(directory / "rows-earlier.csv")
        rows = read_meshes(directory) if path.exists() else []
        known = {(row["family"], row["n"], row["seed"], row["method"]) for row in rows}
        chosen = tasks() if todo is None else todo
        _write_manifest(directory, command, len(chosen))
        missing = [task for task in chosen if task.key not in known]
        if not path.exists():
            replace(path, (",".join(COLUMNS) + "\n").encode())
        for done, task in enumerate(missing, start=1):
            line = io.StringIO()
            csv.DictWriter(line, COLUMNS, lineterminator="\n").writerow(_row(task))
            with open(path, "a", encoding="utf-8") as file:
                file.write(line.getvalue())
            if tell is not None:
                tell(len(chosen) - len(missing) + done)
    return len(missing)


def read_meshes(directory: Path) -> list[dict[str, str]]:
    """The rows of a mesh study, as text; a line that was cut off at the end is left out.

    Raises:
        UserError: there are none, or other columns.
    """
    path = directory / ROWS
    if not path.exists():
        raise UserError(f"{directory}: no study of meshes here ({ROWS} is missing)")
    text = path.read_text(encoding="utf-8")
    whole = text[: text.rfind("\n") + 1]
    if whole != text:
        replace(path, whole.encode())
    reader = csv.DictReader(io.StringIO(whole))
    if tuple(reader.fieldnames or ()) != COLUMNS:
        raise UserError(f"{path}: not the rows of a study of meshes")
    return list(reader)


def is_mesh_study(directory: Path) -> bool:
    """Whether a directory holds rows of this study, going by their head."""
    try:
        with open(directory / ROWS, encoding="utf-8") as file:
            return file.readline().rstrip("\n") == ",".join(COLUMNS)
    except (OSError, UnicodeDecodeError):
        return False


def _row(task: MeshTask) -> dict[str, Any]:
    """Improve one mesh and tell what came of it."""
    from harness.mesh.door import improve

    points, triangles = TRIANGULATIONS[task.family](task.n, task.seed)
    options = METHODS[task.method]
    better = improve(
        points,
        triangles,
        objective=options.objective,
        topology=options.topology,
        remedy=options.remedy,
        sweeps=options.sweeps,
        workers=1,
    )
    before, after = better.before.as_dict(), better.after.as_dict()
    history = [
        [round(value, 4) for value in sweep.quality.as_dict().values()] for sweep in better.history
    ]
    return {
        **{"family": task.family, "n": task.n, "seed": task.seed, "method": task.method},
        "triangles": len(triangles),
        "triangles_after": len(better.triangles),
        **{f"{name}_before": round(before[name], 9) for name in FIGURES},
        **{name: round(after[name], 9) for name in FIGURES},
        "visits": better.visits,
        "moves": better.moves,
        "flips": better.flips,
        "inverted": better.inverted,
        "seconds": round(better.seconds, 6),
        "angles_before": json.dumps(_histogram(points, triangles)),
        "angles": json.dumps(_histogram(better.points, better.triangles)),
        "history": json.dumps(history),
    }


def _histogram(points: Any, triangles: Any) -> list[int]:
    """All angles in bins of 5°; those that are not positive are left out."""
    from harness.mesh.quality import corner_angles

    angles = corner_angles(points, triangles)
    counts: list[int] = np.histogram(angles, BINS, (0.0, 180.0))[0].tolist()
    return counts


def _write_manifest(directory: Path, command: str, total: int) -> None:
    manifest = {
        "study": NAME,
        "description": DESCRIPTION,
        "kind": "meshes",
        "avd": harness.__version__,
        "commit": git_commit(),
        "versions": versions(),
        "machine": machine(),
        "command": command,
        "seeds": "0, 1, … for each family and n",
        "tasks": total,
    }
    text = json.dumps(manifest, indent=2, ensure_ascii=False) + "\n"
    replace(directory / MANIFEST, text.encode())
