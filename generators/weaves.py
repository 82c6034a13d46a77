"""The weaves, whose diagram is quadratic in the kernel: ``zigzag`` and ``convex-weave``.

Both are regular n-gons, n even, whose radii alternate between 1 and ρ < 1.  Their edges fall
into two mirror-image families of n/2 edges each, tilted by +τ and −τ (the angle between an
edge's normal and the radius to its middle), and at every level of the visual angle both families'
discs touch one and the same disc about the centre.  From the centre to the rim of the kernel
the tips of one family turn by π − 2τ against those of the other, so each of the n/2 tips passes
about (n/2)(1 − 2τ/π) others, and every passing makes two triple points:

    vertices ≈ (n²/2)(1 − 2τ/π).

Noise of relative size ``noise``·n^(−``noise_power``) makes the polygon generic; the default is
below the n⁻³ (convex: n⁻⁴) at which the weave comes apart.  The exact numbers of vertices and
cells, and the noise they bear, are derived in ``harness.analysis.weave`` and ``weave_noise``.
"""

from __future__ import annotations

import math

import numpy as np

from generators.family import Family, GeneratorError, Interval, Parameter
from generators.portable import Array, Stream, cosine, inverse_power, perturbed, polar, sine

_NOISE = (
    Parameter("noise", float, 1e-3, "relative noise, times n^noise_power", Interval(0.0, 1e12)),
    Parameter("noise_power", int, 3, "noise is scaled by n^(-noise_power)", Interval(0, 6)),
)

#: π/6, the default tilt
_SIXTH = math.pi / 6.0


def zigzag(
    n: int, seed: int = 0, *, tilt: float = _SIXTH, noise: float = 1e-3, noise_power: int = 3
) -> Array:
    """A star with n/2 equal spikes, every edge tilted by ``tilt`` radians; shape (n, 2).

    For an edge from radius 1 to radius ρ over the angle φ = 2π/n the tilt τ at its middle
    obeys tan τ = (1 − ρ²) / (2ρ sin φ), hence ρ = √(1 + κ²) − κ with κ = tan τ · sin φ: the
    amplitude shrinks like 1/n and the tilt stays.  Every vertex is then moved, radially and
    tangentially, by at most ε = noise·n^(−noise_power) times its radius.

    As ε ≤ 1/n, neighbours stay in angular order: a vertex turns by at most
    atan(ε/(1 − ε)) ≤ atan(1/(n − 1)) < π/n.  So the polygon is star-shaped about the origin.

    Source: the zigzag star as a counterexample to linear complexity in the kernel; the weave
    of tips described in this module.  O(n).
    """
    ZIGZAG.check(n, {"tilt": tilt, "noise": noise, "noise_power": noise_power})
    inner = zigzag_inner_radius(n, tilt)
    return _alternating("zigzag", n, seed, inner, noise * inverse_power(n, noise_power))


def zigzag_inner_radius(n: int, tilt: float) -> float:
    """ρ = √(1 + κ²) − κ with κ = tan(tilt) sin(2π/n), the inner radius of ``zigzag``."""
    turns = tilt / (2.0 * math.pi)
    kappa = sine(turns) / cosine(turns) * sine(1.0 / n)
    return 1.0 / (kappa + float(np.sqrt(1.0 + kappa * kappa)))  # stably


def convex_weave(
    n: int, seed: int = 0, *, delta: float = 0.5, noise: float = 1e-3, noise_power: int = 3
) -> Array:
    """A convex n-gon with radii alternating between 1 and 1 − δ(1 − cos 2π/n); shape (n, 2).

    At δ = 1 the inner vertices would lie on the chords of the outer ones, at δ = 0 the polygon
    is regular; between, it is convex, so its kernel is all of it.  Noise as in ``zigzag``.

    An inner vertex stands (1 − δ)(1 − cos 2π/n) above the chord of its neighbours, an outer one
    more.  A noise of ε moves each point by at most √2 ε, so convexity survives if 2√2 ε is
    less than that height; ``noise`` is refused above a quarter of it.

    Source: the convex counterexample to linear complexity in the kernel; see this module.  O(n).
    """
    CONVEX_WEAVE.check(n, {"delta": delta, "noise": noise, "noise_power": noise_power})
    inner = convex_inner_radius(n, delta)
    return _alternating("convex-weave", n, seed, inner, noise * inverse_power(n, noise_power))


def convex_inner_radius(n: int, delta: float) -> float:
    """ρ = 1 − δ(1 − cos 2π/n), the inner radius of ``convex_weave``."""
    return 1.0 - delta * _sagitta(n)


def _alternating(family: str, n: int, seed: int, inner: float, size: float) -> Array:
    """Radii 1, ρ, 1, ρ, … at equal angles; each vertex moved by at most ``size`` each way."""
    index = np.arange(n, dtype=np.float64)
    vertices = polar(np.where(index % 2 == 0, 1.0, inner), index, n)
    return perturbed(vertices, size, Stream(family, n, seed))


def _sagitta(n: int) -> float:
    """1 − cos(2π/n), as 2 sin²(π/n) so that nothing cancels."""
    half = sine(0.5 / n)
    return 2.0 * half * half


def _zigzag_condition(n: int, *, noise: float, noise_power: int, **_others: float) -> None:
    """Noise may not disturb the angular order."""
    _limit_noise("zigzag", n, noise, noise_power, 1.0 / n, "1/n")


def _weave_condition(n: int, *, delta: float, noise: float, noise_power: int) -> None:
    """Neither noise nor rounding may dent the polygon."""
    most = 0.25 * (1.0 - delta) * _sagitta(n)
    if most < 2.0**-48:
        raise GeneratorError(
            f"convex-weave: delta = {delta:g} leaves less height than rounding needs for n = {n}"
        )
    _limit_noise("convex-weave", n, noise, noise_power, most, "(1 - delta)(1 - cos(2π/n))/4")


def _limit_noise(family: str, n: int, noise: float, power: int, most: float, formula: str) -> None:
    """Refuse noise whose relative size exceeds ``most``."""
    size = noise * inverse_power(n, power)
    if size > most:
        raise GeneratorError(
            f"{family}: noise = {noise:g} means a relative noise of noise/n^{power} = {size:.3g}, "
            f"which must be at most {formula} = {most:.3g} for n = {n}"
        )


ZIGZAG = Family(
    name="zigzag",
    kind="polygon",
    summary="star with n/2 equal spikes of fixed tilt: quadratic in the kernel",
    source="mirror-image weave, vertices ~ (n²/2)(1 − 2τ/π)",
    growth="n^2",
    control=True,
    build=zigzag,
    parameters=(
        Parameter("tilt", float, _SIXTH, "tilt τ of the edges, in radians", Interval(1e-4, 1.56)),
        *_NOISE,
    ),
    smallest=4,
    largest=1_000_000,
    even=True,
    condition=_zigzag_condition,
)

CONVEX_WEAVE = Family(
    name="convex-weave",
    kind="polygon",
    summary="convex polygon with alternating radii: quadratic in the kernel",
    source="mirror-image weave, convex version",
    growth="n^2",
    control=True,
    build=convex_weave,
    parameters=(
        Parameter(
            "delta",
            float,
            0.5,
            "inner radius is 1 − δ(1 − cos 2π/n)",
            Interval(0.0, 1.0, "()"),
        ),
        *_NOISE,
    ),
    smallest=4,
    largest=1_000_000,
    even=True,
    condition=_weave_condition,
)
