"""What every verb shares: finding it, failing, stopping; and that ``avd --help`` imports little."""

import subprocess
import sys
from pathlib import Path

import pytest

from harness.cli import main as command
from harness.cli.main import VERBS, build_parser, main
from harness.errors import UserError

HEAVY = ("numpy", "pandas", "matplotlib", "scipy", "numba", "flint", "jinja2", "pebble")
ROOT = Path(__file__).resolve().parents[2]


def run_python(code: str, **options) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, **options
    )


def test_help_imports_nothing_heavy():
    code = (
        "import sys\n"
        "from harness.cli.main import build_parser\n"
        "build_parser().format_help()\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules])\n"
    )
    done = run_python(code)
    assert (done.stdout, done.stderr) == ("[]\n", "")


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help(verb, capsys):
    with pytest.raises(SystemExit) as stop:
        main([verb, "--help"])
    assert stop.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: avd {verb}")


def test_the_version_is_printed(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out.startswith("avd ")


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["cuont"], "did you mean 'count'?"),
        (["zzz"], "the verbs are count, draw"),
        ([], "VERB"),
        (["count"], "FILE"),
        (["count", "x.json", "--domain", "kernell"], "kernell"),
        (["--versio"], "VERB"),
    ],
)
def test_wrong_usage_is_status_2_and_says_why(arguments, hint, capsys):
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    told = capsys.readouterr()
    assert stop.value.code == 2
    assert hint in told.err
    assert not told.out


def failing_with(monkeypatch, error: BaseException) -> int:
    def run(_args):
        raise error

    parser = build_parser()
    monkeypatch.setattr(
        parser, "parse_args", lambda _: type("Args", (), {"run": staticmethod(run)})
    )
    monkeypatch.setattr(command, "build_parser", lambda: parser)
    return main(["families"])


@pytest.mark.parametrize(
    ("error", "status", "told"),
    [
        (
            UserError("f.json: segment 3:\n  zero length"),
            1,
            "avd: f.json: segment 3: zero length\n",
        ),
        (FileNotFoundError(2, "No such file", "a.svg"), 1, "avd: a.svg: No such file\n"),
        (OSError("device lost"), 1, "avd: device lost\n"),
        (KeyboardInterrupt(), 130, "avd: interrupted\n"),
    ],
)
def test_failures_are_one_line(monkeypatch, capsys, error, status, told):
    assert failing_with(monkeypatch, error) == status
    assert capsys.readouterr().err == told


def test_a_fault_of_the_program_is_not_hidden(monkeypatch):
    with pytest.raises(ZeroDivisionError):
        failing_with(monkeypatch, ZeroDivisionError())


def test_a_reader_that_goes_away_is_no_error():
    code = (
        "import os, sys\n"
        "from harness.cli.main import main\n"
        "read, write = os.pipe()\n"
        "os.close(read)\n"
        "os.dup2(write, 1)\n"
        "sys.exit(main(['families']))\n"
    )
    done = run_python(code)
    assert (done.returncode, done.stderr) == (0, "")
