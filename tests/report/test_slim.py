"""A slim figure shows what the one that matplotlib wrote shows."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from collections import Counter

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from harness.report.slim import slim

Shape = tuple[str, str, tuple[float, ...], str]


@pytest.fixture(scope="module")
def document() -> str:
    """Lines, markers of one and of several styles, text, a clipped region and a legend."""
    rng = np.random.default_rng(5)
    with mpl.rc_context({"svg.fonttype": "none", "font.family": ["DejaVu Sans"]}):
        figure = Figure(figsize=(3, 3))
        axes = figure.add_subplot()
        axes.plot(rng.random(50), rng.random(50), ".", alpha=0.4, label="dots & <more>")
        axes.scatter(rng.random(9), rng.random(9), c=rng.random(9))
        axes.fill_between([0, 1], [0.1, 0.2], [0.3, 0.5])
        axes.set_title("one  title")
        axes.legend()
        buffer = io.StringIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    return buffer.getvalue()


def shapes(document: str) -> Counter[Shape]:
    """Everything visible: what it is, its words or its source, its numbers, the style it ends up
    with from itself and from the groups around it."""
    root = ET.fromstring(document.encode())
    names = {element.get("id"): element for element in root.iter() if element.get("id")}
    found: Counter[Shape] = Counter()

    def visit(element: ET.Element, style: dict[str, str], clip: str) -> None:
        tag = element.tag.partition("}")[2]
        style = {**style, **dict(re.findall(r"([\w-]+): ([^;]*)", element.get("style", "")))}
        if "font-family" in element.attrib:
            style["font-family"] = element.attrib["font-family"]
        clip = element.get("clip-path", clip)
        if tag in ("path", "use", "text", "rect"):
            link = element.get("{http://www.w3.org/1999/xlink}href", "")
            words = element.text or "" if tag == "text" else link
            if link:
                assert link[1:] in names
            drawn = " ".join(element.get(name, "") for name in ("x", "y", "d", "transform"))
            drawn = re.sub(r"rotate\(-?0 [^)]*\)", "", drawn)
            numbers = tuple(round(float(x), 1) for x in re.findall(r"-?\d+\.?\d*", drawn))
            used = {
                key: value for key, value in style.items() if tag == "text" or "font" not in key
            }
            found[tag, words, numbers, f"{sorted(used.items())} {clip}"] += 1
        if tag != "clipPath":
            for child in element:
                visit(child, style, clip)

    visit(root, {}, "")
    return found


def test_it_shows_the_same(document: str) -> None:
    """Coordinates to a tenth: rounding twice may move a few by one more hundredth."""
    before, after = shapes(document), shapes(slim(document))
    assert before.total() == after.total() > 80
    assert (before - after).total() < 0.1 * before.total()
    words = [Counter(key[:2] for key in found.elements()) for found in (before, after)]
    assert words[0] == words[1]
    styles = [Counter((key[0], key[3]) for key in found.elements()) for found in (before, after)]
    assert styles[0] == styles[1]


def test_it_is_smaller_and_cannot_be_made_slimmer(document: str) -> None:
    once = slim(document)
    assert len(once) < 0.7 * len(document)
    assert slim(once) == once
