"""The diagram as one object, in the manner of :class:`scipy.spatial.Voronoi`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from harness.diagram import BUILDERS, build
from harness.diagram.counts import Counts, Domain, Objective
from harness.diagram.planar_map import VERTEX_KINDS, Cell, Edge, Node, PlanarMap
from harness.errors import UserError
from harness.geometry.coordinates import Kind
from harness.geometry.instance import Instance
from harness.geometry.validation import validate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: What ``locate`` answers for a point outside the domain, and for one on an edge or node.
OUTSIDE, ON_AN_EDGE = -1, -2


class AngularVoronoi:
    """The angular Voronoi diagram of n line segments, exactly.

    A point belongs to the region of the segment whose visual angle from it is the smallest
    (Asano, Tamaki, Katoh and Tokuyama, "Angular Voronoi Diagram with Applications", ISVD 2006),
    or the largest, on request.

    Parameters:
        segments: array-like of shape (n, 2, 2), segment × end point × (x, y); or of shape (n, 2),
            the vertices of a simple polygon, in either orientation, segment i joining vertices i
            and i + 1; or an :class:`~harness.geometry.instance.Instance`; or anything with a
            ``__geo_interface__``, or such a mapping.  Numbers are taken as the doubles they are,
            :class:`~fractions.Fraction` and strings such as ``"1/3"`` exactly.
        domain: "kernel" or "interior" of the polygon, or "plane"; by default the kernel of a
            polygon and the plane for segments.
        objective: "smallest" or "largest" visual angle.
        builder: one of ``harness.diagram.BUILDERS``.

    Attributes:
        instance: the :class:`~harness.geometry.instance.Instance`.
        segments: (n, 2, 2) doubles; those of a polygon have its interior to their left.
        vertices: (v, 2) doubles, where at least three edges meet: the nodes of the kinds triple,
            crossing and saddle.
        nodes: all m nodes, in the order to which ``Edge.start`` and ``Edge.end`` refer.
        edges: the Voronoi edges; ``edges[k].polyline(tolerance)`` follows one.
        cells: the c Voronoi cells, in the order to which ``locate`` refers.
        cell_segments: (c,) integers, the segment that owns each cell.
        counts: everything that is counted, a :class:`~harness.diagram.counts.Counts`.
        diagram: the planar map behind all of this.

    Raises:
        UserError: the input is not an instance, or is not valid (repeated vertex, zero length,
            crossing segments, not simple, not star-shaped in domain kernel, …); the message is
            one line that names the index and the reason.

    Time is that of the builder; see :mod:`harness.diagram.reference`.

    >>> triangle = AngularVoronoi([(0, 0), (4, 0), (1, 3)])
    >>> triangle.counts.cells, triangle.counts.vertices  # the vertex is Fermat's point
    (3, 1)
    """

    def __init__(
        self,
        segments: Any,
        domain: Domain | None = None,
        objective: Objective = "smallest",
        builder: str = BUILDERS[0],
    ) -> None:
        """Check the input and build the diagram."""
        self.instance = as_instance(segments)
        validate(self.instance)
        self.diagram: PlanarMap = build(self.instance, domain, objective, builder)
        self.domain: Domain = self.diagram.domain
        self.objective: Objective = self.diagram.objective
        self.segments: NDArray[np.float64] = self.instance.segments
        self.nodes: Sequence[Node] = self.diagram.nodes
        self.edges: Sequence[Edge] = self.diagram.edges
        self.cells: Sequence[Cell] = self.diagram.cells
        self.counts: Counts = self.diagram.counts
        self.vertices: NDArray[np.float64] = np.array(
            [node.point for node in self.nodes if node.kind in VERTEX_KINDS]
        ).reshape(-1, 2)
        self.cell_segments: NDArray[np.int64] = np.array([cell.segment for cell in self.cells])

    def locate(self, points: Iterable[Sequence[float | Fraction]]) -> NDArray[np.int64]:
        """The cell of each of m points, exactly: (m,) indices into ``cells``.

        ``points``: array-like of shape (m, 2).  −1 stands for a point outside the domain, −2 for
        one on an edge or at a node.  Raises ValueError for another shape or coordinates that are
        not finite.
        """
        rows = [tuple(map(_rational, point)) for point in points]
        if any(len(row) != 2 for row in rows):
            raise ValueError("points must have shape (m, 2)")
        found = self.diagram.locate(rows)
        return np.array([ON_AN_EDGE if cell is None else cell for cell in found], dtype=np.int64)

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw the diagram into ``ax`` (by default new axes of pyplot's); return the axes.

        ``options`` are those of :func:`harness.report.drawing.plot`: window, nodes, labels.
        """
        from harness.report.drawing import plot

        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.figure().add_subplot()
        plot(self.diagram, ax, **options)
        return ax

    def _repr_svg_(self) -> str:
        """The picture that a notebook shows."""
        from harness.report.drawing import render

        return render(self.diagram, "svg").decode()

    def __repr__(self) -> str:
        """What it is of, and the headline counts."""
        counts = self.counts
        return (
            f"<AngularVoronoi of {counts.n} segments, {self.domain}, {self.objective}: "
            f"{counts.cells} cells, {counts.edges} edges, {counts.vertices} vertices>"
        )


def as_instance(segments: Any) -> Instance:
    """The instance that the argument of :class:`AngularVoronoi` describes; raises UserError."""
    if isinstance(segments, Instance):
        return segments
    if isinstance(segments, Mapping) or hasattr(segments, "__geo_interface__"):
        return Instance.from_geo_interface(segments)
    if isinstance(segments, str) or not isinstance(segments, Iterable):
        raise UserError("segments must be an array of shape (n, 2, 2) or (n, 2), or an instance")
    values = segments.tolist() if isinstance(segments, np.ndarray) else list(segments)
    return Instance.from_arrays(_kind(values), values)


def _rational(value: Any) -> Fraction:
    """The exact value of a coordinate; numpy's numbers are taken as the Python numbers they are."""
    plain = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, float) and not math.isfinite(plain):
        raise ValueError(f"coordinates must be finite, not {plain}")
    return Fraction(plain)


def _kind(values: Sequence[Any]) -> Kind:
    """Vertices of a polygon, or segments: told apart by the depth of the first row."""
    try:
        leaf = values[0][0]
    except (IndexError, TypeError, KeyError):
        return "segments"  # whose reader says what is wrong
    return "polygon" if isinstance(leaf, str) or not isinstance(leaf, Iterable) else "segments"
