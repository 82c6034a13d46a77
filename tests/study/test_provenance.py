"""What the manifest says about code and machine is true."""

from __future__ import annotations

import math
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

from harness.study import manifest
from harness.study.manifest import git_commit
from harness.study.processors import container_share, default_jobs


def _git(directory: Path, *arguments: str) -> str:
    identity = ["-c", "user.name=t", "-c", "user.email=t@example.org"]
    command = ["git", *identity, "-C", str(directory), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A repository with the two packages, all committed, and an installed copy inside it."""
    top = tmp_path / "checkout"
    for package in manifest.PACKAGES:
        (top / package / "study").mkdir(parents=True)
        (top / package / "__init__.py").write_text("x = 1\n")
    (top / "harness" / "study" / "task.py").write_text("y = 2\n")
    (top / ".gitignore").write_text(".venv/\n")
    _git(top.parent, "init", "-q", str(top))
    _git(top, "add", ".")
    _git(top, "commit", "-qm", "all")
    for package in manifest.PACKAGES:
        shutil.copytree(top / package, top / ".venv" / "lib" / package)
    return top


def _commit_seen_from(root: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object] | None:
    place = SimpleNamespace(__file__=str(root / "harness" / "__init__.py"))
    monkeypatch.setattr(manifest, "harness", place)
    return git_commit()


def test_the_commit_is_that_of_the_code_that_runs(
    checkout: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Run from the checkout, or from a copy installed in an environment inside it."""
    head = _git(checkout, "rev-parse", "HEAD")
    for root in (checkout, checkout / ".venv" / "lib"):
        assert _commit_seen_from(root, monkeypatch) == {"hash": head, "dirty": False}


def test_a_changed_file_makes_it_dirty(checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    installed = checkout / ".venv" / "lib"
    (installed / "harness" / "study" / "task.py").write_text("y = 3\n")
    seen = _commit_seen_from(installed, monkeypatch)
    assert seen is not None
    assert seen["dirty"] is True
    assert _commit_seen_from(checkout, monkeypatch) == {**seen, "dirty": False}
    (checkout / "generators" / "new.py").touch()
    assert _commit_seen_from(checkout, monkeypatch) == seen


def test_other_repositories_are_not_taken_for_ours(
    checkout: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert _commit_seen_from(tmp_path, monkeypatch) is None
    (tmp_path / "other").mkdir()
    _git(tmp_path, "init", "-q", str(tmp_path / "other"))
    shutil.copytree(checkout / "harness", tmp_path / "other" / ".venv" / "harness")
    assert _commit_seen_from(tmp_path / "other" / ".venv", monkeypatch) is None


@pytest.mark.parametrize(
    ("text", "share"),
    [("max 100000\n", math.inf), ("150000 100000\n", 1.5), ("50000 100000", 0.5)],
)
def test_a_container_grants_a_share_of_the_processors(text: str, share: float) -> None:
    assert container_share(text) == share


def test_there_is_always_a_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for text, most in (("50000 100000", 1), ("nonsense", 10_000), ("max 1", 10_000)):
        (tmp_path / "cpu.max").write_text(text)
        monkeypatch.setattr("harness.study.processors._QUOTA", tmp_path / "cpu.max")
        assert 1 <= default_jobs() <= most
