"""Cells of a kernel against pixels: an oracle that knows nothing of curves, events or sweeps."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial.distance import cdist

import generators
from harness.diagram import build
from harness.diagram.planar_map import Cell, PlanarMap, Side
from harness.geometry.instance import Instance
from harness.geometry.visual_angle import cot_visual_angle

RESOLUTION = 420
FAMILIES = ("star", "star-fat", "near-regular", "convex-valtr", "convex-circle", "cavity")
INSTANCES = [(f, n, seed) for f in FAMILIES for n in (5, 6, 7) for seed in range(8)]


def outline(diagram: PlanarMap, side: Side, tolerance: float) -> NDArray[np.float64]:
    """The points of one step of a boundary walk, in the walk's direction."""
    if side.is_wall:
        points = np.array(diagram.walls[side.item].ends)
    else:
        points = diagram.edges[side.item].polyline(tolerance)
    return points if side.forward else points[::-1]


def area_and_perimeter(diagram: PlanarMap, cell: Cell, tolerance: float) -> tuple[float, float]:
    area = perimeter = 0.0
    for walk in cell.walks:
        loop = np.concatenate([outline(diagram, side, tolerance) for side in walk])
        following = np.roll(loop, -1, axis=0)
        area += float(np.sum(loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0])) / 2
        perimeter += float(np.sum(np.hypot(*(following - loop).T)))
    return area, perimeter


def has_neck(diagram: PlanarMap, cell: Cell, pixel: float) -> bool:
    """Whether two sides of a cell that do not follow one another come within a few pixels.

    There the cell may hang together by a neck that no pixel shows.
    """
    for walk in cell.walks:
        lines = [densified(outline(diagram, side, pixel / 4), pixel) for side in walk]
        for i, j in itertools.combinations(range(len(walk)), 2):
            adjacent = j - i in (1, len(walk) - 1)
            if not adjacent and cdist(lines[i], lines[j]).min() < 6 * pixel:
                return True
    return False


def densified(line: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """The line with points no further apart than ``step``."""
    pieces = [
        np.linspace(a, b, 2 + int(np.hypot(*(b - a)) / step)) for a, b in itertools.pairwise(line)
    ]
    return np.concatenate(pieces)


def winners_on_grid(diagram: PlanarMap) -> tuple[NDArray[np.int64], float]:
    """The winner at every pixel of the kernel (−1 outside), and the width of a pixel."""
    corners = diagram.corners
    assert corners is not None
    low, high = corners.min(axis=0), corners.max(axis=0)
    pixel = float(np.max(high - low)) / RESOLUTION
    xs = np.arange(low[0] + pixel / 2, high[0], pixel)
    ys = np.arange(low[1] + pixel / 2, high[1], pixel)
    points = np.stack(np.meshgrid(xs, ys), axis=-1)
    cot = np.stack([cot_visual_angle(points, s) for s in diagram.instance.segments])
    inside = np.ones(points.shape[:2], dtype=bool)
    for a, b in itertools.pairwise([*corners, corners[0]]):
        inside &= (b[0] - a[0]) * (points[..., 1] - a[1]) > (b[1] - a[1]) * (points[..., 0] - a[0])
    return np.where(inside, np.argmax(cot, axis=0), -1), pixel


def visible_components(winners: NDArray[np.int64]) -> int:
    """Connected pieces of one winner, not counting crumbs at the tips of wedges."""
    count = 0
    for segment in np.unique(winners[winners >= 0]):
        labels, _ = ndimage.label(winners == segment)
        count += int(np.sum(np.bincount(labels.ravel())[1:] >= 20))
    return count


def test_cells_agree_with_a_raster() -> None:
    compared = 0
    for family, n, seed in INSTANCES:
        diagram = build(Instance.from_generated(generators.generate(family, n, seed)), "kernel")
        winners, pixel = winners_on_grid(diagram)
        sizes = [area_and_perimeter(diagram, cell, pixel / 4) for cell in diagram.cells]
        assert all(area > 0 for area, _ in sizes), (family, n, seed)
        if any(area < 400 * pixel**2 or area < 4 * pixel * around for area, around in sizes):
            continue
        if any(has_neck(diagram, cell, pixel) for cell in diagram.cells):
            continue
        compared += 1
        assert visible_components(winners) == len(diagram.cells), (family, n, seed)
    assert compared >= 50


@pytest.mark.parametrize("family", ["star", "zigzag", "convex-weave"])
def test_cell_areas_fill_the_kernel(family: str) -> None:
    diagram = build(Instance.from_generated(generators.generate(family, 10, 3)), "kernel")
    assert diagram.corners is not None
    x, y = diagram.corners.T
    kernel_area = float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
    total = sum(area_and_perimeter(diagram, cell, 1e-4)[0] for cell in diagram.cells)
    assert total == pytest.approx(kernel_area, rel=1e-9)
