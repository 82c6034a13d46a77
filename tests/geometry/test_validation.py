"""Validation accepts exactly the proper instances, and names real offenders otherwise."""

import re
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.geometry import sweep, validation
from harness.geometry.instance import Instance
from harness.geometry.validation import validate
from tests.geometry.shapes import conflicting_pairs, lattice_polygons, lattice_segments, turn


def complaint(instance):
    """The message of the refusal, or None."""
    try:
        validate(instance)
    except UserError as error:
        return str(error)
    return None


def check_against_oracle(instance):
    if instance.kind == "polygon" and instance.n < 3:
        assert "at least 3" in complaint(instance)
        return
    message = complaint(instance)
    segments = [tuple(sorted(pair)) for pair in instance.rational_segments()]
    if len({p for pair in segments for p in pair}) < instance.n and instance.kind == "polygon":
        i, j = named(message)
        assert "repeated vertex" in message
        assert instance.exact_vertex(i) == instance.exact_vertex(j)
    elif any(a == b for a, b in segments):
        assert segments[named(message)[0]][0] == segments[named(message)[0]][1]
        assert "length zero" in message
    elif len(set(segments)) < len(segments):
        i, j = named(message)
        assert "duplicate" in message
        assert segments[i] == segments[j]
    else:
        pairs = conflicting_pairs(instance)
        assert (message is not None) == bool(pairs)
        if pairs:
            assert named(message) in pairs
            assert ("overlap" in message) == (
                not any(turn(*segments[named(message)[0]], p) for p in segments[named(message)[1]])
            )


def named(message):
    """The indices in a message."""
    return tuple(map(int, re.findall(r"\d+", message.replace("(counting from 0)", ""))))


@given(st.one_of(lattice_polygons(), lattice_segments()))
def test_agrees_with_all_pairs_in_fractions(instance):
    check_against_oracle(instance)


def test_compiled_sweep_agrees_too(monkeypatch):
    monkeypatch.setattr(validation, "LARGE", 0)
    instances = st.one_of(lattice_polygons(), lattice_segments())
    settings(deadline=None)(given(instances)(check_against_oracle))()


