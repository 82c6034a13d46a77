"""The study file: every mistake is named; tasks and seeds depend on content, not on order."""

from __future__ import annotations

import hashlib
import itertools
import json
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from generators import FAMILIES
from harness.cli.study import EPILOG
from harness.errors import UserError
from harness.study import study_file
from harness.study.builtin import builtin_studies, find_study
from harness.study.study_file import parse_study, read_study
from harness.study.task import SEED_RULE
from tests.study.studies import study

SWEEP = '[[sweep]]\nfamily = "star"\nn = 5\n'


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("name = 3 3\n", ["s.toml", "not TOML", "line 1"]),
        (SWEEP, ["s.toml", "'name' is missing"]),
        ('name = "a/b"\n' + SWEEP, ["s.toml: name", "'a/b'"]),
        ('name = ".."\n' + SWEEP, ["s.toml: name"]),
        ("name = 3\n" + SWEEP, ["s.toml: name", "must be a string"]),
        ('name = "a"', ["s.toml", "no [[sweep]]"]),
        ('name = "a"\nsweep = 3', ["s.toml: sweep", "[[sweep]]"]),
        ('name = "a"\ntimelimit = 3\n' + SWEEP, ["s.toml", "'timelimit'", "'time_limit'"]),
        ('name = "a"\ntime_limit = true\n' + SWEEP, ["s.toml: time_limit", "True", "number"]),
        ('name = "a"\ntime_limit = 0\n' + SWEEP, ["s.toml: time_limit", "positive"]),
        ('name = "a"\ntime_limit = inf\n' + SWEEP, ["s.toml: time_limit", "positive"]),
        ('name = "a"\ntime_limit = 1e300\n' + SWEEP, ["s.toml: time_limit", "at most", "a year"]),
        (f'name = "a"\ntime_limit = {10**400}\n' + SWEEP, ["s.toml: time_limit", "too large"]),
        (f'name = "a"\nbase_seed = {"9" * 5000}\n' + SWEEP, ["s.toml: not TOML"]),
        (f'name = "a"\nmemory_limit = {10**30}\n' + SWEEP, ["s.toml: memory_limit", "at most"]),
        ('name = "a"\nmemory_limit = 3\n' + SWEEP, ["s.toml: memory_limit", "at least"]),
        ('name = "a"\nmemory_limit = 1e3\n' + SWEEP, ["s.toml: memory_limit", "integer"]),
        ('name = "a"\nbase_seed = "x"\n' + SWEEP, ["s.toml: base_seed", "integer"]),
    ],
)
def test_mistakes_at_the_top_are_named(text: str, parts: list[str]) -> None:
    with pytest.raises(UserError) as error:
        parse_study(text, "s.toml")
    assert "\n" not in str(error.value)
    assert all(part in str(error.value) for part in parts), str(error.value)


@pytest.mark.parametrize(
    ("sweep", "parts"),
    [
        ("n = 5", ["'family' is missing"]),
        ('family = "star"', ["'n' is missing"]),
        ('family = "stra"\nn = 5', ["family", "'stra'", "did you mean 'star'"]),
        ('family = "star"\nn = 5\nreplicate = 2', ["'replicate'", "did you mean 'replicates'"]),
        ('family = "star"\nn = 5\nreplicates = 0', ["replicates", "at least 1"]),
        ('family = "star"\nn = 5\nreplicates = 1.0', ["replicates", "integer"]),
        ('family = "star"\nn = []', ["n: "]),
        ('family = "star"\nn = [5, 6.0]', ["n: "]),
        ('family = "star"\nn = [5, true]', ["n: "]),
        ('family = "star"\nn = "5"', ["n: "]),
        ('family = "star"\nn = 2', ["star", "n = 2"]),
        ('family = "zigzag"\nn = 7', ["zigzag", "n = 7", "even"]),
        ('family = "star"\nn = {from = 8}', ["n: ", "'to' is missing"]),
        ('family = "star"\nn = {from = 8, to = 4}', ["n: from", "at most"]),
        ('family = "star"\nn = {from = 0, to = 4}', ["n: from", "at least 1"]),
        ('family = "star"\nn = {from = 8, to = 9, factor = 1}', ["n: factor", "greater than 1"]),
        ('family = "star"\nn = {from = 8, to = 9, fctor = 2}', ["'fctor'", "'factor'"]),
        ('family = "star"\nn = 5\nparams = 3', ["params", "table"]),
        ('family = "star"\nn = 5\nparams = {rmin = 0.5}', ["'rmin'", "did you mean 'r_min'"]),
        ('family = "star"\nn = 5\nparams = {r_min = "x"}', ["r_min", "number"]),
        ('family = "star"\nn = 5\nparams = {r_min = []}', ["params: r_min"]),
        ('family = "star"\nn = 5\nparams = {r_min = nan}', ["r_min"]),
        ('family = "star"\nn = 5\ndomain = "kernal"', ["domain", "did you mean 'kernel'"]),
        ('family = "star"\nn = 5\ndomain = []', ["domain", "empty"]),
        ('family = "star"\nn = 5\ndomain = [1]', ["domain", "1 must be a string or a list"]),
        ('family = "star"\nn = 5\ndomain = {a = 1}', ["domain", "must be a string or a list"]),
        ('family = ["star"]\nn = 5', ["family", "['star'] must be a string"]),
        (f'family = "star"\nn = {{from = 8, to = {10**400}}}', ["n: to", "more than"]),
        ('family = "star"\nn = 5\nobjective = "least"', ["objective", "'least'"]),
        ('family = "star"\nn = 5\nbuilder = "referense"', ["builder", "did you mean 'reference'"]),
        ('family = "grid"\nn = 4\ndomain = "kernel"', ["domain", "grid", "plane"]),
    ],
)
def test_mistakes_in_a_sweep_name_file_and_table(sweep: str, parts: list[str]) -> None:
    text = f'name = "a"\n{SWEEP}\n[[sweep]]\n{sweep}\n'
    with pytest.raises(UserError) as error:
        parse_study(text, "s.toml")
    assert all(part in str(error.value) for part in ["s.toml: sweep 2", *parts]), str(error.value)


