"""Identities that the counts of every diagram satisfy, checked on the record alone.

They need no map, so they can be asked of a stored record, and of diagrams whose objects are too
many to be made.  The bookkeeping is that of :func:`harness.diagram.checks.euler_holds`.
"""

from __future__ import annotations

from dataclasses import dataclass

from harness.diagram.counts import Counts


@dataclass(frozen=True)
class Broken:
    """An identity that fails: a key of the record, what it states, what the other keys imply."""

    key: str
    stated: int
    implied: str


def broken_identity(counts: Counts) -> Broken | None:
    """The first identity that a record breaks; None if all hold.  O(number of degrees).

    * vertices = triple + crossing + saddle = Σ over the histogram of degrees;
    * Euler: cells = E − N + components in a bounded domain (N: nodes but those on the boundary),
      E − N + 1 + components in the plane (N: nodes but infinite ends, and one point at infinity if
      there are any), loops aside in E;
    * every edge but a loop has two ends: 2E = Σ degree · number, over vertices, endpoint nodes (of
      degree 1 or 2), boundary nodes and infinite ends;
    * at most n segments own a cell, and every region has one; no more unbounded cells than cells.
    """
    nodes, plain = counts.nodes, counts.edges - counts.loops
    vertices = sum(nodes.get(kind, 0) for kind in ("triple", "crossing", "saddle"))
    if counts.vertices != vertices:
        return Broken("vertices", counts.vertices, f"{vertices} (triple + crossing + saddle)")
    of_degrees = sum(counts.degrees.values())
    if counts.vertices != of_degrees:
        return Broken("vertices", counts.vertices, f"{of_degrees} (sum over degrees)")
    endpoints, infinite = nodes.get("endpoint", 0), nodes.get("infinity", 0)
    euler = plain - vertices - endpoints + counts.components
    if counts.domain == "plane":
        euler += 1 - (infinite > 0)
    if counts.cells != euler:
        return Broken("cells", counts.cells, f"{euler} (Euler)")
    ends = sum(degree * number for degree, number in counts.degrees.items())
    ends += nodes.get("boundary", 0) + infinite
    if not endpoints <= 2 * plain - ends <= 2 * endpoints:
        low, high = (ends + endpoints + 1) // 2, ends // 2 + endpoints
        implied = f"{low}" if low == high else f"{low} to {high}"
        return Broken("edges", counts.edges, f"{implied} and the loops (ends of edges)")
    if not min(1, counts.cells) <= counts.regions <= min(counts.n, counts.cells):
        return Broken("regions", counts.regions, f"1 to {min(counts.n, counts.cells)}")
    if counts.unbounded > counts.cells:
        return Broken("unbounded", counts.unbounded, f"at most {counts.cells}")
    return None
