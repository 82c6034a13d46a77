"""Peaks by the diagram, for both objectives: against the other methods and plain searches."""

from fractions import Fraction

import numpy as np
import pytest
from flint import ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from harness.geometry.instance import Instance
from harness.geometry.visual_angle import L, visual_angle
from harness.peak import peak
from harness.peak.candidates import built
from harness.peak.polygon import Polygon
from harness.peak.tangency import tangencies
from tests import strategies
from tests.peak.polygons import KNOWN, STARS, generated, kernel_points, segments_of


@pytest.mark.parametrize("family", STARS)
@pytest.mark.parametrize("n", [3, 4, 6, 7])
def test_the_naive_algorithm_finds_the_same_peak(family, n):
    vertices = generated(family, n, 5)
    if vertices is None:
        return
    one, other = peak(vertices.tolist()), peak(vertices.tolist(), "diagram")
    assert max(one.lower, other.lower) <= min(one.upper, other.upper)


@given(strategies.polygons(max_size=5))
@settings(max_examples=15)
def test_degenerate_polygons_have_the_same_peak_by_both(instance):
    one, other = peak(instance[1]), peak(instance[1], "diagram")
    assert max(one.lower, other.lower) <= min(one.upper, other.upper)


@pytest.mark.parametrize("sign", [1, -1])
@given(seed=st.integers(0, 10**6), i=st.integers(0, 6), j=st.integers(0, 6))
def test_where_circles_touch_the_gradients_of_the_two_angles_are_parallel(sign, seed, i, j):
    polygon = Polygon(Instance.from_arrays("polygon", generated("star", 7, seed).tolist()))
    segments = segments_of(np.stack([polygon.x, polygon.y], axis=1))[[i, j]]
    with ctx.workprec(200):
        found = [
            (float(c.mid()), float(x.mid()), float(y.mid()))
            for c, x, y in tangencies(polygon.exact_edges[i], polygon.exact_edges[j], sign)
        ]
    assert i != j or found == []
    for c, x, y in found:
        middles, along = segments.mean(axis=1), segments[:, 1] - segments[:, 0]
        centres = middles + c * np.stack([-along[:, 1], along[:, 0]], axis=1) / 2
        away = (x, y) - centres
        radii = np.hypot(*along.T) * np.hypot(1, c) / 2
        assert np.hypot(*away.T) == pytest.approx(radii, rel=1e-6)
        (ax, ay), (bx, by) = away / radii[:, np.newaxis]
        assert ax * by - ay * bx == pytest.approx(0, abs=1e-5)
        assert np.sign(ax * bx + ay * by) == -sign


def test_every_maximum_inside_an_edge_is_a_tangency():
    """The greatest common angle on an edge, which the map knows: of an end or a tangency."""
    inner = 0
    for seed in range(6):
        polygon = Polygon(Instance.from_arrays("polygon", generated("near-regular", 6, seed)))
        position = {int(name): k for k, name in enumerate(polygon.names)}
        diagram = built(polygon, "smallest", "reference")
        for edge in diagram.edges:
            ends = [diagram.nodes[k] for k in (edge.start, edge.end) if k is not None]
            if any(node.endpoint for node in ends):
                continue  # the limit there depends on the direction
            i, j = (position[k] for k in edge.segments)
            segment = polygon.instance.segments[edge.segments[0]]
            highest = np.arctan2(1, edge.cotangent_range[0])
            angles = [float(visual_angle(np.array(node.point), segment)) for node in ends]
            if highest <= max(angles) + 1e-9:
                continue
            inner += 1
            angles = [
                np.arctan2(1, float(c.mid()))
                for sign in (1, -1)
                for c, _, _ in tangencies(polygon.exact_edges[i], polygon.exact_edges[j], sign)
            ]
            assert min(abs(highest - angle) for angle in angles) < 1e-9
    assert inner > 0


@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.parametrize("shift", [(10**7, -(10**9)), (Fraction(1, 3), 10**30)])
@pytest.mark.parametrize(
    "options", [{"method": "diagram"}, {"method": "parametric"}, {"objective": "min-max"}]
)
def test_where_a_polygon_is_does_not_matter(name, shift, options):
    vertices = KNOWN[name][0]
    moved = [(Fraction(x) + shift[0], Fraction(y) + shift[1]) for x, y in vertices]
    one, other = peak(vertices, **options), peak(moved, **options)
    assert max(one.lower, other.lower) <= min(one.upper, other.upper)
    assert max(one.upper - one.lower, other.upper - other.lower) <= 1e-12


def test_a_diagram_that_lacks_the_best_vertex_is_found_out(monkeypatch):
    from harness.peak import diagram

    whole = diagram.node_candidates
    monkeypatch.setattr(diagram, "node_candidates", lambda *given: list(whole(*given))[1:])
    monkeypatch.setattr(diagram, "touching_candidates", lambda *_: [])
    told = [told_by(generated("near-regular", 5, seed).tolist()) for seed in range(8)]
    assert None in told
    assert any(told)
    assert all(reason is None or "the diagram's best angle is" in reason for reason in told)


def told_by(vertices: list) -> str | None:
    """What the method complains about; None if it finds the peak all the same."""
    try:
        found = peak(vertices, "diagram")
    except ArithmeticError as problem:
        return str(problem)
    assert found.basis == peak(vertices).basis
    return None


# --- min–max -------------------------------------------------------------------------------------


def greatest(p: np.ndarray, segments: np.ndarray) -> float:
    """The greatest visual angle; π outside the open kernel."""
    if (L(p, segments) <= 0).any():
        return np.pi
    return float(np.nan_to_num(visual_angle(p, segments), nan=np.pi).max())


@pytest.mark.parametrize("family", STARS)
@pytest.mark.parametrize("n", [3, 4, 5, 8])
def test_min_max_agrees_with_a_dense_search(family, n):
    vertices = generated(family, n, 1)
    if vertices is None:
        return
    segments = segments_of(vertices)
    found = peak(vertices.tolist(), objective="min-max")
    assert found.upper - found.lower <= 1e-12
    here = np.array([found.x, found.y])
    points = kernel_points(vertices, 10_000, np.random.default_rng(4))
    seen = np.nan_to_num(visual_angle(points[:, np.newaxis], segments), nan=np.pi).max(axis=1)
    assert seen.min() >= found.lower - 1e-12
    # No local descent from the best samples gets below it, and from just beside it one comes near.
    middle = points[np.argmax(L(points[:, np.newaxis], segments).min(axis=1))]
    starts = [*points[np.argsort(seen)[:3]], here + 1e-6 * (middle - here)]
    options = {"xatol": 1e-12, "fatol": 1e-13, "maxiter": 1000}
    lowest = [
        minimize(greatest, start, (segments,), "Nelder-Mead", options=options).fun
        for start in starts
    ]
    assert min(lowest) >= found.lower - 1e-12
    assert min(lowest) == pytest.approx(found.angle, abs=1e-5)


def test_min_max_of_known_polygons():
    square = peak(KNOWN["square"][0], objective="min-max")
    assert (square.x, square.y, square.angle) == (0.5, 0.5, pytest.approx(np.pi / 2))
    # The vertex of 143°: its edges are seen under at least π − γ/2, the third under γ, which is
    # more, and least there.
    obtuse = peak(KNOWN["obtuse triangle"][0], objective="min-max")
    assert (obtuse.vertex, obtuse.basis) == (0, (1,))
    assert obtuse.angle == pytest.approx(np.arctan2(4, -3))