NUMBERS = ["1", "-1", "1.5", "1e300", "inf", "nan", "9" * 400]
OTHERS = ["true", "''", "'x'", "[]", "[1]", "['x', 1]", "[[1]]", "{}", "1979-05-27", "'\\u0000'"]
VALUES = st.sampled_from([*NUMBERS, *OTHERS, "{a = 1}", "{from = 4, to = 6, factor = 1e-9}"])


@given(st.sampled_from(["time_limit", "memory_limit", "base_seed", "name", "description"]), VALUES)
def test_any_value_at_the_top_is_taken_or_refused_in_a_line(key: str, value: str) -> None:
    table = {"name": "'a'", key: value}
    read_or_refused("\n".join(f"{key} = {value}" for key, value in table.items()) + "\n" + SWEEP)


@given(
    st.sampled_from(["family", "n", "replicates", "params", "domain", "objective", "builder"]),
    VALUES,
)
def test_any_value_in_a_sweep_is_taken_or_refused_in_a_line(key: str, value: str) -> None:
    table = {"family": "'star'", "n": "5", key: value}
    lines = [f"{key} = {value}" for key, value in table.items()]
    read_or_refused("\n".join(["name = 'a'", "[[sweep]]", *lines]))


def read_or_refused(text: str) -> None:
    try:
        assert parse_study(text, "s.toml").tasks
    except UserError as error:
        if not str(error).startswith("s.toml: ") or len(str(error)) > 300:
            raise AssertionError from error


