"""What can be chosen, by name; nothing heavy is imported here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral, Real

from harness.errors import UserError, shown, suggestion

OBJECTIVES = ("all", "apex", "laplacian", "smart-laplacian", "combined")
"""``all``: raise the smallest of all angles.  ``apex``: the paper's greedy, which looks at the
angles at the moved vertex.  The others are for comparison: every vertex into the mean of its
neighbours; the same only where the star gets no worse; and smart Laplacian sweeps followed by
ascent where angles are small (Freitag and Ollivier-Gooch, 1997).  ``laplacian`` may invert
triangles and make the mesh worse, ``apex`` may lessen angles that it does not look at."""
TOPOLOGIES = ("fixed", "flip", "full")
"""What may change besides coordinates: nothing; edges; edges and the number of vertices."""
REMEDIES = ("none", "bisector", "chord", "both")
"""Against small angles at the rim of a star after a move of ``apex`` (paper, Figure 6); a chord
changes the connectivity."""
SWEEPS, MOST_SWEEPS = 20, 10**6


@dataclass(frozen=True)
class Options:
    """What to do with a mesh; ``sweeps``: at most that many times n visits of vertices."""

    objective: str = OBJECTIVES[0]
    topology: str = TOPOLOGIES[0]
    remedy: str = REMEDIES[0]
    sweeps: int = SWEEPS

    def __post_init__(self) -> None:
        """Raise UserError if a name is unknown or two do not go together."""
        known = {"objective": OBJECTIVES, "topology": TOPOLOGIES, "remedy": REMEDIES}
        for key, names in known.items():
            value = getattr(self, key)
            if value not in names:
                hint = suggestion(str(value), names) or f"it is one of {', '.join(names)}"
                raise UserError(f"{key} {value!r} is unknown; {hint}")
        _check_whole("sweeps", self.sweeps, 0, MOST_SWEEPS)
        if self.topology != "fixed" and self.objective != "all":
            raise UserError(f"topology {self.topology} needs the objective 'all'")
        if self.remedy != "none" and self.objective != "apex":
            raise UserError(f"remedy {self.remedy} needs the objective 'apex'")

    @property
    def reconnects(self) -> bool:
        """Whether edges may change."""
        return self.topology != "fixed" or self.remedy in ("chord", "both")


def check_limits(workers: object, time_limit: object) -> None:
    """Raise UserError unless these are a number of threads and one of seconds, or None."""
    if workers is not None:
        _check_whole("workers", workers, 1)
    if time_limit is None:
        return
    if not isinstance(time_limit, Real) or math.isnan(time_limit) or time_limit < 0:
        raise UserError(f"time_limit {shown(time_limit)} must be a number of seconds, at least 0")


def _check_whole(name: str, value: object, least: int, most: float = math.inf) -> None:
    if not isinstance(value, Integral) or not least <= int(value) <= most:
        limit = f" and at most {most}" if most < math.inf else ""
        raise UserError(f"{name} {shown(value)} must be a whole number, at least {least}{limit}")
