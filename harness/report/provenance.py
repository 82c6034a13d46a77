"""Where the rows come from, as the manifest says it: flattened for the page."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from harness.report.labels import plain

#: An absolute path: quoted (it may hold spaces then), or up to the next space or comma.
_PATH = re.compile(
    r"""(?P<quote>["'])(?P<quoted>(?:[A-Za-z]:)?[\\/].*?)(?P=quote)"""
    r"""|(?<![^\s=(,])(?P<bare>(?:[A-Za-z]:)?[\\/][^\s,)"']*)"""
)


def entries(manifest: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """(name, value) pairs in the manifest's own order; the runs come last."""
    if not manifest:
        return [("manifest", "missing: the origin of these rows is not recorded")]
    plain_part = {name: value for name, value in manifest.items() if name != "runs"}
    found = list(_flatten(plain_part))
    for number, run in enumerate(manifest.get("runs") or (), start=1):
        found.extend(_flatten(run, f"run {number} · "))
    return found


def _flatten(value: Any, prefix: str = "") -> Iterator[tuple[str, str]]:
    for name, item in value.items():
        label = prefix + str(name).replace("_", " ")
        if isinstance(item, Mapping):
            yield from _flatten(item, f"{label} · ")
        else:
            yield label, _text(item)


def _text(item: Any) -> str:
    if item is None or item == "":
        return "–"
    if isinstance(item, bool):
        return "yes" if item else "no"
    if isinstance(item, list | tuple):
        return ", ".join(_text(each) for each in item)
    return without_directories(item) if isinstance(item, str) else plain(item)


def without_directories(text: str) -> str:
    """The text with every absolute path cut down to its last part: where a file lay is private."""
    return _PATH.sub(_last_part, text)


def _last_part(match: re.Match[str]) -> str:
    path = match["quoted"] or match["bare"]
    parts = [part for part in re.split(r"[\\/]", path) if part]
    last = parts[-1] if parts else ""
    return f"{match['quote']}{last}{match['quote']}" if match["quote"] else last
