"""What a claim is: a statement of the paper, read in one way, that an instance can refute."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from harness.diagram.counts import Domain
from harness.geometry.instance import Instance

Outcome = Literal["holds", "fails", "undecided", "outside"]
"""``undecided``: the arithmetic at hand, or a limit, did not suffice; ``outside``: the instance
does not meet the hypotheses, so that it says nothing."""
OUTCOMES: tuple[Outcome, ...] = ("holds", "fails", "undecided", "outside")

Kind = Literal["for all", "there is", "growth"]
"""``for all``: one failure refutes the statement.  ``there is``: one instance proves it; those
without the property are called ``fails`` and refute nothing.  ``growth``: about all n; a failure
exceeds the constant of the reading, which is no refutation by itself."""

Point = tuple[float, float]


@dataclass(frozen=True)
class Finding:
    """What one instance says of a claim.

    ``message``: one sentence with the numbers behind the outcome.  ``facts``: numbers to be stored
    with the row.  ``marks``: points worth showing in a picture, as doubles.
    """

    outcome: Outcome
    message: str = ""
    facts: Mapping[str, int | float] = field(default_factory=dict)
    marks: tuple[Point, ...] = ()


@dataclass(frozen=True)
class Row:
    """A finding and the identity of its instance, by which it can be made again."""

    claim: str
    family: str
    n: int
    params: str
    seed: int
    outcome: Outcome
    message: str
    facts: Mapping[str, int | float]


@dataclass(frozen=True)
class Series:
    """How a count of one family grows: the sizes, the counts (the largest at each size), a verdict.

    ``verdict`` is that of :mod:`harness.analysis`; ``is_single``: whether it leaves one model.
    ``ratios`` maps a title such as "vertices/n²" to
    one number for each size.
    """

    family: str
    title: str
    n: tuple[int, ...]
    counts: tuple[int, ...]
    ratios: Mapping[str, tuple[float, ...]]
    verdict: str
    is_single: bool
    sentence: str


Cases = Callable[[int, int], Iterator[Instance]]
"""A source of instances: about ``count`` of them, the same for the same (count, seed)."""


@dataclass(frozen=True)
class Claim:
    """One statement in one reading.

    ``gloss``: what it says, in a few words; ``quote``: the paper's words; ``reading``: what is
    tested, in words of our own; ``failure``: what counts against it; ``arithmetic``: what decides;
    ``limits``: what the finite experiment shows, and what it cannot.  ``check`` is a pure function
    of the instance.  ``domain``: that of the diagram the claim is about, which both builders
    certify for the example that is shown, or None if it is about no diagram.  ``count``: how many
    instances by default.  ``series``: how counts grow, from the rows.  ``shrink``: whether the
    example is made as small as possible.  ``beyond``: whether the reading says more than the
    paper's words must, so that its failure is none of the paper's.
    """

    name: str
    title: str
    gloss: str
    quote: str
    reading: str
    failure: str
    arithmetic: str
    limits: str
    cases: Cases
    check: Callable[[Instance], Finding]
    kind: Kind = "for all"
    domain: Domain | None = None
    count: int = 200
    series: Callable[[Sequence[Row]], list[Series]] | None = None
    shrink: bool = True
    beyond: bool = False

    @property
    def sought(self) -> Outcome:
        """The outcome that an example shows: a counterexample, or a witness."""
        return "holds" if self.kind == "there is" else "fails"


@dataclass(frozen=True)
class Tally:
    """How often each outcome came up."""

    holds: int = 0
    fails: int = 0
    undecided: int = 0
    outside: int = 0

    @classmethod
    def of(cls, rows: Sequence[Row]) -> Tally:
        """The outcomes of rows."""
        return cls(**{name: sum(row.outcome == name for row in rows) for name in OUTCOMES})

    @property
    def tried(self) -> int:
        """Instances that say something."""
        return self.holds + self.fails

    def verdict(self, kind: Kind) -> str:
        """The verdict in words that claim no more than was seen."""
        if not self.tried:
            words = "nothing tried"
        elif kind == "there is":
            words = (
                f"shown by {self.holds} of {self.tried}"
                if self.holds
                else f"no example among {self.tried} tried"
            )
        elif kind == "growth":
            words = (
                f"above the bound on {self.fails} of {self.tried} tried"
                if self.fails
                else f"within the bound on all {self.tried} tried"
            )
        elif self.fails:
            words = f"fails on {self.fails} of {self.tried}"
        else:
            words = f"holds on all {self.tried} tried"
        return words + (f" ({self.undecided} undecided)" if self.undecided else "")


def as_facts(**facts: Any) -> dict[str, int | float]:
    """Facts as plain numbers."""
    return {
        name: value if isinstance(value, int) else float(value) for name, value in facts.items()
    }
