"""The one way to a peak: instance, method and objective in, point and proof out."""

from __future__ import annotations

from typing import Any

from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.peak.result import METHODS, OBJECTIVES, Objective, Peak


def peak(
    polygon: Any,
    method: str | None = None,
    objective: Objective = "max-min",
    *,
    exact: bool = False,
    seed: int = 0,
    builder: str | None = None,
) -> Peak:
    """The point of best visual angle in the kernel of a star-shaped polygon.

    ``polygon``: a validated :class:`~harness.geometry.instance.Instance`, or vertices (n, 2) as
    numbers, Fractions or strings with rationals, which are validated here.  ``objective``:
    ``max-min``, the greatest least visual angle (the paper, section 3), or ``min-max``, the least
    greatest one (end of section 2).  ``method``:

    * ``lp`` (default for max-min): randomised quasiconvex programming, expected O(n);
    * ``diagram`` (the only one for min-max): all edges and vertices of the angular Voronoi diagram,
      made by ``builder`` (by default the one that suits n);
    * ``parametric``: Megiddo's search over the parallel intersection of n discs (Theorem 7).

    ``exact`` asks for the algebraic number and all ties (max-min).  ``seed``: of random samples and
    orders; it changes nothing but the work.

    Raises:
        UserError: no polygon; a kernel without interior (naming edges); an unknown method or
            objective; what the method cannot do; vertices that make no simple polygon.
    """
    if objective not in OBJECTIVES:
        raise UserError(f"unknown objective {objective!r}: choose from {', '.join(OBJECTIVES)}")
    if method is not None and method not in METHODS:
        raise UserError(f"unknown method {method!r}: choose from {', '.join(METHODS)}")
    instance = polygon if isinstance(polygon, Instance) else _validated(polygon)
    if seed < 0:
        raise UserError(f"the seed must not be negative, and is {seed}")
    if objective == "min-max":
        if method not in (None, "diagram"):
            raise UserError(f"the objective min-max has the method diagram only, not {method}")
        if exact:
            raise UserError("the objective min-max has no exact decision")
    from harness.peak.polygon import Polygon

    found = _found(Polygon(instance), method or "lp", objective, seed, builder)
    if exact:
        from harness.peak.decision import decided

        return decided(Polygon(instance), found)
    return found


def _found(polygon: Any, method: str, objective: Objective, seed: int, builder: str | None) -> Peak:
    """The peak by one method; those that look at points in doubles do it near the origin."""
    if method == "lp" and objective == "max-min":
        from harness.peak.lp import lp_peak

        return lp_peak(polygon, seed)
    from harness.peak.shifting import near_origin, shifted

    moved, shift = near_origin(polygon)
    if objective == "min-max":
        from harness.peak.min_max import min_max_peak

        found = min_max_peak(moved, builder)
    elif method == "diagram":
        from harness.peak.diagram import diagram_peak

        found = diagram_peak(moved, builder)
    else:
        from harness.peak.parametric import parametric_peak

        found = parametric_peak(moved)
    return shifted(found, shift)


def _validated(vertices: Any) -> Instance:
    """A valid instance of vertices."""
    from harness.geometry.validation import validate

    instance = Instance.from_arrays("polygon", vertices)
    validate(instance)
    return instance
