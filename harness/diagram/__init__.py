"""Angular Voronoi diagrams: the planar map and the builders that make it."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from harness.diagram.counts import default_domain
from harness.errors import UserError

if TYPE_CHECKING:
    from harness.diagram.counts import Domain, Objective
    from harness.diagram.planar_map import PlanarMap
    from harness.geometry.coordinates import Point
    from harness.geometry.instance import Instance

_log = logging.getLogger(__name__)

BUILDERS = ("fast", "reference")
"""The names of the builders; the first is the default."""

MOST_HANDED_OVER = 32
"""An instance with at most so many segments goes to the reference builder if the fast one fails."""


def build(
    instance: Instance,
    domain: Domain | None = None,
    objective: Objective = "smallest",
    builder: str = BUILDERS[0],
    workers: int | None = None,
    subdivision: int = 0,
) -> PlanarMap:
    """The angular Voronoi diagram of a validated instance.

    ``domain`` defaults to ``kernel`` for a polygon and ``plane`` for segments.  ``workers``:
    threads of the fast builder, by default one per processor; the map does not depend on it.
    ``subdivision``: another number (0, 1, 2, …) makes the fast builder cut the domain into other
    triangles, so that a count can be made again in another way; the diagram is the same.

    Raises:
        UserError: an unknown builder; an instance so degenerate that the fast builder cannot
            certify it, and too large for the reference builder; a domain that does not go with
            the kind of instance; a polygon that is not star-shaped, or whose kernel has no
            interior, in domain ``kernel``.
    """
    if builder not in BUILDERS:
        raise UserError(f"unknown builder {builder!r}: choose from {', '.join(BUILDERS)}")
    domain = domain or default_domain(instance.kind)
    corners = domain_corners(instance, domain)
    if builder == "fast":
        return _fast_or_reference(instance, domain, objective, corners, workers, subdivision)
    from harness.diagram.reference import build_reference

    return build_reference(instance, domain, objective, corners)


def _fast_or_reference(
    instance: Instance,
    domain: Domain,
    objective: Objective,
    corners: list[Point],
    workers: int | None,
    subdivision: int,
) -> PlanarMap:
    """The fast builder's map; of a small instance that it cannot certify, the reference's.

    Both are exact, so the name of the builder only says who was asked.
    """
    from dataclasses import replace

    from harness.diagram.fast.map import build_fast
    from harness.diagram.fast.prepare import has_plain_size
    from harness.diagram.fast.subdivide import subdivide
    from harness.diagram.work import Contradiction, Work
    from harness.geometry.jit import is_compiled

    if not is_compiled(subdivide):
        _log.warning("compiling the fast builder, once; this takes about a minute")
    try:
        if not has_plain_size(instance):
            raise Contradiction("coordinates beyond the middle of the range of doubles")
        return build_fast(instance, domain, objective, corners, workers, subdivision)
    except Contradiction as problem:
        if instance.n > MOST_HANDED_OVER:
            raise UserError(
                f"{instance.label}: the fast builder cannot certify this instance ({problem}), and "
                f"{instance.n} segments are too many for the reference builder"
            ) from problem
    from harness.diagram.reference import build_reference

    exact = build_reference(instance, domain, objective, corners)
    return replace(exact, builder="fast", work=Work(0, 0, 1, 0, 0, 1, 1))


def domain_corners(instance: Instance, domain: Domain) -> list[Point]:
    """The counter-clockwise exact corners of a domain; none for the plane.

    Raises:
        UserError: as :func:`build`.
    """
    from harness.geometry.kernel import kernel, why_not_star_shaped

    if domain == "plane":
        return []
    if instance.kind != "polygon":
        raise UserError(f"{instance.label}: domain {domain} needs a polygon, not segments")
    if domain == "interior":
        vertices = [instance.exact_vertex(k) for k in range(instance.n)]
        return vertices if instance.orientation > 0 else vertices[::-1]
    found = kernel(instance)
    reason = why_not_star_shaped(instance, found)
    if reason is not None:
        raise UserError(reason)
    return found.corners
