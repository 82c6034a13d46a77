"""Where two cubics vanish together: found from wherever the zero is."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.diagram.fast.common_zeros import common_zero
from harness.diagram.fast.forms import value_and_gradient

# Bernstein coefficients of two contests that tie in the triangle near its first corner and, not far
# away, outside: Newton's method prefers the outer zero.
NEAR_CORNER = np.array(
    [
        *(-0.004759, 1.0, 0.373981, 0.318573, 0.12016),
        *(0.653396, 0.784758, 0.246404, 0.576137, 0.446683),
        *(-0.005998, 1.0, 0.463591, 0.399881, 0.152205),
        *(0.735956, 0.847532, 0.308739, 0.668242, 0.534943),
    ]
).reshape(2, 10)


# Bernstein coefficients whose gradients are nearly parallel but very close to a side.
ALONG_SIDE = np.array(
    [
        *(6.43639576e-13, -2.06884126e-13, 0.935361736, 3.60131669e-13, 4.11320988e-4),
        *(7.66237685e-14, 4.11320962e-4, 2.56689739e-2, 2.56689735e-2, 4.11320975e-4),
        *(0, 4.01960020e-21, -0.885521255, 1.78648901e-21, -2.17099035e-4),
        *(3.12635575e-21, -2.17099028e-4, -1.78483278e-2, -1.78483276e-2, -2.17099032e-4),
    ]
).reshape(2, 10)


def residues(cubics, weights):
    out = np.zeros(3)
    for cubic in cubics:
        value_and_gradient(cubic, weights[1], weights[2], out)
        yield abs(out[0])


def test_a_zero_beside_one_outside_that_attracts():
    found = common_zero(*NEAR_CORNER, (0.117, -0.292))
    assert found is not None
    assert min(found) > 0
    assert max(residues(NEAR_CORNER, found)) < 1e-12


def test_a_zero_beside_a_side_to_which_gradients_lead_but_not_along_it():
    found = common_zero(*ALONG_SIDE, (2e7, 0.22))
    assert found is not None
    assert min(found) > 0
    assert max(residues(ALONG_SIDE, found)) < 1e-24


@settings(max_examples=60, deadline=None)
@given(
    x=st.floats(1e-6, 0.98),
    share=st.floats(1e-6, 0.98),
    turn=st.floats(0.2, 1.3),
    bend=st.lists(st.floats(-0.2, 0.2), min_size=20, max_size=20),
)
def test_a_planted_zero_is_found_from_anywhere(x, share, turn, bend):
    """Two bent lines through a point of the triangle meet there."""
    y = share * (1 - x)
    u = np.array([0, 3, 0, 1, 0, 2, 2, 0, 1, 1]) / 3 - x  # the coefficients of x and y, raised
    v = np.array([0, 0, 3, 0, 1, 0, 1, 2, 2, 1]) / 3 - y
    cubics = np.array([np.cos(turn) * u + np.sin(turn) * v, np.cos(turn) * v - np.sin(turn) * u])
    bends = np.array(bend).reshape(2, 10)
    out = np.zeros(3)
    for row, cubic in zip(bends, cubics, strict=True):
        value_and_gradient(row, x, y, out)
        cubic += row - out[0]
    found = common_zero(*cubics, (1 / 3, 1 / 3))
    assert found is not None
    assert max(residues(cubics, found)) < 1e-9
