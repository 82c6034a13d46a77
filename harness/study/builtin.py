"""The studies that come with the program, found by name."""

from __future__ import annotations

import os
from pathlib import Path

from harness.errors import UserError, suggestion
from harness.study.study_file import Study, read_study

_FOLDER = Path(__file__).parent / "builtin"


def builtin_studies() -> dict[str, Study]:
    """The built-in studies by name."""
    return {path.stem: read_study(path) for path in sorted(_FOLDER.glob("*.toml"))}


def find_study(name: str) -> Study:
    """The study in the file ``name``, or the built-in study of that name.

    A word without directory and suffix names a built-in study, so a directory ``quick`` in the
    way does not matter.  Raises UserError if there is neither, or if the file is wrong.
    """
    path = Path(name)
    if path.suffix or os.sep in name or path.is_file():
        return read_study(path)
    known = [file.stem for file in sorted(_FOLDER.glob("*.toml"))]
    if name in known:
        return read_study(_FOLDER / f"{name}.toml")
    hint = suggestion(name, known) or f"built-in are {', '.join(known)}"
    raise UserError(f"no file and no built-in study is called {name!r}; {hint}")
