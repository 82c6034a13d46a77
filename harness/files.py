"""Writing a file in one step: whoever reads it, or a crash, sees the old content or the new.

And reading what was written so as a JSON object.
"""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import Any

from harness.errors import UserError


def read_object(path: Path, name: str) -> dict[str, Any] | None:
    """The JSON object in a file; None if there is no such file.

    Raises UserError if it cannot be read or holds something else than ``name``.
    """
    if not path.exists():
        return None
    try:
        found = json.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:
        raise UserError(f"{path}: cannot be read: {error}") from None
    if not isinstance(found, dict):
        raise UserError(f"{path}: not {name}")
    return found


def replace(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path``, wholly or not at all; on return it is on the disk.

    A device or a pipe is written to, a symbolic link followed.  Raises OSError naming ``path``.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(content)
        else:
            _replace(Path(os.path.realpath(path)), content)
    except OSError as error:
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None


def _replace(target: Path, content: bytes) -> None:
    descriptor, scratch = tempfile.mkstemp(".tmp", f".{target.name[:50]}.", target.parent)
    try:
        with open(descriptor, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(scratch, _permissions(target))
        os.replace(scratch, target)
    except BaseException:
        os.unlink(scratch)
        raise


def _permissions(target: Path) -> int:
    """Those of the file that is there, or those of any new file."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
