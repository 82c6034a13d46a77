"""What a stored row and a manifest must look like: people edit them, and disks damage them.

Whatever passes can be analysed and reported on; what does not is named by file, place and reason.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from harness.diagram.counts import DOMAINS, OBJECTIVES
from harness.errors import UserError, shown
from harness.study.outcome import COUNT_COLUMNS, STATUSES
from harness.study.schema import Record


def check_row(row: Record, where: str) -> None:
    """Raise UserError naming ``where`` and the column if a cell of a row cannot be.

    A task that was counted has all counts; of another they may be missing.
    """
    for column, (is_right, wanted) in _ALWAYS.items():
        if not is_right(row[column]):
            raise _wrong(where, column, row[column], wanted)
    for column, (is_right, wanted) in _COUNTED.items():
        value = row[column]
        if not is_right(value) and (value != "" or row["status"] == "ok"):
            raise _wrong(where, column, value, wanted)


def _wrong(where: str, key: str, value: object, wanted: str) -> UserError:
    return UserError(f"{where}: {key}: {shown(value)} must be {wanted}")


def _is_whole(text: str) -> bool:
    return re.fullmatch(r"[0-9]{1,18}", text) is not None  # fits into 64 bits


def _is_measured(text: str) -> bool:
    try:
        return 0 <= float(text) < math.inf
    except ValueError:
        return False


def _object(text: str) -> dict[str, Any] | None:
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return value if isinstance(value, dict) else None


def _is_parameters(text: str) -> bool:
    values = _object(text)
    return values is not None and all(_is_scalar(value) for value in values.values())


def _is_scalar(value: object) -> bool:
    return isinstance(value, str) or (
        type(value) in (int, float) and abs(value) < math.inf  # type: ignore[arg-type]  # a number
    )


def _is_histogram(text: str) -> bool:
    values = _object(text)
    return values is not None and all(
        _is_whole(degree) and type(count) is int and count >= 0 for degree, count in values.items()
    )


Rule = tuple[Callable[[str], bool], str]

_WHOLE: Rule = (_is_whole, "a whole number")
_MEASURED: Rule = (_is_measured, "a number, at least 0")


def _one_of(words: tuple[str, ...]) -> Rule:
    return (lambda text: text in words), f"one of {', '.join(words)}"


_ALWAYS: Mapping[str, Rule] = {
    "task": (lambda text: text.strip() != "", "the key of a task"),
    "family": (lambda text: text.strip() != "", "the name of a family"),
    "n": _WHOLE,
    "params": (_is_parameters, "a JSON object of numbers and strings"),
    "replicate": _WHOLE,
    "seed": _WHOLE,
    "domain": _one_of(DOMAINS),
    "objective": _one_of(OBJECTIVES),
    "builder": (lambda text: text.strip() != "", "the name of a builder"),
    "status": _one_of(STATUSES),
    "peak_mib": (lambda text: text == "" or _is_measured(text), "a number, at least 0"),
}

_COUNTED: Mapping[str, Rule] = {
    "segments": _WHOLE,
    **dict.fromkeys(COUNT_COLUMNS, _WHOLE),
    "degrees": (_is_histogram, "a JSON object of whole numbers"),
    "certified": _one_of(("true", "false")),
    "seconds": _MEASURED,
}

_TEXT, _NUMBER, _TABLE, _FLAG = (str,), (int,), (dict,), (bool,)
_NAMES = {str: "a string", int: "a whole number", dict: "an object", bool: "true or false"}

_KEYS: Mapping[str, tuple[type, ...]] = {
    "study": _TEXT,
    "description": _TEXT,
    "avd": _TEXT,
    "commit": (dict, type(None)),
    "versions": _TABLE,
    "machine": _TABLE,
    "command": _TEXT,
    "base_seed": _NUMBER,
    "seeds": _TEXT,
    "limits": _TABLE,
    "tasks": _NUMBER,
    "statuses": _TABLE,
}
_RUN_KEYS: Mapping[str, tuple[type, ...]] = {"end": (str, type(None)), "interrupted": _FLAG}


def check_manifest(manifest: Mapping[str, Any], where: str) -> None:
    """Raise UserError naming ``where`` and the key if a value has the wrong type.

    Keys may be missing but for those of a run that the next run asks for.
    """
    for key in _KEYS.keys() & manifest.keys():
        _check_type(manifest[key], _KEYS[key], f"{where}: {key}")
    runs = manifest.get("runs", [])
    if not isinstance(runs, list):
        raise UserError(f"{where}: runs: must be a list")
    for number, run in enumerate(runs, start=1):
        place = f"{where}: run {number}"
        _check_type(run, _TABLE, place)
        for key, types in _RUN_KEYS.items():
            if key not in run:
                raise UserError(f"{place}: the key {key!r} is missing")
            _check_type(run[key], types, f"{place}: {key}")


def _check_type(value: Any, types: tuple[type, ...], where: str) -> None:
    if type(value) not in types:
        names = " or ".join(_NAMES.get(each, "null") for each in types)
        raise UserError(f"{where}: must be {names}")
