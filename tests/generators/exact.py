"""Exact checks of polygons and segments given as doubles, for the tests of the families."""

from fractions import Fraction

import numpy as np


def exact_points(coordinates):
    """The doubles of an (n, 2) array as pairs of Fractions."""
    return [(Fraction(x), Fraction(y)) for x, y in coordinates.tolist()]


def left_of_edges(vertices, point=(Fraction(0), Fraction(0))):
    """Whether ``point`` lies strictly left of every edge."""
    px, py = point
    following = vertices[1:] + vertices[:1]
    return all(
        (bx - ax) * (py - ay) > (by - ay) * (px - ax)
        for (ax, ay), (bx, by) in zip(vertices, following, strict=True)
    )


def rounds_once(vertices):
    """Whether the closed polygon winds round the origin exactly once, given left_of_edges."""
    following = vertices[1:] + vertices[:1]
    return sum((p[1] < 0) != (q[1] < 0) for p, q in zip(vertices, following, strict=True)) == 2


def turns_left_everywhere(vertices):
    """Whether the closed polygon turns strictly left at every vertex, and once in all."""
    n = len(vertices)
    steps = [
        (vertices[(i + 1) % n][0] - x, vertices[(i + 1) % n][1] - y)
        for i, (x, y) in enumerate(vertices)
    ]
    left = all(steps[i - 1][0] * steps[i][1] > steps[i - 1][1] * steps[i][0] for i in range(n))
    upward = [dy > 0 or (dy == 0 and dx > 0) for dx, dy in steps]
    return left and sum(upward[i - 1] != upward[i] for i in range(n)) == 2


def distances_to_lines(coordinates):
    """Float distance of the origin from the line of every edge."""
    edge = np.roll(coordinates, -1, axis=0) - coordinates
    area = coordinates[:, 0] * edge[:, 1] - coordinates[:, 1] * edge[:, 0]
    return area / np.hypot(edge[:, 0], edge[:, 1])


def tilts(coordinates):
    """Tilt of every edge at its middle, in radians, positive where the radius grows."""
    following = np.roll(coordinates, -1, axis=0)
    edge, middle = following - coordinates, (following + coordinates) / 2
    along = (edge * middle).sum(axis=1)
    across = middle[:, 0] * edge[:, 1] - middle[:, 1] * edge[:, 0]
    return np.arctan2(along, across)


def visual_angles(coordinates, at=(0.0, 0.0)):
    """Visual angle of every edge from a point left of all of them."""
    a = coordinates - np.asarray(at)
    b = np.roll(a, -1, axis=0)
    return np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))
