"""The strategies keep their promises, and do make what they are there to make."""

from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import find, given
from hypothesis import strategies as st

from tests.strategies import (
    concurrent_lines,
    convex_polygons,
    cross,
    degenerate_segment_sets,
    disjoint_subset,
    instances,
    interiors_meet,
    moved,
    polygons,
    rational_segment_sets,
    segment_sets,
    similarities,
    star_polygons,
    star_shaped_about_origin,
    straight_angled_polygons,
    symmetric_polygons,
)

SEGMENTS = segment_sets() | rational_segment_sets() | degenerate_segment_sets()
COUNTER_CLOCKWISE = (
    star_polygons() | convex_polygons() | symmetric_polygons() | straight_angled_polygons()
)


@pytest.mark.parametrize(
    ("s", "t", "meet"),
    [
        (((0, 0), (2, 0)), ((1, -1), (1, 1)), True),
        (((0, 0), (2, 0)), ((1, 0), (1, 1)), False),  # a T-junction
        (((0, 0), (2, 0)), ((2, 0), (3, 0)), False),  # end to end
        (((0, 0), (2, 0)), ((3, 0), (1, 0)), True),
        (((0, 0), (2, 0)), ((0, 0), (0, 1)), False),
        (((0, 0), (2, 2)), ((2, 2), (0, 0)), True),
        (((0, 0), (2, 0)), ((0, 1), (2, 1)), False),
    ],
)
def test_interiors_meet(s, t, meet):
    assert interiors_meet(s, t) is meet
    assert interiors_meet(t, s) is meet


@given(SEGMENTS)
def test_segments_have_disjoint_interiors(instance):
    kind, segments = instance
    assert kind == "segments"
    assert 1 <= len(segments) <= 5
    assert all(a != b for a, b in segments)
    assert not any(interiors_meet(s, t) for s, t in combinations(segments, 2))


@given(st.integers(1, 6).flatmap(lambda k: st.tuples(st.just(k), segment_sets(k, 6))))
def test_least_size_is_reached(pair):
    least, (_, segments) = pair
    assert least <= len(segments) <= 6
    assert not any(interiors_meet(s, t) for s, t in combinations(segments, 2))


@given(COUNTER_CLOCKWISE)
def test_polygons_are_star_shaped_about_the_origin(instance):
    kind, vertices = instance
    assert kind == "polygon"
    assert 3 <= len(vertices) <= 8
    assert star_shaped_about_origin(vertices)
    # Winding once round the origin makes a star-shaped closed curve a simple polygon.
    crossings = sum(
        (p[1] < 0) != (q[1] < 0) for p, q in zip(vertices, vertices[1:] + vertices[:1], strict=True)
    )
    assert crossings == 2


@given(convex_polygons())
def test_convex_polygons_are_strictly_convex(instance):
    _, v = instance
    assert all(cross(v[i - 2], v[i - 1], v[i]) > 0 for i in range(len(v)))


@given(instances(), similarities())
def test_similarities_keep_validity_and_scale_areas(instance, similarity):
    kind, image = moved(instance, similarity)
    a, b, *_ = similarity
    factor = a * a + b * b
    if kind == "segments":
        assert disjoint_subset(image) == image
        sample = [p for s in instance[1] for p in s], [p for s in image for p in s]
    else:
        sample = instance[1], image
    before, after = (points[:2] + points[-1:] for points in sample)
    assert cross(*after) == factor * cross(*before)


def test_degenerate_configurations_do_occur():
    """Ties are what the diagram is tested for: each kind must be within reach of the strategies."""

    def lines_meet_at_one_point(instance):
        return len(instance[1]) >= 3 and len({s[0] for s in instance[1]}) == 1

    def t_junction(instance):
        return any(
            cross(*s, p) == 0 and min(s) < p < max(s)
            for s in instance[1]
            for t in instance[1]
            for p in t
        )

    find(degenerate_segment_sets(), lines_meet_at_one_point)
    find(degenerate_segment_sets(), t_junction)
    find(concurrent_lines(), lambda segments: len(segments) >= 3)
    find(star_polygons(), lambda instance: len(instance[1]) == 3)
    find(polygons(), lambda instance: len(instance[1]) == 8)
    find(symmetric_polygons(), lambda instance: len(instance[1]) == 8)
    find(
        rational_segment_sets(),
        lambda instance: any(
            isinstance(z, Fraction) and z.denominator > 1 for s in instance[1] for p in s for z in p
        ),
    )
