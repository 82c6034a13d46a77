"""Circles that touch for one level only: a double root that no ball arithmetic can tell apart."""

from flint import arb, ctx, fmpq

from harness.peak.tangency import tangencies


def test_an_exact_double_root_is_enclosed() -> None:
    """g(c) of these edges is a multiple of (c − φ)², φ the golden ratio."""
    edges = [((6, 3), (7, 5)), ((4, 2), (7, 2))]
    first, second = (tuple((fmpq(x), fmpq(y)) for x, y in edge) for edge in edges)
    for bits in (64, 128, 512):
        with ctx.workprec(bits):
            golden = (1 + arb(5).sqrt()) / 2
            found = [t for sign in (1, -1) for t in tangencies(first, second, sign) or ()]
            assert any(c.overlaps(golden) for c, _, _ in found)
            assert all(c.rad() < 1e-6 for c, _, _ in found)
