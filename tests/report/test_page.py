"""The page: self-contained, well-formed, complete, and the same bytes for the same rows."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path
from urllib.parse import unquote

import pandas as pd
import pytest

from harness.report.build import analyse
from harness.report.page import outputs
from harness.report.pages import REPORT
from tests.report.pages import Page
from tests.report.studies import MANIFEST, STUDY_FILE, sample, store


@pytest.fixture(scope="module")
def files() -> dict[str, str]:
    return outputs(analyse(sample(), "sample", MANIFEST, STUDY_FILE))


@pytest.fixture(scope="module")
def page(files: dict[str, str]) -> Page:
    return Page(files[REPORT])


def test_nothing_is_loaded_from_elsewhere(files: dict[str, str], page: Page) -> None:
    assert all(load.startswith(("data:", "#")) for load in page.loads)
    text = files[REPORT]
    for address in re.findall(r"https?://[^\s\"'<]+", text):
        assert address.startswith("http://www.w3.org/"), address  # names of XML, never fetched
    for css in re.findall(r"url\(([^)]*)\)", text):
        assert css.startswith("#")
    assert "@import" not in text
    assert "fetch(" not in text
    assert page.scripts == 1
    assert "default-src 'none'" in text


def test_links_lead_somewhere(files: dict[str, str], page: Page) -> None:
    for link in page.links:
        if link.startswith("#"):
            assert link[1:] in page.ids
        elif not link.startswith("data:"):
            assert link in files
    for name in files:
        assert name == REPORT or name in page.links, f"{name} is linked from nowhere"


def test_the_page_holds_a_copy_of_every_table(files: dict[str, str], page: Page) -> None:
    head = "data:text/csv;charset=utf-8,"
    copies = {unquote(link[len(head) :]) for link in page.links if link.startswith(head)}
    assert copies == {text for name, text in files.items() if name.endswith(".csv")}


def test_html_is_well_formed_with_unique_ids_and_square_tables(page: Page) -> None:
    assert not page.open
    assert max(Counter(page.ids).values()) == 1
    for rows in page.widths:
        assert len(set(rows)) <= 1


def test_figures_are_well_formed_svg_without_a_date(files: dict[str, str]) -> None:
    figures = {name: text for name, text in files.items() if name.endswith(".svg")}
    assert len(figures) == 3 * 3 + 2
    for text in figures.values():
        ET.fromstring(text.encode())
        assert "dc:date" not in text
        assert "<image" not in text


def test_same_rows_same_bytes_whatever_their_order(files: dict[str, str]) -> None:
    shuffled = sample().sample(frac=1.0, random_state=11)
    assert outputs(analyse(shuffled, "sample", MANIFEST, STUDY_FILE)) == files


def test_same_rows_same_bytes_in_another_process(tmp_path: Path) -> None:
    contents = []
    for name, seed in (("one", "1"), ("two", "2")):
        directory = store(tmp_path / name / "sample", sample())
        root = Path(__file__).resolve().parents[2]
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(root)}
        environment["MPLCONFIGDIR"] = str(tmp_path / name)
        if name == "two":  # the user's own settings do not reach the figures
            (tmp_path / name / "matplotlibrc").write_text("lines.linewidth: 7\nfont.size: 20\n")
        code = "import sys, pathlib, harness.report as r; r.write_report(pathlib.Path(sys.argv[1]))"
        subprocess.run(
            [sys.executable, "-c", code, str(directory)], env=environment, check=True, cwd=tmp_path
        )
        found = sorted(path for path in directory.rglob("*") if path.is_file())
        contents.append({path.relative_to(directory): path.read_bytes() for path in found})
    assert contents[0] == contents[1]
    assert str(tmp_path).encode() not in contents[0][Path(REPORT)]


def test_every_task_without_a_count_is_listed(files: dict[str, str], page: Page) -> None:
    listed = pd.read_csv(io.StringIO(files["data/failures.csv"]))
    frame = sample()
    failed = frame[frame["status"] != "ok"]
    assert sorted(listed["task"]) == sorted(failed["task"])
    assert Counter(page.words)["stopped after 60 s"] == len(failed)
    assert "INCOMPLETE" not in " ".join(page.words)


def test_censored_maxima_are_marked(files: dict[str, str], page: Page) -> None:
    censored = [word for word in page.words if word.startswith("≥ ")]
    frame = sample()
    seen = frame[(frame["family"] == "segments") & (frame["n"] == 32) & (frame["status"] == "ok")]
    assert f"≥ {seen['vertices'].max()}" in censored


def test_a_missing_part_of_the_study_is_announced() -> None:
    study = analyse(sample(), "sample", {**MANIFEST, "tasks": 10**6})
    assert "INCOMPLETE" in study.lines[0]


def test_text_from_outside_is_escaped() -> None:
    frame = sample()
    frame.loc[frame["status"] != "ok", "message"] = "<script>alert(1)</script> & more"
    frame.loc[frame["family"] == "star", "family"] = "<i>star</i>"
    page = Page(outputs(analyse(frame, "<h1>x</h1>", MANIFEST, STUDY_FILE))[REPORT])
    assert page.scripts == 1
    assert "<script>alert(1)</script> & more" in page.words
    assert "<h1>x</h1>" in page.words
    assert "i" not in page.open
    assert STUDY_FILE in "".join(page.words)


def test_private_paths_do_not_reach_the_page(files: dict[str, str]) -> None:
    assert "/home" not in files[REPORT]
    assert "avd study &#39;sample.toml&#39; --jobs 2" in files[REPORT]


def test_the_page_never_claims_a_proof(page: Page) -> None:
    text = " ".join(page.words).lower()
    assert not re.search(r"\b(proved|proven|provably)\b", text)
    assert "it proves nothing about larger n" in text


def test_the_control_is_called_right_and_the_planted_samples_are_shown(page: Page) -> None:
    text = " ".join(page.words)
    assert "called right" in text
    assert "CALLED WRONG" not in text
    assert text.count("share of samples in which the candidate was rejected") >= 3


def test_a_study_of_failures_alone_still_has_a_report() -> None:
    frame = sample()
    frame = frame[frame["status"] != "ok"]
    study = analyse(frame, "sample", None)
    page = Page(outputs(study)[REPORT])
    assert not page.open
    assert "not decided" in " ".join(study.lines)
    assert "missing: the origin of these rows is not recorded" in page.words
