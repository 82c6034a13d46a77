"""Doubles inside leaves, in bulk, at which a given segment certainly wins."""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.arrays import Numbers
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.forms import U
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.prepare import Floats, Ints

#: Leaves of each cell that are tried, the largest first.
_TRIED = 3
#: Points of a leaf that are tried: all of a lattice with so many steps on each side.
_STEPS = 14


@compiled
def clear_points(triangles, owner, other_first, others, segments, sense, weights, points, good):
    """For every triangle a point in it at which ``owner`` beats all ``others``, if one is found.

    ``triangles`` (t, 3, 2): corners within 16u times their size.  ``owner`` (t,), ``others``: CSR.
    ``segments`` (n, 2, 2): exact doubles.  ``weights`` (k, 3): the points to try, of which the
    clearest is taken.  Results: ``points`` (t, 2), ``good`` (t,).

    Q and L are off by 5u of the sums S of their products, hence Q_i|L_j| − Q_j|L_i| by less than
    16u (SQ_i SL_j + SQ_j SL_i).
    """
    forms = np.empty(4)
    for t in range(len(triangles)):
        corners = triangles[t]
        size = np.abs(corners).max()
        best = 0.0
        for r in range(len(weights)):
            x = y = 0.0
            for k in range(3):
                x += weights[r, k] * corners[k, 0]
                y += weights[r, k] * corners[k, 1]
            _forms(segments[owner[t]], x, y, forms)
            q, line, q_size, line_size = forms[0], forms[1], forms[2], forms[3]
            least = np.inf
            for z in range(other_first[t], other_first[t + 1]):
                _forms(segments[others[z]], x, y, forms)
                gain = sense * (q * forms[1] - forms[0] * line)
                bound = 16.0 * U * (q_size * forms[3] + forms[2] * line_size)
                least = min(least, gain / bound if bound > 1e-280 else 0.0)
            if least > best and _is_inside(corners, x, y, 16.0 * U * size):
                best = least
                points[t, 0], points[t, 1] = x, y
        good[t] = best > 1.01


@compiled
def _forms(segment, x, y, out):
    """Q and |L| at a point, and the sums of the absolute products in them."""
    ax, ay = segment[0, 0] - x, segment[0, 1] - y
    bx, by = segment[1, 0] - x, segment[1, 1] - y
    out[0] = ax * bx + ay * by
    out[1] = abs(ax * by - ay * bx)
    out[2] = abs(ax * bx) + abs(ay * by)
    out[3] = abs(ax * by) + abs(ay * bx)


@compiled
def _is_inside(corners, x, y, slack):
    """Whether a point is certainly inside a counter-clockwise triangle with blurred corners."""
    for k in range(3):
        dx, dy = corners[(k + 1) % 3, 0] - corners[k, 0], corners[(k + 1) % 3, 1] - corners[k, 1]
        ex, ey = x - corners[k, 0], y - corners[k, 1]
        reach = abs(dx) + abs(dy) + abs(ex) + abs(ey)
        if not dx * ey - dy * ex > 8.0 * slack * reach + 16.0 * U * reach * reach:
            return False
    return True


def points_in_leaves(
    diagram: FastDiagram, cells: Ints
) -> tuple[list[int], list[float], list[float]]:
    """Cells (of some given ones) and the coordinates of a point in each, where one was found.

    In a leaf of which only one cell of a segment has a piece, that segment wins in no other.
    """
    if diagram.instance.exact is not None or not len(cells):
        return [], [], []
    slots, leaf = _usable_slots(diagram, cells)
    triangles = _triangles(diagram, leaf)
    owner, cell = diagram.arrays.owner[slots], diagram.cell_of_slot[slots]
    d, e = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    order = np.lexsort((-np.abs(d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]), cell))
    rank = np.arange(len(order)) - np.searchsorted(cell[order], cell[order])
    weights = np.array(
        [(k, m, _STEPS - k - m) for k in range(1, _STEPS) for m in range(1, _STEPS - k)]
    )
    found = np.full((diagram.cells, 2), np.nan)
    sense = 1.0 if diagram.objective == "smallest" else -1.0
    for turn in range(_TRIED):
        rows = order[rank == turn]
        rows = rows[np.isnan(found[cell[rows], 0])]
        first, others = _other_owners(diagram, leaf[rows], owner[rows])
        points, good = np.empty((len(rows), 2)), np.zeros(len(rows), dtype=bool)
        clear_points(
            triangles[rows],
            owner[rows],
            first,
            others,
            diagram.instance.segments,
            sense,
            weights / _STEPS,
            points,
            good,
        )
        found[cell[rows[good]]] = points[good]
    there = np.flatnonzero(~np.isnan(found[:, 0]))
    return there.tolist(), found[there, 0].tolist(), found[there, 1].tolist()


def _usable_slots(diagram: FastDiagram, cells: Ints) -> tuple[Ints, Ints]:
    """The slots of some cells, with their leaves, that are their segment's only cell in the leaf.

    The leaves were not solved by algebra and are finite.
    """
    leaves, arrays = diagram.leaves, diagram.arrays
    usual = int(leaves.first_slot[-1])
    leaf_of_slot = np.repeat(np.arange(len(leaves.kinds)), np.diff(leaves.first_slot))
    wanted = np.zeros(diagram.cells, dtype=bool)
    wanted[cells] = True
    used = np.flatnonzero(arrays.owner[:usual] >= 0)
    cell = diagram.cell_of_slot[used]
    key = leaf_of_slot[used] * diagram.instance.n + arrays.owner[used]
    pairs = np.unique(np.column_stack([key, cell]), axis=0)
    several = np.unique(pairs[1:, 0][pairs[1:, 0] == pairs[:-1, 0]])
    mine = used[wanted[cell] & ~np.isin(key, several) & (arrays.ports[leaf_of_slot[used]] > 0)]
    leaf = leaf_of_slot[mine]
    root = leaves.shape_roots[diagram.rows_of_leaves[leaf]]
    weights = np.array(diagram.roots.corners.weights)
    finite = weights[diagram.roots.triangles[root]].all(axis=1)
    return mine[finite], leaf[finite]


def _triangles(diagram: FastDiagram, leaf: Ints) -> Floats:
    """The corners of leaves, as doubles, (k, 3, 2)."""
    rows = diagram.rows_of_leaves[leaf]
    shapes = diagram.leaves.shapes[rows].reshape(-1, 3, 3)
    corners = diagram.roots.triangles[diagram.leaves.shape_roots[rows]]
    triangles: Floats = np.einsum("tkc,tcd->tkd", shapes, diagram.corner_points[corners])
    return triangles


def _other_owners(diagram: FastDiagram, leaf: Ints, owner: Ints) -> tuple[Ints, Numbers]:
    """The owners of the pieces of leaves but one of each, in CSR form."""
    arrays = diagram.arrays
    most = int(arrays.ports[leaf].max(initial=0))
    places = np.arange(most)
    there = places < arrays.ports[leaf][:, None]
    owners = arrays.owner[np.where(there, arrays.start[leaf][:, None] + places, 0)]
    there &= owners != owner[:, None]
    first = np.concatenate([[0], np.cumsum(there.sum(axis=1))])
    return first, owners[there]
