"""Colours of the weave: one family of edges light and warm, its mirror image dark and cool.

A checkerboard is read by its lightness, which every reader sees and every printer prints; the hue
tells the edges of one family apart.  Hue and lightness run once around an oval, so the edges'
cyclic order is seen, and the last edge is a neighbour of the first.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.colors import to_hex

#: Of both families: lightness and its swing, chroma, hue and its swing (degrees), in OKLCH.
_LIGHT = (0.875, 0.028, 0.115, 68.0, 42.0)
_DARK = (0.500, 0.060, 0.130, 250.0, 52.0)

_LMS = (
    (1.0, 0.3963377774, 0.2158037573),
    (1.0, -0.1055613458, -0.0638541728),
    (1.0, -0.0894841775, -1.2914855480),
)
_RGB = (
    (4.0767416621, -3.3077115913, 0.2309699292),
    (-1.2684380046, 2.6097574011, -0.3413193965),
    (-0.0041960863, -0.7034186147, 1.7076147010),
)


def weave_colour(edge: int, n: int) -> str:
    """The colour of edge 0 ≤ ``edge`` < n (n even): even edges are light, odd ones dark."""
    lightness, lighter, chroma, hue, turn = _DARK if edge % 2 else _LIGHT
    around = 2 * math.pi * (edge // 2) / (n // 2)
    return oklch(lightness + lighter * math.sin(around), chroma, hue + turn * math.cos(around))


def oklch(lightness: float, chroma: float, hue: float) -> str:
    """A colour of Ottosson's OKLCH space (2020) as #rrggbb; ``hue`` in degrees.

    A colour that screens cannot show is made duller, at its lightness and hue, until they can.
    """
    angle = math.radians(hue)
    for _ in range(200):
        lab = (lightness, chroma * math.cos(angle), chroma * math.sin(angle))
        linear = np.array(_RGB) @ (np.array(_LMS) @ lab) ** 3
        if linear.min() >= -1e-9 and linear.max() <= 1 + 1e-9:
            break
        chroma *= 0.97
    linear = np.clip(linear, 0.0, 1.0)
    curved = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    red, green, blue = np.clip(curved, 0.0, 1.0).tolist()
    return to_hex((red, green, blue))
