"""Polygons for the tests of peaks, and plain means of looking at them."""

import math

import numpy as np

import generators
from harness.geometry.instance import Instance
from harness.geometry.kernel import kernel
from harness.geometry.visual_angle import visual_angle

#: Families of star-shaped polygons.
STARS = [name for name, family in generators.FAMILIES.items() if family.kind == "polygon"]


def generated(family: str, n: int, seed: int) -> np.ndarray | None:
    """Vertices, shape (n, 2); None if the family has no such size."""
    try:
        return np.asarray(generators.generate(family, n, seed).coordinates)
    except generators.GeneratorError:
        return None


def regular(n: int) -> np.ndarray:
    """A regular n-gon about the origin, in doubles."""
    turns = 2 * math.pi * np.arange(n) / n
    return np.stack([np.cos(turns), np.sin(turns)], axis=1)


def segments_of(vertices: np.ndarray) -> np.ndarray:
    """Segment i from vertex i to vertex i + 1, shape (n, 2, 2)."""
    return np.stack([vertices, np.roll(vertices, -1, axis=0)], axis=1)


def least_angles(points: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """The least visual angle from each point, shape (m,)."""
    return visual_angle(points[:, np.newaxis], segments_of(vertices)).min(axis=1)


def kernel_points(vertices: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Random points of the kernel (not uniform), shape (count, 2)."""
    corners = kernel(Instance.from_arrays("polygon", vertices.tolist())).floats
    return rng.dirichlet(np.full(len(corners), 0.5), count) @ corners


#: Name: (vertices, angle, point); worked out by hand.
KNOWN = {
    "square": ([(0, 0), (1, 0), (1, 1), (0, 1)], math.pi / 2, (0.5, 0.5)),
    "equilateral triangle": (
        [(0, 0), (2, 0), (1, math.sqrt(3))],
        2 * math.pi / 3,
        (1, math.sqrt(3) / 3),
    ),
    # An angle γ of at least 120°: the vertex itself, π − γ/2.
    "obtuse triangle": (
        [(0, 0), (10, 0), (-3, 4)],
        math.pi - math.atan2(4, -3) / 2,
        (0, 0),
    ),
    # A reflex vertex of 270°, from which the others are seen under at least π − 135°.
    "letter L": ([(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)], math.pi / 4, (0, 0)),
    # The legs lean inwards: best seen from the base, on which the point lies.
    "low trapezoid": ([(-1, 0), (1, 0), (0.9, 0.1), (-0.9, 0.1)], math.atan2(0.1, 0.9), (0, 0)),
    # Two edges decide: the short sides, tangent circles in the middle.
    "oblong": ([(0, 0), (8, 0), (8, 1), (0, 1)], 2 * math.atan2(0.5, 4), (4, 0.5)),
}
