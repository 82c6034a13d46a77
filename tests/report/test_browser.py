"""The committed pages in a browser: no error, nothing from outside, every head sorts its column.

Where no Chromium is found these tests are skipped; what can be said of a page without one is in
``test_page`` and its neighbours.
"""

from __future__ import annotations

import subprocess
from collections import Counter
from pathlib import Path

import pytest

from tests.report.browser import Seen, dump, find, see

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted((ROOT / "results").rglob("report.html"))
PHONE, DESKTOP = 360, 1200
FAULTY = """<!doctype html><html><head><title>t</title></head><body>
<table class="sortable"><thead><tr><th>n</th></tr></thead>
<tbody><tr><td data-key="1">1</td></tr></tbody></table>
<details><p>folded</p></details><p style="width: 3000px">wide</p>{}</body></html>"""


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> str:
    program = find()
    if program is None:
        pytest.skip("no Chromium on this machine")
    try:
        text = dump(program, "data:text/html,<p>here", tmp_path_factory.mktemp("first"))
    except (subprocess.SubprocessError, OSError) as error:
        pytest.skip(f"the Chromium on this machine does not run: {error}")
    assert "<p>here" in text
    return program


def number(key: str) -> float | None:
    try:
        return float(key)
    except ValueError:
        return None


def check_sorted(keys: list[str], down: bool) -> None:
    """Numbers in order, and what is missing at the end, whichever the direction."""
    present = [key for key in keys if key not in ("", "nan", "–")]
    assert keys[: len(present)] == present
    numbers = [number(key) for key in present]
    if all(value is not None for value in numbers):
        assert numbers == sorted(numbers, reverse=down, key=lambda value: value or 0.0)


def check(seen: Seen, width: int) -> None:
    assert seen.faults == []
    assert seen.fetched == []
    assert seen.blank == []
    assert seen.width == width
    assert seen.reach <= width  # wide tables scroll in themselves, the page does not
    assert seen.reach_unfolded <= width
    assert seen.folded_on_paper == 0
    for table in seen.tables:
        for column in table:
            assert Counter(column.orders[1]) == Counter(column.orders[0])
            assert column.marks == ["ascending", "descending"], column.name
            check_sorted(column.orders[1], down=False)
            check_sorted(column.orders[2], down=True)


@pytest.mark.parametrize("width", [PHONE, DESKTOP])
@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.parent.name)
def test_a_page_opens_without_a_fault(path: Path, width: int, browser: str, tmp_path: Path) -> None:
    seen = see(browser, path.read_text(encoding="utf-8"), tmp_path, width)
    check(seen, width)
    assert seen.pictures > 0
    assert seen.tables


def test_all_studies_have_pages() -> None:
    assert {path.parent.name for path in PAGES} >= {"results", "audit", "conjecture", "weave"}


@pytest.mark.parametrize(
    ("planted", "word"),
    [
        ("<img src='http://elsewhere.example/dot.png'>", "elsewhere.example"),
        ("<link rel=stylesheet href='https://elsewhere.example/a.css'>", "elsewhere.example"),
        ("<img src='data:image/png;base64,AAAA'>", "not loaded"),
        ("<script>undefined_name()</script>", "undefined_name"),
        ("<script>Promise.reject('broken')</script>", "broken"),
        ("<script>console.error('alas')</script>", "alas"),
    ],
)
def test_a_planted_fault_is_seen(planted: str, word: str, browser: str, tmp_path: Path) -> None:
    seen = see(browser, FAULTY.format(planted), tmp_path, DESKTOP)
    assert any(word in fault for fault in seen.faults)
    assert seen.reach > DESKTOP
    assert seen.folded_on_paper == 1
    assert seen.tables[0][0].marks == [None, None]  # no script of ours, nothing is sorted


def test_a_policy_against_loading_is_seen_to_work(browser: str, tmp_path: Path) -> None:
    policy = "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
    policy += "script-src 'unsafe-inline'\">"
    page = FAULTY.format("<img src='http://elsewhere.example/dot.png'>")
    seen = see(browser, page.replace("<title>", policy + "<title>"), tmp_path, DESKTOP)
    assert any(fault.startswith("not allowed: http://elsewhere") for fault in seen.faults)
