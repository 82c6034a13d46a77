"""The families by name, and the one function that makes an instance of any of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from generators.cavity import CAVITY
from generators.controls import CONTROL_CONSTANT, CONTROL_LINEAR
from generators.convex import CONVEX_CIRCLE, CONVEX_VALTR
from generators.family import Family, GeneratorError, Kind, Value, did_you_mean, whole_number
from generators.fat import STAR_FAT
from generators.portable import Array
from generators.scatter import FIGURE_2, GRID, SEGMENTS
from generators.stars import NEAR_REGULAR, STAR
from generators.weaves import CONVEX_WEAVE, ZIGZAG

FAMILIES: Mapping[str, Family] = MappingProxyType(
    {
        family.name: family
        for family in (
            STAR,
            STAR_FAT,
            NEAR_REGULAR,
            CONVEX_CIRCLE,
            CONVEX_VALTR,
            ZIGZAG,
            CONVEX_WEAVE,
            CAVITY,
            CONTROL_CONSTANT,
            CONTROL_LINEAR,
            GRID,
            SEGMENTS,
            FIGURE_2,
        )
    }
)


@dataclass(frozen=True)
class Generated:
    """One instance and what it was made from.

    ``coordinates``: float64, shape (n, 2), the vertices of a polygon counter-clockwise, or
    (n, 2, 2), the end points of n segments.  ``params`` holds every parameter, defaults included.
    """

    kind: Kind
    coordinates: Array
    family: str
    n: int
    params: dict[str, Value]
    seed: int


def family_named(name: str) -> Family:
    """The family called ``name``; GeneratorError with a suggestion if there is none."""
    try:
        return FAMILIES[name]
    except KeyError:
        raise GeneratorError(
            f"unknown family {name!r}{did_you_mean(name, FAMILIES)}; "
            f"the families are {', '.join(FAMILIES)}"
        ) from None


def generate(family: str, n: int, seed: int = 0, **params: object) -> Generated:
    """An instance of ``family`` with n segments.

    The same (family, n, seed, params) gives the same coordinates, bit for bit, on every machine.
    Parameters may be given as numbers or as their text.  Raises GeneratorError, with one line
    naming the parameter and what it may be, if there is no such instance.
    """
    described = family_named(family)
    resolved = described.check(n, params)
    size, start = whole_number(f"{family}: n", n), whole_number(f"{family}: seed", seed)
    if start < 0:
        raise GeneratorError(f"{family}: seed = {start} must not be negative")
    coordinates = described.build(size, start, **resolved)
    coordinates.flags.writeable = False
    return Generated(described.kind, coordinates, family, len(coordinates), resolved, start)
