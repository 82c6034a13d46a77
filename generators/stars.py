"""Random star-shaped polygons about the origin: ``star`` and ``near-regular``.

Both list their vertices counter-clockwise by angle, every gap between neighbours well below half
a turn.  Then the origin lies strictly left of every edge and the angle winds round once: the
polygon is simple, star-shaped, and its kernel has interior.  The shortest gap allowed, 2⁻⁴⁸ turn,
is far above the rounding of the coordinates, so this holds of the floats as given.
"""

from __future__ import annotations

import math

import numpy as np

from generators.family import Family, GeneratorError, Interval, Parameter
from generators.portable import Array, Stream, polar

_SHORTEST_GAP = 2.0**-48
_LONGEST_GAP = 0.49


def star(n: int, seed: int = 0, *, radius: str = "uniform", r_min: float = 0.25) -> Array:
    """n vertices at sorted random angles, with random radii in [r_min, 1]; shape (n, 2).

    The angles are independent and uniform, given that no gap between neighbours exceeds 0.49
    turn (so that the origin is in the kernel): the plain random star polygon of the literature.
    The radii are independent, and ``radius`` is their distribution:

    * ``uniform`` — uniform on [r_min, 1];
    * ``area`` — the vertices are uniform on the annulus;
    * ``inverse`` — 1/r is uniform on [1, 1/r_min] (many short radii, a few long);
    * ``two-point`` — r_min or 1, each with probability 1/2.

    The kernel shrinks fast as n grows: some edge is always nearly radial.

    Source: Auer & Held, "Heuristics for the generation of random polygons", CCCG 1996
    (star-shaped polygons about a kernel point); O'Rourke & Virmani, "Generating random
    polygons", 1991.  O(n log n).
    """
    STAR.check(n, {"radius": radius, "r_min": r_min})
    stream = Stream("star", n, seed)
    turns = stream.sorted_turns(n, _SHORTEST_GAP, _LONGEST_GAP)
    u = stream.uniform(n)
    if radius == "uniform":
        radii = np.add(r_min, np.multiply(1.0 - r_min, u))
    elif radius == "area":
        radii = np.sqrt(np.add(r_min * r_min, np.multiply(1.0 - r_min * r_min, u)))
    elif radius == "inverse":
        radii = np.divide(1.0, np.add(1.0, np.multiply(1.0 / r_min - 1.0, u)))
    else:
        radii = np.where(u < 0.5, r_min, 1.0)
    return polar(radii, turns)


def near_regular(n: int, seed: int = 0, *, angular: float = 0.4, radial: float = 0.4) -> Array:
    """The regular n-gon, each vertex jittered in angle and radius by about k/n; shape (n, 2).

    Vertex i lies at (i + angular·u)/n turns and at distance 1 + radial·(2π/n)·v, with u, v
    independent and uniform on [−1/2, 1/2): both jitters are in units of the spacing of the
    vertices, which is what it takes to tilt the edges by an angle that does not depend on n.

    Source: the "slightly perturbed regular polygon" of smoothed analysis; compare Arthur,
    Manthey & Röglin, J. ACM 58 (2011).  O(n).
    """
    NEAR_REGULAR.check(n, {"angular": angular, "radial": radial})
    stream = Stream("near-regular", n, seed)
    shift = np.multiply(np.subtract(stream.uniform(n), 0.5), angular)
    swell = np.multiply(np.subtract(stream.uniform(n), 0.5), radial * (math.tau / n))
    return polar(np.add(1.0, swell), np.add(np.arange(n, dtype=np.float64), shift), n)


def _near_regular_condition(n: int, *, angular: float, radial: float) -> None:
    """No gap above 0.49 turn, no radius below a tenth."""
    if (1.0 + angular) / n > _LONGEST_GAP:
        raise GeneratorError(
            f"near-regular: angular = {angular:g} must be at most "
            f"{_LONGEST_GAP * n - 1.0:g} for n = {n}"
        )
    if radial * math.pi / n > 0.9:
        raise GeneratorError(
            f"near-regular: radial = {radial:g} must be at most {0.9 * n / math.pi:g} for n = {n}"
        )


STAR = Family(
    name="star",
    kind="polygon",
    summary="sorted random angles, independent random radii",
    source="Auer & Held 1996; O'Rourke & Virmani 1991",
    growth="1",
    build=star,
    parameters=(
        Parameter(
            "radius",
            str,
            "uniform",
            "distribution of the radii",
            choices=("uniform", "area", "inverse", "two-point"),
        ),
        Parameter("r_min", float, 0.25, "least radius (the greatest is 1)", Interval(0.001, 1.0)),
    ),
)

NEAR_REGULAR = Family(
    name="near-regular",
    kind="polygon",
    summary="regular polygon with angular and radial jitter of order 1/n",
    source="smoothed analysis, after Arthur, Manthey & Röglin 2011",
    growth="unknown",
    build=near_regular,
    parameters=(
        Parameter(
            "angular", float, 0.4, "spread of the angles, in gaps (1/n turn)", Interval(0.0, 0.99)
        ),
        Parameter(
            "radial", float, 0.4, "spread of the radii, in gaps (2π/n)", Interval(0.0, 1000.0)
        ),
    ),
    condition=_near_regular_condition,
)
