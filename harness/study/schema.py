"""The version of what a study stores, and the way from an older version to this one.

One number covers the rows and the manifest.  It grows when the meaning of a stored value, or the
set of columns, changes; every step then gets an entry below, so old results stay readable.  What
a newer program wrote is refused: guessing at unknown columns would be worse than stopping.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from harness.errors import UserError

SCHEMA = 1

Record = dict[str, str]
"""One stored row: column name to text."""

ROW_STEPS: dict[int, Callable[[Record], Record]] = {}
"""From a row of schema k to one of schema k + 1."""

MANIFEST_STEPS: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}
"""From a manifest of schema k to one of schema k + 1."""


def schema_of(record: Mapping[str, Any], where: str) -> int:
    """The schema a record says it has; ``where`` names it in the errors.

    Raises UserError if the number is missing, malformed or newer than this program.
    """
    text = str(record.get("schema", ""))
    if not text.isdecimal() or int(text) < 1:
        raise UserError(f"{where}: no valid schema number (found {text!r})")
    found = int(text)
    if found > SCHEMA:
        raise UserError(
            f"{where}: written with schema {found}, this avd reads up to {SCHEMA}: "
            "install a newer angular-voronoi"
        )
    return found


def migrate_row(record: Record, where: str) -> Record:
    """The row as the present schema has it.  Raises UserError (see ``schema_of``)."""
    for version in range(schema_of(record, where), SCHEMA):
        record = {**ROW_STEPS[version](record), "schema": str(version + 1)}
    return record


def migrate_manifest(manifest: dict[str, Any], where: str) -> dict[str, Any]:
    """The manifest as the present schema has it.  Raises UserError (see ``schema_of``)."""
    for version in range(schema_of(manifest, where), SCHEMA):
        manifest = {**MANIFEST_STEPS[version](manifest), "schema": version + 1}
    return manifest
