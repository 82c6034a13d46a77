"""The study ``mesh``: does moving vertices by angles pay?  Methods over meshes, row by row.

One row for each mesh and method.  No row depends on the order, and but for ``seconds`` and
``peak_mib`` (and a few of the iterations) no value on the machine.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from generators.triangulations import TRIANGULATIONS
from harness.mesh.options import Options
from harness.study.limits import Limits
from harness.study.outcome import Outcome, one_line
from harness.study.task import canonical

if TYPE_CHECKING:
    from harness.study.schema import Record

NAME = "mesh"
DESCRIPTION = "Mesh improvement: does moving vertices by their angles pay in practice?"
SEEDS = "seed = replicate = 0, 1, … for each family and n: every method sees the same meshes"
LIMITS = Limits(seconds=300, mib=4096)
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
    *("task", "family", "n", "seed", "method", "status", "message"),
    *("triangles", "triangles_after"),
    *(f"{name}_before" for name in FIGURES),
    *FIGURES,
    *("iterations_before", "iterations", "error_before", "error"),
    *("visits", "moves", "flips", "inverted", "angles_before", "angles", "history"),
    *("seconds", "peak_mib"),
)


@dataclass(frozen=True)
class MeshTask:
    """One mesh and one method."""

    family: str
    n: int
    seed: int
    method: str

    @property
    def key(self) -> str:
        """16 hexadecimal digits of the SHA-256 of the canonical JSON of the content."""
        content = [self.family, self.n, self.seed, self.method]
        return hashlib.sha256(canonical(content).encode()).hexdigest()[:16]


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


def row_of(task: MeshTask, outcome: Outcome) -> Record:
    """The row of a task, as text, with every column."""
    # The engines carry what `measure` returns and never look into it.
    measured: Any = outcome.measurement
    row = dict.fromkeys(COLUMNS, "")
    row.update(
        task=task.key,
        family=task.family,
        n=str(task.n),
        seed=str(task.seed),
        method=task.method,
        status=outcome.status,
        message=one_line(outcome.message),
    )
    if measured is not None:
        row.update({name: str(value) for name, value in measured.items()})
    if outcome.peak_mib is not None:
        row["peak_mib"] = f"{outcome.peak_mib:.1f}"
    return row


def measure(task: MeshTask) -> dict[str, Any]:
    """Improve one mesh, in the process of the task, and tell what came of it."""
    from harness.mesh.door import improve_mesh
    from harness.mesh.mesh import Mesh

    options = METHODS[task.method]
    improve_mesh(Mesh.of(*TRIANGULATIONS["random-mesh"](30, 0)), options, workers=1)  # compiled now
    mesh = Mesh.of(*TRIANGULATIONS[task.family](task.n, task.seed))
    better = improve_mesh(mesh, options, workers=1)
    before, after = better.before.as_dict(), better.after.as_dict()
    history = [
        [round(value, 4) for value in sweep.quality.as_dict().values()] for sweep in better.history
    ]
    return {
        "triangles": len(mesh.triangles),
        "triangles_after": len(better.triangles),
        **{f"{name}_before": round(before[name], 9) for name in FIGURES},
        **{name: round(after[name], 9) for name in FIGURES},
        **_in_use(mesh.points, mesh.triangles, "_before"),
        **_in_use(better.points, better.triangles, ""),
        "visits": better.visits,
        "moves": better.moves,
        "flips": better.flips,
        "inverted": better.inverted,
        "angles_before": json.dumps(_histogram(mesh.points, mesh.triangles)),
        "angles": json.dumps(_histogram(better.points, better.triangles)),
        "history": json.dumps(history, separators=(",", ":")),
        "seconds": f"{better.seconds:.6f}",
    }


def _in_use(points: Any, triangles: Any, suffix: str) -> dict[str, Any]:
    """What solving Poisson's equation takes and gives; the families fill the unit square."""
    from harness.mesh.poisson import solve

    solved = solve(points, triangles)
    if solved is None:
        return {}
    return {
        f"iterations{suffix}": solved.iterations,
        f"error{suffix}": round(solved.error_on_unit_square, 9),
    }


def _histogram(points: Any, triangles: Any) -> list[int]:
    """All angles in bins of 5°; those that are not positive are left out."""
    import numpy as np

    from harness.mesh.quality import corner_angles

    angles = corner_angles(points, triangles)
    counts: list[int] = np.histogram(angles, BINS, (0.0, 180.0))[0].tolist()
    return counts
