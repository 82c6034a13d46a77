"""The planted controls: the inequalities of their theorem, and their counts."""

import math

import numpy as np
import pytest

from generators import generate
from tests.generators.exact import distances_to_lines, visual_angles

SAWS = [("control-constant", n) for n in (*range(6, 60), 99, 100, 200, 301, 2000)]
SAWS += [("control-linear", n) for n in (*range(6, 60, 2), 100, 200, 300, 2000)]


def teeth(name: str, n: int) -> int:
    return 3 if name == "control-constant" else n // 2


@pytest.mark.parametrize(("name", "n"), SAWS)
def test_the_inequalities_of_the_theorem(name, n):
    """Steps 1 and 2 of the proof, with room for the default noise."""
    m = teeth(name, n)
    saw = generate(name, n).coordinates
    angle, distance = visual_angles(saw), distances_to_lines(saw)
    flank = np.argsort(angle)[:m]
    back = np.setdiff1d(np.arange(n), flank)
    eta, reach = angle[flank].max(), distance[flank].max() / math.cos(math.pi / m)
    assert angle[back].min() >= 15.9 * eta
    assert distance[back].min() > 1.05 * reach
    assert np.hypot(saw[:, 0], saw[:, 1]).min() > 0.4999
    assert angle[back].min() - 2 * math.asin(2.001 * reach) > 1.05 * eta
    # The flanks are rotations of one another by equal angles.
    turned = np.sort(np.arctan2(saw[flank, 1], saw[flank, 0]) % math.tau)
    gaps = np.diff(np.append(turned, turned[0] + math.tau))
    assert np.allclose(gaps, math.tau / m, rtol=1e-2)


@pytest.mark.parametrize(("name", "n"), [("control-constant", 40), ("control-linear", 40)])
def test_only_flanks_win_and_each_wins_one_sector(name, n):
    """A raster of the kernel in polar coordinates, away from the rim."""
    m = teeth(name, n)
    saw = generate(name, n).coordinates
    angle = visual_angles(saw)
    flank = np.argsort(angle)[:m]
    inradius = distances_to_lines(saw)[flank].min()
    for share in (0.1, 0.5, 0.9):
        turns = np.linspace(0, math.tau, 64 * m, endpoint=False)
        ring = share * inradius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        winners = np.array([np.argmin(visual_angles(saw, p)) for p in ring])
        assert set(winners) == set(flank)
        assert np.count_nonzero(winners != np.roll(winners, 1)) == m


@pytest.mark.parametrize("noise", [0.0, 1e-3, 0.1])
@pytest.mark.parametrize(
    ("name", "n"),
    [("control-constant", n) for n in (6, 7, 10)] + [("control-linear", n) for n in (6, 8, 10)],
)
def test_the_counts_of_the_theorem(name, n, noise):
    from harness.diagram import build
    from harness.geometry.instance import Instance

    m = teeth(name, n)
    counts = build(Instance.from_generated(generate(name, n, 1, noise=noise))).counts
    # Without noise the doubles are still generic: rounding alone splits the centre.
    assert (counts.cells, counts.regions) == (m, m)
    assert counts.vertices == m - 2
    assert dict(counts.degrees) == {3: m - 2}
