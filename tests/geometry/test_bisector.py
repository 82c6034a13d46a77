"""The bisector's cubics: their zeros, their points at infinity, the paper's equation (5)."""

from fractions import Fraction

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from harness.geometry.bisector import MONOMIALS, bisector_cubics
from harness.geometry.predicates import compare_visual_angles

rational = st.fractions(-5, 5, max_denominator=12)
points = st.tuples(rational, rational)
segments = st.tuples(points, points)


def forms(p, s):
    (ax, ay), (bx, by) = ((q[0] - p[0], q[1] - p[1]) for q in s)
    return ax * bx + ay * by, ax * by - ay * bx


@given(segments, segments, points)
def test_signs_compare_visual_angles(s, t, p):
    """Off the lines, F₊ or F₋, by the sides of p, has the sign of the difference of angles."""
    (_, ls), (_, lt) = forms(p, s), forms(p, t)
    assume(ls != 0 and lt != 0)
    plus, minus = bisector_cubics(s, t)
    # θ(s) > θ(t) ⇔ Q_s|L_t| < Q_t|L_s|
    value = plus(*p) if ls * lt > 0 else minus(*p)
    value = value if lt > 0 else -value
    assert compare_visual_angles(p, s, t) == (value < 0) - (value > 0)


@given(segments, segments)
def test_pass_through_endpoints_and_the_meeting_of_the_lines(s, t):
    cubics = bisector_cubics(s, t)
    for cubic in cubics:
        assert all(cubic(*point) == 0 for point in (*s, *t))
    (ax, ay), (bx, by) = s
    (cx, cy), (dx, dy) = t
    det = (bx - ax) * (dy - cy) - (by - ay) * (dx - cx)
    assume(det != 0)
    k = ((cx - ax) * (dy - cy) - (cy - ay) * (dx - cx)) / det
    meeting = ax + k * (bx - ax), ay + k * (by - ay)
    assert all(cubic(*meeting) == 0 for cubic in cubics)


@given(segments, segments)
def test_leading_part_is_circular(s, t):
    """The cubic terms are (x² + y²) times a linear form."""
    for cubic in bisector_cubics(s, t):
        c = dict(zip(MONOMIALS, cubic.coefficients, strict=True))
        assert c[3, 0] == c[1, 2]
        assert c[0, 3] == c[2, 1]
        assert np.abs(cubic.floats).max() in (0.0, 1.0)


@given(segments, segments)
def test_reversal_and_exchange(s, t):
    plus, minus = bisector_cubics(s, t)
    reversed_plus, reversed_minus = bisector_cubics(s, (t[1], t[0]))
    negated = tuple(-c for c in minus.coefficients)
    assert reversed_plus.coefficients == negated
    assert reversed_minus.coefficients == tuple(-c for c in plus.coefficients)
    swapped_plus, swapped_minus = bisector_cubics(t, s)
    assert swapped_plus.coefficients == tuple(-c for c in plus.coefficients)
    assert swapped_minus == minus


@given(
    rational,
    rational,
    st.fractions(Fraction(1, 9), 4, max_denominator=9),
    st.fractions(-3, 3, max_denominator=9),
    points,
)
def test_equation_5_of_the_paper(a, b, half, tangent, p):
    """s on the x-axis from −1 to 1; t about (a, b), of half length l and slope φ.

    (5): y((x−a)² + (y−b)² − l²) − l((x−a) sin φ − (y−b) cos φ)(x² + y² − 1) = 0 is F₋/2, and
    −F₊/2 if t is directed the other way.  (The signs are lost in some copies of the paper.)
    """
    cos, sin = (1 - tangent**2) / (1 + tangent**2), 2 * tangent / (1 + tangent**2)
    s = (Fraction(-1), Fraction(0)), (Fraction(1), Fraction(0))
    t = (a - half * cos, b - half * sin), (a + half * cos, b + half * sin)
    x, y = p
    equation = y * ((x - a) ** 2 + (y - b) ** 2 - half**2) - half * (
        (x - a) * sin - (y - b) * cos
    ) * (x**2 + y**2 - 1)
    assert equation == bisector_cubics(s, t)[1](x, y) / 2
    assert equation == -bisector_cubics(s, t[::-1])[0](x, y) / 2