@pytest.mark.parametrize(
    ("kind", "rows", "reason"),
    [
        ("polygon", [], "at least 3 vertices, not 0"),
        ("polygon", [[0, 0], [1, 0]], "at least 3 vertices, not 2"),
        ("polygon", [[0, 0], [1, 0], [1, 0], [0, 1]], "vertices 1 and 2"),
        ("polygon", [[0, 0], [2, 0], [1, 1], [2, 2], [1, 1]], "vertices 2 and 4"),
        ("polygon", [[0, 0], [1, 0], [0, 1], [0, 0]], "closing repeat"),
        ("polygon", [[0, 0], [2, 2], [2, 0], [0, 2]], "edges 0 and 2 (counting from 0) cross"),
        ("polygon", [[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], "(counting from 0) touch"),
        ("polygon", [[0, 0], [1, 1], [2, 2]], "(counting from 0) overlap"),
        ("polygon", [[0, 0], [4, 0], [4, 4], [4, 2]], "the polygon intersects itself"),
        ("segments", [], "no segments"),
        ("segments", [[[0, 0], [0, 0]]], "segment 0 (counting from 0) has length zero"),
        ("segments", [[[0, 0], [1, 0]], [[1, 0], [0, 0]]], "segments 0 and 1"),
        ("segments", [[[0, 0], [2, 2]], [[0, 2], [2, 0]]], "cross"),
        ("segments", [[[0, 0], [2, 0]], [[1, 0], [3, 0]]], "overlap"),
    ],
)
def test_names_index_and_reason(kind, rows, reason):
    message = complaint(Instance.from_arrays(kind, rows, source="in.json"))
    assert message.startswith("in.json: ")
    assert reason in message
    assert "\n" not in message


@pytest.mark.parametrize(
    "rows",
    [
        [[[0, 0], [2, 0]], [[1, 0], [1, 3]]],  # an endpoint inside another segment
        [[[0, 0], [2, 0]], [[1, 0], [1, 3]], [[1, 0], [1, -3]], [[0, 0], [0, 1]]],
        [[[0, 0], [1, 0]], [[1, 0], [2, 0]]],  # collinear, sharing an endpoint
        [[["0", "1e-300"], ["1e300", "1e-300"]], [[0, 0], ["1e300", 0]]],
    ],
)
def test_touching_segments_are_accepted(rows):
    validate(Instance.from_arrays("segments", rows))


def test_a_hair_decides_at_any_scale():
    """A spike's tip a single unit in the last place over or under the opposite edge."""
    for scale in (1.0, 1e-300, 2.0**1000, 1e150):
        inside = [[0, 0], [3, 1], [3, 3], [2, np.nextafter(2 / 3, 1)], [0, 3]]
        outside = [[0, 0], [3, 1], [3, 3], [2, np.nextafter(2 / 3, 0)], [0, 3]]
        assert complaint(Instance.from_arrays("polygon", np.array(inside) * scale)) is None
        assert "cross" in complaint(Instance.from_arrays("polygon", np.array(outside) * scale))
        exactly = [[0, 0], [3, 1], [3, 3], [2, Fraction(2, 3)], [0, 3]]
        assert "touch" in complaint(Instance.from_arrays("polygon", exactly))


def test_planted_crossing_is_found_among_many():
    """One crossing planted into a large polygon, at every kind of place."""
    n = 3000
    angle = 2 * np.pi * np.arange(n) / n
    rng = np.random.default_rng(5)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) * rng.uniform(0.5, 1, (n, 1))
    validate(Instance.from_arrays("polygon", ring))
    for k in (0, 1, 1234, n - 1):
        planted = ring.copy()
        planted[k] *= -3  # its two edges now cross the whole ring
        instance = Instance.from_arrays("polygon", planted)
        i, j = named(complaint(instance))
        (a, b), (c, d) = instance.rational_segment(i), instance.rational_segment(j)
        assert turn(a, b, c) * turn(a, b, d) <= 0
        assert turn(c, d, a) * turn(c, d, b) <= 0


def test_long_slanted_comb_is_simple():
    """Bounding boxes all overlap; exact collinearities abound (teeth end on common lines)."""
    teeth = np.arange(700)
    low, high = np.stack([2 * teeth, 0 * teeth], 1), np.stack([2 * teeth + 1, 0 * teeth + 5000], 1)
    rows = np.concatenate([np.stack([low, high], 1).reshape(-1, 2), [[9999, 5000], [9999, -1]]])
    rotated = np.concatenate([rows, [[0, -1]]]) @ np.array([[4, 3], [-3, 4]])
    validate(Instance.from_arrays("polygon", rotated))


coordinate = st.floats(-1, 1)


@given(st.lists(coordinate, min_size=6, max_size=6))
@example([0.0, 0.0, 0.1, 0.3, 0.2, 0.6])
@example([0.5, 0.5, 12.0 / 16, 12.0 / 16, 24.0 / 32, 0.75 + 2.0**-53])
def test_filter_is_never_wrong(values):
    """The filter says nothing but the truth, and is sure wherever differences are exact."""
    x, y = values[::2], values[1::2]
    truth = turn(*(tuple(map(Fraction, p)) for p in zip(x, y, strict=True)))
    assert sweep.turn(x, y, 0.0, [], 0, 1, 2) in (truth, sweep.UNSURE)
    assert sweep.turn(x, y, 2.0**-50, [], 0, 1, 2) in (truth, sweep.UNSURE)


@given(st.lists(st.integers(-(2**52), 2**52), min_size=6, max_size=6))
@example([0, 0, 3**30, 3**31, 3**32, 3**33])
def test_filter_always_decides_on_integers(values):
    x = [v / 2.0**52 for v in values[::2]]
    y = [v / 2.0**52 for v in values[1::2]]
    points = list(zip(values[::2], values[1::2], strict=True))
    assert sweep.turn(x, y, 0.0, [], 0, 1, 2) == turn(*points)
