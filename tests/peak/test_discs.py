"""Intersections of discs against brute force, and what must hold of any of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.peak import meet

CLOSE = 1e-7


def brute_force(z: np.ndarray, r: np.ndarray) -> list[tuple[float, float, int, int]]:
    """All crossings of two circles that lie in all other discs, with the two."""
    found = []
    for i in range(len(z)):
        for j in range(i):
            d = z[j] - z[i]
            distance = np.hypot(*d)
            if not abs(r[i] - r[j]) < distance < r[i] + r[j]:
                continue
            along = (distance**2 + r[i] ** 2 - r[j] ** 2) / (2 * distance)
            across = np.sqrt(max(0.0, r[i] ** 2 - along**2))
            for side in (1, -1):
                p = z[i] + (along * d + side * across * np.array([-d[1], d[0]])) / distance
                others = [k for k in range(len(z)) if k not in (i, j)]
                if (np.hypot(*(z[others] - p).T) <= r[others]).all():
                    found.append((*p, i, j))
    return found


@st.composite
def discs(draw):
    """Random discs; half of the time around a common point."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    n = draw(st.integers(1, 14))
    centres = rng.normal(size=(n, 2))
    if draw(st.booleans()):
        return centres, np.hypot(*centres.T) + rng.uniform(0.0, draw(st.floats(1e-3, 1.0)), n)
    return centres, rng.uniform(0.3, 3, n)


@given(discs())
@settings(max_examples=150)
def test_it_is_what_brute_force_finds(given_discs):
    centres, radii = given_discs
    found = meet(centres, radii)
    crossings = brute_force(centres, radii)
    for x, y, _, _ in crossings:
        assert np.hypot(*(found.vertices - (x, y)).T).min() < CLOSE
    if crossings:
        assert found.arcs() == sorted({k for crossing in crossings for k in crossing[2:]})
    for x, y in found.vertices:  # all others are the leftmost and rightmost points of discs
        if not any(np.hypot(x - p[0], y - p[1]) < CLOSE for p in crossings):
            ends = np.abs(np.abs(centres[:, 0] - x) - radii) + np.abs(centres[:, 1] - y)
            assert ends.min() < CLOSE


@given(discs())
@settings(max_examples=100)
def test_vertices_and_arcs_alternate_by_increasing_x(given_discs):
    centres, radii = given_discs
    found = meet(centres, radii)
    assert len(found.upper) == len(found.lower) == max(0, len(found.vertices) - 1)
    if found.is_empty:
        return
    x = found.vertices[:, 0]
    assert (np.diff(x) > 0).all()
    same = (found.upper[1:] == found.upper[:-1]) & (found.lower[1:] == found.lower[:-1])
    assert not same.any()
    middle = (x[1:] + x[:-1]) / 2
    tops, bottoms = (
        centres[arcs, 1]
        + sign * np.sqrt(np.maximum(0, radii[arcs] ** 2 - (middle - centres[arcs, 0]) ** 2))
        for arcs, sign in ((found.upper, 1), (found.lower, -1))
    )
    assert (bottoms <= tops).all()
    for y in (tops, bottoms, (tops + bottoms) / 2):
        points = np.stack([middle, y], axis=1)
        distances = np.hypot(*(points[:, np.newaxis] - centres).transpose(2, 0, 1))
        assert (distances <= radii + CLOSE).all()


@given(discs(), st.integers(0, 2**32))
def test_the_order_of_the_discs_does_not_matter(given_discs, seed):
    centres, radii = given_discs
    order = np.random.default_rng(seed).permutation(len(radii))
    one, other = meet(centres, radii), meet(centres[order], radii[order])
    assert one.vertices == pytest.approx(other.vertices, abs=CLOSE)
    assert one.upper.tolist() == order[other.upper].tolist()


def test_one_disc_and_equal_discs():
    for count in (1, 2, 5):
        found = meet([(1, 2)] * count, [3] * count)
        assert found.vertices.tolist() == [[-2, 2], [4, 2]]
        assert found.arcs() == [0]


def test_a_lens_and_nothing():
    lens = meet([(-1, 0), (1, 0)], [2**0.5, 2**0.5])
    assert lens.vertices[[0, -1], 0] == pytest.approx([1 - 2**0.5, 2**0.5 - 1])
    assert lens.arcs() == [0, 1]
    assert meet([(-2, 0), (2, 0)], [1, 1]).is_empty


@pytest.mark.parametrize(
    ("centres", "radii", "reason"),
    [
        (np.empty((0, 2)), [], "centres"),
        ([(0, 0)], [1, 2], "centres"),
        ([(0, 0), (1, 1)], [1, 0], "disc 1"),
        ([(0, 0), (np.nan, 1)], [1, 1], "disc 1"),
    ],
)
def test_what_is_no_disc_is_refused(centres, radii, reason):
    with pytest.raises(UserError, match=reason):
        meet(centres, radii)
