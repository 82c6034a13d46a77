"""A page as a real browser shows it: headless Chromium, told to print what its page has become.

The page is copied with one script of ours at its very beginning, which listens from then on and,
once everything is loaded, sends what it saw to the document around it: the page stands in a frame,
because a window cannot be made as narrow as a phone.  No driver and no debugging protocol is needed
for that; names of hosts do not resolve, so nothing could come from outside even by mistake.
"""

from __future__ import annotations

import html
import json
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
SECONDS = 90  # a page of 5 MB takes two on one core

PROBE = """<script>
"use strict";
{
const faults = [];
addEventListener("error", (event) => faults.push(
  event.message || "not loaded: " + (event.target.src || event.target.href)), true);
addEventListener("unhandledrejection", (event) => faults.push(String(event.reason)));
document.addEventListener("securitypolicyviolation",
  (event) => faults.push("not allowed: " + event.blockedURI));
console.error = console.warn = (...words) => faults.push(words.join(" "));

const keys = (table, column) =>
  [...table.tBodies[0].rows].map((row) => row.cells[column].dataset.key);
const sorted = (table) => [...table.tHead.rows[0].cells].map((head, column) => {
  const orders = [keys(table, column)];
  const marks = [];
  for (let click = 0; click < 2; click += 1) {
    head.click();
    orders.push(keys(table, column));
    marks.push(head.getAttribute("aria-sort"));
  }
  return { name: head.textContent.trim(), orders, marks };
});
const blank = (picture) => {
  const box = picture.getBoundingClientRect();
  return !(box.width > 20 && box.height > 20 && (picture.naturalWidth ?? 1) > 0);
};

addEventListener("load", () => setTimeout(() => {
  const folded = () => [...document.querySelectorAll("details:not(.numbers)")]
    .filter((details) => !details.open).length;
  const seen = { width: innerWidth, reach: document.documentElement.scrollWidth };
  seen.folded = folded();
  dispatchEvent(new Event("beforeprint"));
  seen.folded_on_paper = folded();
  for (const details of document.querySelectorAll("details")) details.open = true;
  seen.reach_unfolded = document.documentElement.scrollWidth;
  const pictures = [...document.querySelectorAll("img, figure svg")];
  seen.pictures = pictures.length;
  seen.blank = pictures.filter(blank).map((picture) => picture.outerHTML.slice(0, 200));
  seen.tables = [...document.querySelectorAll("table.sortable")].map(sorted);
  seen.fetched = performance.getEntriesByType("resource").map((entry) => entry.name)
    .filter((name) => !name.startsWith("data:"));
  seen.faults = faults;
  parent.postMessage(JSON.stringify(seen), "*");
}, 0));
}
</script>"""

FRAME = """<!doctype html><meta charset="utf-8"><pre id="seen"></pre>
<script>
addEventListener("message", (event) => {{
  document.getElementById("seen").textContent = event.data;
}});
</script>
<iframe src="page.html" style="width: {width}px; height: 900px; border: 0"></iframe>
"""


@dataclass(frozen=True)
class Column:
    """The keys of one column as they stood, and after one and after two clicks on its head."""

    name: str
    orders: list[list[str]]
    marks: list[str | None]


@dataclass(frozen=True)
class Seen:
    """What the browser saw; widths in CSS pixels, ``reach`` the width of what is laid out."""

    width: int
    reach: int
    reach_unfolded: int
    folded: int
    folded_on_paper: int
    pictures: int
    blank: list[str]
    tables: list[list[Column]]
    fetched: list[str]
    faults: list[str]


def find() -> str | None:
    """The path of a Chromium on this machine, if there is one."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


def dump(program: str, address: str, directory: Path) -> str:
    """The document at ``address`` as it stands when all is loaded; its profile in ``directory``."""
    command = [program, "--headless", "--disable-gpu", "--disable-dev-shm-usage"]
    if os.geteuid() == 0:  # Chromium refuses its sandbox to root; the pages are our own
        command.append("--no-sandbox")
    command += ["--no-first-run", "--disable-background-networking", "--disable-extensions"]
    command += ["--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={directory / 'profile'}"]
    command += ["--hide-scrollbars", "--virtual-time-budget=10000", "--dump-dom", address]
    done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=True)
    return done.stdout


def see(program: str, page: str, directory: Path, width: int) -> Seen:
    """Open the text of a page in a frame of ``width`` CSS pixels."""
    assert page.count("<head>") == 1
    copy = page.replace("<head>", "<head>" + PROBE)
    (directory / "page.html").write_text(copy, encoding="utf-8")
    frame = directory / "frame.html"
    frame.write_text(FRAME.format(width=width), encoding="utf-8")
    text = dump(program, frame.as_uri(), directory)
    start = text.index('<pre id="seen">') + len('<pre id="seen">')
    seen = json.loads(html.unescape(text[start : text.index("</pre>", start)]))
    seen["tables"] = [[Column(**column) for column in table] for table in seen["tables"]]
    return Seen(**seen)
