"""Compiling with Numba, for the kernels of the fast builder; see :mod:`harness.geometry.jit`."""

from __future__ import annotations

from harness.geometry.jit import compiled

__all__ = ["compiled"]
