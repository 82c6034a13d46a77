"""Where the ports inside a side of a leaf are: as doubles, and exactly.

In a leaf that was proved, every zero of the contests of two neighbours on a side is simple, and is
a port (:mod:`harness.diagram.fast.sides`).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from flint import arb

from harness.diagram.fast.forms import SIDES
from harness.diagram.fast.univariate import Zero, isolated_zeros, rounded, zeros_inside

if TYPE_CHECKING:
    from harness.diagram.fast.chart import Chart


class PortOnSide(NamedTuple):
    """A port inside a side of its leaf.

    ``position``: the corner from which the side starts.  ``along``: the parameter, as a double.
    ``sign``: the curve F^± (0 if the segments share a line) that passes through it.
    """

    position: int
    along: float
    sign: int


def port_on_side(chart: Chart, port: int) -> PortOnSide:
    """Where a port with an odd place is on its side.

    Doubles find the zeros of most contests; where they do not find all, integers do.
    """
    place = int(chart.diagram.arrays.place[port])
    position = place // 2
    here = _ports_of_pair(chart, port)
    zeros = sorted(
        (t, which)
        for which, exact in _on_side(chart, port, position)
        for t in zeros_inside(rounded(exact))
    )
    if len(zeros) == len(here):
        return PortOnSide(position, *zeros[here.index(port)])
    zero, which = exact_ports(chart, place)[port]
    zero.narrow(80)
    return PortOnSide(position, float((zero.low + zero.high) / 2), which)


def port_ball(chart: Chart, port: int, bits: int) -> Any:
    """An enclosure of the parameter of a port along its side, of radius about 2^−bits."""
    zero, _ = exact_ports(chart, int(chart.diagram.arrays.place[port]))[port]
    zero.narrow(bits)
    low, high = (arb(x.numerator) / x.denominator for x in (zero.low, zero.high))
    return low.union(high)


def exact_ports(chart: Chart, place: int) -> dict[int, tuple[Zero, int]]:
    """The ports of an (odd) place in their order: the zero, and the curve F^±.

    The intervals are disjoint and inside (0, 1).  Raises ArithmeticError if a pair has not as many
    zeros as ports.
    """
    arrays = chart.diagram.arrays
    base, count = int(arrays.start[chart.leaf]), int(arrays.ports[chart.leaf])
    ports = [p for p in range(base, base + count) if arrays.place[p] == place]
    found: dict[int, tuple[Zero, int]] = {}
    for port in ports:
        if port in found:
            continue
        mine = _ports_of_pair(chart, port)
        zeros = [
            (zero, which)
            for which, exact in _on_side(chart, port, place // 2)
            for zero in isolated_zeros(exact)
        ]
        if len(zeros) != len(mine):
            raise ArithmeticError(f"{len(mine)} ports of a pair near port {port}, not {len(zeros)}")
        _separate(zeros)
        found |= dict(zip(mine, sorted(zeros, key=lambda zero: zero[0].low), strict=True))
    for zero, _ in found.values():
        while zero.low <= 0 or zero.high >= 1:
            zero.refine()
    for one, other in pairwise(ports):
        low, high = found[one][0], found[other][0]
        while low.high >= high.low:
            low.refine()
            high.refine()
    return {port: found[port] for port in ports}


def _separate(zeros: list[tuple[Zero, int]]) -> None:
    """Refine the zeros of two curves until their intervals are disjoint."""
    for k, (one, which) in enumerate(zeros):
        for other, _ in (z for z in zeros[:k] if z[1] != which):
            while one.low <= other.high and other.low <= one.high:
                one.refine()
                other.refine()


def _ports_of_pair(chart: Chart, port: int) -> list[int]:
    """The ports of the same pair of segments at the same place, in their order."""
    arrays = chart.diagram.arrays
    base, count = int(arrays.start[chart.leaf]), int(arrays.ports[chart.leaf])
    pair, place = set(chart.pair(port)), arrays.place[port]
    return [
        p
        for p in range(base, base + count)
        if arrays.place[p] == place and set(chart.pair(p)) == pair
    ]


def _on_side(chart: Chart, port: int, position: int) -> Iterator[tuple[int, list[Any]]]:
    """The curves of a port's pair on a side: sign, and Bernstein coefficients along it."""
    i, j = sorted(chart.pair(port))
    for which in chart.signs(i, j):
        cubic = chart.cubic(i, j, which)
        yield which, [cubic[c] for c in SIDES[(position + 2) % 3]]
