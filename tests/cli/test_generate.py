"""``avd generate`` and ``avd families``: what the generators say, and files that read back."""

import json

import numpy as np
import pytest

from generators import FAMILIES, generate
from harness.cli.main import main
from harness.geometry.formats import parse_instance, read_instance


@pytest.mark.parametrize("family", FAMILIES)
def test_the_instance_reads_back_exactly(family, capsys):
    described = FAMILIES[family]
    n = min(max(described.smallest, 8), described.largest)
    assert main(["generate", family, "-n", str(n), "--seed", "7"]) == 0
    instance = parse_instance(capsys.readouterr().out)
    made = generate(family, n, 7)
    assert instance.kind == made.kind
    assert np.array_equal(instance.floats, made.coordinates)
    assert (instance.family, instance.seed, instance.params) == (family, 7, made.params)


def test_parameters_and_output_file(tmp_path, capsys):
    target = tmp_path / "weave.json"
    arguments = ["generate", "zigzag", "-n", "12", "--param", "tilt=0.4", "-o", str(target)]
    assert main(arguments) == 0
    assert capsys.readouterr().out == ""
    assert np.array_equal(
        read_instance(target).floats, generate("zigzag", 12, 0, tilt=0.4).coordinates
    )
    assert [path.name for path in tmp_path.iterdir()] == ["weave.json"]


@pytest.mark.parametrize(
    ("arguments", "status", "hint"),
    [
        (["zigzga", "-n", "6"], 1, "did you mean 'zigzag'"),
        (["zigzag", "-n", "7"], 1, "must be even"),
        (["zigzag", "-n", "6", "--param", "tlit=1"], 1, "did you mean 'tilt'"),
        (["zigzag", "-n", "6", "--param", "family=1"], 1, "no parameter 'family'"),
        (["zigzag", "-n", "6", "--param", "tilt=steep"], 1, "tilt = 'steep' must be a number"),
        (["zigzag", "-n", "6", "--seed", "-1"], 1, "seed"),
        (["zigzag", "-n", "6", "--param", "tilt"], 2, "name=value"),
        (["zigzag", "-n", "6", "--param", "tilt=1", "--param", "tilt=2"], 2, "twice"),
        (["zigzag", "-n", "six"], 2, "six"),
        (["zigzag"], 2, "-n"),
    ],
)
def test_what_cannot_be_made_is_said(arguments, status, hint, capsys):
    try:
        found = main(["generate", *arguments])
    except SystemExit as stop:
        found = stop.code
    told = capsys.readouterr()
    assert found == status
    assert hint in told.err
    assert told.out == ""


def test_a_file_that_cannot_be_written_is_named(tmp_path, capsys):
    target = tmp_path / "absent" / "x.json"
    assert main(["generate", "grid", "-n", "6", "-o", str(target)]) == 1
    assert str(target) in capsys.readouterr().err


def test_families_tells_everything(capsys):
    assert main(["families", "--json"]) == 0
    listed = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [record["name"] for record in listed] == list(FAMILIES)
    assert main(["families"]) == 0
    blocks = capsys.readouterr().out.strip().split("\n\n")
    for record, family, block in zip(listed, FAMILIES.values(), blocks, strict=True):
        names = [parameter.name for parameter in family.parameters]
        assert [parameter["name"] for parameter in record["parameters"]] == names
        words = " ".join(block.split())
        for text in (family.name, family.summary, family.source, *names):
            assert " ".join(text.split()) in words
