"""The house itself: lint, formatting, types, the rooms and their doors, and a README that is true.

Everything that is checked of a change is here or beside it, so ``pytest`` is all there is to run.
"""

from __future__ import annotations

import ast
import doctest
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from harness.cli.main import VERBS, build_parser, main
from harness.diagram.counts import Counts
from harness.geometry.formats import parse_instance
from harness.geometry.validation import validate
from harness.study import load

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
#: From the ground up.  A room may use those before it; the generators use nothing at all.
ROOMS = (
    "errors",
    "files",
    "geometry",
    "diagram",
    "peak",
    "mesh",
    "generators",
    "study",
    "bench",
    "analysis",
    "audit",
    "report",
    "voronoi",
    "cli",
)
LONGEST = 350


def sources(*folders: str) -> list[Path]:
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def texts() -> Iterator[tuple[str, str]]:
    """Name and text of everything that people wrote."""
    written = [path for path in ROOT.iterdir() if path.is_file()]
    for folder in ("generators", "harness", "tests", ".ci"):
        written += [path for path in (ROOT / folder).rglob("*") if path.is_file()]
    written.append(ROOT / "results" / "README.md")
    for path in sorted(written):
        if "__pycache__" not in path.parts and path.name not in (".git", ".coverage"):
            yield str(path.relative_to(ROOT)), path.read_text(encoding="utf-8")


def code_blocks(language: str) -> list[str]:
    fenced = re.findall(r"^```(\w*)\n(.*?)^```$", README, flags=re.DOTALL | re.MULTILINE)
    return [block for name, block in fenced if name == language]


MAY_LACK = {"tests/report/test_browser.py": "Chromium"}  # what a machine may lack, and who asks


# --- lint, formatting, types ---------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments",
    [["ruff", "check", "."], ["ruff", "format", "--check", "."], ["mypy"]],
    ids=["lint", "format", "types"],
)
def test_the_tools_are_content(arguments) -> None:
    done = subprocess.run(
        [sys.executable, "-m", *arguments], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_nothing_is_left_open_or_silenced_without_a_reason() -> None:
    unfinished = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|NotImplemented" + r"Error)\b")
    skipped = re.compile(r"pytest\.(mark\.)?(sk" + r"ip|xf" + r"ail)")
    silenced = re.compile(r"# (type: ig" + r"nore|no" + r"qa)\b(?!.*[#(]\s*\S)")
    found = [
        f"{name}:{number}: {line.strip()}"
        for path in sources("generators", "harness", "tests")
        for name in [str(path.relative_to(ROOT))]
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if unfinished.search(line)
        or silenced.search(line)
        or (skipped.search(line) and MAY_LACK.get(name, "nothing") not in line)
    ]
    assert found == []


# --- rooms and doors -----------------------------------------------------------------------------


def test_rooms_are_small() -> None:
    lengths = {
        str(path.relative_to(ROOT)): len(path.read_text().splitlines())
        for path in sources("generators", "harness")
    }
    assert {name: length for name, length in lengths.items() if length > LONGEST} == {}


def imported(path: Path) -> Iterator[str]:
    """Every module that a file imports anywhere, also for type checking only."""
    package = path.relative_to(ROOT).with_suffix("").parts[:-1]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join([*base, *([node.module] if node.module else [])])
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)


def room_of(module: str) -> str | None:
    """The room in which a module lives; None outside the house and for its front door."""
    for name in module.split(".")[:2]:
        if name in ROOMS:
            return name
        if name != "harness":
            return None
    return None


def test_arrows_run_downwards_only() -> None:
    wrong = []
    for path in sources("harness"):
        here = room_of(".".join(path.relative_to(ROOT).with_suffix("").parts))
        for module in imported(path):
            there = room_of(module)
            if here and there and ROOMS.index(there) > ROOMS.index(here):
                wrong.append(f"{path.relative_to(ROOT)} imports {module}")
    assert wrong == []


def test_the_generators_know_nothing_of_the_harness() -> None:
    assert {
        module
        for path in sources("generators")
        for module in imported(path)
        if module.startswith("harness")
    } == set()


def test_every_room_has_its_place_in_the_order() -> None:
    there = {
        path.stem
        for path in (ROOT / "harness").iterdir()
        if not path.name.startswith(("__", ".")) and path.suffix in ("", ".py")
    }
    assert there == set(ROOMS) - {"generators"}


def test_nothing_depends_on_a_machine() -> None:
    folders = "|".join(["work", "root", "farm", "tmp"])
    path = re.compile(rf"(^|[^\w.:])/({folders})/")
    assert [name for name, text in texts() if path.search(text)] == []


# --- the README ----------------------------------------------------------------------------------


