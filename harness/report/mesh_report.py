"""The report of the study of meshes: one page that opens offline, with its figures beside it."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from harness.analysis.meshes import PLAIN, MethodFindings, answer, findings, lines, median
from harness.errors import UserError
from harness.report import mesh_figures, provenance
from harness.report.labels import number
from harness.report.pages import REPORT, environment, write_files
from harness.report.sections import Cell, Table
from harness.report.style import inline, render
from harness.study.manifest import read_manifest
from harness.study.mesh_rows import read_meshes
from harness.study.meshes import DESCRIPTION, FIGURES, NAME
from harness.study.outcome import STATUSES
from harness.study.progress import tally

Row = dict[str, str]
Drawn = tuple[Callable[[Figure], None], float, float, str]
"""How a figure is drawn, its size in inches, its caption."""
PER = 1000
"""Triangles to which times are related."""
MIDDLE = 8.0
"""Inches; figures that are wider fill the page."""


def write_mesh_report(directory: Path) -> tuple[Path, list[str]]:
    """Write ``report.html`` and ``figures/``; returns the page and its conclusions.

    The same rows and manifest give the same bytes.  Raises UserError if there are no rows.
    """
    rows = read_meshes(directory)
    done = [row for row in rows if row["status"] == "ok"]
    if not done:
        raise UserError(f"{directory}: there are no finished rows to report on")
    found = findings(rows)
    files: dict[str, str] = {}
    measured = _render(_figures(done), files)
    paper = _render(_paper_figures(), files)
    manifest = read_manifest(directory)
    page = (
        environment()
        .get_template("meshes.html")
        .render(
            name=NAME,
            description=DESCRIPTION,
            tasks=_tasks(rows, manifest),
            answer=answer(found),
            findings=findings_table(found),
            sizes=[_size_table(done, *group) for group in _groups(done)],
            figures=measured,
            paper=paper,
            provenance=provenance.entries(manifest),
        )
    )
    return write_files(directory, {**files, REPORT: page + "\n"}), lines(found)


def _tasks(rows: Sequence[Row], manifest: Any) -> str:
    planned = (manifest or {}).get("tasks", len(rows))
    counts = tally({status: sum(row["status"] == status for row in rows) for status in STATUSES})
    return f"{len(rows)} of {planned} tasks have a row: {counts}."


def findings_table(found: Sequence[MethodFindings]) -> Table:
    """The methods side by side: one line each, from all meshes of the study."""
    head = ["method", "meshes", "up", "down", "inverted", "failed", "smallest angle before"]
    head += ["after", "iterations ×", "error ×"]
    head += ["greater smallest angle", "fewer iterations", "less error", "time ×"]
    rows = [
        [
            Cell(each.method),
            *(_cell(value) for value in (each.meshes, each.rose)),
            _cell(each.fell, "bad" if each.fell else ""),
            _cell(each.inverted, "bad" if each.inverted else ""),
            _cell(each.failed, "warn" if each.failed else ""),
            *(_degrees(value) for value in (each.smallest_before, each.smallest)),
            *(_cell(value) for value in (each.iterations, each.error)),
            *(
                Cell(f"{count} of {each.compared}", str(count), _kind(each, purpose))
                for purpose, count in each.better.items()
            ),
            _cell(each.slower),
        ]
        for each in found
    ]
    caption = f"What each method did; the last four columns: beside {PLAIN} on the same meshes"
    return Table(caption, head, rows)


def _kind(each: MethodFindings, purpose: str) -> str:
    return "good" if purpose in each.pays_for else ""


def _cell(value: float | None, kind: str = "") -> Cell:
    return Cell(number(value), "" if value is None else f"{value:.9g}", kind)


def _degrees(value: float) -> Cell:
    return Cell(f"{value:.2f}", f"{value:.9g}")


def _groups(rows: Sequence[Row]) -> list[tuple[str, str]]:
    return list(dict.fromkeys((row["family"], row["n"]) for row in rows))


def _size_table(rows: Sequence[Row], family: str, n: str) -> Table:
    """Medians over the meshes of one family and size, one line for each method."""
    same = [row for row in rows if (row["family"], row["n"]) == (family, n)]
    head = ["method", *(name.replace("_", " ") for name in FIGURES), "iterations", "error"]
    first = [
        Cell("before"),
        *(_degrees(median(same, f"{name}_before")) for name in FIGURES),
        *(_cell(_known(same, f"{name}_before")) for name in ("iterations", "error")),
        Cell("–"),
    ]
    lines_ = [first]
    for method in dict.fromkeys(row["method"] for row in same):
        mine = [row for row in same if row["method"] == method]
        seconds = median(mine, "seconds") * PER / median(mine, "triangles")
        lines_.append(
            [
                Cell(method),
                *(_degrees(median(mine, name)) for name in FIGURES),
                *(_cell(_known(mine, name)) for name in ("iterations", "error")),
                _cell(seconds),
            ]
        )
    meshes = len({row["seed"] for row in same})
    caption = f"{family}, n = {n}: medians of {meshes} meshes"
    return Table(caption, [*head, f"seconds for {PER} triangles"], lines_)


def _known(rows: Sequence[Row], column: str) -> float | None:
    there = [row for row in rows if row[column]]
    return median(there, column) if there else None


def _render(figures: dict[str, Drawn], files: dict[str, str]) -> list[dict[str, str]]:
    """What the page shows of each figure; their documents are added to ``files``."""
    shown = []
    for name, (draw, width, height, caption) in figures.items():
        svg = render(draw, width, height)
        path = f"figures/{name}.svg"
        files[path] = svg
        kind = "wide" if width > MIDDLE else "middle"
        picture = inline(svg, name, caption)
        shown.append({"svg": picture, "caption": caption, "path": path, "kind": kind})
    return shown


def _figures(rows: Sequence[Row]) -> dict[str, Drawn]:
    figures: dict[str, Drawn] = {}
    for family in dict.fromkeys(row["family"] for row in rows):
        mine = [row for row in rows if row["family"] == family]
        largest = max(mine, key=lambda row: int(row["n"]))["n"]
        seed = min(int(row["seed"]) for row in mine if row["n"] == largest)
        shown = [row for row in mine if row["n"] == largest and row["seed"] == str(seed)]
        panels = [
            (row["method"], json.loads(row["angles_before"]), json.loads(row["angles"]))
            for row in shown
        ]
        histories = {row["method"]: json.loads(row["history"]) for row in shown}
        where = f"{family}, n = {largest}, seed {seed}"
        figures[f"angles-{family}"] = (
            partial(mesh_figures.draw_histograms, panels=panels),
            11,
            4.5,
            f"All angles of the mesh before and after: {where}.",
        )
        figures[f"sweeps-{family}"] = (
            partial(mesh_figures.draw_sweeps, lines=histories),
            12,
            3.6,
            f"After each sweep, or as much work as a sweep's: {where}. Where edges may change, "
            "moves alone come first and everything begins anew.",
        )
        figures[f"seconds-{family}"] = (
            partial(mesh_figures.draw_times, times=_times(mine)),
            7,
            4.2,
            f"Median seconds, by the number of triangles: {family}.",
        )
    return figures


def _paper_figures() -> dict[str, Drawn]:
    return {
        "figure-5": (
            mesh_figures.draw_figure_5,
            10,
            2.6,
            "As the paper's Figure 5: a mesh, and two steps of the greedy.",
        ),
        "figure-6": (
            mesh_figures.draw_figure_6,
            10,
            2.6,
            "As the paper's Figure 6: a star's kernel, its triangulation, and one without an ear.",
        ),
        "meshes": (
            mesh_figures.draw_meshes,
            12,
            3.6,
            "One mesh and what becomes of it; triangles are coloured by their smallest angle.",
        ),
    }


def _times(rows: Sequence[Row]) -> dict[str, list[tuple[int, float]]]:
    """For each method the median seconds by the number of triangles."""
    found: dict[str, list[tuple[int, float]]] = {}
    for method in dict.fromkeys(row["method"] for row in rows):
        mine = [row for row in rows if row["method"] == method]
        places = []
        for n in sorted({int(row["n"]) for row in mine}):
            same = [row for row in mine if int(row["n"]) == n]
            places.append((int(median(same, "triangles")), median(same, "seconds")))
        found[method] = places
    return found
