"""Stored rows as a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from harness.errors import UserError
from harness.study.manifest import read_manifest
from harness.study.mesh_rows import is_mesh_study
from harness.study.outcome import COLUMNS, COUNT_COLUMNS
from harness.study.store import ROWS, read_rows

if TYPE_CHECKING:
    import pandas as pd

ORDER = ["family", "params", "n", "domain", "objective", "builder", "replicate"]
"""How the rows are sorted; the file has them in another order."""

_WHOLE = ("schema", "n", "replicate", "seed")
_PERHAPS_WHOLE = ("segments", *COUNT_COLUMNS)
_FLOATS = ("seconds", "peak_mib")


def load(directory: Path | str) -> pd.DataFrame:
    """The rows of a study, one for each finished task, sorted by ``ORDER``.

    Columns as in ``outcome.COLUMNS``.  ``n``, ``replicate``, ``seed`` and ``schema`` are int64;
    the counts and ``segments`` Int64 (missing where the status is not "ok"); ``seconds`` and
    ``peak_mib`` float64; ``certified`` boolean; ``params`` and ``degrees`` JSON text; the others
    text.  Rows of an older schema are migrated.  The files are not touched: a run may be adding
    to them.

    Raises UserError if there is no study, a row is damaged, or a newer program wrote it.
    """
    import pandas as pd

    folder = Path(directory)
    if not (folder / ROWS).exists():
        raise UserError(f"{folder}: no study here ({ROWS} is missing)")
    if is_mesh_study(folder):
        raise UserError(
            f"{folder}: holds a study of meshes; harness.study.mesh_rows.read_meshes reads its rows"
        )
    read_manifest(folder)  # refuses one from a newer program
    table = pd.DataFrame(read_rows(folder / ROWS), columns=list(COLUMNS), dtype=str)
    try:
        table = table.astype(dict.fromkeys(_WHOLE, "int64"))
        for column in _PERHAPS_WHOLE:
            table[column] = pd.to_numeric(table[column]).astype("Int64")
        for column in _FLOATS:
            table[column] = pd.to_numeric(table[column]).astype("float64")
    except (TypeError, ValueError) as error:
        raise UserError(f"{folder / ROWS}: a number is malformed: {error}") from None
    table["certified"] = table["certified"].map({"true": True, "false": False}).astype("boolean")
    return table.sort_values(ORDER, kind="stable", ignore_index=True)
