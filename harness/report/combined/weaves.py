"""The weaves: their counts beside the exact prediction, and how much noise they bear."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from harness.report.build import read
from harness.report.combined.parts import Chapter, Workshop, absent
from harness.report.labels import number, raised
from harness.report.parts import Figure, Part
from harness.report.plates.comparisons import SMOOTHED, WEAVE
from harness.report.plates.studies import first_of
from harness.report.sections import Download
from harness.report.weaves import parts

CONSTANT = ("weave", "How many vertices does a weave have?")
NOISE = ("smoothed", "How much noise does a weave bear?")


def constant_chapter(shop: Workshop) -> Chapter:
    """Every weave beside its prediction, the reason of every deviation, and the derivation."""
    found = _part(shop, WEAVE, CONSTANT[0])
    if found is None:
        return absent(*CONSTANT, WEAVE[:1])
    name, part = found
    wrong = int(part.shown["unexplained"])
    limit = (
        "For large n it is about (n²/2)(1 − 2τ/π) vertices for zigzag stars of tilt τ, and n²/2 "
        "for convex weaves."
    )
    return Chapter(
        *CONSTANT,
        f"{wrong} counts contradict the prediction" if wrong else "As derived: of order n²",
        "" if wrong else "faster",
        [f"{part.shown['summary']} {limit}"],
        part=part,
        sources=[name],
    )


def noise_chapter(shop: Workshop) -> Chapter:
    """Vertices that are left when those of the polygon are moved at random, and how that scales."""
    found = _part(shop, SMOOTHED, NOISE[0])
    if found is None:
        return absent(*NOISE, SMOOTHED[:1])
    name, part = found
    views = part.shown["views"]
    sentences = [f"{view['title']}: {view['sentences'][0]}" for view in views]
    powers = [f"n⁻{raised(number(view['exponent'].value))} ({view['family']})" for view in views]
    answer = f"At these sizes about {' and '.join(powers)}"
    return Chapter(*NOISE, answer, "slower", sentences, part=part, sources=[name])


def _part(shop: Workshop, studies: tuple[str, ...], slug: str) -> tuple[str, Part] | None:
    """The part of that slug of the first of the studies that has rows, and the study's name."""
    directory = first_of(shop.results, studies)
    if directory is None:
        return None
    part = next((part for part in parts(read(directory).groups) if part.slug == slug), None)
    if part is None:
        return None
    # Its files are those beside the study's own report; another study has some of the same name.
    here = replace(part, **_moved(vars(part), directory.name))
    shop.files.update(here.files)
    return directory.name, here


def _moved(value: Any, folder: str) -> Any:
    """The same with every figure and table in a folder."""
    if isinstance(value, Figure | Download):
        return replace(value, path=f"{folder}/{value.path}")
    if isinstance(value, Mapping):
        return {name: _moved(item, folder) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_moved(item, folder) for item in value]
    return value