def test_the_readme_and_the_check_run_the_same_commands() -> None:
    commands = [line for line in README.splitlines() if line.startswith("python3 -m venv")]
    script = (ROOT / ".ci" / "run").read_text()
    ran = [line.strip() for line in script.splitlines() if "python3 -m venv" in line]
    assert commands == ran
    install = "python3 -m venv .venv && .venv/bin/pip install"
    assert commands == [
        f"{install} . && .venv/bin/avd study quick",
        f"{install} '.[test]' && .venv/bin/pytest",
    ]


def test_the_layout_in_the_readme_is_true() -> None:
    (layout,) = code_blocks("")
    drawn = re.findall(r"^( *)([\w.]+)", layout, flags=re.MULTILINE)
    assert {name for indent, name in drawn if not indent} == {
        "generators",
        "harness",
        "results",
        "tests",
    }
    rooms = [name.removesuffix(".py") for indent, name in drawn if indent]
    assert rooms == [room for room in ROOMS if room != "generators"]


def test_every_command_in_the_readme_is_understood() -> None:
    parser = build_parser()
    used = set()
    for block in code_blocks("sh"):
        for line in block.splitlines():
            words = shlex.split(line, comments=True)
            if words[:1] == ["avd"]:
                words = words[1 : words.index("|")] if "|" in words else words[1:]
                used.add(parser.parse_args(words).verb)
    assert used == set(VERBS)


def test_the_session_in_the_readme_is_what_happens(tmp_path, monkeypatch, capsys) -> None:
    (session,) = code_blocks("console")
    monkeypatch.chdir(tmp_path)
    for step in re.split(r"^\$ avd ", session, flags=re.MULTILINE)[1:]:
        command, _, shown = step.partition("\n")
        assert main(shlex.split(command)) == 0
        assert capsys.readouterr().out == shown


def test_the_picture_in_the_readme_is_what_its_command_draws(tmp_path, monkeypatch) -> None:
    (path,) = re.findall(r'<img src="([^"]+)"', README)
    (command,) = re.findall(r"[Mm]ade\s+by `avd (figures [^`]*)`", README)
    shown = (ROOT / path).read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(shlex.split(command)) == 0
    drawn = (tmp_path / path).read_text(encoding="utf-8")
    # Another version of matplotlib may write other paths, but it writes the same words.
    words = [re.findall(r"<text[^>]*>([^<]*)</text>", text) for text in (shown, drawn)]
    assert words[0] == words[1]
    captions = (tmp_path / path).with_name("captions.json").read_text(encoding="utf-8")
    (cells, vertices) = re.findall(r"woven into (\d+) cells with (\d+) vertices", README)[0]
    assert re.search(rf"{cells} cells, \d+ edges and {vertices} vertices \(certified\)", captions)


def test_the_numbers_of_the_answer_are_those_of_the_rows() -> None:
    rows = load(ROOT / "results" / "conjecture").to_dict("records")
    assert {(row["status"], row["certified"]) for row in rows} == {("ok", True)}

    def vertices(n: int, domain: str, *families: str) -> list[int]:
        return [
            row["vertices"]
            for row in rows
            if (row["n"], row["domain"]) == (n, domain) and row["family"] in families
        ]

    random = ("star", "star-fat", "near-regular", "cavity", "convex-circle", "convex-valtr")
    few = vertices(4096, "kernel", *random)
    said = {
        r"([\d,]+) for the zigzag of 2,048 edges": max(vertices(2048, "kernel", "zigzag")),
        r"([\d,]+) for the convex weave": max(vertices(2048, "kernel", "convex-weave")),
        r"of ([\d,]+) random polygons of 4,096 edges": len(few),
        r"none has more than ([\d,]+) vertices in its kernel": max(few),
        r"([\d,]+) vertices in its interior": max(vertices(2048, "interior", "star")),
    }
    for words, number in said.items():
        assert re.findall(words, " ".join(README.split())) == [f"{number:,}"], words


def test_the_python_in_the_readme_runs() -> None:
    failed, ran = doctest.testfile(str(ROOT / "README.md"), module_relative=False, encoding="utf-8")
    assert (failed, ran > 3) == (0, True)


def test_the_instances_in_the_readme_are_valid() -> None:
    (block,) = code_blocks("json")
    for line in block.splitlines():
        validate(parse_instance(line))


def test_the_readme_explains_every_count() -> None:
    counts = Counts(
        "plane", "smallest", "reference", 1, 1, 0, 0, 1, 0, 1, 1, 0, {}, {}, certified=True
    )
    record = counts.as_dict()
    explained = set(re.findall(r"`(\w+)`", README))
    assert {*record, *record["nodes"], "file", "name", "seconds"} - explained == set()


def test_the_changelog_knows_this_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert f"## [{project['version']}]" in (ROOT / "CHANGELOG.md").read_text()
