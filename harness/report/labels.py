"""How curves and numbers are written for people."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence

from harness.analysis import Key

_RAISED = str.maketrans("-−.0123456789", "⁻⁻·⁰¹²³⁴⁵⁶⁷⁸⁹")


def curve_labels(keys: Sequence[Key]) -> list[str]:
    """A short, unambiguous label for each group of a study.

    The family, the parameters in which it differs from the study's other groups of that family,
    and domain, objective and builder where the study has more than one of them for it.
    """
    short = _labels(keys, [_with_one_noise(_description(key)) for key in keys])
    if len(set(short)) == len(set(keys)):
        return short
    return _labels(keys, [_description(key) for key in keys])


def _labels(keys: Sequence[Key], descriptions: Sequence[dict[str, str]]) -> list[str]:
    varying: dict[str, set[str]] = defaultdict(set)
    for family in {key.family for key in keys}:
        described = [d for key, d in zip(keys, descriptions, strict=True) if key.family == family]
        for name in {name for description in described for name in description}:
            if len({str(description.get(name)) for description in described}) > 1:
                varying[family].add(name)
    return [_label(k, d, varying[k.family]) for k, d in zip(keys, descriptions, strict=True)]


def _label(key: Key, described: dict[str, str], names: set[str]) -> str:
    parts = [f"{name} = {described[name]}" for name in key.parameters if name in names]
    parts += [described[name] for name in ("domain", "objective", "builder") if name in names]
    return ", ".join([key.family, *parts])


def _description(key: Key) -> dict[str, str]:
    parameters = {name: plain(value) for name, value in key.parameters.items()}
    rest = {"domain": key.domain, "objective": key.objective, "builder": key.builder}
    return {**parameters, **rest}


def _with_one_noise(description: dict[str, str]) -> dict[str, str]:
    """A noise relative to a power of n as one: noise/n²."""
    short = dict(description)
    if "noise" in short:
        power = short.pop("noise_power", "0")
        if float(short["noise"]) and power != "0":
            short["noise"] += "/n" if power == "1" else f"/n{raised(power)}"
    return short


def parameters(key: Key) -> str:
    """All parameters of a group on one line."""
    return ", ".join(f"{name} = {plain(value)}" for name, value in key.parameters.items())


def plain(value: object) -> str:
    """A parameter's value: floats short, everything else as it is."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def number(value: float | None, digits: int = 3) -> str:
    """A number for a table: whole if it is, else to ``digits`` significant digits."""
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if abs(value) < 1e15 and (float(value).is_integer() or abs(value) >= 10**digits):
        return f"{value + 0.0:.0f}".replace("-", "−")  # + 0.0: no negative zero
    text = f"{value:.{digits}g}"
    if "e" in text:  # too small, or too large, for a table of decimals
        mantissa, exponent = text.split("e")
        return f"{mantissa}·10{raised(str(int(exponent)))}".replace("-", "−")
    return text.replace("-", "−")


def raised(text: str) -> str:
    """A number as an exponent: ⁻³·⁹."""
    return text.translate(_RAISED)


def bracket(low: float | None, high: float | None, digits: int = 3) -> str:
    """An interval, or nothing if there is none."""
    if low is None or high is None or math.isnan(low) or math.isnan(high):
        return ""
    return f"[{number(low, digits)}, {number(high, digits)}]"


def signed_percent(value: float) -> str:
    """A relative miss: +37 %."""
    rounded = round(100 * value)
    return f"{rounded:+d} %".replace("-", "−") if rounded else "0 %"


def percent(share: float) -> str:
    """A share: 98 %."""
    return f"{100 * share:.0f} %"


def sizes(values: Sequence[float]) -> str:
    """The sizes of a curve: all of them if few, the range otherwise."""
    if not len(values):
        return "none"
    if len(values) <= 8:
        return ", ".join(f"{value:g}" for value in values)
    return f"{values[0]:g} … {values[-1]:g} ({len(values)} sizes)"


def spread(least: int, most: int) -> str:
    """1 … 30; one number if they are equal."""
    return f"{least}" if least == most else f"{least} … {most}"


def plural(count: int, noun: str, many: str = "") -> str:
    """1 task, 2 tasks; ``many`` where an s is not enough."""
    return f"{count} {noun}" if count == 1 else f"{count} {many or noun + 's'}"
