"""Reading a TOML table key by key: types checked, leftovers refused, the place always named."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeVar

from harness.errors import UserError, shown, suggestion
from harness.study.task import Scalar

_Choice = TypeVar("_Choice", bound=str)

_REQUIRED: Any = object()


class Table:
    """A TOML table of which every key is taken once; ``finish`` refuses what is left.

    ``where`` names the table in errors.  Every method raises UserError naming table and key.
    """

    def __init__(self, values: Mapping[str, Any], where: str) -> None:
        """A table that nothing has been taken from."""
        self.where = where
        self._values = values
        self._known: set[str] = set()

    def __iter__(self) -> Iterator[str]:
        """The keys of the table as it was given."""
        return iter(self._values)

    def error(self, key: str, reason: str) -> UserError:
        """The error to raise about a key."""
        return UserError(f"{self.where}: {key}: {reason}")

    def take(self, key: str, default: Any = _REQUIRED) -> Any:
        """The raw value of a key."""
        self._known.add(key)
        value = self._values.get(key, default)
        if value is _REQUIRED:
            raise UserError(f"{self.where}: the key {key!r} is missing")
        return value

    def finish(self) -> None:
        """Refuse the keys that nobody asked for."""
        for key in self._values:
            if key not in self._known:
                hint = suggestion(key, self._known)
                tail = f" ({hint})" if hint else ""
                raise UserError(f"{self.where}: unknown key {shown(key)}{tail}")

    def text(self, key: str, default: Any = _REQUIRED) -> str:
        """A string."""
        value = self.take(key, default)
        if not isinstance(value, str):
            raise self.error(key, f"{shown(value)} must be a string")
        return value

    def integer(self, key: str, default: Any = _REQUIRED) -> int:
        """An integer (true and false are not)."""
        value = self.take(key, default)
        if type(value) is not int:
            raise self.error(key, f"{shown(value)} must be an integer")
        return value

    def number(self, key: str, default: Any = _REQUIRED) -> float:
        """An integer or a float."""
        value = self.take(key, default)
        if type(value) not in (int, float):
            raise self.error(key, f"{shown(value)} must be a number")
        try:
            return float(value)
        except OverflowError:
            raise self.error(key, f"{shown(value)} is too large") from None

    def scalars(self, key: str) -> list[Scalar]:
        """One value or a non-empty list of values."""
        value = self.take(key)
        values = value if isinstance(value, list) else [value]
        if not values or any(type(item) not in (int, float, str) for item in values):
            raise self.error(key, f"{shown(value)} must be a number, a string, or a list of these")
        return values

    def choices(self, key: str, default: _Choice, allowed: Iterable[_Choice]) -> list[_Choice]:
        """One or several of the allowed words."""
        value = self.take(key, default)
        values = value if isinstance(value, list) else [value]
        if not values:
            raise self.error(key, "the list is empty")
        for item in values:
            if not isinstance(item, str):
                raise self.error(key, f"{shown(item)} must be a string or a list of strings")
        return [choose(self, key, item, allowed) for item in dict.fromkeys(values)]

    def table(self, key: str) -> Table:
        """A table, empty if it is not there."""
        value = self.take(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f"{shown(value)} must be a table")
        return Table(value, f"{self.where}: {key}")

    def tables(self, key: str) -> list[Table]:
        """A non-empty array of tables, numbered from 1."""
        value = self.take(key, [])
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.error(key, f"must be an array of tables, [[{key}]]")
        if not value:
            raise UserError(f"{self.where}: there is no [[{key}]]")
        return [Table(item, f"{self.where}: {key} {k}") for k, item in enumerate(value, start=1)]


def choose(table: Table, key: str, given: str, allowed: Iterable[_Choice]) -> _Choice:
    """The allowed word that was given; UserError with a suggestion if it is none of them."""
    words = list(allowed)
    for word in words:
        if word == given:
            return word
    hint = suggestion(given, words)
    tail = f" ({hint})" if hint else f"; it is one of {', '.join(words)}"
    raise table.error(key, f"unknown {key} {shown(given)}{tail}")
