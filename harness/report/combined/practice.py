"""Does mesh improvement pay, and what can the programs do?  From ``mesh`` and the benchmarks."""

from __future__ import annotations

import csv
import json
from pathlib import Path

from harness.analysis.meshes import PAPER, answer, findings
from harness.report.combined.parts import Chapter, Workshop, absent
from harness.report.labels import plural
from harness.report.mesh_report import findings_table
from harness.report.sections import Cell, Table, cell
from harness.study.mesh_rows import is_mesh_study, read_meshes

MESH = ("mesh", "Does moving vertices by their angles pay?")
BENCH = ("bench", "How fast are the programs?")
PLATES = ("figure-5", "figure-6", "meshes")


def mesh_chapter(shop: Workshop) -> Chapter:
    """The methods of mesh improvement side by side."""
    directory = shop.results / "mesh"
    found = findings(read_meshes(directory)) if is_mesh_study(directory) else []
    if not found:
        return absent(*MESH, ("mesh",))
    said = {each.method: each for each in found}
    best = max(found, key=lambda each: each.smallest)
    sentences = [answer(found)]
    for method, words in ((PAPER, "The paper’s greedy"), (best.method, f"“{best.method}”")):
        if method in said:
            each = said[method]
            sentences.append(
                f"{words} raised the smallest angle on {each.rose} of {each.meshes} meshes and "
                f"lowered it on {each.fell}; its median went from {each.smallest_before:.2f}° to "
                f"{each.smallest:.2f}°."
            )
    rose, meshes = sum(each.rose for each in found), sum(each.meshes for each in found)
    return Chapter(
        *MESH,
        f"The smallest angle rose in {rose} of {meshes} runs",
        "",
        sentences,
        shop.shelved(PLATES, wide=["meshes"]),
        [findings_table(found)],
        sources=["mesh"],
    )


def bench_chapter(shop: Workshop) -> Chapter:
    """One table for each benchmark."""
    found = sorted((shop.results / "bench").glob("*/rows.csv"))
    if not found:
        missing = "No benchmark is stored here yet (avd bench diagram makes one)."
        return Chapter(*BENCH, missing=missing)
    tables, certified, total = [], 0, 0
    for path in found:
        rows = _read(path)
        total += len(rows)
        certified += sum(row.get("certified") == "true" for row in rows)
        tables.append(_bench_table(path.parent.name, rows))
    return Chapter(
        *BENCH,
        f"{plural(total, 'timing')}",
        "",
        [
            f"{plural(len(found), 'benchmark')} of {plural(total, 'instance')}; in {certified} of "
            "them the result is certified. Times are medians of so many whole runs as the tables "
            "say, on the machine that the manifest names, and say nothing about other machines."
        ],
        (),
        tables,
        sources=[f"bench/{path.parent.name}" for path in found],
    )


def _read(path: Path) -> list[dict[str, str]]:
    """The rows as they are stored, and how many ``runs`` were timed for each."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [{**row, "runs": str(len(json.loads(row.get("timings") or "[]")) or "")} for row in rows]


#: A benchmark's columns on the page, where it has them.
SHOWN = {
    "n": "n",
    "vertices": "vertices",
    "sides": "sides",
    "seconds": "seconds",
    "runs": "runs",
    "vertices_per_second": "vertices / s",
    "sides_per_second": "sides / s",
    "moves_per_second": "moves / s",
    "smallest_before": "smallest before (°)",
    "smallest": "smallest (°)",
    "peak_mib": "MiB",
}


def _bench_table(name: str, rows: list[dict[str, str]]) -> Table:
    columns = [key for key in SHOWN if any(row.get(key) for row in rows)]
    body = []
    for row in rows:
        numbers = [row.get(key, "") for key in columns]
        cells = [cell(float(text)) if text else Cell("") for text in numbers]
        body.append([Cell(row["instance"]), Cell(row.get("builder", "")), *cells])
    head = ["instance", "by", *(SHOWN[key] for key in columns)]
    return Table(f"Benchmark “{name}”", head, body)
