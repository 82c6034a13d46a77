"""Where the nodes of a fast diagram are: certified boxes of any precision, and doubles."""

from __future__ import annotations

from harness.diagram.fast.chart import Chart
from harness.diagram.fast.counting import FastDiagram
from harness.diagram.fast.enclosures import ExactPoint, PortPlace, TiePlace
from harness.diagram.fast.leaves import CROSSING
from harness.diagram.fast.node_points import crossing, local_node, node_point, single_port
from harness.diagram.planar_map import Place


def place_of(diagram: FastDiagram, node: int) -> Place | None:
    """The place of a node; None at infinity.

    A special corner is exact; so is a crossing.  A vertex at which three or four segments tie is
    enclosed by Krawczyk's test, a port on the boundary by isolated roots.
    """
    arrays, vertices = diagram.arrays, len(diagram.arrays.vertices)
    if node < vertices:
        special = arrays.special.get(node)
        if special is not None:
            return special.place
        leaf = int(arrays.vertices[node, 0])
        if diagram.leaves.kinds[leaf] == CROSSING:
            return ExactPoint(crossing(diagram, leaf))
        return TiePlace(Chart(diagram, leaf), node)
    if node < vertices + len(diagram.nodes.corners):
        corner = diagram.nodes.corners[node - vertices].corner
        return ExactPoint(diagram.roots.corners.exact[corner])
    if diagram.domain == "plane":
        return None
    port = single_port(diagram, node)
    local = local_node(diagram, port)
    return PortPlace(diagram, port) if local is None else local.place


__all__ = ["ExactPoint", "PortPlace", "TiePlace", "node_point", "place_of"]
