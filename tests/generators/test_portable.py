"""Arithmetic and randomness that do not depend on the machine."""

import ast
import hashlib
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st

import generators
from generators.portable import (
    Stream,
    arccosine,
    cosine,
    cyclic_gaps,
    inverse_power,
    sine,
    surely_convex_corners,
    surely_positive_cross,
    unit_vectors,
)

FINITE = st.floats(-1e3, 1e3)

# What a C library, a vector unit or a version of NumPy may compute differently.
NOT_PORTABLE = {
    *("sin", "cos", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan", "atan2"),
    *("arcsin", "arccos", "arctan", "arctan2", "exp", "exp2", "expm1", "log", "log2", "log10"),
    *("log1p", "pow", "power", "float_power", "hypot", "cbrt", "dot", "vdot", "inner", "matmul"),
    *("einsum", "tensordot", "linalg", "fft", "mean", "std", "var", "average", "prod"),
    *("linspace", "geomspace", "logspace", "default_rng", "Generator", "RandomState"),
    *("standard_normal", "permutation", "choice", "seed"),
}


def ulps(value: float, true: arb) -> float:
    return float(abs(arb(value) - true) / arb(math.ulp(float(true))))


@given(st.floats(0.0, 1.0, exclude_max=True) | st.fractions(0, 1).map(float))
def test_unit_vectors_are_accurate_to_about_an_ulp(turns):
    x, y = unit_vectors(turns)
    with ctx.workprec(200):
        angle = 2 * arb(turns)
        assert ulps(x, angle.cos_pi()) < 1.5
        assert ulps(y, angle.sin_pi()) < 1.5


@given(st.integers(1, 10**6).flatmap(lambda n: st.tuples(st.integers(0, n - 1), st.just(n))))
def test_vertices_of_a_regular_polygon_are_accurate(pair):
    index, n = pair
    x, y = unit_vectors(index, n)
    with ctx.workprec(200):
        angle = 2 * arb(index) / n
        # Reduction is exact, so only an exact 0 has to be special.
        assert x == 0.0 if 4 * index in (n, 3 * n) else ulps(x, angle.cos_pi()) < 2.0
        assert y == 0.0 if 2 * index in (0, n) else ulps(y, angle.sin_pi()) < 2.0


@pytest.mark.parametrize("n", [4, 8, 12, 16, 20, 1000])
def test_regular_polygons_have_exact_symmetry(n):
    v = unit_vectors(np.arange(n), n)
    quarter = np.roll(v, -n // 4, axis=0)
    assert np.array_equal(quarter, np.stack([-v[:, 1], v[:, 0]], axis=1))
    assert np.array_equal(v[-np.arange(n)], v * [1.0, -1.0])


@given(st.floats(0.0, 1.0))
def test_arccosine_inverts_cosine(value):
    turns = arccosine(value)
    assert 0.0 <= turns <= 0.25
    # A cosine cannot be finer than the spacing of the angles allows.
    assert abs(cosine(turns) - value) <= 2.0**-52 + 8 * math.ulp(turns) * sine(turns)


@given(st.lists(st.tuples(FINITE, FINITE, FINITE, FINITE), min_size=1, max_size=20))
def test_a_sure_sign_is_the_true_sign(rows):
    u, v = np.array([r[:2] for r in rows]), np.array([r[2:] for r in rows])
    for sure, (a, b, c, d) in zip(surely_positive_cross(u, v), rows, strict=True):
        if sure:
            assert Fraction(a) * Fraction(d) > Fraction(b) * Fraction(c)


@given(st.lists(st.tuples(FINITE, FINITE), min_size=3, max_size=12))
def test_a_sure_left_turn_is_one(points):
    v = [tuple(map(Fraction, p)) for p in points]
    for i, sure in enumerate(surely_convex_corners(np.array(points))):
        (ax, ay), (bx, by), (cx, cy) = v[i - 1], v[i], v[(i + 1) % len(v)]
        if sure:
            assert (bx - ax) * (cy - by) > (by - ay) * (cx - bx)


def test_raw_words_make_the_documented_doubles():
    """NumPy guarantees PCG64's words; ours are the doubles its own Generator makes of them."""
    stream = Stream("star", 5, 7)
    key = int.from_bytes(hashlib.sha256(b"star").digest()[:8], "little")
    theirs = np.random.Generator(np.random.PCG64(np.random.SeedSequence([key, 5, 7])))
    assert np.array_equal(stream.uniform(1000), theirs.random(1000))


def test_streams_differ_by_family_size_and_seed():
    streams = [Stream(f, n, s) for f in ("star", "zigzag") for n in (5, 6) for s in (0, 1, 2**40)]
    assert len({stream.uniform(1)[0] for stream in streams}) == len(streams)


def test_sorted_turns_respect_their_gaps():
    for seed in range(200):
        turns = Stream("gaps", 3, seed).sorted_turns(3, 0.01, 0.49)
        gaps = cyclic_gaps(turns)
        assert (gaps >= 0.01).all()
        assert (gaps <= 0.49).all()
        assert abs(gaps.sum() - 1.0) < 1e-15


def test_shuffle_is_a_permutation_and_fair():
    values = np.arange(4.0)
    seen = [tuple(Stream("shuffle", 4, seed).shuffle(values)) for seed in range(2400)]
    assert all(sorted(s) == [0, 1, 2, 3] for s in seen)
    counts = [seen.count(s) for s in set(seen)]
    assert len(counts) == 24
    assert sum((c - 100) ** 2 / 100 for c in counts) < 50  # χ² with 23 degrees of freedom


def test_inverse_power():
    assert inverse_power(10, 0) == 1.0
    assert inverse_power(10, 3) == 1e-3
    assert inverse_power(10**6, 6) == 1e-36


def test_no_family_calls_anything_that_varies_between_machines():
    """The contract of the room: every operation in it is correctly rounded."""
    for path in Path(generators.__file__).parent.glob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        names = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
        assert not names & NOT_PORTABLE, path.name
        for node in ast.walk(tree):
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
                # A power is fine between integers, or of the constant 2.
                base = node.left
                literal = isinstance(base, ast.Constant) and base.value == 2.0
                integer = ast.unparse(node) == "n ** power"
                assert literal or integer, f"{path.name}:{node.lineno}"
