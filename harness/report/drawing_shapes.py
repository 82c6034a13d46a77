"""Where things are drawn: the window, the curves of the edges, the outlines of the cells."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from harness.diagram.planar_map import Edge, PlanarMap, Side, Walk, Window
from harness.errors import UserError

Points = NDArray[np.float64]

#: A node further from the segments than this many times their own extent is left outside.
FAR_NODE = 1.0
#: Free space around what the window must show, as a part of its extent.
MARGIN = 0.06
#: Curves are followed to this part of the window's extent: a twentieth of a pixel or less.
TOLERANCE = 1 / 10_000
#: Windows of less or more extent are not drawn, nor any that small beside its coordinates.
DRAWABLE = (1e-100, 1e100)
FINEST = 1e-9


def natural_window(diagram: PlanarMap) -> Window:
    """The window (xmin, ymin, xmax, ymax) that shows the whole diagram.

    All segments, and in the plane every finite node that is not far from them: at most as far
    from their bounding box as that box is wide or high, whichever is more.
    """
    seen = diagram.instance.segments.reshape(-1, 2)
    low, high = seen.min(axis=0), seen.max(axis=0)
    if diagram.corners is None:
        reach = FAR_NODE * float((high - low).max())
        nodes = np.array([n.point for n in diagram.nodes if n.kind != "infinity"]).reshape(-1, 2)
        near = ((nodes >= low - reach) & (nodes <= high + reach)).all(axis=1)
        seen = np.concatenate([seen, nodes[near]])
    # Unbounded cells show by the space around: a quarter of the extent in the plane.
    return framed(seen, 0.25 if diagram.corners is None else MARGIN)


def framed(points: Points, margin: float = MARGIN) -> Window:
    """The bounding box of the points (m, 2) with a margin, and never thinner than 1 : 4."""
    low, high = points.min(axis=0), points.max(axis=0)
    extent = float((high - low).max())
    half = np.maximum((high - low) / 2, extent / 8) + margin * extent
    middle = (low + high) / 2
    (x0, y0), (x1, y1) = middle - half, middle + half
    return checked_window((x0, y0, x1, y1))


def checked_window(window: Sequence[float]) -> Window:
    """``window`` as floats.

    Raises:
        UserError: unless xmin < xmax and ymin < ymax, and doubles (and the renderers, which square
            lengths) can tell its points apart.
    """
    x0, y0, x1, y1 = (float(value) for value in window)
    described = f"the window {x0:g} {y0:g} {x1:g} {y1:g}"
    if not (x0 < x1 and y0 < y1):
        raise UserError(f"{described} must have x0 < x1 and y0 < y1")
    extent, farthest = max(x1 - x0, y1 - y0), max(map(abs, (x0, y0, x1, y1)))
    if not DRAWABLE[0] < extent <= 2 * farthest < DRAWABLE[1] or extent < FINEST * farthest:
        raise UserError(f"{described} is too large, too small or too far from the origin to draw")
    return x0, y0, x1, y1


class Shapes:
    """The curves and outlines of a diagram, cut to a window.

    Every edge is followed once, within ``TOLERANCE`` of the window's extent; what lies outside
    the window is only as true as the outlines of the cells inside need it to be.
    """

    def __init__(self, diagram: PlanarMap, window: Window) -> None:
        """``window``: (xmin, ymin, xmax, ymax)."""
        self.diagram = diagram
        self.window = window
        x0, y0, x1, y1 = window
        self.middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
        self.extent = max(x1 - x0, y1 - y0)
        # Outlines are cut a little outside what is shown, so that no cut is ever seen.
        slack = 0.05 * self.extent
        self._cut = (x0 - slack, y0 - slack, x1 + slack, y1 + slack)

    @cached_property
    def curves(self) -> list[Points]:
        """The polyline of every edge from start to end, shape (m, 2).

        Unbounded ends run on beyond everything else that is drawn, all of them equally far: so
        those of one direction are ordered by angle as they are side by side.
        """
        tolerance = TOLERANCE * self.extent
        curves = [e.polyline(tolerance, self.window) for e in self.diagram.edges]
        farthest = max((float(np.abs(curve - self.middle).max()) for curve in curves), default=0.0)
        reach = 4 * farthest + 100 * self.extent
        return [
            self._extended(e, curve, reach)
            for e, curve in zip(self.diagram.edges, curves, strict=True)
        ]

    def _extended(self, edge: Edge, curve: Points, reach: float) -> Points:
        """The curve, its unbounded ends prolonged straight in the direction in which they leave,
        until they are ``reach`` away in it from the middle."""
        nodes = self.diagram.nodes
        pieces = [curve]
        for node, end in ((edge.start, 0), (edge.end, -1)):
            if node is not None and nodes[node].kind == "infinity":
                direction = np.array(nodes[node].point)
                along = float((curve[end] - self.middle) @ direction)
                tip = curve[end] + (reach - along) * direction
                pieces.insert(0 if end == 0 else len(pieces), tip[None])
        return np.concatenate(pieces)

    def visible_curves(self) -> Iterator[Points]:
        """The parts of all edges near the window, as polylines."""
        x0, y0, x1, y1 = self._cut
        for curve in self.curves:
            # A chord may be seen unless both its ends are beyond the same side of the window.
            outside = np.stack(
                [curve[:, 0] < x0, curve[:, 0] > x1, curve[:, 1] < y0, curve[:, 1] > y1]
            )
            seen: NDArray[np.bool_] = ~np.any(outside[:, 1:] & outside[:, :-1], axis=0)
            for run in _runs(seen):
                yield curve[run.start : run.stop + 1]

    def outlines(self, cell: int) -> list[Points]:
        """The boundary of a cell, cut to (a little more than) the window: rings of shape (m, 2).

        To be filled by the even–odd rule.  Pieces of a ring may run along the cut.
        """
        record = self.diagram.cells[cell]
        rings = [self._ring(walk) for walk in record.walks]
        if record.outer is None:  # all of the plane around the holes
            rings.append(_box(self._cut))
        return [ring for ring in (clip(ring, self._cut) for ring in rings) if len(ring) > 2]

    def _ring(self, walk: Walk) -> Points:
        """The closed polygon of a walk; through infinity it goes counter-clockwise, far out."""
        pieces: list[Points] = []
        for side, following in zip(walk, (*walk[1:], walk[0]), strict=True):
            curve = self._side(side)
            pieces.append(curve)
            if self._leaves(side):
                pieces.append(self._far_arc(curve[-1], self._side(following)[0]))
        return np.concatenate(pieces)

    def _side(self, side: Side) -> Points:
        if side.is_wall:
            curve = np.array(self.diagram.walls[side.item].ends)
        else:
            curve = self.curves[side.item]
        return curve if side.forward else curve[::-1]

    def _leaves(self, side: Side) -> bool:
        """Whether a step of a walk ends at infinity."""
        if side.is_wall:
            return False
        edge = self.diagram.edges[side.item]
        last = edge.end if side.forward else edge.start
        return last is not None and self.diagram.nodes[last].kind == "infinity"

    @cached_property
    def _beyond(self) -> float:
        return 2 * max(float(np.abs(curve - self.middle).max()) for curve in self.curves)

    def _far_arc(self, start: Points, end: Points) -> Points:
        """Points on a far circle, counter-clockwise from the direction of start to that of end."""
        first, last = (
            math.atan2(point[1] - self.middle[1], point[0] - self.middle[0])
            for point in (start, end)
        )
        turn = (last - first) % (2 * math.pi)
        angles = first + turn * np.linspace(0, 1, 2 + int(turn / 0.3))
        return self.middle + self._beyond * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def clip(ring: Points, box: Window) -> Points:
    """The part of a polygon inside a box (Sutherland and Hodgman, CACM 1974); shape (m, 2).

    Where the true part has several pieces they are joined by lines along the box.
    """
    for axis, bound, sense in ((0, box[0], 1), (1, box[1], 1), (0, box[2], -1), (1, box[3], -1)):
        if not len(ring):
            break
        inside = sense * (ring[:, axis] - bound) >= 0
        if inside.all():
            continue
        following = np.roll(ring, -1, axis=0)
        crosses = inside != np.roll(inside, -1)
        kept: list[Points] = []
        for k, point in enumerate(ring):
            if inside[k]:
                kept.append(point)
            if crosses[k]:
                part = (bound - point[axis]) / (following[k, axis] - point[axis])
                cut = point + part * (following[k] - point)
                cut[axis] = bound
                kept.append(cut)
        ring = np.array(kept).reshape(-1, 2)
    return ring


def roomiest_point(
    rings: Sequence[Points], segments: Points, steps: int = 24
) -> tuple[Points, float]:
    """A point inside the rings (even–odd) far from their boundary and from segments (n, 2, 2).

    The best of a grid of steps × steps points, and its distance from all that; 0 if none of them
    is inside.  O(steps² · (points of the rings + segments beside them)).
    """
    corners = np.concatenate(rings)
    low, high = corners.min(axis=0), corners.max(axis=0)
    offsets = (np.arange(steps) + 0.5) / steps
    grid = low + (high - low) * np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2)
    inside = np.zeros(len(grid), dtype=bool)
    distance = np.full(len(grid), np.inf)
    for a, b in _chords(rings):
        inside ^= _is_left_of(grid, a, b)
        distance = np.minimum(distance, distance_to_chord(grid, a, b))
    beside = (segments.max(axis=1) >= low) & (segments.min(axis=1) <= high)
    for a, b in segments[beside.all(axis=1)]:
        distance = np.minimum(distance, distance_to_chord(grid, a, b))
    distance[~inside] = 0.0
    best = int(distance.argmax())
    return grid[best], float(distance[best])


def _chords(rings: Iterable[Points]) -> Iterator[tuple[Points, Points]]:
    for ring in rings:
        yield from zip(ring, np.roll(ring, -1, axis=0), strict=True)


def _is_left_of(points: Points, a: Points, b: Points) -> NDArray[np.bool_]:
    """Whether a ray to the right from each point crosses the chord ab."""
    spans = (points[:, 1] < a[1]) != (points[:, 1] < b[1])
    slope = (b[0] - a[0]) / (b[1] - a[1]) if b[1] != a[1] else 0.0
    crosses: NDArray[np.bool_] = spans & (points[:, 0] < a[0] + (points[:, 1] - a[1]) * slope)
    return crosses


def distance_to_chord(points: Points, a: Points, b: Points) -> Points:
    """From the points (m, 2) to the chord ab; shape (m,)."""
    along = b - a
    square = float(along @ along)
    part = np.clip((points - a) @ along / square, 0, 1) if square else np.zeros(len(points))
    result: Points = np.hypot(*(points - a - part[:, None] * along).T)
    return result


def _runs(flags: NDArray[np.bool_]) -> Iterator[range]:
    """The maximal ranges of consecutive true flags."""
    changes = np.flatnonzero(np.diff(np.concatenate([[0], flags.view(np.int8), [0]])))
    for start, stop in changes.reshape(-1, 2).tolist():
        yield range(start, stop)


def _box(box: Window) -> Points:
    x0, y0, x1, y1 = box
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
