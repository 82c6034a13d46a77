"""Families of instances: documented functions of (n, parameters, seed) giving coordinates.

``generate(family, n, seed, **params)`` makes an instance, ``FAMILIES`` describes what there is.
Nothing here knows of diagrams.
"""

from generators.family import GROWTHS, Family, GeneratorError, Interval, Parameter
from generators.registry import FAMILIES, Generated, family_named, generate

__all__ = [
    "FAMILIES",
    "GROWTHS",
    "Family",
    "Generated",
    "GeneratorError",
    "Interval",
    "Parameter",
    "family_named",
    "generate",
]
