"""A task: one diagram to build, known by its content."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, TypeVar

from harness.diagram.counts import Domain, Objective

Scalar = int | float | str
"""What a parameter of a family may be."""

SEED_RULE = (
    "seed = the first 13 hexadecimal digits of the SHA-256 of the canonical JSON of "
    "[base_seed, family, params, n, replicate]; domain, objective and builder do not enter, "
    "so they see the same instance"
)


class Keyed(Protocol):
    """What can be run as a task: all that is asked of it is a name of its own, fit for a file's."""

    @property
    def key(self) -> str:
        """Different for different tasks."""


AnyTask = TypeVar("AnyTask", bound=Keyed)


@dataclass(frozen=True)
class Task:
    """One row to be: an instance (family, n, params, seed) and a diagram of it.

    ``params`` holds every parameter of the family, defaults included, sorted by name: two ways
    of writing the same task are the same task.
    """

    family: str
    n: int
    params: tuple[tuple[str, Scalar], ...]
    replicate: int
    seed: int
    domain: Domain
    objective: Objective
    builder: str

    @cached_property
    def key(self) -> str:
        """16 hexadecimal digits of the SHA-256 of the canonical JSON of the content."""
        content = {
            "family": self.family,
            "n": self.n,
            "params": dict(self.params),
            "replicate": self.replicate,
            "seed": self.seed,
            "domain": self.domain,
            "objective": self.objective,
            "builder": self.builder,
        }
        return hashlib.sha256(canonical(content).encode()).hexdigest()[:16]

    @property
    def params_json(self) -> str:
        """The parameters as canonical JSON, keys sorted."""
        return canonical(dict(self.params))


def canonical(value: Any) -> str:
    """JSON with sorted keys and no spaces: equal values, equal text.

    Raises ValueError for NaN and infinities, which JSON does not have.
    """
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def seed_of(
    base_seed: int, family: str, params: Mapping[str, Scalar], n: int, replicate: int
) -> int:
    """The seed of an instance: 52 bits (exact in a double, so in any reader's JSON).

    A function of what the instance is, never of the order of the run (``SEED_RULE``).
    """
    identity = canonical([base_seed, family, dict(params), n, replicate])
    return int(hashlib.sha256(identity.encode()).hexdigest()[:13], 16)
