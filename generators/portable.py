"""Arithmetic and randomness whose every bit is the same on every machine.

The families promise *same seed, same coordinates, on every machine and worker*.  Library
sines, logarithms, powers and normal deviates do not keep that promise: their last bit depends
on the C library, on the vector unit and on the version.  So the families use only

* the operations IEEE 754 rounds correctly: ``+ − × / sqrt``, comparisons, sorting, and
  ``cumsum`` (which adds from left to right; ``sum`` and ``dot`` may regroup);
* the raw 64-bit words of PCG64, which NumPy guarantees never to change (NEP 19);
* the unit vectors below, evaluated by a fixed sequence of such operations.

Each NumPy call performs one operation per element, so no compiler can fuse a multiplication
with an addition.  Angles are measured in **turns** (1 turn = 2π): reduction to an eighth of a
turn is then exact.
"""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

# Taylor coefficients of sin(πx/2)/x and of cos(πx/2) in powers of x², as nearest doubles.
# On |x| ≤ 1/2 the first term left out is below 1e-19.
_SINE = (
    1.5707963267948966,
    -0.6459640975062463,
    0.07969262624616705,
    -0.004681754135318688,
    0.00016044118478735983,
    -3.598843235212085e-06,
    5.692172921967927e-08,
    -6.688035109811468e-10,
    6.0669357311061955e-12,
)
_SQRT_HALF = 0.7071067811865476
_SINE_TAIL = 6.123233995736766e-17  # π/2 minus its nearest double
_COSINE = (
    1.0,
    -1.2337005501361697,
    0.25366950790104803,
    -0.02086348076335296,
    0.0009192602748394266,
    -2.5202042373060607e-05,
    4.710874778818172e-07,
    -6.386603083791852e-09,
    6.565963114979473e-11,
    -5.294400200734623e-13,
)


def _horner(coefficients: tuple[float, ...], z: Array) -> Array:
    value = np.full_like(z, coefficients[-1])
    for coefficient in reversed(coefficients[:-1]):
        value = np.add(np.multiply(value, z), coefficient)
    return value


def unit_vectors(numerator: ArrayLike, denominator: float = 1.0) -> Array:
    """Points of the unit circle at ``numerator / denominator`` turns; shape (…, 2).

    Accurate to about one unit in the last place of each coordinate.  Regular polygons should
    pass the index as numerator and n as denominator: the reduction is then exact in the integers
    and the result has every symmetry by quarter turns and reflections that n allows.
    O(1) a point.
    """
    four = np.multiply(np.asarray(numerator, dtype=np.float64), 4.0)
    quarter = np.rint(np.divide(four, denominator))
    x = np.divide(np.subtract(four, np.multiply(quarter, denominator)), denominator)
    z = np.multiply(x, x)
    # sin: leading term last, with the tail of π/2, so that its rounding dominates the error.
    tail = np.add(np.multiply(_horner(_SINE[1:], z), z), _SINE_TAIL)
    sine = np.add(np.multiply(x, _SINE[0]), np.multiply(x, tail))
    cosine = _horner(_COSINE, z)
    # Half-way between two quarters either reduction serves; both must give the same point.
    half_way = np.abs(x) == 0.5
    sine = np.where(half_way, np.copysign(_SQRT_HALF, x), sine)
    cosine = np.where(half_way, _SQRT_HALF, cosine)
    turn = np.mod(quarter, 4.0).astype(np.int64)
    odd = (turn & 1).astype(bool)
    along = np.where(odd, sine, cosine)
    across = np.where(odd, cosine, sine)
    out = np.empty((*np.shape(along), 2))
    out[..., 0] = np.where((turn == 1) | (turn == 2), -along, along)
    out[..., 1] = np.where(turn >= 2, -across, across)
    return np.add(out, 0.0)  # no negative zeros


def polar(radius: ArrayLike, numerator: ArrayLike, denominator: float = 1.0) -> Array:
    """Points at distance ``radius`` from the origin, ``numerator / denominator`` turns round."""
    return np.multiply(
        unit_vectors(numerator, denominator), np.asarray(radius, dtype=np.float64)[..., np.newaxis]
    )


def cosine(turns: float) -> float:
    """Cosine of an angle in turns."""
    return float(unit_vectors(turns)[0])


def sine(turns: float) -> float:
    """Sine of an angle in turns."""
    return float(unit_vectors(turns)[1])


