"""Angular Voronoi diagrams: the planar map and the builders that make it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from harness.errors import UserError

if TYPE_CHECKING:
    from harness.diagram.counts import Domain, Objective
    from harness.diagram.planar_map import PlanarMap
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
    from harness.geometry.kernel import kernel

    if builder not in BUILDERS:
        raise UserError(f"unknown builder {builder!r}: choose from {', '.join(BUILDERS)}")
    domain = domain or ("kernel" if instance.kind == "polygon" else "plane")
    if domain != "plane" and instance.kind != "polygon":
        raise UserError(f"domain {domain!r} needs a polygon, not segments")
    if domain == "plane":
        corners = []
    elif domain == "kernel":
        corners = kernel(instance).corners
    else:
        corners = [a for a, _ in instance.rational_segments()]
    return build_reference(instance, domain, objective, corners)
