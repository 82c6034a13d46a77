"""The reference builder: exact, from all triples of segments; short and slow.

1. Write every bisector F^±_ij as an integer polynomial and split it into irreducible components.
2. Find all events on every component exactly (:mod:`harness.diagram.bisectors`).
3. Cut the components at their events into u-monotone arcs; keep those on which the winners of the
   two sides differ (:mod:`harness.diagram.arcs`).
4. Sweep over these arcs to find the faces; read off the map
   (:mod:`harness.diagram.sweep`, :mod:`harness.diagram.assemble`).

Nothing is subdivided and nothing is rounded.  If the coordinates turn out not to be generic (two
events on one vertical line) everything is thrown away and done again with another shear.

Time is O(n³) resultants of cubics and as many tests against all n segments; in practice n = 10 in
the plane and n = 18 in a kernel take seconds.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from harness.diagram.algebra import NotGeneric
from harness.diagram.arcs import bisector_arcs, wall_arcs
from harness.diagram.assemble import Assembly
from harness.diagram.bisectors import Register, components, find_events
from harness.diagram.cotangents import check_common_endpoints
from harness.diagram.counts import Domain, Objective
from harness.diagram.domain import Region
from harness.diagram.locate import Locator, unsheared
from harness.diagram.planar_map import PlanarMap, RationalPoint
from harness.diagram.scene import Scene, coordinate_bits
from harness.diagram.sweep import sweep
from harness.errors import UserError
from harness.geometry.instance import Instance

LONGEST = 400
"""Coordinates may span this many powers of two; beyond, separating roots would take minutes."""

SHEARS = (1_009, 10_007, 299_993, 15_485_863, 1_000_000_007)


def build_reference(
    instance: Instance, domain: Domain, objective: Objective, corners: Sequence[RationalPoint]
) -> PlanarMap:
    """The exact diagram of ``instance`` inside the polygon ``corners`` (none: the plane).

    ``corners``: counter-clockwise.

    Raises:
        UserError: coordinates that differ too much in size.
    """
    span = coordinate_bits([p for s in instance.rational_segments() for p in s])
    if span > LONGEST:
        raise UserError(
            f"{instance.label}: the coordinates span {span} powers of two from the finest digit to "
            f"the largest value; the reference builder takes {LONGEST}"
        )
    for shear in SHEARS:
        try:
            return _build(instance, domain, objective, corners, shear)
        except NotGeneric:
            continue
    raise ArithmeticError("no shear brought the instance into generic position")


def _build(
    instance: Instance,
    domain: Domain,
    objective: Objective,
    corners: Sequence[RationalPoint],
    shear: int,
) -> PlanarMap:
    scene = Scene(instance.rational_segments(), objective, shear, others=corners)
    check_common_endpoints(scene)
    region = Region(scene, corners)
    # Inside a kernel every L is positive, so only F^+ is ever a bisector there.
    curves = components(scene, signs=(1,) if domain == "kernel" else (1, -1))
    register = Register()
    find_events(scene, region, curves, register)
    arcs = [arc for curve in curves for arc in bisector_arcs(scene, region, curve)]
    ends = {p.number.key: p for arc in arcs for p in (arc.start, arc.end) if p is not None}
    ends |= {p.number.key: register.canonical(p) for p in region.corners}
    endpoints = frozenset(
        scene.sheared(point).coordinates for segment in scene.segments for point in segment
    )
    swept = sweep([*arcs, *wall_arcs(region, list(ends.values()))], endpoints)
    parts = Assembly(scene, region, swept)
    return PlanarMap(
        instance=instance,
        domain=domain,
        objective=objective,
        builder="reference",
        certified=True,
        nodes=tuple(parts.nodes),
        edges=tuple(parts.edges),
        cells=tuple(parts.cells),
        walls=tuple(parts.walls),
        corners=None
        if region.is_plane
        else np.array([[float(c) for c in corner] for corner in corners]),
        witnesses=tuple(
            (unsheared(scene, u, v), parts.cell_of.get(face, -1)) for u, v, face in swept.samples
        ),
        locator=Locator(scene, swept, parts.cell_of),
    )
