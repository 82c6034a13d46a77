"""Poisson's equation on meshes: energies that are known, and the error that theory promises."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given

from harness.mesh.poisson import SQUARE, solve
from tests.mesh.meshes import grid_mesh, triangulations


def test_the_energy_of_the_square_is_its_series() -> None:
    odd = np.arange(1, 2001, 2)
    series = 1 / 12 - 16 / np.pi**5 * (np.tanh(odd * np.pi / 2) / odd**5.0).sum()
    assert pytest.approx(series, abs=1e-15) == SQUARE


def test_one_unknown_is_solved_by_hand() -> None:
    points, triangles = grid_mesh(2)  # six triangles at the centre, its matrix is (4)
    solved = solve(points, triangles)
    assert solved is not None
    assert solved.iterations == 1
    load = 6 * (1 / 8) / 3
    assert solved.energy == pytest.approx(load * load / 4)


def test_half_the_step_is_half_the_error() -> None:
    errors = [
        solved.error_on_unit_square
        for k in (8, 16, 32)
        if (solved := solve(*grid_mesh(k))) is not None
    ]
    for coarse, fine in itertools.pairwise(errors):
        assert coarse / fine == pytest.approx(2, rel=0.02)


@given(triangulations())
def test_no_mesh_of_the_square_has_more_than_the_exact_energy(made) -> None:
    points, triangles = made
    size = points.max()
    solved = solve(points / size, triangles)
    if solved is not None:
        assert 0 < solved.energy < SQUARE
        turned = solve(np.column_stack([-points[:, 1], points[:, 0]]) / size, triangles)
        assert turned is not None
        assert turned.energy == pytest.approx(solved.energy, rel=1e-6)


def test_what_cannot_be_solved_is_not() -> None:
    points, triangles = grid_mesh(2)
    assert solve(points, triangles[:2]) is None  # nothing is unknown
    points[4] = 0
    assert solve(points, triangles) is None  # a triangle is flat
