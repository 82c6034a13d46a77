"""The page of an audit: whole, offline, the same bytes again."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from harness.audit.cases import sizes
from harness.audit.registry import CLAIMS
from harness.audit.runner import run_audit
from harness.errors import UserError
from harness.report.audit_page import tone, write_audit_page

TRIED = ("lemma-2-proof", "lemma-4-kernel", "not-a-vertex", "lemma-3", "grid")


@pytest.fixture(scope="module")
def audit(tmp_path_factory):
    directory = tmp_path_factory.mktemp("audit")
    claims = {name: CLAIMS[name] for name in TRIED}
    # Smaller grids, and a first example instead of the smallest, are enough for a page.
    claims["grid"] = replace(claims["grid"], cases=sizes({"grid": (3, 4, 5, 6, 8)}))
    run_audit([replace(claim, shrink=False) for claim in claims.values()], directory, count=24)
    write_audit_page(directory)
    return directory


class Links(HTMLParser):
    """What a page refers to, and the names it has."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.names: list[str] = []

    def handle_starttag(self, tag, attrs):
        for key, value in attrs:
            if key in ("href", "src", "xlink:href"):
                self.targets.append(value)
            if key == "id":
                self.names.append(value)


def test_the_page_is_whole_and_offline(audit) -> None:
    page = (audit / "report.html").read_text(encoding="utf-8")
    links = Links()
    links.feed(page)
    assert len(set(links.names)) == len(links.names)
    for target in links.targets:
        if target.startswith("#"):
            assert target[1:] in links.names
        else:
            assert (audit / target).is_file(), target
    assert not re.search(r'(src|href)="(https?:)?//', page)
    for name in TRIED:
        assert CLAIMS[name].title in page


def test_the_same_rows_give_the_same_bytes(audit) -> None:
    names = ["report.html", *(f"figures/{p.name}" for p in (audit / "figures").iterdir())]
    before = {name: (audit / name).read_bytes() for name in names}
    write_audit_page(audit)
    assert {name: (audit / name).read_bytes() for name in names} == before
    assert any("growth" in name for name in names)


def test_verdicts_have_their_tone() -> None:
    def record(holds, fails):
        return {"tally": {"holds": holds, "fails": fails}}

    for_all, there_is = CLAIMS["lemma-2"], CLAIMS["not-a-vertex"]
    assert [tone(for_all, record(*x)) for x in ((3, 0), (3, 1), (0, 0))] == ["good", "bad", "open"]
    assert [tone(there_is, record(*x)) for x in ((1, 5), (0, 5))] == ["good", "open"]


def test_nothing_to_report_on(tmp_path) -> None:
    with pytest.raises(UserError, match="no finished claim"):
        write_audit_page(tmp_path)
