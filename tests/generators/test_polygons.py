"""The polygons are what their families say, exactly, as the doubles they are."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from generators import FAMILIES, generate
from generators.portable import cyclic_gaps
from tests.generators.exact import (
    distances_to_lines,
    exact_points,
    left_of_edges,
    rounds_once,
    tilts,
    turns_left_everywhere,
)

SEEDS = st.integers(0, 2**32)
CENTRED = ("star", "star-fat", "near-regular", "zigzag", "convex-weave", "cavity",
           "control-constant", "control-linear")  # fmt: skip
CONVEX = ("convex-circle", "convex-valtr", "convex-weave")


def sizes(name: str, most: int) -> st.SearchStrategy[int]:
    family = FAMILIES[name]
    found = st.integers(family.smallest, most)
    return found.map(lambda n: n + n % 2) if family.even else found


@pytest.mark.parametrize("name", CENTRED)
@settings(max_examples=40)
@given(data=st.data(), seed=SEEDS)
def test_star_polygons_have_the_origin_strictly_inside_their_kernel(name, data, seed):
    n = data.draw(sizes(name, 14 if name == "cavity" else 60))
    vertices = exact_points(generate(name, n, seed).coordinates)
    assert len(set(vertices)) == n
    assert left_of_edges(vertices)
    assert rounds_once(vertices)


@pytest.mark.parametrize("name", CONVEX)
@settings(max_examples=40)
@given(data=st.data(), seed=SEEDS)
def test_convex_polygons_are_strictly_convex(name, data, seed):
    vertices = exact_points(generate(name, data.draw(sizes(name, 60)), seed).coordinates)
    assert turns_left_everywhere(vertices)


@pytest.mark.parametrize("name", [*CENTRED, *CONVEX])
def test_large_polygons_are_valid_too(name):
    n = 600 if name == "cavity" else 10_000
    vertices = exact_points(generate(name, n, 1).coordinates)
    if name in CENTRED:
        assert left_of_edges(vertices)
        assert rounds_once(vertices)
    if name in CONVEX:
        assert turns_left_everywhere(vertices)


@pytest.mark.parametrize(("name"), ["star", "near-regular", "convex-circle", "convex-valtr"])
def test_a_million_vertices(name):
    v = generate(name, 1_000_000, 5).coordinates
    w = np.roll(v, -1, axis=0)
    if name in CENTRED:
        first, second = v[:, 0] * w[:, 1], v[:, 1] * w[:, 0]
    else:
        edge = w - v
        before = np.roll(edge, 1, axis=0)
        first, second = before[:, 0] * edge[:, 1], before[:, 1] * edge[:, 0]
    assert (first - second > 1e-15 * (np.abs(first) + np.abs(second))).all()


# --- the parameters do what they say -------------------------------------------------------------


@pytest.mark.parametrize("radius", ["uniform", "area", "inverse", "two-point"])
@pytest.mark.parametrize("r_min", [0.1, 0.5, 1.0])
def test_star_radii_follow_their_distribution(radius, r_min):
    r = np.hypot(*generate("star", 4000, 2, radius=radius, r_min=r_min).coordinates.T)
    assert r.min() >= r_min * (1 - 1e-15)
    assert r.max() <= 1 + 1e-15
    if r_min == 1.0:
        return
    if radius == "two-point":
        assert 0.45 < (r > 0.99).mean() < 0.55
        assert np.isclose(r[r < 0.99], r_min).all()
        return
    position = {
        "uniform": (r - r_min) / (1 - r_min),
        "area": (r**2 - r_min**2) / (1 - r_min**2),
        "inverse": (1 / r - 1) / (1 / r_min - 1),
    }[radius]
    # Kolmogorov–Smirnov distance from the uniform distribution, far above its usual 0.02.
    assert np.abs(np.sort(position) - np.linspace(0, 1, 4000)).max() < 0.03


def test_star_angles_are_uniform_where_no_gap_interferes():
    v = generate("star", 4000, 3).coordinates
    turns = np.sort(np.arctan2(v[:, 1], v[:, 0]) % math.tau) / math.tau
    assert np.abs(turns - np.linspace(0, 1, 4000)).max() < 0.03
    assert cyclic_gaps(turns).min() < 1e-6  # like n⁻², not like n⁻¹: the draws are independent


@settings(max_examples=60)
@given(
    n=st.integers(3, 300),
    seed=SEEDS,
    share=st.floats(0.01, 1.0),
    roughness=st.floats(0.01, 0.99),
)
def test_the_kernel_of_a_fat_star_contains_the_disc(n, seed, share, roughness):
    """Exactly: squared distance of every edge's line from the origin ≥ squared radius."""
    disc = max(0.01, share * 0.99 * math.cos(math.pi / n) * (1 - 1e-12))
    v = generate("star-fat", n, seed, disc=disc, roughness=roughness).coordinates
    check_disc(v, disc)
    assert np.hypot(v[:, 0], v[:, 1]).max() < 1 + 1e-12


