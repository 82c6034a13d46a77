"""What the fast builder did, and how it says that it could not."""

from __future__ import annotations

from dataclasses import dataclass


class Contradiction(ArithmeticError):
    """Free points were not free enough, or a part of the fast builder is wrong."""


class Hopeless(Contradiction):
    """The instance is so degenerate that other free points would not help."""


@dataclass(frozen=True)
class Work:
    """The work behind one diagram.

    ``triangles``: triangles examined.  ``tests``: pairs of candidates compared on a triangle.
    ``leaves``: triangles in which the diagram was read off, of which ``by_floats`` by double
    arithmetic alone, ``by_balls`` with a sign from ball arithmetic, ``exactly`` by algebra.
    """

    triangles: int
    tests: int
    leaves: int
    by_floats: int
    by_balls: int
    exactly: int
    workers: int
