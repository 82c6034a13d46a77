"""Interfaces stay: between regions, and where edges are named, whatever else changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.errors import UserError
from harness.mesh import Mesh, improve
from harness.mesh.cuts import cut
from harness.mesh.interfaces import shared_edges
from harness.mesh.validation import boundary
from tests.mesh.meshes import grid_mesh, random_mesh, triangulations
from tests.mesh.test_topology import area, is_mesh
from tests.mesh.test_validation import rows

RECONNECTING = (
    {"topology": "flip"},
    {"topology": "full"},
    {"objective": "apex", "remedy": "both"},
)


def places(points: np.ndarray, edges: np.ndarray) -> list[tuple[float, ...]]:
    """Edges by the coordinates of their ends."""
    return sorted(tuple(sorted(map(tuple, points[edge].tolist()))) for edge in edges)


@st.composite
def with_regions(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A triangulation, and regions that are chance, or the sides of a line."""
    points, triangles = draw(triangulations())
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    if draw(st.booleans()):
        return points, triangles, rng.random(len(triangles)) < draw(st.sampled_from([0.05, 0.5]))
    centres = points[triangles].mean(axis=1)
    return points, triangles, centres @ rng.normal(size=2) > 0.5


@pytest.mark.parametrize("options", [{}, *RECONNECTING])
@settings(max_examples=15)
@given(made=with_regions())
def test_every_region_is_what_it_was(made, options) -> None:
    points, triangles, regions = made
    better = improve(points, triangles, regions=regions, sweeps=4, **options)
    now = regions[better.cells]
    assert is_mesh(better.points, better.triangles)
    before = Mesh.of(points, triangles, regions=regions)
    after = Mesh.of(better.points, better.triangles, regions=now)
    assert places(points, before.kept) == places(better.points, after.kept)
    for region in np.unique(regions):
        assert area(better.points, better.triangles[now == region]) == pytest.approx(
            area(points, triangles[regions == region])
        )


@pytest.mark.parametrize("options", RECONNECTING)
@settings(max_examples=15)
@given(made=triangulations(), data=st.data())
def test_named_edges_stay(made, options, data) -> None:
    points, triangles = made
    shared = shared_edges(Mesh.of(points, triangles).triangles)[0]
    if not len(shared):
        return
    chosen = shared[data.draw(st.lists(st.integers(0, len(shared) - 1), min_size=1, max_size=9))]
    better = improve(points, triangles, edges=chosen, sweeps=4, **options)
    assert is_mesh(better.points, better.triangles)
    left = shared_edges(better.triangles)[0]
    assert set(places(points, chosen)) <= set(places(better.points, left))


@given(with_regions())
def test_what_is_cut_open_can_be_glued(made) -> None:
    points, triangles, regions = made
    mesh = Mesh.of(points, triangles, regions=regions)
    opened = cut(mesh)
    assert rows(opened.owners[opened.mesh.triangles]) == rows(mesh.triangles)
    rim = opened.owners[boundary(opened.mesh.triangles)[0]]
    sides = {tuple(sorted(edge)) for edge in rim.tolist()}
    assert {tuple(edge) for edge in mesh.kept.tolist()} <= sides
    assert (opened.mesh.fixed >= mesh.fixed[opened.owners]).all()


def test_a_single_edge_can_be_cut_open_with_another() -> None:
    points, triangles = grid_mesh(6)
    mesh = Mesh.of(points, triangles, edges=[(16, 17)])
    opened = cut(mesh)
    assert len(opened.owners) == len(points) + 1  # where the two edges meet
    assert len(boundary(opened.mesh.triangles)[0]) == len(boundary(triangles)[0]) + 4


def test_flips_go_on_beside_an_interface() -> None:
    points, triangles = random_mesh(300, 3)
    regions = points[triangles].mean(axis=1)[:, 0] > 0.5
    kept = improve(points, triangles, regions=regions, topology="flip")
    assert kept.flips > 100
    assert kept.after.percentile_5 > kept.before.percentile_5 + 10


def test_mistakes_are_named() -> None:
    points, triangles = grid_mesh(2)
    with pytest.raises(UserError, match="each of 8 triangles"):
        improve(points, triangles, regions=[1, 2])
    with pytest.raises(UserError, match="no edge between its vertices 0 and 8"):
        improve(points, triangles, edges=[(0, 8)])
    with pytest.raises(UserError, match="pairs of vertices"):
        improve(points, triangles, edges=[0, 8])
