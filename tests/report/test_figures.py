"""Figures show the stored numbers and no others."""

from __future__ import annotations

import io

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from harness.analysis import HEADLINES
from harness.report import figures, tables
from harness.report.build import StudyGrowth, analyse
from harness.report.labels import number
from harness.report.provenance import without_directories
from harness.report.style import inline, render
from tests.report.studies import sample


@pytest.fixture(scope="module")
def study() -> StudyGrowth:
    return analyse(sample(), "sample")


def numbers(*texts: str) -> set[float]:
    """Every number in the CSV texts."""
    found: set[float] = set()
    for text in texts:
        table = pd.read_csv(io.StringIO(text))
        for column in table.select_dtypes("number"):
            found.update(float(value) for value in table[column].dropna())
    return found


@pytest.mark.parametrize("headline", HEADLINES)
@pytest.mark.parametrize("index", [0, 1, 2])
def test_every_plotted_number_is_in_the_linked_data(
    study: StudyGrowth, headline: str, index: int
) -> None:
    analysed = study.groups[index]
    texts = [
        tables.to_csv(table)
        for table in (
            tables.curves(analysed),
            tables.trials(analysed),
            tables.raw_rows(analysed.group),
        )
    ]
    stored = numbers(*texts)
    curves, trials, rows = (tables.from_csv(text) for text in texts)
    figure = Figure()
    of_count = curves[curves["count"] == headline]
    of_trials = trials[trials["count"] == headline]
    figures.growth(figure, of_count, of_trials, rows[rows["status"] == "ok"], "n")
    upper, lower = figure.axes
    plotted: set[float] = set()
    for line in upper.lines:
        plotted.update(np.asarray(line.get_xydata()).ravel().tolist())
    for band in upper.collections:
        for path in band.get_paths():
            plotted.update(path.vertices.ravel().tolist())
    misses = {float(x) for line in lower.lines for x in np.ravel(line.get_xdata())}
    assert len(plotted) > 6
    assert plotted <= stored
    assert misses - {0.0} <= stored
    assert upper.lines
    maximum = of_count[of_count["statistic"] == "maximum"]["value"].tolist()
    assert any(np.ravel(line.get_ydata()).tolist() == maximum for line in upper.lines)


def test_the_overview_shows_the_stored_ratios(study: StudyGrowth) -> None:
    text = tables.to_csv(tables.overview(study.groups, study.labels))
    figure = Figure(figsize=(4.8, 4.0))
    figures.overview(figure, tables.from_csv(text))
    plotted = {
        float(value) for line in figure.axes[0].lines for value in np.ravel(line.get_xydata())
    }
    assert plotted
    assert plotted <= numbers(text)


def test_very_many_curves_are_named_by_family() -> None:
    rows = [
        {"curve": f"{family}, tilt = {k}", "n": n, "per_n": float(n + k)}
        for family, curves in (("zigzag", 12), ("weave", 9))
        for k in range(1, curves + 1)
        for n in (8, 16)
    ]
    table = pd.DataFrame(rows)
    figure = Figure(figsize=(4.8, figures.overview_height(table["curve"])))
    figures.overview(figure, table)
    (axes,) = figure.axes
    assert len(axes.lines) == 21
    named = [text.get_text().split(",")[0] for text in axes.get_legend().get_texts()]
    assert sorted(named) == ["weave: 9 curves", "zigzag: 12 curves"]
    few = table[table["curve"].str.startswith("weave")]
    assert figures.overview_height(few["curve"]) > figures.overview_height(table["curve"])


def test_tables_survive_the_way_through_text(study: StudyGrowth) -> None:
    for analysed in study.groups:
        for table in (tables.curves(analysed), tables.trials(analysed)):
            text = tables.to_csv(table)
            assert tables.to_csv(tables.from_csv(text)) == text


def test_verdicts_have_a_row_for_every_curve(study: StudyGrowth) -> None:
    table = tables.verdicts(study.groups)
    assert len(table) == 3 * 3 * 3
    assert not table.duplicated(["family", "params", "domain", "count", "statistic"]).any()


def test_ids_of_two_inlined_figures_never_meet() -> None:
    def draw(figure: Figure) -> None:
        figure.add_subplot().plot([1, 2], [3, 4])

    document = render(draw, 2, 2)
    assert document == render(draw, 2, 2)
    one, other = inline(document, "a", "x"), inline(document, "b", 'a "label" & <more>')
    ids = [{part.split('"')[0] for part in text.split(' id="')[1:]} for text in (one, other)]
    assert ids[0]
    assert not ids[0] & ids[1]
    assert 'aria-label="a &quot;label&quot; &amp; &lt;more>"' in other


@given(
    value=st.floats(-1e300, 1e300) | st.sampled_from([float("inf"), float("-inf"), float("nan")])
)
def test_numbers_in_tables_are_short_and_right(value: float) -> None:
    text = number(value)
    assert len(text) <= 22
    raised = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    readable = text.replace("−", "-").replace("·10", "e").replace("∞", "inf").translate(raised)
    if text != "–":
        assert float(readable) == pytest.approx(value, rel=6e-3)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("avd study quick --jobs 2", "avd study quick --jobs 2"),
        ("/usr/bin/avd study /a/b.toml", "avd study b.toml"),
        ("avd study '/a b/c d.toml'", "avd study 'c d.toml'"),
        ("--out=/x/y/z", "--out=z"),
        (r"C:\Users\x\study.toml", "study.toml"),
        ("1/2 of n/a", "1/2 of n/a"),
    ],
)
def test_absolute_paths_are_cut_to_their_last_part(text: str, expected: str) -> None:
    assert without_directories(text) == expected
