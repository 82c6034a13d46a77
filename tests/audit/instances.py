"""Instances whose verdicts are known."""

from harness.geometry.instance import Instance


def polygon(*vertices) -> Instance:
    return Instance.from_arrays("polygon", vertices)


def segments(*rows) -> Instance:
    return Instance.from_arrays("segments", rows)


SQUARE = polygon((0, 0), (1, 0), (1, 1), (0, 1))
TRIANGLE = polygon((0, 0), (4, 0), (1, 3))
#: An arrow head: not convex, star-shaped.
DART = polygon((0, 0), (2, 1), (0, 2), (1, 1))
#: The line of each meets the other's outside both.
CROSSING = segments(((0, 0), (1, 0)), ((3, 1), (3, 2)))
#: The line of the first meets the second inside: the first owns one cell.
TEE = segments(((0, 0), (1, 0)), ((3, -1), (3, 1)))
#: Their lines meet outside both, yet the second owns one cell.
BESIDE = segments(((0, 0), (2, 0)), ((0, 1), (1, 2)))
PARALLEL = segments(((0, 0), (1, 0)), ((0, 1), (1, 1)))
#: In its kernel the edge of segments 0 and 3 has a local minimum of θ.
VALLEY = polygon((3, 8), (-3, 2), (0, -8), (3, -6), (5, -3))
