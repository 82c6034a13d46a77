"""Certificates where doubles end: sizes, needles, spikes, slits; held against exact witnesses."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.peak import peak, peaks
from harness.peak.bounds import cotangent_bound, least_angle
from tests.peak.polygons import KNOWN, generated, regular
from tests.peak.witnesses import angles_of, broken

SHAPES = {
    **{name: vertices for name, (vertices, _, _) in KNOWN.items()},
    **{
        family: generated(family, 8, 1).tolist()
        for family in ("star", "zigzag", "convex-weave", "control-linear")
    },
}
EXPONENTS = (-307, -200, -161, -159, -154, -100, -30, 30, 100, 153, 200)


def spiky(n: int, thin: float, seed: int) -> list[tuple[float, float]]:
    """A star of n spikes of length 1 around a kernel of size ``thin``."""
    rng = np.random.default_rng(seed)
    turns = np.pi * np.arange(2 * n) / n
    radii = np.where(np.arange(2 * n) % 2, thin * rng.uniform(0.5, 1, 2 * n), 1.0)
    return [
        (float(r * math.cos(t)), float(r * math.sin(t))) for r, t in zip(radii, turns, strict=True)
    ]


def tall(height: float) -> list[tuple[float, float]]:
    """A unit square with a roof of this height."""
    return [(0, 0), (1, 0), (1, 1), (0.55, height), (0, 1)]


def slit(thin: Fraction) -> list[tuple[Fraction, Fraction]]:
    """A quadrilateral of which one angle is nearly 0, too thin for doubles to know its side."""
    return [(Fraction(0), Fraction(0)), (thin, Fraction(0)), (1, 1), (Fraction(0), thin)]


def cut(thin: Fraction) -> list[tuple]:
    """A square with one corner cut off, by an edge of length ``thin``."""
    return [(0, 0), (1, 0), (1, 1 - thin), (1 - thin, 1), (0, 1)]


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("exponent", EXPONENTS)
def test_certificates_hold_at_every_size(name, exponent):
    size = Fraction(10) ** exponent
    scaled = [(float(Fraction(x) * size), float(Fraction(y) * size)) for x, y in SHAPES[name]]
    found = peaks([scaled])
    assert found.status.tolist() == [0]
    k = found.vertices[0]
    point = found.points[0].tolist() if k < 0 else scaled[k]
    assert broken(scaled, found.angles[0], found.bounds[0], point) is None
    one = peak(scaled)
    assert max(one.lower, found.angles[0]) <= min(one.upper, found.bounds[0])


@pytest.mark.parametrize("thin", [Fraction(1, 10**k) for k in (3, 9, 20, 160, 200, 320)])
@pytest.mark.parametrize("shape", [slit, cut])
@pytest.mark.parametrize("shift", [0, Fraction(1, 3), 2**40])
def test_features_that_doubles_cannot_see(thin, shape, shift):
    vertices = [(x + shift, y - shift) for x, y in shape(thin)]
    found = peak(vertices)
    assert broken(vertices, found.lower, found.upper, found.point) is None
    rounded = [(float(x), float(y)) for x, y in shape(thin)]
    batch = peaks([rounded])
    assert batch.status[0] == 2 or not batch.bounds[0] < peak(rounded).lower


@pytest.mark.parametrize("thin", [1e-3, 1e-9, 1e-13, 1e-15, 1e-20, 1e-160])
@pytest.mark.parametrize("n", [3, 4, 5, 6])
def test_spikes_around_a_tiny_kernel(n, thin):
    """The third way of proving must not take forever to rise from 2π/n."""
    for seed in range(3):
        vertices = spiky(n, thin, seed)
        try:
            found = peak(vertices)
        except UserError:
            assert n == 3 or thin < 1e-15  # three reflex vertices may leave no kernel
            continue
        assert broken(vertices, found.lower, found.upper, found.point) is None


@pytest.mark.parametrize(
    ("flat", "digits"),
    [
        ([(-114, 46), (18, -118), (-23, 55), (120, 105)], 20),
        ([(-116, -37), (9, 7), (-21, -45), (120, 50)], 20),
        ([(-115, 86), (-102, -52), (-58, -18), (-102, 66), (21, 102)], 42),
        ([(-68, -76), (18, -69), (-48, -83), (93, -54), (-51, -41)], 20),
    ],
)
def test_a_slit_whose_cap_doubles_do_not_see(flat, digits):
    """An interior angle of nearly 2π: discs below its cap meet in that vertex and nowhere else.

    A rational ascent that starts below that cap, because doubles do not name the vertex, comes
    to no end on these.
    """
    thin = [(Fraction(x, 100), Fraction(y) / 10**digits) for x, y in flat]
    found = peak(thin)
    assert broken(thin, found.lower, found.upper, found.point) is None


@pytest.mark.parametrize("method", ["parametric", "diagram"])
@pytest.mark.parametrize(
    "vertices", [tall(1e5), tall(1e9), spiky(4, 1e-9, 1), spiky(5, 1e-12, 2), spiky(6, 1e-6, 3)]
)
def test_other_methods_reach_thin_kernels_too(method, vertices):
    one, other = peak(vertices), peak(vertices, method)
    assert max(one.lower, other.lower) <= min(one.upper, other.upper)


@pytest.mark.parametrize("size", [1e-160, 1e-30, 1e30, 1e200])
@pytest.mark.parametrize("method", ["parametric", "diagram"])
def test_other_methods_at_every_size(method, size):
    vertices = [(x * size, y * size) for x, y in KNOWN["letter L"][0]]
    assert peak(vertices, method).angle == pytest.approx(math.pi / 4)


def test_what_parametric_search_cannot_tell_is_refused():
    with pytest.raises(UserError, match="too thin for it, use the method lp"):
        peak(spiky(5, 1e-15, 5), "parametric")


@given(
    x=st.floats(-1, 1),
    y=st.floats(0.01, 1),
    exponent=st.integers(-340, -300),
    c=st.floats(0.1, 10),
)
@settings(max_examples=200)
def test_faint_products_prove_nothing(x, y, exponent, c):
    """Coordinates so small that products lose digits, or all of them: no bound may be wrong."""
    size = 10.0 ** (exponent / 2)
    starts = np.array([(-1.0, 0.0), (1.0, 0.0), (x, y)]) * size
    middle = starts.mean(axis=0)
    ax, ay = (starts - middle).T.copy()
    dx, dy = (np.roll(starts, -1, axis=0) - starts).T.copy()
    found = peak(starts.tolist())
    seen, _ = least_angle(-1, ax, ay, dx, dy, 3)
    assert seen <= found.upper
    bound = cotangent_bound(c, np.array([0, 2, 4]), np.full(3, 1 / 3), ax, ay, dx, dy, 3)
    assert math.atan2(1, bound) >= found.lower


def test_bounds_of_a_polygon_that_winds_twice_contradict_each_other():
    pentagram = regular(5)[[0, 2, 4, 1, 3]]
    found = peaks([pentagram, regular(5)])
    assert found.status.tolist() == [2, 0]
    assert np.isnan(found.angles[0])


# --- min–max -------------------------------------------------------------------------------------

SUBDIVIDED = {
    "two collinear edges": [(0, 0), (1, 0), (2, 0), (2, 3), (0, 3)],
    "an edge on two sides": [(0, 0), (0.5, 0), (1, 0), (1, 4), (0, 4), (0, 4 / 3)],
    "three collinear edges": [(0, 0), (1, 0), (2, 0), (4, 0), (4, 1), (2, 3), (1, 3), (0, 3)],
    "thirds": [
        (Fraction(x, 3), Fraction(y, 3)) for x, y in ((0, 0), (1, 0), (2, 0), (4, 0), (3, 4))
    ],
    "nearly a vertex twice": [(0, 0), (1, 0), (1, 1e-30), (1, 1), (0, 1)],
    "spikes": spiky(4, 1e-15, 59),
    "L": KNOWN["letter L"][0],
}


@pytest.mark.parametrize("name", SUBDIVIDED)
def test_min_max_is_what_its_point_reaches_and_no_sample_beats_it(name):
    vertices = SUBDIVIDED[name]
    found = peak(vertices, objective="min-max")
    assert 0 <= found.upper - found.lower <= 1e-12
    assert found.upper >= 2 * math.pi / len(vertices)
    angles = angles_of(vertices, found.point)
    if angles is not None and found.vertex is None:
        assert max(float(angle.mid()) for angle in angles) == pytest.approx(found.angle, abs=1e-9)
    rng = np.random.default_rng(1)
    corners = np.array([(float(x), float(y)) for x, y in vertices])
    for weights in rng.dirichlet(np.full(len(corners), 0.5), 300):
        sampled = angles_of(vertices, [Fraction(v) for v in weights @ corners])
        if sampled is not None:
            assert not all(angle < found.lower for angle in sampled)


def test_a_phantom_touching_point_is_not_taken(monkeypatch):
    """Without the look whether a point is in the kernel, the answer would be too small."""
    from harness.peak import candidates

    vertices = SUBDIVIDED["an edge on two sides"]
    right = peak(vertices, objective="min-max").angle
    monkeypatch.setattr(candidates, "_counts", lambda *_: True)
    assert peak(vertices, objective="min-max").angle < right - 0.1
