"""The ideal weave, drawn twice: in its kernel, and unrolled to where tips run on straight lines."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from generators.weaves import zigzag_inner_radius
from harness.analysis.models import Floats
from harness.analysis.weave import Weave, predict
from harness.report.style import BLACK, BLUE, GREY, PALE, VERMILLION

#: The weave that is drawn: that of the README's picture.
SPIKES, TILT = 6, math.pi / 6
#: Steps along a curve.
STEPS = 240


@dataclass(frozen=True)
class Ideal:
    """Lengths and angles of an ideal weave in doubles; see ``harness.analysis.weave``."""

    weave: Weave
    ratio: float

    @property
    def h(self) -> float:
        """Half the angle of an edge at the centre."""
        return math.pi / self.weave.n

    def level(self, tip: Floats) -> Floats:
        """The visual angle at which the tips stand at ``tip``."""
        skew = (1 - self.ratio) / (1 + self.ratio)
        return np.asarray(self.h - np.arctan(skew / np.tan(tip)))

    def radius(self, tip: Floats, aside: Floats) -> Floats:
        """Distance from the centre where the tips stand at ``tip``, ``aside`` the nearest one."""
        level = self.level(tip)
        centre = (1 - self.ratio) * np.cos(self.h - level) / np.sin(tip) / 2 / np.sin(level)
        along = centre * np.cos(aside)
        power = self.ratio * np.sin(2 * self.h - level) / np.sin(level)
        return np.asarray(np.sqrt(along**2 + power) - along)

    def tips(self, tip: float) -> Floats:
        """Directions of all tips, those of the family A first; (n,)."""
        turns = 4 * self.h * np.arange(self.weave.m)
        return np.concatenate([turns + self.h + tip, turns - self.h - tip])

    def aside(self, tip: float, direction: Floats) -> Floats:
        """How far directions (k,) are from the nearest tip."""
        apart = direction[:, np.newaxis] - self.tips(tip)
        return np.asarray(np.abs(np.remainder(apart + math.pi, 2 * math.pi) - math.pi).min(axis=1))

    def borders(self, tip: float) -> Floats:
        """Directions half-way between neighbouring tips, (n,)."""
        ordered = np.sort(np.remainder(self.tips(tip), 2 * math.pi))
        following = np.append(ordered[1:], ordered[0] + 2 * math.pi)
        return np.asarray((ordered + following) / 2)

    def passing(self) -> list[float]:
        """Where the tips stand at the levels at which they pass, from the centre outwards."""
        return [(2 * j + 1) * self.h for j in range(self.weave.last, self.weave.first - 1, -1)]


def ideal() -> Ideal:
    """The weave that is drawn."""
    ratio = zigzag_inner_radius(2 * SPIKES, TILT)
    return Ideal(predict(SPIKES, 1.0, ratio), ratio)


def weave_picture(figure: Figure) -> None:
    """Left the kernel of a zigzag star, right the same diagram unrolled."""
    shape = ideal()
    _kernel(figure.add_axes((0.0, 0.02, 0.47, 0.9)), shape)
    _unrolled(figure.add_axes((0.56, 0.14, 0.42, 0.74)), shape)


def _kernel(axes: Axes, shape: Ideal) -> None:
    corners = np.arange(shape.weave.n + 1) * 2 * shape.h
    reach = np.where(np.arange(shape.weave.n + 1) % 2 == 0, 1.0, shape.ratio)
    axes.fill(reach * np.cos(corners), reach * np.sin(corners), color=PALE, zorder=0)
    for k in range(shape.weave.n):
        axes.plot(
            (reach * np.cos(corners))[k : k + 2],
            (reach * np.sin(corners))[k : k + 2],
            color=(BLUE, VERMILLION)[k % 2],
            lw=1.6,
        )
    low, high = shape.weave.tilt + 1e-6, math.pi - shape.weave.tilt - 1e-6
    ends = [high, *shape.passing(), low]
    for before, after in itertools.pairwise(ends):
        _band(axes, shape, np.linspace(before - 1e-9, after + 1e-9, STEPS // 8))
    around = np.linspace(0, 2 * math.pi, STEPS * 2)
    for tip in (*shape.passing(), low):
        _polar(axes, shape, np.full(len(around), tip), around, color=BLACK, lw=0.8)
    _marks(axes, shape)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title("the ideal kernel", loc="center")


def _band(axes: Axes, shape: Ideal, tips: Floats) -> None:
    """Between two passings: the borders (black) and the tips themselves (coloured, dotted)."""
    borders = np.unwrap(np.array([shape.borders(float(tip)) for tip in tips]), axis=0)
    for border in borders.T:
        _polar(axes, shape, tips, border, color=BLACK, lw=0.8)
    for sign, colour in ((1, BLUE), (-1, VERMILLION)):
        for k in range(shape.weave.m):
            direction = 4 * shape.h * k + sign * (shape.h + tips)
            _polar(axes, shape, tips, direction, color=colour, lw=0.7, ls=":")


def _polar(axes: Axes, shape: Ideal, tips: Floats, direction: Floats, **style: Any) -> None:
    apart = np.array(
        [
            shape.aside(float(tip), np.array([one]))[0]
            for tip, one in zip(tips, direction, strict=True)
        ]
    )
    radius = shape.radius(tips, apart)
    axes.plot(radius * np.cos(direction), radius * np.sin(direction), **style)


def _marks(axes: Axes, shape: Ideal) -> None:
    for tip in shape.passing():
        for direction in np.unique(np.round(np.remainder(shape.tips(tip), 2 * math.pi), 9)):
            for aside, marker in ((0.0, "o"), (2 * shape.h, "s")):
                at = direction + aside
                radius = float(shape.radius(np.array(tip), np.array(aside)))
                if aside and radius > shape.ratio * (1 - 1e-9):
                    continue  # the tie of the last passing lies in a corner of the kernel
                axes.plot(
                    radius * math.cos(at), radius * math.sin(at), marker, **_face(marker), zorder=5
                )


def _face(marker: str) -> dict[str, Any]:
    face = "white" if marker == "o" else BLACK
    return {"mfc": face, "mec": BLACK, "ms": 3.4, "mew": 0.8}


def _unrolled(axes: Axes, shape: Ideal) -> None:
    h, weave = shape.h, shape.weave
    low, high = weave.tilt, math.pi - weave.tilt
    tips = np.array([high, low])
    for k in range(-2 * weave.m, 2 * weave.m):
        axes.plot(4 * h * k + h + tips, high - tips, color=BLUE, lw=1.2)
        axes.plot(4 * h * k - h - tips, high - tips, color=VERMILLION, lw=1.2)
    last = 2 * weave.m
    for tip in shape.passing():
        axes.axhline(high - tip, color=GREY, lw=0.7, ls="--")
        met = np.unique(np.round(np.remainder(shape.tips(tip), 4 * h), 9))[0]
        for k in range(-1, weave.m + 1):
            at = met + 4 * h * k
            for place, marker in ((at, "o"), (at + 2 * h, "s")):
                corner = marker == "s" and tip < 4 * h
                if -1e-9 <= place <= 2 * h * last / 2 + 1e-9 and not corner:
                    axes.plot(place, high - tip, marker, **_face(marker), zorder=5)
    axes.set_xlim(0, 2 * h * last / 2)
    axes.set_ylim(0, high - low)
    axes.set_xticks([2 * h * k for k in range(0, weave.n // 2 + 1, 2)])
    axes.set_xticklabels([f"{k}φ" if k else "0" for k in range(0, weave.n // 2 + 1, 2)])
    axes.set_yticks([0, *(high - tip for tip in shape.passing()), high - low])
    axes.set_yticklabels(["centre", *(f"j = {j}" for j in _numbers(weave)), "rim"])
    axes.set_xlabel("direction of the tips (half of the turn)")
    levels = len(shape.passing())
    axes.set_title(f"unrolled: {weave.n} tips, {levels} levels", loc="center")


def _numbers(weave: Weave) -> list[int]:
    return list(range(weave.last, weave.first - 1, -1))
