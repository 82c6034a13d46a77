"""The picture of a family in the report: of an instance that the study counted, or none."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pandas as pd
import pytest

import generators
from harness.diagram import build
from harness.geometry.instance import Instance
from harness.report.build import StudyGrowth, analyse
from harness.report.examples import MOST, example
from harness.report.page import outputs
from harness.report.pages import REPORT
from tests.analysis.frames import rows
from tests.report.studies import MANIFEST, defaults, sample

TERMS = Path(__file__).parents[2] / "harness" / "report" / "templates" / "terms.html"


def counted(sizes: tuple[int, ...]) -> pd.DataFrame:
    """Rows of a family with the counts and seeds of real diagrams."""
    frame = rows("near-regular", lambda n, _: n, params=defaults("near-regular"), sizes=sizes)
    for index, row in frame.iterrows():
        made = generators.generate("near-regular", int(row["n"]), seed=int(row["seed"]))
        counts = build(Instance.from_generated(made)).counts
        for name in ("cells", "edges", "vertices"):
            frame.loc[index, name] = getattr(counts, name)
    return frame


@pytest.fixture(scope="module")
def study() -> StudyGrowth:
    return analyse(counted((4, 6, 8, 10, 12)), "sample", MANIFEST)


def test_it_shows_the_largest_small_instance(study: StudyGrowth) -> None:
    found = example(study.groups)
    assert found is not None
    assert found.caption.startswith(f"n = {MOST['kernel']}, seed ")
    ET.fromstring(found.document.encode())
    last = study.groups[0].group.rows.sort_values("n").iloc[-1]
    assert f"{last['cells']} cells, {last['edges']} edges, " in found.caption


def test_it_is_on_the_page_and_beside_it(study: StudyGrowth) -> None:
    files = outputs(study)
    assert "figures/example-near-regular.svg" in files
    assert 'href="figures/example-near-regular.svg"' in files[REPORT]
    assert files == outputs(study)


@pytest.mark.parametrize("change", [{"vertices": 77}, {"family": "of-yesterday"}, {"segments": 90}])
def test_what_was_not_counted_is_not_shown(study: StudyGrowth, change: dict[str, object]) -> None:
    frame = study.groups[0].group.rows.assign(**change)
    assert example(analyse(frame, "sample", MANIFEST).groups) is None


def test_the_terms_are_explained_and_their_example_is_true() -> None:
    page = outputs(analyse(sample(), "sample", MANIFEST))[REPORT]
    assert 'id="terms"' in page
    terms = TERMS.read_text(encoding="utf-8")
    (found,) = re.findall(r"n/2 − 2 have an exponent of ([\d.]+) between n = 6 and n = 20", terms)
    assert float(found) == round(math.log((20 / 2 - 2) / (6 / 2 - 2)) / math.log(20 / 6), 1)


def test_an_exponent_that_differs_from_the_verdict_is_explained() -> None:
    page = outputs(analyse(sample(), "sample", MANIFEST))[REPORT]
    exponents = re.findall(r"exponent ([\d.]+)[^,]*, not 1: a pure power has no lower-order", page)
    assert exponents  # counts of exactly n/2 − 2, and a linear verdict
    assert all(abs(float(exponent) - 1) >= 0.05 for exponent in exponents)
