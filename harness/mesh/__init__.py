"""Mesh improvement: triangulations of the plane made better (paper, section 4).

* :func:`improve`: points and triangles in, better ones out, by several methods.
* :class:`Mesh`: a checked triangulation.
* :func:`read_mesh`, :func:`write_mesh`: files of all formats of meshio, their data kept.
* :func:`quality_of`: the figures by which meshes are compared.

Everything is imported when first asked for, as compiled code takes a moment to load.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from harness.mesh.door import Improved as Improved
    from harness.mesh.door import improve as improve
    from harness.mesh.files import read_mesh as read_mesh
    from harness.mesh.files import write_mesh as write_mesh
    from harness.mesh.mesh import Mesh as Mesh
    from harness.mesh.quality import Quality as Quality
    from harness.mesh.quality import quality_of as quality_of

_HOMES = {
    "Improved": "door",
    "Mesh": "mesh",
    "Quality": "quality",
    "improve": "door",
    "quality_of": "quality",
    "read_mesh": "files",
    "write_mesh": "files",
}

__all__ = ["Improved", "Mesh", "Quality", "improve", "quality_of", "read_mesh", "write_mesh"]


def __getattr__(name: str) -> Any:
    """Import a name of this door on first use (PEP 562)."""
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(f"harness.mesh.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
