"""Benchmarks: fixed instances, timed apart from each other, beside the figures to be reached.

One file of this room describes one benchmark (``diagram``, ``peak``, ``mesh``); the rest of the
room is what all of them share: timing (``timing``), processes of their own (``runner``), rows and
manifest (``store``), the table (``table``).  A new benchmark is a new file with a ``BENCHMARK`` in
it, and its name below.  ``optimisers`` and ``smoothers``: what peaks and meshes are compared with.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from harness.bench.benchmark import Benchmark

BENCHMARKS = ("diagram", "peak", "mesh")
"""The names of the benchmarks; each is a module of this room, imported when asked for."""


def benchmark_named(name: str) -> Benchmark:
    """The benchmark called ``name``, one of ``BENCHMARKS``."""
    benchmark: Benchmark = importlib.import_module(f"harness.bench.{name}").BENCHMARK
    return benchmark
