"""The studies that come with the program, found by name."""

from __future__ import annotations

import os
from pathlib import Path

from harness.errors import UserError, suggestion
from harness.study.study_file import Study, read_study

SMALL, FULL = "small", "full"
"""The scales of a study that is two files: ``NAME-small.toml`` and ``NAME.toml``."""

_FOLDER = Path(__file__).parent / "builtin"


def builtin_studies() -> dict[str, Study]:
    """The built-in studies by name."""
    return {path.stem: read_study(path) for path in sorted(_FOLDER.glob("*.toml"))}


class NoScales(Exception):
    """A study that comes in one size only was asked for in another."""


def find_study(name: str, scale: str | None = None) -> Study:
    """The study in the file ``name``, or the built-in study of that name, in one of its scales.

    A word without directory and suffix names a built-in study, so a directory ``quick`` in the
    way does not matter.  Without ``scale`` the study is taken as named.  Raises UserError if there
    is neither, or if the file is wrong; NoScales if ``scale`` is given and there is no other.
    """
    path = _path_of(name)
    if scale is not None:
        small = path.with_name(f"{path.stem}-{SMALL}{path.suffix}")
        if path.is_file() and not small.is_file():
            raise NoScales(f"{name} has no scales: there is no {small.name} beside {path.name}")
        path = small if scale == SMALL and path.is_file() else path
    return read_study(path)


def _path_of(name: str) -> Path:
    """The file of a study.  Raises UserError if the name is that of no built-in study."""
    path = Path(name)
    if path.suffix or os.sep in name or path.is_file():
        return path
    known = [file.stem for file in sorted(_FOLDER.glob("*.toml"))]
    if name in known:
        return _FOLDER / f"{name}.toml"
    hint = suggestion(name, known) or f"built-in are {', '.join(known)}"
    raise UserError(f"no file and no built-in study is called {name!r}; {hint}")
