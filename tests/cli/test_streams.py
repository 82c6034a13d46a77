"""Closed, full and abandoned standard streams: one line, an exit status, and never a traceback."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
AVD = [sys.executable, "-m", "harness.cli.main"]
TRIANGLE = '{"kind": "polygon", "vertices": [[0, 0], [4, 0], [0, 3]]}'


@pytest.fixture(scope="module")
def triangle(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("streams") / "triangle.json"
    path.write_text(TRIANGLE)
    return str(path)


def run(arguments: list[str], redirection: str) -> subprocess.CompletedProcess[str]:
    """The command with its streams redirected by a shell."""
    script = f'exec "$@" {redirection}'
    return subprocess.run(
        ["sh", "-c", script, "sh", *AVD, *arguments],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=False,
    )


@pytest.mark.parametrize("verb", ["count", "draw"])
def test_closed_standard_input(verb: str) -> None:
    done = run([verb, "-"], "<&-")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == "avd: standard input: is closed\n"


@pytest.mark.parametrize(
    "command",
    [
        "count FILE",
        "count --json FILE",
        "draw FILE",
        "families",
        "study --list",
        "generate zigzag -n 8",
        "--version",
        "count --help",
    ],
)
def test_closed_standard_output(command: str, triangle: str) -> None:
    done = run(command.replace("FILE", triangle).split(), ">&-")
    assert done.returncode == 1
    assert done.stderr == "avd: standard output: is closed\n"


def test_a_command_that_writes_a_file_needs_no_standard_output(tmp_path: Path) -> None:
    target = tmp_path / "star.json"
    done = run(["generate", "zigzag", "-n", "8", "-o", str(target)], ">&- <&-")
    assert (done.returncode, done.stderr) == (0, "")
    assert len(json.loads(target.read_text())["vertices"]) == 8


def test_messages_do_not_go_to_standard_output_if_the_error_stream_is_closed() -> None:
    done = run(["count", "absent.json"], "2>&-")
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "")


def test_an_output_file_that_takes_no_more(tmp_path: Path) -> None:
    script = 'ulimit -f 0; exec "$@" > out'
    command = ["sh", "-c", script, "sh", *AVD, "--help"]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        check=False,
    )
    assert (done.returncode, done.stderr) == (1, "avd: File too large\n")


def test_a_reader_that_goes_away_is_no_failure() -> None:
    process = subprocess.Popen(
        [*AVD, "families"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=ROOT
    )
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    assert process.stderr.read() == b""
    process.stderr.close()
    assert process.wait() == 0


@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_standard_input_may_begin_with_a_byte_order_mark(mark: str) -> None:
    done = subprocess.run(
        [*AVD, "count", "--json", "-"],
        input=(mark + TRIANGLE).encode(),
        capture_output=True,
        cwd=ROOT,
        env={"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONPATH": str(ROOT)},
        check=True,
    )
    assert json.loads(done.stdout)["cells"] == 3
