"""What is known beforehand: the growth a family declares for its number of vertices."""

from __future__ import annotations

from dataclasses import dataclass

from harness.analysis.models import BY_NAME, Model
from harness.analysis.samples import Key

#: Families declare the growth of this count, in these domains, for the smallest visual angle.
DECLARED_COUNT = "vertices"
DECLARED_DOMAIN = {"polygon": "kernel", "segments": "plane"}
DECLARED_OBJECTIVE = "smallest"


@dataclass(frozen=True)
class Declared:
    """The declared model; whether it is derived, or only expected; which parameters differ.

    A family declares one growth; with other parameters (more noise, say) it may not apply, so
    only a group with the default parameters of a family whose growth is derived is a control.
    """

    model: Model
    derived: bool
    changed: tuple[str, ...]

    @property
    def defaults(self) -> bool:
        """Whether the group uses the family's own parameters."""
        return not self.changed

    @property
    def is_control(self) -> bool:
        """Whether the growth is known, so that a verdict against it would be an error."""
        return self.derived and self.defaults


def declared_growth(key: Key) -> Declared | None:
    """The declared growth of a group's number of vertices; None if nobody has declared one."""
    from generators import FAMILIES

    family = FAMILIES.get(key.family)
    if family is None or key.domain != DECLARED_DOMAIN.get(family.kind):
        return None
    if key.objective != DECLARED_OBJECTIVE or family.growth not in BY_NAME:
        return None
    defaults = {parameter.name: parameter.default for parameter in family.parameters}
    changed = tuple(
        sorted(name for name, value in key.parameters.items() if defaults.get(name, value) != value)
    )
    return Declared(BY_NAME[family.growth], family.control, changed)
