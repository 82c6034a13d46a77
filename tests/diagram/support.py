"""What the diagram tests share: instances from plain coordinates, the corpus, other countings."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

from harness.diagram.planar_map import PlanarMap
from harness.geometry.formats import parse_instance
from harness.geometry.instance import Instance
from harness.geometry.validation import validate

CORPUS = Path(__file__).parent.parent / "corpus"
SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


def polygon(*vertices: Any) -> Instance:
    return _valid(Instance.from_arrays("polygon", vertices))


def segments(*values: Any) -> Instance:
    return _valid(Instance.from_arrays("segments", values))


def instance_of(plain: tuple[str, Any]) -> Instance:
    """The instance of a pair made by :mod:`tests.strategies`."""
    kind, coordinates = plain
    return _valid(Instance.from_arrays(kind, coordinates))  # type: ignore[arg-type]  # "polygon" or "segments"


def _valid(instance: Instance) -> Instance:
    validate(instance)
    return instance


def corpus() -> dict[str, dict[str, Any]]:
    """Every case of the corpus by name: instance, domain, objective and what is known of it."""
    paths = sorted(CORPUS.glob("*.json"))
    return {path.stem: json.loads(path.read_text("utf-8")) for path in paths}


def corpus_instance(case: dict[str, Any]) -> Instance:
    return _valid(parse_instance(json.dumps(case["instance"])))


def edges_through_endpoints(diagram: PlanarMap) -> int:
    """How many edges there are if a segment endpoint of degree 2 is no node but a point of an edge.

    Joining at a node of degree 2 removes one edge, unless it closes a loop: so count the cycles
    that consist of such nodes only.
    """
    bends = {k for k, node in enumerate(diagram.nodes) if node.kind == "endpoint"}
    parent = {k: k for k in bends}

    def root(k: int) -> int:
        while parent[k] != k:
            k = parent[k]
        return k

    cycles = 0
    for edge in diagram.edges:
        if edge.start in bends and edge.end in bends:
            a, b = root(edge.start), root(edge.end)
            cycles += a == b
            parent[a] = b
    return len(diagram.edges) - len(bends) + cycles


def summary(diagram: PlanarMap) -> dict[str, Any]:
    """The counts in the corpus's terms."""
    counts = diagram.counts
    owners = Counter(cell.segment for cell in diagram.cells)
    return {
        "cells": counts.cells,
        "edges": counts.edges,
        "edges_merged_at_endpoints": edges_through_endpoints(diagram),
        "vertices": counts.vertices,
        "degree_3": counts.degrees.get(3, 0),
        "degree_4": counts.degrees.get(4, 0),
        "degree_5_up": sum(c for degree, c in counts.degrees.items() if degree > 4),
        "boundary_ends": counts.nodes["boundary"],
        "infinite_ends": counts.nodes.get("infinity", 0),
        "cells_per_segment": [owners[k] for k in range(counts.n)],
    }
