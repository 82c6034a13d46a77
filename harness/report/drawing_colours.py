"""Colours for the cells of a diagram: one per segment, neighbours told apart by every reader.

The palette was found by maximising its least contrast: any two of its first eight colours are at
least 0.09 apart in the OKLab colour space, any two of all twelve 0.055 (a difference of 0.02 is
just visible), and that for normal vision as well as for full protanopia, deuteranopia and
tritanopia as simulated by Machado, Oliveira and Fernandes ("A physiologically-based model for
simulation of color vision deficiency", IEEE TVCG 15, 2009).  Where twelve are not enough,
hatching repeats them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import to_hex, to_rgb
from numpy.typing import NDArray

#: Fill colours.  The first eight serve alone as long as they can.
PALETTE = (
    "#96d8fd",  # sky
    "#fdcd66",  # orange
    "#f28fae",  # pink
    "#f8f5ba",  # cream
    "#a3acf5",  # periwinkle
    "#c6d8bb",  # sage
    "#b6f9fd",  # ice
    "#c3b351",  # olive
    "#c39273",  # clay
    "#9e94d0",  # violet
    "#5cc8d5",  # teal
    "#edae91",  # apricot
)
FEW = 8

#: Hatchings laid over the palette, in the order in which they are needed; the first is none.
HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----", "||||", "oo", "++++", "**")

#: What a segment that owns no cell is drawn in.
NEUTRAL = "#6b6b6b"

_SIMULATIONS = (
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    (
        (0.152286, 1.052583, -0.204868),
        (0.114503, 0.786281, 0.099216),
        (-0.003882, -0.048116, 1.051998),
    ),
    (
        (0.367322, 0.860646, -0.227968),
        (0.280085, 0.672501, 0.047413),
        (-0.011820, 0.042940, 0.968881),
    ),
    (
        (1.255528, -0.076749, -0.178779),
        (-0.078411, 0.930809, 0.147602),
        (0.004733, 0.691367, 0.303900),
    ),
)
_LMS = (
    (0.4122214708, 0.5363325363, 0.0514459929),
    (0.2119034982, 0.6806995451, 0.1073969566),
    (0.0883024619, 0.2817188376, 0.6299787005),
)
_LAB = (
    (0.2104542553, 0.7936177850, -0.0040720468),
    (1.9779984951, -2.4285922050, 0.4505937099),
    (0.0259040371, 0.7827717662, -0.8086757660),
)


@dataclass(frozen=True)
class Style:
    """How one segment and its cells are drawn: fill, hatching and the dark shade of the line."""

    fill: str
    hatch: str
    line: str


def contrast(colours: Iterable[str]) -> NDArray[np.float64]:
    """(k, k) distances between k colours in OKLab, each the least over the four kinds of vision."""
    srgb = np.array([to_rgb(colour) for colour in colours])
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    least = np.full((len(srgb), len(srgb)), np.inf)
    for simulation in _SIMULATIONS:
        seen = np.clip(linear @ np.array(simulation).T, 0.0, 1.0)
        lab = np.cbrt(seen @ np.array(_LMS).T) @ np.array(_LAB).T
        least = np.minimum(least, np.linalg.norm(lab[:, None] - lab[None], axis=-1))
    return least


def styles(n: int, neighbours: Iterable[tuple[int, int]], owners: Iterable[int]) -> list[Style]:
    """A style for each of n segments; segments with adjacent cells get different ones.

    ``neighbours``: pairs of segments with an edge between them.  ``owners``: the segments that
    have a cell; the others are drawn in a neutral grey.  Greedy in order of saturation (Brélaz,
    "New methods to color the vertices of a graph", CACM 1979): the segment whose neighbours
    already show the most styles comes next.  Up to twelve owners all get colours of their own.
    O(n² + pairs) for a bounded number of styles.
    """
    beside: dict[int, set[int]] = {owner: set() for owner in sorted(set(owners))}
    for i, j in neighbours:
        beside[i].add(j)
        beside[j].add(i)
    colours = PALETTE[:FEW] if len(beside) <= FEW else PALETTE
    apart = contrast(colours)
    uses = [0] * len(colours)
    chosen: dict[int, tuple[int, int]] = {}  # segment -> (hatch, colour)
    waiting = dict.fromkeys(beside)
    while waiting:
        segment = max(
            waiting,
            key=lambda k: (len({chosen[j] for j in beside[k] if j in chosen}), len(beside[k]), -k),
        )
        del waiting[segment]
        taken = {chosen[j] for j in beside[segment] if j in chosen}
        hatch = next(h for h in range(n) if any((h, c) not in taken for c in range(len(colours))))
        near = [colour for _, colour in taken]
        colour = min(
            (c for c in range(len(colours)) if (hatch, c) not in taken),
            key=lambda c: (uses[c], -min((apart[c, k] for k in near), default=0.0), c),
        )
        uses[colour] += 1
        chosen[segment] = hatch, colour
    return [_style(colours, *chosen[k]) if k in chosen else _unowned() for k in range(n)]


def dark(colour: str) -> str:
    """The dark shade of a fill: for the segment itself, its hatching and its index."""
    red, green, blue = to_rgb(colour)
    return to_hex((0.5 * red, 0.5 * green, 0.5 * blue))


def _style(colours: tuple[str, ...], hatch: int, colour: int) -> Style:
    fill = colours[colour]
    return Style(fill=fill, hatch=HATCHES[hatch % len(HATCHES)], line=dark(fill))


def _unowned() -> Style:
    return Style(fill="none", hatch="", line=NEUTRAL)
