"""The report on weaves: shown where it belongs, numbers from the rows, faults in plain sight."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

from harness.analysis import analyse_group, smoothed, split
from harness.analysis.smoothed import Estimate
from harness.analysis.weave import predict
from harness.analysis.weave_rows import SHAPES
from harness.report import weaves, write_report
from harness.report.parts import Part
from harness.report.smoothed import trend
from harness.report.weave_picture import ideal
from tests.analysis.frames import rows
from tests.analysis.weaves import corners, visual_angles
from tests.report.studies import sample, store


@pytest.fixture(autouse=True)
def few_resamples(monkeypatch) -> None:
    monkeypatch.setattr(smoothed, "RESAMPLES", 20)


def weave(family: str, value: float, sizes: tuple[int, ...], noise: float = 1e-9, **more):
    """Rows that agree with the prediction, as a study would store them."""
    params = {SHAPES[family][0]: value, "noise": noise, "noise_power": 0}
    frame = rows(family, lambda n, _: 0, sizes=sizes, params=params, **more)
    for index, n in zip(frame.index, frame["n"], strict=True):
        ideal = predict(n // 2, 1.0, SHAPES[family][1](int(n), value))
        counts = {"vertices": ideal.vertices, "edges": ideal.edges, "cells": ideal.cells}
        for name, count in counts.items():
            frame.loc[index, name] = count
        frame.loc[index, "degrees"] = json.dumps({"3": ideal.vertices})
    return frame


def tilted(*families: str) -> pd.DataFrame:
    values = {"zigzag": (0.3, 0.6, 0.9), "convex-weave": (0.2, 0.5, 0.8)}
    chosen = families or tuple(values)
    parts = [weave(name, value, (12, 16, 24)) for name in chosen for value in values[name]]
    return pd.concat(parts, ignore_index=True)


def noisy(exponent: float) -> pd.DataFrame:
    """Zigzags of which a noise ε leaves the share 1/(1 + ε·nᵃ/2ᵃ)."""
    rng = np.random.default_rng(1)
    parts = []
    for noise in (1e-6, 1e-5, 1e-4, 1e-3, 1e-2):
        frame = weave("zigzag", 0.5, (16, 24, 32, 48), noise, replicates=4)
        share = 1 / (1 + noise * (frame["n"] / 2.0) ** exponent)
        scatter = rng.lognormal(0, 0.02, len(frame))
        frame["vertices"] = (frame["vertices"] * share * scatter).round().astype(int)
        parts.append(frame)
    return pd.concat(parts, ignore_index=True)


def parts_of(frame: pd.DataFrame) -> list[Part]:
    return weaves.parts([analyse_group(group) for group in split(frame)])


def test_a_study_without_weaves_has_no_such_section() -> None:
    assert parts_of(sample()) == []
    assert parts_of(weave("zigzag", 0.5, (12, 16, 24))) == []  # one shape, one noise


def test_counts_as_predicted_are_said_to_be_so() -> None:
    (part,) = parts_of(tilted())
    assert part.slug == "weave"
    assert part.shown["summary"] == (
        "Of 18 certified counts, 18 are exactly as predicted; none contradicts the prediction."
    )
    assert part.shown["deviations"].rows == []


def test_a_planted_fault_is_announced() -> None:
    frame = tilted()
    frame.loc[frame.index[0], "vertices"] += 1
    (part,) = parts_of(frame)
    assert "17 are exactly as predicted; 1 contradicts the prediction." in part.shown["summary"]
    (row,) = part.shown["deviations"].rows
    assert row[-1].text == "unexplained"


@pytest.mark.parametrize("exponent", [2.0, 3.0])
def test_a_planted_scaling_is_found(exponent) -> None:
    (part,) = parts_of(noisy(exponent))
    assert part.slug == "smoothed"
    (view,) = part.shown["views"]
    ruled_out = {2.0: "rules out 1, 3, 4, 5 and leaves 2 of the whole exponents from 1 to 5."}
    ruled_out[3.0] = "rules out 1, 2, 4, 5 and leaves 3 of the whole exponents from 1 to 5."
    assert any(ruled_out[exponent] in sentence for sentence in view["sentences"])


def test_exponents_that_lean_one_way_are_called_undecided() -> None:
    def said(*exponents: float, width: float = 0.01) -> str:
        return trend([Estimate(a, a - width, a + width) for a in exponents])

    assert "rise with n throughout" in said(3.7, 3.8, 3.9)
    assert "fall with n throughout" in said(3.2, 3.1, 3.0)
    assert not said(3.1, 2.9, 3.0)
    assert not said(3.1, 3.2)
    assert not said(3.7, 3.8, 3.9, width=0.1)


def test_the_page_shows_both_and_loads_nothing(tmp_path) -> None:
    frame = pd.concat([tilted("convex-weave"), noisy(3.0)], ignore_index=True)
    directory = store(tmp_path / "study", frame)
    page = write_report(directory).read_text(encoding="utf-8")
    for word in ('<section id="weave">', '<section id="smoothed">', "the derivation in full"):
        assert word in page
    assert page.index('<section id="weave">') < page.index('<section id="verdicts">')
    assert "src=" not in page
    assert (directory / "data" / "weaves.csv").read_text().count("\n") == len(frame) + 1
    for name in ("weave-convex-weave", "weave-ideal", "smoothed-zigzag-0.5"):
        assert (directory / "figures" / f"{name}.svg").read_text().startswith("<?xml")
        assert page.count(f'href="figures/{name}.svg"') == 1


def test_the_section_is_the_same_whatever_the_order_of_rows() -> None:
    frame = pd.concat([tilted("convex-weave"), noisy(3.0)], ignore_index=True)
    mixed = frame.sample(frac=1.0, random_state=5)
    for one, other in zip(parts_of(frame), parts_of(mixed), strict=True):
        assert one.files == other.files


def test_the_picture_of_the_ideal_weave_is_true() -> None:
    """Its saddles are ties of two edges, its squares of four, by plain visual angles."""
    shape = ideal()
    vertices = corners(shape.weave.m, shape.ratio)
    for tip in shape.passing():
        direction = float(shape.tips(tip)[0])
        for aside, tied in ((0.0, 2), (2 * shape.h, 4)):
            radius = float(shape.radius(np.array(tip), np.array(aside)))
            at = direction + aside
            p = radius * np.array([np.cos(at), np.sin(at)])
            if radius > shape.ratio * (1 - 1e-9):
                continue  # in a corner, where the angles of its own edges are undefined
            angles = np.sort(visual_angles(vertices, p))
            assert np.ptp(angles[:tied]) < 1e-9 < angles[tied] - angles[0]
