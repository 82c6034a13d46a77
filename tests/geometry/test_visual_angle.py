"""The visual angle in floating point: identities with independent definitions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.geometry.visual_angle import L, Q, cot_visual_angle, visual_angle

unit = st.floats(-1, 1)


def test_thales_and_inscribed_angles():
    diameter = np.array([[-1.0, 0.0], [1.0, 0.0]])
    t = np.linspace(0.1, 3, 50)
    circle = np.stack([np.cos(t), np.sin(t)], axis=1)
    assert visual_angle(circle, diameter) == pytest.approx(np.full(50, np.pi / 2), abs=1e-14)
    chord = np.array([[np.cos(-1), np.sin(-1)], [np.cos(-2.5), np.sin(-2.5)]])
    assert visual_angle(circle, chord) == pytest.approx(np.full(50, 0.75), abs=1e-14)


def test_special_positions():
    s = np.array([[0.0, 0.0], [2.0, 0.0]])
    points = np.array([[1.0, 0.0], [3.0, 0.0], [-1.0, 0.0], [0.0, 0.0], [2.0, 0.0], [1.0, 1.0]])
    expected = [np.pi, 0, 0, np.nan, np.nan, np.pi / 2]
    assert visual_angle(points, s) == pytest.approx(expected, nan_ok=True)
    cot = cot_visual_angle(points, s)
    assert cot == pytest.approx([-np.inf, np.inf, np.inf, np.nan, np.nan, 0], nan_ok=True)


@given(st.lists(unit, min_size=6, max_size=6))
def test_agrees_with_arc_tangents_of_directions(values):
    p, a, b = np.array(values).reshape(3, 2)
    if min(np.hypot(*(a - p)), np.hypot(*(b - p))) < 1e-6:
        return
    turn = np.angle(complex(*(b - p)) / complex(*(a - p)))
    s = np.stack([a, b])
    assert visual_angle(p, s) == pytest.approx(abs(turn), abs=1e-12)
    assert (
        np.sign(L(p, s)) * visual_angle(p, s)
        == pytest.approx(np.angle(Q(p, s) + 1j * L(p, s)), abs=1e-12)
        or L(p, s) == 0
    )


@pytest.mark.parametrize("scale", [5e-324, 1e-300, 1e-160, 1e160, 1e300, 2.0**1021])
def test_any_scale(scale):
    s = np.array([[-2.0, 0.0], [6.0, 0.0]]) * scale
    p = np.array([2.0, 4.0]) * scale
    assert visual_angle(p, s) == pytest.approx(np.pi / 2, abs=1e-14)
    assert cot_visual_angle(p, s) == pytest.approx(0, abs=1e-14)


def test_one_turn_around_an_inner_point():
    """From inside, the visual angles of a polygon's edges sum to 2π."""
    rng = np.random.default_rng(1)
    t = np.sort(rng.uniform(0, 2 * np.pi, 40))
    ring = np.stack([np.cos(t), np.sin(t)], axis=1) * rng.uniform(0.5, 1, (40, 1))
    edges = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
    assert visual_angle(np.zeros(2), edges).sum() == pytest.approx(2 * np.pi)
    assert visual_angle(np.zeros((3, 1, 2)), edges).shape == (3, 40)
    assert (L(np.zeros(2), edges) > 0).all()


def test_infinite_forms_do_not_warn():
    s = np.array([[-1e300, 0.0], [1e300, 1e300]])
    assert np.isinf(Q(np.zeros(2), s))
    assert np.isinf(L(np.zeros(2), s))
    assert np.isfinite(visual_angle(np.zeros(2), s))
