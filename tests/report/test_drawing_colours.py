"""Neighbours never look alike, to anybody."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb

from harness.report.drawing_colours import FEW, HATCHES, NEUTRAL, PALETTE, contrast, dark, styles


@pytest.mark.parametrize(("colours", "least"), [(PALETTE[:FEW], 0.09), (PALETTE, 0.055)])
def test_the_palette_is_told_apart_by_every_reader(colours, least) -> None:
    apart = contrast(colours)
    assert np.array_equal(apart, apart.T)
    assert (apart[~np.eye(len(colours), dtype=bool)] >= least).all()


def test_contrast_knows_that_red_and_green_are_confused() -> None:
    """The planted fault: a pair that normal vision tells apart and deuteranopia does not."""
    red, green = "#c05a00", "#7f7f00"
    assert contrast([red, green])[0, 1] < 0.055
    assert contrast(["#000000", "#ffffff"])[0, 1] == pytest.approx(1, abs=0.02)


def test_dark_shades_stand_out_from_their_fills() -> None:
    for colour in PALETTE:
        assert contrast([colour, dark(colour)])[0, 1] > 0.2
        assert max(to_rgb(dark(colour))) <= 0.5


@st.composite
def neighbourhoods(draw: st.DrawFn) -> tuple[int, list[tuple[int, int]], list[int]]:
    n = draw(st.integers(1, 40))
    owners = draw(st.lists(st.integers(0, n - 1), min_size=1, unique=True))
    pairs = st.tuples(st.sampled_from(owners), st.sampled_from(owners))
    return n, draw(st.lists(pairs.filter(lambda p: p[0] != p[1]), max_size=200)), owners


@given(neighbourhoods())
def test_neighbours_get_different_styles(case) -> None:
    n, pairs, owners = case
    found = styles(n, pairs, owners)
    assert len(found) == n
    assert all(found[i] != found[j] for i, j in pairs)
    for k, style in enumerate(found):
        assert (style.line == NEUTRAL) == (k not in owners)
    if len(owners) <= len(PALETTE):
        assert len({found[k].fill for k in owners}) == len(owners)
    if len(owners) <= FEW:
        assert {found[k].fill for k in owners} <= set(PALETTE[:FEW])
    assert found == styles(n, reversed(pairs), reversed(owners))


@pytest.mark.parametrize("n", [FEW, len(PALETTE), 30, len(PALETTE) * len(HATCHES)])
def test_hatching_helps_where_colours_run_out(n) -> None:
    found = styles(n, itertools.combinations(range(n), 2), range(n))
    assert len(set(found)) == n
    assert any(style.hatch for style in found) == (n > len(PALETTE))
