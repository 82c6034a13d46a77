"""Diagrams for the claims: one way to build them, and both builders compared."""

from __future__ import annotations

from collections import Counter

from harness.diagram import BUILDERS, build
from harness.diagram.counts import Counts, Domain
from harness.diagram.planar_map import PlanarMap
from harness.geometry.instance import Instance

MOST_FOR_REFERENCE = {"kernel": 16, "interior": 10, "plane": 10}
"""Segments up to which the reference builder takes seconds."""


def diagram(instance: Instance, domain: Domain) -> PlanarMap:
    """The diagram of the smallest angle, by the default builder, on one processor."""
    return build(instance, domain, "smallest", workers=1)


def certificates(instance: Instance, domain: Domain) -> dict[str, Counts]:
    """The counts of an instance by every builder that can be asked, checked against each other.

    So are the numbers of cells of each segment, and each map passes the checks that every diagram
    must satisfy.  Instances too large for the reference builder have the other's counts only.

    Raises:
        ArithmeticError: the builders disagree, or one does not vouch for its counts.
    """
    found, contents = {}, set()
    for builder in BUILDERS:
        if builder == "reference" and instance.n > MOST_FOR_REFERENCE[domain]:
            continue
        made = build(instance, domain, "smallest", builder, workers=1)
        made.sanity_check()
        if not made.certified:
            raise ArithmeticError(f"the {builder} builder does not vouch for {instance.label}")
        found[builder] = made.counts
        contents.add(_content(made))
    if len(contents) > 1:
        raise ArithmeticError(f"the builders disagree about {instance.label}")
    return found


def _content(made: PlanarMap) -> str:
    """Everything that is counted, without the builder's name."""
    record = {**made.counts.as_dict(), "builder": ""}
    owners = Counter(cell.segment for cell in made.cells)
    return repr((sorted(record.items()), sorted(owners.items())))
