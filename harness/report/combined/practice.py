"""Does mesh improvement pay, and what can the programs do?  From ``mesh`` and the benchmarks."""

from __future__ import annotations

import csv
import statistics
from pathlib import Path

from harness.report.combined.parts import Chapter, Workshop, absent
from harness.report.labels import number, plural
from harness.report.mesh_report import GAIN
from harness.report.sections import Cell, Table, cell
from harness.study.meshes import METHODS, is_mesh_study, read_meshes

MESH = ("mesh", "Does moving vertices by their angles pay?")
BENCH = ("bench", "How fast are the programs?")
PAPER = "apex"
OURS = "all"


def mesh_chapter(shop: Workshop) -> Chapter:
    """The methods of mesh improvement side by side."""
    directory = shop.results / "mesh"
    rows = read_meshes(directory) if is_mesh_study(directory) else []
    if not rows:
        return absent(*MESH, ("mesh",))
    methods = [method for method in METHODS if any(row["method"] == method for row in rows)]
    lines = {method: _figures([r for r in rows if r["method"] == method]) for method in methods}
    sentences = []
    for method, words in ((PAPER, "The paper’s greedy"), (OURS, "Raising all angles at once")):
        if method in lines:
            line = lines[method]
            sentences.append(
                f"{words} raised the smallest angle in {line['rose']:g} of {line['meshes']:g} "
                f"meshes and lowered it in {line['fell']:g}; in the median it went from "
                f"{number(line['before'])}° to {number(line['after'])}°."
            )
    best = max(lines, key=lambda method: lines[method]["after"])
    sentences.append(f"The largest median was reached by “{best}”.")
    head = ["method", "meshes", "rose", "fell", "inverted", "smallest before (°)"]
    head += ["smallest after (°)", "mean of least angles (°)", "seconds"]
    keys = ("meshes", "rose", "fell", "inverted", "before", "after", "mean", "seconds")
    body = [[Cell(name), *(cell(line[key]) for key in keys)] for name, line in lines.items()]
    rose, meshes = (sum(line[key] for line in lines.values()) for key in ("rose", "meshes"))
    return Chapter(
        *MESH,
        f"The smallest angle rose in {rose:g} of {meshes:g} runs",
        "",
        sentences,
        shop.shelved(["figure-5", "figure-6"]),
        [Table("Methods compared (medians over all meshes)", head, body)],
        sources=["mesh"],
    )


def _figures(rows: list[dict[str, str]]) -> dict[str, float]:
    """Counts and medians over the meshes of one method."""
    gains = [float(row["smallest"]) - float(row["smallest_before"]) for row in rows]

    def median(column: str) -> float:
        return statistics.median(float(row[column]) for row in rows)

    return {
        "meshes": len(rows),
        "rose": sum(gain > GAIN for gain in gains),
        "fell": sum(gain < -GAIN for gain in gains),
        "inverted": sum(int(row["inverted"]) > 0 for row in rows),
        "before": median("smallest_before"),
        "after": median("smallest"),
        "mean": median("mean"),
        "seconds": median("seconds"),
    }


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
            "them the result is certified. Times are medians of whole runs on the machine that "
            "the manifest names, and say nothing about other machines."
        ],
        (),
        tables,
        sources=[f"bench/{path.parent.name}" for path in found],
    )


def _read(path: Path) -> list[dict[str, str]]:
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


#: A benchmark's columns on the page, where it has them.
SHOWN = {
    "n": "n",
    "vertices": "vertices",
    "sides": "sides",
    "seconds": "seconds",
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
