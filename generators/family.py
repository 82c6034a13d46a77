"""What a family of instances is: its parameters, its sizes, its declared growth."""

from __future__ import annotations

import difflib
import math
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from generators.portable import Array

Kind = Literal["polygon", "segments"]
Value = int | float | str
GROWTHS = ("1", "log n", "n", "n log n", "n^2", "unknown")


class GeneratorError(ValueError):
    """A family, a size, a seed or a parameter that cannot be served; the message is one line."""


@dataclass(frozen=True)
class Interval:
    """The numbers a parameter may take; either end may be left out."""

    low: float
    high: float
    closed: Literal["[]", "[)", "(]", "()"] = "[]"

    def __contains__(self, value: float) -> bool:
        """Whether ``value`` is allowed."""
        above = value >= self.low if self.closed[0] == "[" else value > self.low
        below = value <= self.high if self.closed[1] == "]" else value < self.high
        return above and below

    def __str__(self) -> str:
        """The interval in the usual notation."""
        return f"{self.closed[0]}{self.low:g}, {self.high:g}{self.closed[1]}"


@dataclass(frozen=True)
class Parameter:
    """A named parameter of a family: ``allowed`` bounds a number, ``choices`` list the words."""

    name: str
    type: type[int] | type[float] | type[str]
    default: Value
    help: str
    allowed: Interval | None = None
    choices: tuple[str, ...] = ()

    def read(self, family: str, given: object) -> Value:
        """``given`` (a number, or its text) as this parameter's type, or GeneratorError."""
        expected = " or ".join(self.choices) or {int: "an integer", float: "a number"}[self.type]
        wrong = GeneratorError(f"{family}: {self.name} = {given!r} must be {expected}")
        if isinstance(given, bool):
            raise wrong
        if self.type is str:
            if given not in self.choices:
                raise wrong
            return str(given)
        try:
            number = float(given)  # type: ignore[arg-type]  # anything at all may be given
        except (TypeError, ValueError, OverflowError):
            raise wrong from None
        if not math.isfinite(number) or (self.type is int and not number.is_integer()):
            raise wrong
        if self.allowed is not None and number not in self.allowed:
            raise GeneratorError(f"{family}: {self.name} = {number:g} is outside {self.allowed}")
        return int(number) if self.type is int else number


def _no_further_condition(_n: int, **_params: Any) -> None:
    """Most families are feasible wherever n and each parameter is within its own bounds."""


@dataclass(frozen=True)
class Family:
    """A documented family of instances.

    ``growth`` declares how the number of Voronoi vertices grows with n in the kind's default
    domain (the kernel of a polygon, the plane for segments), "unknown" where nobody has said.
    ``control`` says that this is a theorem or a derivation given with the family, so that an
    analysis can be checked by it; elsewhere it is what experiments suggest.
    ``build(n, seed, **parameters)`` returns the coordinates; ``condition`` raises where the
    parameters and n do not go together.
    """

    name: str
    kind: Kind
    summary: str
    source: str
    growth: str
    build: Callable[..., Array]
    parameters: tuple[Parameter, ...] = ()
    control: bool = False
    random: bool = True
    smallest: int = 3
    largest: int = 4_000_000
    even: bool = False
    condition: Callable[..., None] = field(default=_no_further_condition, repr=False)

    def __post_init__(self) -> None:
        """A growth model is one of the known ones."""
        if self.growth not in GROWTHS or (self.control and self.growth == "unknown"):
            raise ValueError(f"{self.name}: growth {self.growth!r} is not one of {GROWTHS}")

    def resolve(self, params: Mapping[str, object]) -> dict[str, Value]:
        """Every parameter, as given or by default, typed and within its own bounds."""
        known = {parameter.name: parameter for parameter in self.parameters}
        for name in params:
            if name not in known:
                has = f"it has {', '.join(known)}" if known else "it has none"
                raise GeneratorError(
                    f"{self.name} has no parameter {name!r}{did_you_mean(name, known)}; {has}"
                )
        return {
            name: parameter.read(self.name, params.get(name, parameter.default))
            for name, parameter in known.items()
        }

    def check(self, n: int, params: Mapping[str, object] | None = None) -> dict[str, Value]:
        """Raise GeneratorError unless (n, params) is feasible; return the resolved parameters."""
        size = whole_number(f"{self.name}: n", n)
        even = " even" if self.even else ""
        if self.smallest == self.largest != size:
            raise GeneratorError(f"{self.name}: n = {size} must be {self.smallest}")
        if not self.smallest <= size <= self.largest or (self.even and size % 2):
            raise GeneratorError(
                f"{self.name}: n = {size} must be{even} between {self.smallest} and {self.largest}"
            )
        resolved = self.resolve(params or {})
        self.condition(size, **resolved)
        return resolved


def whole_number(name: str, value: object) -> int:
    """``value`` as an int; GeneratorError if it is not a whole number (booleans are not)."""
    try:
        if isinstance(value, bool):
            raise TypeError
        return operator.index(value)  # type: ignore[arg-type]  # anything at all may be given
    except TypeError:
        raise GeneratorError(f"{name} = {value!r} must be an integer") from None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """A suggestion to put after an unknown name, or nothing."""
    close = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f" (did you mean {close[0]!r}?)" if close else ""
