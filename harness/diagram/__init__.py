"""Angular Voronoi diagrams: the planar map and the builders that make it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from harness.errors import UserError

if TYPE_CHECKING:
    from harness.diagram.counts import Domain, Objective
    from harness.diagram.planar_map import PlanarMap
    from harness.geometry.coordinates import Point
    from harness.geometry.instance import Instance

BUILDERS = ("reference",)
"""The names of the builders; the first is the default."""


def build(
    instance: Instance,
    domain: Domain | None = None,
    objective: Objective = "smallest",
    builder: str = BUILDERS[0],
) -> PlanarMap:
    """The angular Voronoi diagram of a validated instance.

    ``domain`` defaults to ``kernel`` for a polygon and ``plane`` for segments.

    Raises:
        UserError: an unknown builder; a domain that does not go with the kind of instance; a
            polygon that is not star-shaped, or whose kernel has no interior, in domain ``kernel``.
    """
    from harness.diagram.reference import build_reference

    if builder not in BUILDERS:
        raise UserError(f"unknown builder {builder!r}: choose from {', '.join(BUILDERS)}")
    domain = domain or ("kernel" if instance.kind == "polygon" else "plane")
    return build_reference(instance, domain, objective, domain_corners(instance, domain))


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
