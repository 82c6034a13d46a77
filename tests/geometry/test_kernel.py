"""Kernels against clipping in fractions, known cases, invariances and witnesses."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.geometry import halfplanes
from harness.geometry.instance import Instance
from harness.geometry.kernel import kernel, why_not_star_shaped
from harness.geometry.validation import validate
from tests.geometry.shapes import clipped, lattice_polygons, turn


def polygon(*vertices):
    return Instance.from_arrays("polygon", [list(vertex) for vertex in vertices])


def check_against_clipping(instance):
    assume(instance.n >= 3 and instance.orientation != 0)
    found, expected = kernel(instance), clipped(instance)
    assert found.dimension == min(len(expected) - 1, 2)
    assert set(found.corners) == set(expected)
    assert found.is_empty == (not expected)
    if found.has_interior:
        check_sides(instance, found)
        assert why_not_star_shaped(instance, found) is None
    else:
        assert found.sides == []
        assert len(found.witness) in (2, 3)
        assert len(clipped(instance, found.witness)) < 3
        message = why_not_star_shaped(instance, found)
        assert all(str(edge) in message for edge in found.witness)


def check_sides(instance, found):
    """Corners turn left; side k lies on the line of its edge, and runs along it."""
    segments, size = instance.rational_segments(), len(found.corners)
    assert len(found.sides) == size >= 3
    for k, edge in enumerate(found.sides):
        start, end = found.corners[k], found.corners[(k + 1) % size]
        assert turn(found.corners[k - 1], start, end) > 0
        a, b = segments[edge]
        assert turn(a, b, start) == 0 == turn(a, b, end)
        assert (b[0] - a[0]) * (end[0] - start[0]) + (b[1] - a[1]) * (end[1] - start[1]) > 0


@given(lattice_polygons())
def test_agrees_with_clipping(instance):
    check_against_clipping(instance)


def test_compiled_envelopes_agree_too(monkeypatch):
    monkeypatch.setattr(halfplanes, "LARGE", 0)
    settings(deadline=None)(given(lattice_polygons())(check_against_clipping))()


def test_convex_polygon_is_its_own_kernel():
    found = kernel(polygon((0, 0), (4, 0), (5, 3), (1, 6)))
    assert found.sides == [0, 1, 2, 3]
    assert set(found.corners) == {(0, 0), (4, 0), (5, 3), (1, 6)}
    assert found.floats.shape == (4, 2)


def test_an_l_has_a_square_kernel():
    found = kernel(polygon((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)))
    assert set(found.corners) == {(0, 0), (1, 0), (1, 1), (0, 1)}
    assert sorted(found.sides) == [0, 2, 3, 5]


def test_dimensions_of_kernels_without_interior():
    square_spiral = ((0, 0), (5, 0), (5, 5), (1, 5), (1, 2), (3, 2), (3, 3), (2, 3), (2, 4))
    empty = polygon(*square_spiral, (4, 4), (4, 1), (0, 1))
    validate(empty)
    assert kernel(empty).is_empty
    assert "empty" in why_not_star_shaped(empty)
    # the inner walls of a Z stand exactly over each other: it is seen from a segment
    segment = polygon((0, 0), (2, 0), (2, 2), (3, 2), (3, 4), (1, 4), (1, 2), (0, 2))
    validate(segment)
    narrowed = polygon((0, 0), (2, 0), (2, 2), (4, 2), (4, 4), (2, 4), (2, 3), (0, 3))
    validate(narrowed)
    assert kernel(narrowed).dimension == 1
    assert set(kernel(narrowed).corners) == {(2, 2), (2, 3)}
    assert "a segment, without interior" in why_not_star_shaped(narrowed)
    point = pinwheel(0)
    validate(point)
    assert kernel(point).corners == [(0, 0)]
    assert "a point, without interior" in why_not_star_shaped(point)
    assert kernel(pinwheel(Fraction(1, 10**30))).dimension == 2
    assert kernel(pinwheel(-Fraction(1, 10**30))).is_empty


def pinwheel(gap):
    """Four blades with walls on lines that miss the centre by ``gap``, all on the same side."""
    blade = [(1, -gap), (4, -gap), (4, 3)]
    return polygon(
        *(rotate(vertex, quarter) for quarter in range(4) for vertex in blade),
    )


def rotate(point, quarters):
    x, y = point
    for _ in range(quarters):
        x, y = -y, x
    return x, y


similarities = st.sampled_from(
    [
        lambda x, y: (3 * x - 4 * y, 4 * x + 3 * y),
        lambda x, y: (x + 1000, y - 777),
        lambda x, y: (x * 1024, y * 1024),
        lambda x, y: (-y, x),
    ]
)


@given(
    st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=3, max_size=8),
    similarities,
    st.integers(0, 7),
    st.booleans(),
)
def test_invariant_under_similarity_relabelling_and_reversal(points, move, shift, reverse):
    original = polygon(*points)
    assume(original.orientation != 0)
    try:
        validate(original)
    except UserError:
        assume(False)
    order = [(k + shift) % len(points) for k in range(len(points))]
    order = order[::-1] if reverse else order
    moved = polygon(*(move(*points[k]) for k in order))
    assert set(kernel(moved).corners) == {move(*corner) for corner in kernel(original).corners}
    assert moved.orientation == (-original.orientation if reverse else original.orientation)


def test_large_star_polygons_from_their_own_construction():
    """The centre of a star polygon is in its kernel; every corner satisfies every edge."""
    rng = np.random.default_rng(8)
    for n in (100, 3000):
        angles = np.sort(rng.uniform(0, 2 * np.pi, n))
        radii = rng.uniform(0.5, 1, n)
        ring = np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)
        for points in (ring, ring[::-1], ring + 2.0**20):
            instance = Instance.from_arrays("polygon", points)
            found = kernel(instance)
            check_sides(instance, found)
            segments = instance.rational_segments()
            for corner in found.corners:
                assert all(turn(a, b, corner) >= 0 for a, b in segments)


def test_regular_polygons_in_floats_are_mostly_convex_and_exactly_decided():
    """Thousands of nearly parallel sides and nearly concurrent triples."""
    n = 4096
    angles = 2 * np.pi * np.arange(n) / n
    ring = Instance.from_arrays("polygon", np.stack([np.cos(angles), np.sin(angles)], axis=1))
    found = kernel(ring)
    segments = ring.rational_segments()
    convex = all(turn(*segments[k - 1], segments[k][1]) > 0 for k in range(n))
    assert convex == (len(found.sides) == n)
    check_sides(ring, found)


def test_two_sides_that_are_parallel_but_for_a_hair():
    """Directions that no double tells apart still turn."""
    hair = Fraction(1, 10**40)
    found = kernel(polygon((0, 0), (4, 0), (8, hair), (8, 4), (0, 4)))
    assert found.sides == [0, 1, 2, 3, 4]
    bent = kernel(polygon((0, 0), (4, 0), (8, -hair), (8, 4), (0, 4)))
    assert bent.sides == [1, 0, 2, 3, 4]
    straight = kernel(polygon((0, 0), (4, 0), (8, 0), (8, 4), (0, 4)))
    assert straight.sides[0] == 0
    assert len(straight.sides) == 4


@pytest.mark.parametrize(
    "instance",
    [
        Instance.from_arrays("segments", [[[0, 0], [1, 0]]]),
        polygon((0, 0), (1, 1), (2, 2)),
        polygon((0, 0), (1, 1)),
    ],
)
def test_no_kernel_without_area(instance):
    with pytest.raises(UserError):
        kernel(instance)
