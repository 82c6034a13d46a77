"""What a benchmark is: its instances, what each is to reach, and what is measured of each."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import generators
from harness.diagram.counts import Domain, Objective
from harness.errors import UserError, suggestion
from harness.study.limits import Limits
from harness.study.task import Scalar, Task

if TYPE_CHECKING:
    from harness.diagram.counts import Counts


@dataclass(frozen=True)
class Measured:
    """What one process found out about one instance.

    ``timings``: seconds of each repeat, in order.  ``amount``: how many units (see
    ``Benchmark.unit``) one repeat produced.  ``peak_mib``: the greatest resident memory of the
    process until the last repeat was over, in MiB.  ``warm_up``: seconds spent before the first
    repeat on compiling, or on loading what was compiled before.  ``facts``: the benchmark's own
    columns, None where the builder does not tell.  ``counts``: None if no diagram is counted; then
    ``proven`` says whether the result is certified.
    """

    timings: tuple[float, ...]
    amount: int
    counts: Counts | None
    workers: int
    peak_mib: float
    warm_up: float
    facts: Mapping[str, float | None]
    proven: bool = False

    @property
    def is_certified(self) -> bool:
        """Whether every decision behind the result was exact, or the result is proven."""
        return self.proven if self.counts is None else self.counts.certified

    @property
    def seconds(self) -> float:
        """The median of the timings."""
        return statistics.median(self.timings)

    @property
    def per_second(self) -> float:
        """Units a second."""
        return self.amount / self.seconds


@dataclass(frozen=True)
class Target:
    """What an instance is to reach; None where nothing is asked.

    ``rate``: at least so many units a second; ``seconds`` and ``mib``: less than that.
    """

    rate: float | None = None
    seconds: float | None = None
    mib: float | None = None

    def is_reached(self, measured: Measured | None) -> bool | None:
        """Whether all that is asked is there, and certified; None if nothing is asked.

        Without a measurement, nothing that is asked is reached.
        """
        if self == Target():
            return None
        if measured is None or not measured.is_certified:
            return False
        return (
            (self.rate is None or measured.per_second >= self.rate)
            and (self.seconds is None or measured.seconds < self.seconds)
            and (self.mib is None or measured.peak_mib < self.mib)
        )


@dataclass(frozen=True)
class Case:
    """One instance of a benchmark: seed 0 of a family, and what is built of it.

    ``by``: what does it, where that is the case's own matter; None for the builder asked for.
    """

    name: str
    family: str
    n: int
    domain: Domain
    params: Mapping[str, Scalar] = field(default_factory=dict)
    objective: Objective = "smallest"
    target: Target = Target()
    by: str | None = None

    def task(self, builder: str) -> Task:
        """The case as a task, with every parameter of the family."""
        resolved = generators.family_named(self.family).check(self.n, self.params)
        return Task(
            family=self.family,
            n=self.n,
            params=tuple(sorted(resolved.items())),
            replicate=0,
            seed=0,
            domain=self.domain,
            objective=self.objective,
            builder=self.by or builder,
        )


@dataclass(frozen=True)
class Comparison:
    """How many times the seconds per unit of ``small`` those of ``large`` are.

    ``most``: to be less than that; None where nothing is asked.
    """

    large: str
    small: str
    most: float | None = None

    def ratio(self, found: Mapping[str, Measured]) -> float | None:
        """The ratio; None unless both instances were measured and produced something."""
        pair = [found.get(name) for name in (self.large, self.small)]
        costs = [one.seconds / one.amount for one in pair if one is not None and one.amount]
        return costs[0] / costs[1] if len(costs) == 2 else None

    def is_reached(self, ratio: float) -> bool | None:
        """Whether the ratio is as small as asked; None if nothing is asked."""
        return None if self.most is None else ratio < self.most


@dataclass(frozen=True)
class Fact:
    """A column of one benchmark: its name in rows, its heading and format in the table."""

    column: str
    heading: str
    form: str


@dataclass(frozen=True)
class Benchmark:
    """A benchmark.

    ``unit``: what is produced, in the plural ("vertices").  ``measure(task, repeat=…,
    workers=…)`` is called in a process of its own; it and ``warm_up(builder, n)``, which makes
    everything be compiled that instances of up to n segments need, must be importable there.
    ``quick``: small cases for trying the benchmark itself.
    """

    name: str
    unit: str
    cases: tuple[Case, ...]
    quick: tuple[Case, ...]
    comparisons: tuple[Comparison, ...]
    facts: tuple[Fact, ...]
    measure: Callable[..., Measured]
    warm_up: Callable[[str, int], None]
    limits: Limits

    @property
    def rate_column(self) -> str:
        """The name of the column of units a second."""
        return f"{self.unit}_per_second"

    def chosen(self, names: Sequence[str] | None, *, quick: bool = False) -> list[Case]:
        """The cases of these names, in the benchmark's order; all of them for None.

        Raises:
            UserError: there is no case of some name.
        """
        cases = {case.name: case for case in (self.quick if quick else self.cases)}
        for name in names or ():
            if name not in cases:
                hint = suggestion(name, cases) or f"they are {', '.join(cases)}"
                raise UserError(f"the benchmark {self.name} has no instance {name!r}; {hint}")
        return [case for case in cases.values() if names is None or case.name in names]
