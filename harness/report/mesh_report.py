"""The report of the mesh study: one page that opens offline, with its figures beside it."""

from __future__ import annotations

import html
import json
import statistics
from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from harness.errors import UserError
from harness.files import replace
from harness.report import mesh_figures
from harness.report.style import inline, render
from harness.study.meshes import FIGURES, METHODS, read_meshes

Row = dict[str, str]
PAPER, BEST = "apex", "all"
GAIN = 1e-6
"""Degrees that count as better."""

STYLE = """
body{font-family:'DejaVu Sans',Verdana,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem}
table{border-collapse:collapse}th,td{padding:.15rem .7rem;text-align:right}
th:first-child,td:first-child{text-align:left}svg{max-width:100%;height:auto}
figcaption{color:#555;margin-bottom:1.5rem}
"""


def write_mesh_report(directory: Path) -> tuple[Path, list[str]]:
    """Write ``report.html`` and ``figures/``; returns the page and its conclusions.

    The same rows give the same bytes.  Raises UserError if there are no rows.
    """
    rows = read_meshes(directory)
    if not rows:
        raise UserError(f"{directory}: there are no rows to report on")
    lines = conclusions(rows)
    parts = ["<h1>Mesh improvement: does it pay?</h1>"]
    parts += [f"<p>{html.escape(line)}</p>" for line in lines]
    for family in dict.fromkeys(row["family"] for row in rows):
        parts.append(_table([row for row in rows if row["family"] == family], family))
    (directory / "figures").mkdir(exist_ok=True)
    for name, (draw, width, height, caption) in _figures(rows).items():
        svg = render(draw, width, height)
        replace(directory / "figures" / f"{name}.svg", svg.encode())
        shown = inline(svg, name, caption)
        parts.append(f"<figure>{shown}<figcaption>{html.escape(caption)}</figcaption></figure>")
    page = directory / "report.html"
    head = f"<!doctype html><html lang=en><meta charset=utf-8><title>meshes</title><style>{STYLE}"
    replace(page, "\n".join([head + "</style>", *parts, "</html>\n"]).encode())
    return page, lines


def conclusions(rows: list[Row]) -> list[str]:
    """What the rows say about the paper's question, method by method."""
    lines = [
        "The paper asks whether moving vertices to the peaks of visual angles is useful in "
        "practice. Counted over the meshes of this study:"
    ]
    for method in METHODS:
        mine = [row for row in rows if row["method"] == method]
        if not mine:
            continue
        gains = [float(row["smallest"]) - float(row["smallest_before"]) for row in mine]
        better = sum(gain > GAIN for gain in gains)
        worse = sum(gain < -GAIN for gain in gains)
        inverted = sum(int(row["inverted"]) > 0 for row in mine)
        lines.append(
            f"{method}: the smallest angle rose in {better} of {len(mine)} meshes, fell in {worse}"
            + (f", and triangles were inverted in {inverted}" if inverted else "")
            + f"; median of the smallest angle {_median(mine, 'smallest'):.2f}°, "
            f"of the mean of the triangles' least angles {_median(mine, 'mean'):.2f}°."
        )
    return lines


def _median(rows: list[Row], column: str) -> float:
    return statistics.median(float(row[column]) for row in rows)


def _table(rows: list[Row], family: str) -> str:
    """Medians over the meshes of one family, one line for each n and method."""
    heads = ["method", "n", *FIGURES, "seconds"]
    lines = [f"<h2>{html.escape(family)}</h2><table><tr>"]
    lines += [f"<th>{head.replace('_', ' ')}</th>" for head in heads]
    lines.append("</tr>")
    for n in dict.fromkeys(row["n"] for row in rows):
        same = [row for row in rows if row["n"] == n]
        before = [f"{_median(same, f'{name}_before'):.3f}" for name in FIGURES]
        lines.append(_line(["before", n, *before, "–"]))
        for method in dict.fromkeys(row["method"] for row in same):
            mine = [row for row in same if row["method"] == method]
            after = [f"{_median(mine, name):.3f}" for name in FIGURES]
            lines.append(_line([method, n, *after, f"{_median(mine, 'seconds'):.3g}"]))
    return "".join([*lines, "</table><p>Medians, in degrees.</p>"])


def _line(cells: list[str]) -> str:
    return "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>"


Drawn = tuple[Callable[[Figure], None], float, float, str]


def _figures(rows: list[Row]) -> dict[str, Drawn]:
    """Name → how it is drawn, its size in inches, its caption."""
    figures: dict[str, Drawn] = {}
    for family in dict.fromkeys(row["family"] for row in rows):
        mine = [row for row in rows if row["family"] == family]
        largest = max(mine, key=lambda row: int(row["n"]))["n"]
        shown = [row for row in mine if row["n"] == largest and row["seed"] == "0"]
        panels = [
            (row["method"], json.loads(row["angles_before"]), json.loads(row["angles"]))
            for row in shown
        ]
        lines = {row["method"]: json.loads(row["history"]) for row in shown}
        times = _times(mine)
        where = f"{family}, n = {largest}, seed 0"
        figures[f"angles-{family}"] = (
            partial(mesh_figures.draw_histograms, panels=panels),
            11,
            4.5,
            f"All angles before and after: {where}.",
        )
        figures[f"sweeps-{family}"] = (
            partial(mesh_figures.draw_sweeps, lines=lines),
            12,
            3.2,
            f"After each sweep: {where}.",
        )
        figures[f"seconds-{family}"] = (
            partial(mesh_figures.draw_times, times=times),
            6,
            4,
            f"Median seconds: {family}.",
        )
    figures["figure-5"] = (
        mesh_figures.draw_figure_5,
        10,
        3.4,
        "As the paper's Figure 5: a mesh, and two steps of the greedy.",
    )
    figures["figure-6"] = (
        mesh_figures.draw_figure_6,
        10,
        3.4,
        "As the paper's Figure 6: a star's kernel, its triangulation, and one without an ear.",
    )
    return figures


def _times(rows: list[Row]) -> dict[str, list[tuple[int, float]]]:
    """For each method the median seconds by the number of triangles."""
    lines: dict[str, list[tuple[int, float]]] = {}
    for method in dict.fromkeys(row["method"] for row in rows):
        mine = [row for row in rows if row["method"] == method]
        places = []
        for n in sorted({int(row["n"]) for row in mine}):
            same = [row for row in mine if int(row["n"]) == n]
            places.append((int(_median(same, "triangles")), _median(same, "seconds")))
        lines[method] = places
    return lines