def test_the_greatest_limits_are_ones_that_the_system_takes() -> None:
    code = (
        "from harness.study.limits import Limits, confine, lift_data_limit\n"
        "from harness.study.study_file import MOST_MEMORY_LIMIT, MOST_SECONDS\n"
        "confine(Limits(MOST_SECONDS, MOST_MEMORY_LIMIT)); lift_data_limit()"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_byte_order_mark_is_no_part_of_a_study_file(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text('\ufeffname = "a"\n' + SWEEP, encoding="utf-8")
    assert read_study(path).text.startswith("name")


def test_an_unreadable_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_bytes(b"\xff\xfe")
    for name in ("x.toml", "missing.toml", "."):
        with pytest.raises(UserError, match=str(tmp_path / name)):
            read_study(tmp_path / name)


@given(st.integers(3, 50), st.integers(0, 4000), st.sampled_from([1.5, 2, 3]))
def test_a_range_is_geometric(first: int, more: int, factor: float) -> None:
    last = first + more
    made = study(f'[[sweep]]\nfamily="star"\nn={{from={first}, to={last}, factor={factor}}}')
    sizes = [task.n for task in made.tasks]
    assert sizes[0] == first
    assert sizes[-1] <= last < sizes[-1] * factor + 1
    for k, size in enumerate(sizes):
        assert abs(size - first * factor**k) <= 0.5


LISTS = st.fixed_dictionaries(
    {
        "n": st.lists(st.integers(3, 9), min_size=1, max_size=3),
        "r_min": st.lists(st.sampled_from([0.25, 0.5, 1]), min_size=1, max_size=3),
        "domain": st.lists(st.sampled_from(["kernel", "interior", "plane"]), min_size=1),
        "objective": st.lists(st.sampled_from(["smallest", "largest"]), min_size=1),
        "replicates": st.integers(1, 3),
    }
)


def _text(lists: dict[str, object]) -> str:
    return (
        '[[sweep]]\nfamily = "star"\n'
        f"n = {json.dumps(lists['n'])}\nreplicates = {lists['replicates']}\n"
        f"params = {{ r_min = {json.dumps(lists['r_min'])} }}\n"
        f"domain = {json.dumps(lists['domain'])}\nobjective = {json.dumps(lists['objective'])}\n"
    )


@given(LISTS)
def test_tasks_are_the_product_without_repetition(lists: dict[str, list[object]]) -> None:
    tasks = study(_text(lists)).tasks
    listed = ("n", "r_min", "domain", "objective")
    expected = set(itertools.product(*(set(lists[name]) for name in listed)))
    found = [(t.n, dict(t.params)["r_min"], t.domain, t.objective) for t in tasks]
    assert set(found) == expected
    assert len(tasks) == len(expected) * lists["replicates"]
    assert len({task.key for task in tasks}) == len(tasks)


@given(LISTS, LISTS)
def test_order_and_company_change_no_task(one: dict[str, object], other: dict[str, object]) -> None:
    """Sweeps in either order, or apart: the same tasks with the same seeds."""
    together = set(study(_text(one) + _text(other)).tasks)
    assert together == set(study(_text(other) + _text(one)).tasks)
    assert together == set(study(_text(one)).tasks) | set(study(_text(other)).tasks)


def test_every_domain_objective_and_builder_sees_the_same_instance() -> None:
    tasks = study(
        '[[sweep]]\nfamily="star"\nn=[4, 5]\nreplicates=3\n'
        'domain=["kernel", "interior", "plane"]\nobjective=["smallest", "largest"]'
    ).tasks
    seeds = {
        (t.n, t.replicate): {u.seed for u in tasks if (u.n, u.replicate) == (t.n, t.replicate)}
        for t in tasks
    }
    assert all(len(found) == 1 for found in seeds.values())
    assert len(set().union(*seeds.values())) == len(seeds) == 6


def test_seeds_follow_the_rule_in_the_manifest() -> None:
    """Recomputed from the sentence that the manifest gives to a reader."""
    assert "first 13 hexadecimal digits" in SEED_RULE
    for task in study(head="base_seed = 7").tasks:
        params = {"r_min": 0.25, "radius": "uniform"}
        identity = json.dumps(
            [7, "star", params, task.n, task.replicate], sort_keys=True, separators=(",", ":")
        )
        assert task.seed == int(hashlib.sha256(identity.encode()).hexdigest()[:13], 16)
        assert task.seed < 2**53


def test_another_base_seed_gives_other_instances() -> None:
    first, second = study(head="base_seed = 1").tasks, study(head="base_seed = 2").tasks
    assert {task.seed for task in first}.isdisjoint(task.seed for task in second)
    assert {task.key for task in first}.isdisjoint(task.key for task in second)


def test_defaults_written_out_are_the_same_task() -> None:
    written = '[[sweep]]\nfamily="star"\nn=4\nparams={r_min=0.25, radius="uniform"}\n'
    written += 'domain="kernel"\nobjective="smallest"\nbuilder="fast"'
    assert study(written).tasks == study('[[sweep]]\nfamily="star"\nn=4').tasks


def test_the_domain_defaults_to_the_kind_of_the_family() -> None:
    tasks = study('[[sweep]]\nfamily="star"\nn=4\n[[sweep]]\nfamily="grid"\nn=4').tasks
    assert {(t.family, t.domain) for t in tasks} == {("star", "kernel"), ("grid", "plane")}


def test_a_family_without_randomness_has_one_replicate() -> None:
    body = '[[sweep]]\nfamily="figure-2"\nn=3\nreplicates=5'
    assert len(study(body).tasks) == 1
    assert not FAMILIES["figure-2"].random


def test_the_examples_in_help_and_documentation_are_studies() -> None:
    documented = (study_file.__doc__ or "").partition("::")[2].partition("The tasks are")[0]
    helped = EPILOG.partition("\n")[2]
    one, other = (parse_study(textwrap.dedent(text), "x") for text in (documented, helped))
    assert one.tasks == other.tasks
    assert len(one.tasks) == 4 * 30 * 2 * 2


def test_built_in_studies_are_found_by_name_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "quick").mkdir()  # as a results directory could be
    for name, built_in in builtin_studies().items():
        assert built_in.name == name
        assert find_study(name) == built_in
        assert built_in.description
    with pytest.raises(UserError, match="did you mean 'quick'"):
        find_study("quik")
    with pytest.raises(UserError, match=r"quick\.toml"):
        find_study("quick.toml")


def test_the_quick_study_has_controls_and_both_sides_of_the_claim() -> None:
    tasks = find_study("quick").tasks
    families = {task.family for task in tasks}
    assert {"control-constant", "control-linear"} < families
    assert {"star", "star-fat", "near-regular", "convex-circle", "convex-valtr"} < families
    assert {"zigzag", "convex-weave", "cavity", "grid", "segments"} < families
    for family in families:
        assert len({task.n for task in tasks if task.family == family}) >= 5


@pytest.mark.parametrize(
    "line",
    ["replicates = 1000000000", "n = { from = 5, to = 9, factor = 1.0000000000000002 }"],
)
def test_absurd_numbers_are_refused_at_once(line, tmp_path):
    path = tmp_path / "absurd.toml"
    sizes = "" if line.startswith("n") else "n = 8\n"
    path.write_text(f'name = "absurd"\n[[sweep]]\nfamily = "star"\n{sizes}{line}\n')
    with pytest.raises(UserError, match="more than 100000"):
        read_study(path)
