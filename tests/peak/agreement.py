"""Peaks by all methods, and samples of the kernel: ``python -m tests.peak.agreement --help``.

Every polygon that fails is printed with what failed.  The methods agree if their proven enclosures
have a common point; 10⁴ points of the kernel must not beat the answer, and superlevel sets must be
convex between pairs of them.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from harness.errors import UserError
from harness.geometry.visual_angle import visual_angle
from harness.peak import peak, peaks
from harness.peak.result import Peak
from tests.peak.polygons import STARS, generated, kernel_points, segments_of

SAMPLES = 10_000


def failures(vertices: np.ndarray, methods: list[str], rng: np.random.Generator) -> list[str]:
    """What is wrong with the peaks of one polygon."""
    found: dict[str, Peak] = {}
    wrong = []
    for method in methods:
        try:
            found[method] = peak(vertices.tolist(), method)
        except (ArithmeticError, UserError) as problem:
            wrong.append(f"{method}: {type(problem).__name__}: {problem}")
    if not found:
        return wrong
    low = max(one.lower for one in found.values())
    high = min(one.upper for one in found.values())
    if low > high:
        wrong.append("; ".join(f"{k}: [{p.lower!r}, {p.upper!r}]" for k, p in found.items()))
    wrong += [f"{k}: too wide" for k, p in found.items() if p.upper - p.lower > 1e-12]
    batch = peaks(vertices[np.newaxis])
    if batch.status[0] != 0 or batch.angles[0] > high or batch.bounds[0] < low:
        wrong.append(f"batch: {batch.angles[0]!r} {batch.bounds[0]!r} {batch.status[0]}")
    points = kernel_points(vertices, SAMPLES, rng)
    seen = visual_angle(points[:, np.newaxis], segments_of(vertices)).min(axis=1)
    if np.nanmax(seen) > high:
        wrong.append(f"a point of the kernel is better: {np.nanmax(seen)!r} > {high!r}")
    half = SAMPLES // 2
    middles = (points[:half] + points[half:]) / 2
    between = visual_angle(middles[:, np.newaxis], segments_of(vertices)).min(axis=1)
    if (between < np.minimum(seen[:half], seen[half:]) - 1e-12).any():
        wrong.append("a superlevel set is not convex")
    return wrong


def main() -> int:
    """Exit status 1 if anything failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs=2, default=(0, 10), metavar=("FROM", "TO"))
    parser.add_argument("--sizes", type=int, nargs="+", default=[3, 4, 5, 6, 7, 8, 10, 12])
    parser.add_argument("--families", nargs="+", default=STARS)
    parser.add_argument("--methods", nargs="+", default=["lp", "diagram", "parametric"])
    args = parser.parse_args()
    rng = np.random.default_rng(0)
    count = bad = 0
    begin = time.perf_counter()
    for family in args.families:
        for n in args.sizes:
            for seed in range(*args.seeds):
                vertices = generated(family, n, seed)
                if vertices is None:
                    continue
                count += 1
                for line in failures(vertices, args.methods, rng):
                    bad += 1
                    print(f"{family} n={n} seed={seed}: {line}", flush=True)
    print(f"{count} polygons, {bad} failures, {time.perf_counter() - begin:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