def arccosine(value: float) -> float:
    """The angle in [0, 1/4] turns whose cosine is ``value`` in [0, 1], by bisection."""
    low, high = 0.0, 0.25
    while True:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            return low
        if cosine(middle) >= value:
            low = middle
        else:
            high = middle


class Stream:
    """The random numbers of one instance: a PCG64 stream of its own per (family, n, seed).

    Parameters are left out of the key on purpose: a sweep over a parameter at one seed sees
    common random numbers, which removes most of the noise from the comparison.
    """

    def __init__(self, family: str, n: int, seed: int) -> None:
        """Start the stream; ``seed`` is any integer ≥ 0."""
        key = int.from_bytes(hashlib.sha256(family.encode()).digest()[:8], "little")
        self._bits: Any = np.random.PCG64(np.random.SeedSequence([key, n, seed]))

    def uniform(self, count: int) -> Array:
        """``count`` independent multiples of 2⁻⁵³, uniform on [0, 1)."""
        words = np.asarray(self._bits.random_raw(count), dtype=np.uint64)
        return np.multiply((words >> np.uint64(11)).astype(np.float64), 2.0**-53)

    def signed(self, count: int) -> Array:
        """``count`` independent multiples of 2⁻⁵², uniform on [−1, 1)."""
        return np.subtract(np.multiply(self.uniform(count), 2.0), 1.0)

    def shuffle(self, values: Array) -> Array:
        """``values`` in uniformly random order."""
        return values[np.argsort(self.uniform(len(values)), kind="stable")]

    def sorted_turns(self, n: int, shortest: float, longest: float = 1.0) -> Array:
        """``n`` independent uniform angles in turns, sorted, given that no gap is extreme.

        Conditions on every gap between cyclic neighbours lying in [shortest, longest], by
        drawing all angles afresh until it does.  With ``longest`` ≥ 0.49 a draw succeeds with
        probability at least 0.2 for n = 3, more for larger n (Wendel), times e^(−n²·shortest).
        """
        while True:
            turns = np.sort(self.uniform(n))
            gaps = cyclic_gaps(turns)
            if gaps.min() >= shortest and gaps.max() <= longest:
                return turns


def perturbed(vertices: Array, size: float, stream: Stream) -> Array:
    """Each point moved radially and tangentially by at most ``size`` times its radius."""
    if size == 0.0:
        return vertices
    out = np.multiply(stream.signed(len(vertices)), size)[:, np.newaxis]
    aside = np.multiply(stream.signed(len(vertices)), size)[:, np.newaxis]
    normal = np.stack([-vertices[:, 1], vertices[:, 0]], axis=1)
    return np.add(vertices, np.add(np.multiply(vertices, out), np.multiply(normal, aside)))


def cyclic_gaps(turns: Array) -> Array:
    """Gap from each sorted angle to the next one round the circle, in turns."""
    return np.append(np.subtract(turns[1:], turns[:-1]), (turns[0] + 1.0) - turns[-1])


def surely_positive_cross(u: Array, v: Array) -> NDArray[np.bool_]:
    """Which cross products u × v are certainly positive, for u, v of shape (n, 2).

    The true value is certain to be positive even when the entries of u and v are themselves
    differences of doubles rounded once: rounding changes u × v by less than 2⁻⁵⁰ times the
    sum of the two products' sizes (six roundings of at most 2⁻⁵³ each).
    """
    first = np.multiply(u[:, 0], v[:, 1])
    second = np.multiply(u[:, 1], v[:, 0])
    bound = np.multiply(np.add(np.abs(first), np.abs(second)), 2.0**-50)
    return np.asarray(np.subtract(first, second) > bound)


def surely_left_of_origin(vertices: Array) -> bool:
    """Whether the origin is certainly strictly left of every edge of the closed polygon."""
    return bool(surely_positive_cross(vertices, np.roll(vertices, -1, axis=0)).all())


def surely_convex_corners(vertices: Array) -> NDArray[np.bool_]:
    """At which vertices the closed polygon certainly turns strictly left."""
    forward = np.subtract(np.roll(vertices, -1, axis=0), vertices)
    return surely_positive_cross(np.roll(forward, 1, axis=0), forward)


def inverse_power(n: int, power: int) -> float:
    """n^(−power); the integer power is exact, so no library ``pow`` is asked."""
    return 1.0 / float(n**power) if power else 1.0
