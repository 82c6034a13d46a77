"""Small triangles cut out of diagrams, with what the reference builder sees in them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from harness.diagram import build
from harness.diagram.counts import OBJECTIVES, Objective
from harness.diagram.planar_map import PlanarMap, RationalPoint, Side
from harness.diagram.reference import build_reference
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.geometry.predicates import compare_visual_angles, orientation
from tests.diagram.fast.exact_forms import exact_table
from tests.diagram.map_view import View


@dataclass(frozen=True)
class Cut:
    """Candidates over a triangle; ``tables``: exact L and Q of each, Q negated for ``largest``."""

    candidates: Instance
    objective: Objective
    corners: tuple[RationalPoint, RationalPoint, RationalPoint]

    @property
    def tables(self) -> list[list[Fraction]]:
        corners = [(x, y, Fraction(1)) for x, y in self.corners]
        sense = 1 if self.objective == "smallest" else -1
        return [exact_table(s, corners, sense) for s in self.candidates.rational_segments()]

    def view(self) -> Seen:
        """What is there, exactly."""
        made = build_reference(self.candidates, "interior", self.objective, self.corners)
        return Seen.of(made, self.corners)


@dataclass(frozen=True)
class Seen:
    """A diagram in a triangle as its boundary shows it.

    ``ports``: where edges end on the boundary, counter-clockwise from corner 0, as pairs (place,
    candidate that owns what follows); places 0, 2, 4 are the corners, 1, 3, 5 the sides after them.
    ``partner``: for every port the port at the other end of its edge, or −1 − node.
    """

    ports: list[tuple[int, int]]
    owner_at_start: int
    partner: list[int]
    nodes: list[tuple[str, int]]
    edges: int
    cells: int

    @classmethod
    def of(cls, made: PlanarMap, corners: tuple[RationalPoint, ...]) -> Seen:
        view = View(made)
        following = {here: after for here, (_, _, after) in view.place_on_walk.items()}
        starts = {wall.ends[0]: k for k, wall in enumerate(made.walls)}
        floats = [(float(x), float(y)) for x, y in corners]
        inner = {
            k: n
            for n, k in enumerate(k for k, node in enumerate(made.nodes) if node.kind != "boundary")
        }
        ports: list[tuple[int, int]] = []
        port_of: dict[tuple[int, int], int] = {}
        darts: list[Side] = []
        place, at = -1, floats[0]
        last = [k for k, wall in enumerate(made.walls) if wall.ends[1] == floats[0]]
        if len(starts) < len(made.walls) or len(last) != 1:
            raise ValueError("boundary nodes at one double")
        before = last[0]
        owner_at_start = made.cells[made.walls[before].cell].segment
        for _ in range(len(made.walls)):
            place = 2 * floats.index(at) if at in floats else 2 * (place // 2) + 1
            dart = following[view.number[Side(before, True, is_wall=True)]]
            while not view.sides[dart].is_wall:
                # ``dart`` leaves the boundary; its other side arrives there.
                back = view.twin(view.sides[dart])
                ports.append((place, made.cells[view.cell(view.sides[back])].segment))
                side = view.sides[dart]
                port_of[side.item, int(side.forward)] = len(darts)
                darts.append(side)
                dart = following[back]
            before = starts[at]
            at = made.walls[before].ends[1]
        partner = []
        for side in darts:
            end = view.ends(side)[1]
            assert end is not None
            other = port_of.get((side.item, int(not side.forward)))
            partner.append(-1 - inner[end] if other is None else other)
        return cls(
            ports,
            owner_at_start,
            partner,
            [(made.nodes[k].kind, made.nodes[k].degree) for k in inner],
            len(made.edges),
            len(made.cells),
        )


def _near(rng: random.Random, x: float, y: float, size: float) -> RationalPoint:
    grain = 2.0**-20 * size
    return tuple(  # type: ignore[return-value]  # two long
        Fraction(round((z + size * rng.uniform(-1, 1)) / grain)) * Fraction(grain) for z in (x, y)
    )


def cuts(made: PlanarMap, rng: random.Random, count: int) -> Iterator[Cut]:
    """Triangles about nodes and elsewhere, with up to four candidates."""
    segments = made.instance.rational_segments()
    box = made.instance.segments.reshape(-1, 2)
    size = float((box.max(axis=0) - box.min(axis=0)).max())
    places = [node.point for node in made.nodes if node.kind != "infinity"]
    low, high = box.min(axis=0), box.max(axis=0)
    for _ in range(len(places) // 2 + 4):
        x, y = (rng.uniform(a - size / 2, b + size / 2) for a, b in zip(low, high, strict=True))
        places.append((x, y))
    places = [(x, y) for x, y in places if abs(x) + abs(y) < 1e3 * size + abs(box).max()]
    for _ in range(count if places else 0):
        x, y = rng.choice(places)
        radius = 2.0 ** round(rng.uniform(-9, 1)) * size
        end = rng.choice(rng.choice(segments))
        at_end = rng.random() < 0.4
        if at_end:
            x, y = float(end[0]), float(end[1])
        corners = [_near(rng, x, y, radius) for _ in range(3)]
        if at_end:
            corners[0] = end
        turn = orientation(*corners)
        if turn == 0:
            continue
        if turn < 0:
            corners[1], corners[2] = corners[2], corners[1]
        winners = _winners(made, segments, corners, loser=rng.random() < 0.3)
        if 2 <= len(winners) <= 4:
            chosen = Instance.from_arrays("segments", [segments[k] for k in winners])
            yield Cut(chosen, made.objective, (corners[0], corners[1], corners[2]))


def _winners(
    made: PlanarMap,
    segments: list[tuple[RationalPoint, RationalPoint]],
    t: list[RationalPoint],
    loser: bool,
) -> list[int]:
    """Who wins at some points of a triangle, and perhaps one more."""
    found = set()
    sense = 1 if made.objective == "smallest" else -1
    for a in range(7):
        for b in range(7 - a):
            w = [Fraction(2 * a + 1, 15), Fraction(2 * b + 1, 15)]
            w.append(1 - w[0] - w[1])
            p = tuple(sum(f * c[axis] for f, c in zip(w, t, strict=True)) for axis in range(2))
            best = 0
            for k in range(1, len(segments)):
                order = compare_visual_angles(p, segments[k], segments[best])  # type: ignore[arg-type]  # a point
                if order is not None and order * sense < 0:
                    best = k
            found.add(best)
    if loser and len(found) < 4:
        found.add((min(found) + 1) % len(segments))
    return sorted(found)


def diagrams(rng: random.Random, sources: list[str], seed: int) -> Iterator[PlanarMap]:
    """Reference diagrams of instances from given sources, for ever."""
    from tests.diagram.fast.agreement import domains
    from tests.diagram.fast.sources import instance

    index = 0
    while True:
        made = instance(rng.choice(sources), seed, index)
        index += 1
        domain = "plane" if rng.random() < 0.5 else rng.choice(domains(made))
        objective: Objective = rng.choice(OBJECTIVES)
        try:
            yield build(made, domain, objective, builder="reference")
        except UserError:  # no kernel
            continue
