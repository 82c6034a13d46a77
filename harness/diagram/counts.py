"""The frozen record of what a diagram contains."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

Domain = Literal["kernel", "interior", "plane"]
Objective = Literal["smallest", "largest"]
NodeKind = Literal["triple", "crossing", "saddle", "endpoint", "boundary", "infinity"]

DOMAINS: tuple[Domain, ...] = ("kernel", "interior", "plane")
OBJECTIVES: tuple[Objective, ...] = ("smallest", "largest")
NODE_KINDS: tuple[NodeKind, ...] = (
    "triple",
    "crossing",
    "saddle",
    "endpoint",
    "boundary",
    "infinity",
)


def default_domain(kind: str) -> Domain:
    """Where a diagram is built if nobody says: the kernel of a polygon, the plane for segments."""
    return "kernel" if kind == "polygon" else "plane"


@dataclass(frozen=True)
class Counts:
    """How many objects of each kind an angular Voronoi diagram has.

    ``vertices`` = triple + crossing + saddle: the points where at least three Voronoi edges
    meet.  ``nodes`` counts points, except for the kinds ``boundary`` and ``infinity``, of which
    it counts edge ends (two edges may end at one boundary point; ``boundary_points`` counts
    those).  So Σ degree · count over the vertices, plus the degrees of endpoint nodes, plus
    boundary, plus infinity is twice the number of edges that are no loops.
    ``degrees`` maps the degree of a vertex to the number of vertices that have it.
    ``components`` are the connected components of
    edges ∪ nodes ∪ boundary of the domain; a loop (closed edge without a node) is one of its own.
    ``certified`` says that every combinatorial decision behind the record was exact.
    """

    domain: Domain
    objective: Objective
    builder: str
    n: int
    cells: int
    edges: int
    vertices: int
    regions: int
    loops: int
    components: int
    unbounded: int
    boundary_points: int
    nodes: Mapping[NodeKind, int]
    degrees: Mapping[int, int]
    certified: bool

    def as_dict(self) -> dict[str, Any]:
        """The record as plain JSON values, keys in the order documented in the README."""
        return {
            "domain": self.domain,
            "objective": self.objective,
            "builder": self.builder,
            "n": self.n,
            "cells": self.cells,
            "edges": self.edges,
            "vertices": self.vertices,
            "regions": self.regions,
            "loops": self.loops,
            "components": self.components,
            "unbounded": self.unbounded,
            "boundary_points": self.boundary_points,
            "nodes": {kind: self.nodes.get(kind, 0) for kind in NODE_KINDS},
            "degrees": {str(degree): self.degrees[degree] for degree in sorted(self.degrees)},
            "certified": self.certified,
        }
