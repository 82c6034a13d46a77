"""The half-planes to the left of a polygon's edges: exact lines, and filtered envelopes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.geometry import envelope as loops
from harness.geometry import exact
from harness.geometry.compiling import LARGE, compiled
from harness.geometry.directions import by_direction
from harness.geometry.instance import Instance
from harness.geometry.scaling import scaled


class HalfPlanes:
    """The closed half-planes to the left of an instance's directed segments, by index."""

    def __init__(self, instance: Instance) -> None:
        """Nothing exact is computed before it is asked for."""
        self.instance = instance
        self._ends: dict[int, tuple[exact.ExactPoint, exact.ExactPoint]] = {}

    def ends(self, edge: int) -> tuple[exact.ExactPoint, exact.ExactPoint]:
        """Start and end with flint rationals, the half-plane to the left."""
        found = self._ends.get(edge)
        if found is None:
            a, b = self._numbers(edge)
            found = self._ends[edge] = exact.point(a), exact.point(b)
        return found

    def _numbers(self, edge: int) -> Any:
        """Both endpoints as doubles if these are exact, else as fractions."""
        if self.instance.exact is None:
            return self.instance.segments[edge].tolist()
        return self.instance.rational_segment(edge)

    def direction(self, edge: int) -> exact.ExactPoint:
        """The vector from start to end."""
        (ax, ay), (bx, by) = self.ends(edge)
        return bx - ax, by - ay

    def line(self, edge: int) -> tuple[Any, Any]:
        """Slope and intercept of the boundary line, which must not be vertical."""
        (x, y), _ = self.ends(edge)
        dx, dy = self.direction(edge)
        return dy / dx, y - dy / dx * x

    def meeting(self, i: int, j: int) -> exact.ExactPoint:
        """Where the boundary lines of i and j meet; they must not be parallel."""
        (ax, ay), _ = self.ends(i)
        (cx, cy), _ = self.ends(j)
        (ux, uy), (vx, vy) = self.direction(i), self.direction(j)
        t = ((cx - ax) * vy - (cy - ay) * vx) / (ux * vy - uy * vx)
        return ax + t * ux, ay + t * uy

    def side(self, edge: int, point: exact.ExactPoint) -> int:
        """1 if ``point`` is inside half-plane ``edge``, 0 on its boundary, −1 outside."""
        return exact.orientation(*self.ends(edge), point)

    def left_turn(self, i: int, j: int) -> int:
        """The sign of the cross product of the directions of i and j."""
        (ux, uy), (vx, vy) = self.direction(i), self.direction(j)
        return exact.sign(ux * vy - uy * vx)

    def headings(self, axis: int = 0) -> npt.NDArray[np.int8]:
        """The sign of every direction's component along x (``axis`` 0) or y (1)."""
        if self.instance.exact is None:
            along = self.instance.segments[:, :, axis]
            start, end = along[:, 0], along[:, 1]
            return (end > start).astype(np.int8) - (end < start).astype(np.int8)
        signs = [exact.sign(self.direction(i)[axis]) for i in range(self.instance.n)]
        return np.array(signs, dtype=np.int8)

    def envelope(self, heading: int) -> list[int]:
        """Of the edges that run to the right (``heading`` 1) or to the left (−1), those whose
        half-planes bound the intersection of all of them, sorted by direction.

        Exact; O(m log m) for m edges, of which only those that rounding leaves open are looked
        at in exact arithmetic.
        """
        segments, slack = scaled(self.instance.segments, self.instance.exact is not None)
        edges = np.flatnonzero(self.headings() == heading)
        way = segments[edges, 1] - segments[edges, 0]
        order, same = by_direction(self.instance, edges, heading * way, slack)
        ends: list[Any] = [segments[:, i, j].copy() for i in (0, 1) for j in (0, 1)]
        stack, size = np.zeros(len(order), dtype=np.int64), np.zeros(1, dtype=np.int64)
        state: list[Any] = [order, same, stack, size]
        compile_it = len(order) >= LARGE
        if not compile_it:
            ends, state = ([array.tolist() for array in group] for group in (ends, state))
        self._run(loops.envelope, compile_it, slack, ends, state)
        return [int(edge) for edge in state[2][: int(state[3][0])]]

    def _run(
        self,
        loop: Callable[..., loops.Outcome],
        compile_it: bool,
        slack: float,
        ends: Sequence[Any],
        state: Sequence[Any],
    ) -> None:
        """Run a loop of :mod:`~harness.geometry.envelope`, answering its open questions."""
        run = compiled(loop, *loops.HELPERS) if compile_it else loop

        def step(start: int, known: loops.Known) -> loops.Outcome:
            answers: Any = np.array(known, dtype=np.int64).reshape(-1, 4) if compile_it else known
            outcome: loops.Outcome = run(start, *ends, slack, answers, *state)
            return outcome

        exact.resolve(step, self._answer)

    def _answer(self, i: int, j: int, k: int) -> int:
        """The exact answer to a question of :mod:`~harness.geometry.envelope`."""
        if k == loops.SIDES:
            return self.side(i, self.ends(j)[0])
        return self.side(k, self.meeting(i, j))

    def without_common_interior(self, edges: Sequence[int]) -> tuple[int, ...] | None:
        """Two or three of the given half-planes whose interiors have no common point, or None.

        By Helly's theorem such a choice exists exactly if all interiors have no common point.
        """
        for size in (2, 3):
            for choice in combinations(sorted(set(edges)), size):
                if self._disjoint(choice):
                    return choice
        return None

    def _disjoint(self, choice: tuple[int, ...]) -> bool:
        """Whether two, or three no two of which are, open half-planes have no common point.

        Two: they are opposite and not overlapping.  Three: their directions positively span the
        plane and the corner of two is not inside the third; any other three leave a cone or a
        strip open.
        """
        if len(choice) == 2:
            i, j = choice
            (ux, uy), (vx, vy) = self.direction(i), self.direction(j)
            opposite = ux * vy - uy * vx == 0 and ux * vx + uy * vy < 0
            return opposite and self.side(i, self.ends(j)[0]) <= 0
        i, j, k = choice
        turns = {self.left_turn(i, j), self.left_turn(j, k), self.left_turn(k, i)}
        return turns in ({1}, {-1}) and self.side(k, self.meeting(i, j)) <= 0
