"""The verb ``audit``."""

import json

import pytest

from harness.audit.registry import CLAIMS
from harness.cli.main import main


def test_the_list_names_every_claim(capsys) -> None:
    assert main(["audit", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(CLAIMS)


def test_an_audit_is_run_reported_and_reported_again(tmp_path, capsys) -> None:
    out = tmp_path / "audit"
    words = ["audit", "lemma-4-convex", "--count", "5", "--jobs", "1", "--out", str(out)]
    assert main(words) == 0
    shown = capsys.readouterr()
    assert shown.out.startswith("lemma-4-convex ")
    assert "report.html" in shown.err
    assert main([*words, "--json", "--resume"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["claim"] == "lemma-4-convex"
    assert sum(record["tally"].values()) == 5
    page = (out / "report.html").read_bytes()
    assert main(["report", str(out)]) == 0
    assert (out / "report.html").read_bytes() == page
    assert "lemma-4-convex: " in capsys.readouterr().out
    commands = [r["command"] for r in json.loads((out / "manifest.json").read_text())["runs"]]
    assert [command.endswith("--resume") for command in commands] == [False, True]
    assert main(words) == 0  # everything anew: earlier runs have no part in it
    assert len(json.loads((out / "manifest.json").read_text())["runs"]) == 1


def test_an_unknown_claim_is_refused_in_one_line(capsys) -> None:
    assert main(["audit", "lemma-22"]) == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "lemma-2" in error


@pytest.mark.parametrize("words", [["--count", "0"], ["--seed", "-1"], ["--jobs", "x"]])
def test_bad_numbers_are_usage_errors(words) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["audit", *words])
    assert stop.value.code == 2


def test_an_interruption_says_how_to_continue(tmp_path, capsys, monkeypatch) -> None:
    def interrupted(*_args, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr("harness.audit.runner.run_audit", interrupted)
    out = str(tmp_path / "a")
    assert main(["audit", "lemma-1", "--out", out, "--count", "3"]) == 130
    assert f"avd audit lemma-1 --out {out} --count 3 --resume" in capsys.readouterr().err