@pytest.mark.parametrize("disc", [0.01, 0.25, 0.9, 0.98])
def test_the_disc_is_there_at_ten_thousand(disc):
    v = generate("star-fat", 10_000, 4, disc=disc, roughness=0.99).coordinates
    check_disc(v, disc)
    # Not a circle: the tangent angle wanders through a fair part of the range it has.
    tangent = np.arccos(disc / np.hypot(v[:, 0], v[:, 1]))
    assert np.ptp(tangent) > 0.2 * math.acos(disc)


def check_disc(coordinates, disc):
    vertices = exact_points(coordinates)
    square = Fraction(disc) ** 2
    for (ax, ay), (bx, by) in zip(vertices, vertices[1:] + vertices[:1], strict=True):
        area = ax * by - ay * bx
        assert area > 0
        assert area * area > square * ((bx - ax) ** 2 + (by - ay) ** 2)


def test_the_lemma_on_tangent_angles():
    """The line of two points misses the open disc exactly if |x − y| ≤ φ ≤ x + y."""
    rng = np.random.default_rng(0)
    x, y = rng.uniform(0.01, 1.5, (2, 5000))
    phi = rng.uniform(0.01, 3.0, 5000)
    a = np.stack([1 / np.cos(x), np.zeros(5000)], axis=1)
    b = np.stack([np.cos(phi), np.sin(phi)], axis=1) / np.cos(y)[:, None]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    distance = area / np.hypot(*(b - a).T)
    granted = (np.abs(x - y) <= phi) & (phi <= x + y)
    clear = np.abs(distance - 1) > 1e-9
    assert ((distance >= 1) == granted)[clear].all()
    assert 500 < granted.sum() < 4500


@given(n=st.integers(4, 200), seed=SEEDS, angular=st.floats(0, 0.9), radial=st.floats(0, 1.0))
@settings(max_examples=40)
def test_near_regular_jitter_is_of_order_one_over_n(n, seed, angular, radial):
    v = generate("near-regular", n, seed, angular=angular, radial=radial).coordinates
    radius = np.hypot(v[:, 0], v[:, 1])
    assert np.abs(radius - 1).max() <= radial * math.pi / n + 1e-12
    turns = np.arctan2(v[:, 1], v[:, 0]) / math.tau * n - np.arange(n)
    away = np.abs((turns + n / 2) % n - n / 2)
    assert away.max() <= angular / 2 + 1e-9


def test_near_regular_without_jitter_is_regular():
    v = generate("near-regular", 12, angular=0, radial=0).coordinates
    assert np.array_equal(np.roll(v, -3, axis=0), np.stack([-v[:, 1], v[:, 0]], axis=1) + 0.0)


@given(n=st.integers(2, 200).map(lambda m: 2 * m), tilt=st.floats(0.01, 1.55))
def test_zigzag_edges_have_the_tilt_that_was_asked_for(n, tilt):
    v = generate("zigzag", n, tilt=tilt, noise=0.0).coordinates
    found = tilts(v)
    assert np.allclose(found[1::2], tilt, rtol=0, atol=1e-6)
    assert np.allclose(found[0::2], -tilt, rtol=0, atol=1e-6)


@given(
    n=st.integers(2, 100).map(lambda m: 2 * m),
    power=st.integers(1, 4),
    share=st.floats(0.001, 1.0),
    seed=SEEDS,
)
def test_zigzag_noise_has_the_size_that_was_asked_for(n, power, share, seed):
    noise = share * float(n) ** (power - 1) * (1 - 1e-12)
    v = generate("zigzag", n, seed, noise=noise, noise_power=power).coordinates
    calm = generate("zigzag", n, noise=0.0).coordinates
    size = noise / n**power
    relative = np.hypot(*(v - calm).T) / np.hypot(*calm.T)
    assert relative.max() <= math.sqrt(2) * size + 1e-15
    assert relative.max() >= 0.2 * size
    assert left_of_edges(exact_points(v))


@given(
    n=st.integers(2, 100).map(lambda m: 2 * m),
    delta=st.floats(0.001, 0.999),
    share=st.floats(0.0, 1.0),
    seed=SEEDS,
)
def test_convex_weave_radii_and_convexity(n, delta, share, seed):
    inner = 1 - delta * (1 - math.cos(math.tau / n))
    calm = generate("convex-weave", n, delta=delta, noise=0.0).coordinates
    assert np.allclose(np.hypot(*calm[0::2].T), 1.0, rtol=0, atol=1e-15)
    assert np.allclose(np.hypot(*calm[1::2].T), inner, rtol=0, atol=1e-14)
    most = (1 - delta) * (1 - math.cos(math.tau / n)) / 4
    v = generate("convex-weave", n, seed, delta=delta, noise=share * most * 0.999, noise_power=0)
    assert turns_left_everywhere(exact_points(v.coordinates))


def test_random_points_on_a_circle():
    v = generate("convex-circle", 2000, 1).coordinates
    assert np.abs(np.hypot(v[:, 0], v[:, 1]) - 1).max() < 1e-15
    turns = np.arctan2(v[:, 1], v[:, 0]) % math.tau / math.tau
    assert (np.diff(turns) > 0).all()
    assert np.abs(turns - np.linspace(0, 1, 2000)).max() < 0.05


def test_valtr_polygons_have_the_law_of_random_points_in_convex_position():
    """Valtr: four points of a square are in convex position with probability (C(6,3)/4!)² = 25/36.

    Given convex position all points are hull vertices, so the bounding box of n = 4 has
    the law of an exchangeable sample; compare the mean area with that of accepted samples.
    """
    rng = np.random.default_rng(5)
    samples = rng.random((6000, 4, 2))
    kept = [hull for hull in map(convex_quadrilateral, samples) if hull is not None]
    assert abs(len(kept) / 6000 - 25 / 36) < 0.02
    expected = np.mean([area(hull) for hull in kept])
    found = np.mean([area(generate("convex-valtr", 4, s).coordinates) for s in range(3000)])
    assert abs(found - expected) < 0.01


def convex_quadrilateral(points):
    centre = points.mean(axis=0)
    around = points[np.argsort(np.arctan2(*(points - centre).T[::-1]))]
    edge = np.roll(around, -1, axis=0) - around
    before = np.roll(edge, 1, axis=0)
    turns = before[:, 0] * edge[:, 1] - before[:, 1] * edge[:, 0]
    return around if (turns > 0).all() else None


def area(v):
    w = np.roll(v, -1, axis=0)
    return float((v[:, 0] * w[:, 1] - v[:, 1] * w[:, 0]).sum()) / 2


def test_star_kernels_shrink_and_fat_ones_do_not():
    thin = [distances_to_lines(generate("star", 1000, s).coordinates).min() for s in range(10)]
    fat = [distances_to_lines(generate("star-fat", 1000, s).coordinates).min() for s in range(10)]
    assert max(thin) < 0.05
    assert min(fat) >= 0.25
