"""The page of all studies: answers from rows, nothing from elsewhere, no failure without rows."""

from __future__ import annotations

import csv
import io
import itertools
import json
import re
from collections import Counter
from pathlib import Path

import pandas as pd
import pytest

from generators.weaves import convex_inner_radius, zigzag_inner_radius
from harness.analysis.weave import predict
from harness.cli.main import main
from harness.errors import UserError
from harness.report.combined import is_collection, write_collection
from harness.report.combined.growth import record_table
from harness.report.combined.page import CHAPTERS, REPORT, outputs
from harness.report.plates import PLATES
from harness.report.plates.shelf import put
from harness.study.meshes import COLUMNS as MESH_COLUMNS
from tests.analysis.frames import rows
from tests.report.pages import Page
from tests.report.studies import sample, store

SHAPE = {"zigzag": "tilt", "convex-weave": "delta"}
INNER = {"zigzag": zigzag_inner_radius, "convex-weave": convex_inner_radius}


def weaves(shapes: list[float], noises: list[float], scale: int) -> pd.DataFrame:
    """Rows of both weaves: the predicted counts, of which a noise ε leaves 1/(1 + ε·n^scale)."""
    parts = []
    for family, shape, noise in itertools.product(SHAPE, shapes, noises):
        params = {SHAPE[family]: shape, "noise": noise, "noise_power": 0}
        part = rows(family, lambda n, _: n, sizes=(16, 32, 64), replicates=3, params=params)
        for row, n in enumerate(part["n"].tolist()):
            ideal = predict(n // 2, 1.0, INNER[family](n, shape))
            left = round(ideal.vertices / (1 + noise * float(n) ** scale))
            part.loc[row, ["vertices", "cells"]] = left, ideal.cells
            part.loc[row, "edges"] = left + ideal.cells - 1
            part.loc[row, "degrees"] = json.dumps({"3": left})
        parts.append(part.astype(object))
    return pd.concat(parts, ignore_index=True)


def meshes(directory: Path) -> None:
    """Three meshes and three methods: the smallest angle falls, stays or rises."""
    directory.mkdir()
    text = io.StringIO()
    writer = csv.DictWriter(text, MESH_COLUMNS, restval="1", lineterminator="\n")
    writer.writeheader()
    for method, gain in (("smart-laplacian", 0.0), ("apex", -1.0), ("all", 2.0)):
        for seed in range(3):
            figures = {"smallest_before": 10.0, "smallest": 10.0 + gain + seed, "inverted": 0}
            identity = {"family": "x", "n": 5, "seed": seed, "method": method, "status": "ok"}
            writer.writerow({**identity, **figures})
    (directory / "rows.csv").write_text(text.getvalue())


def audit(directory: Path) -> None:
    """Two statements, one with a counterexample: its two segments are crossed by no line."""
    (directory / "instances").mkdir(parents=True)
    nothing = dict.fromkeys(("holds", "fails", "undecided", "outside"), 0)
    common = {"count": 9, "seed": 0}
    example = {"domain": "plane", "n": 2, "marks": [[0.5, 1]], "message": "segment <1> is whole"}
    verdicts = {
        "lemma-1": {
            "claim": "lemma-1",
            "verdict": "holds on all 7 tried",
            "tally": {**nothing, "holds": 7},
            "example": None,
            **common,
        },
        "lemma-2": {
            "claim": "lemma-2",
            "verdict": "fails on 2 of 5",
            "tally": {**nothing, "holds": 3, "fails": 2},
            "example": example,
            **common,
        },
        "linear-kernel": {
            "claim": "linear-kernel",
            "verdict": "above the bound on 1 of 4 tried",
            "tally": {**nothing, "holds": 3, "fails": 1},
            "example": None,
            **common,
        },
        "not-a-vertex": {
            "claim": "not-a-vertex",
            "verdict": "shown by 2 of 19",
            "tally": {**nothing, "holds": 2, "fails": 17},
            "example": None,
            **common,
        },
        "convex-levels-interior": {
            "claim": "convex-levels-interior",
            "verdict": "fails on 1 of 1",
            "tally": {**nothing, "fails": 1},
            "example": None,
            **common,
        },
    }
    (directory / "verdicts.json").write_text(json.dumps(verdicts))
    pair = {"kind": "segments", "segments": [[[0, 0], [1, 0]], [[3, -1], [3, 1]]]}
    (directory / "instances" / "lemma-2.json").write_text(json.dumps(pair))


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("all") / "results"
    still = weaves([0.3, 0.5, 0.7], [1e-13], 0)
    store(root / "conjecture", pd.concat([sample(), still], ignore_index=True))
    store(root / "weave", still)
    store(root / "smoothed", weaves([0.5], [10.0**-k for k in range(1, 9)], 3))
    meshes(root / "mesh")
    audit(root / "audit")
    put(PLATES["figure-6"], root / "figures", root)
    return root


@pytest.fixture(scope="module")
def files(results: Path) -> dict[str, str]:
    return outputs(results)[0]


@pytest.fixture(scope="module")
def page(files: dict[str, str]) -> Page:
    return Page(files[REPORT])


def words(text: str) -> str:
    return " ".join("".join(Page(text).words).split())


def test_nothing_is_loaded_from_elsewhere(files: dict[str, str], page: Page) -> None:
    assert all(load.startswith(("data:", "#")) for load in page.loads)
    text = files[REPORT]
    for address in re.findall(r"https?://[^\s\"'<]+", text):
        assert address.startswith("http://www.w3.org/"), address  # names of XML, never fetched
    assert all(css.startswith("#") for css in re.findall(r"url\(([^)]*)\)", text))
    assert "@import" not in text
    assert page.scripts == 1
    assert "default-src 'none'" in text


def test_html_is_well_formed_with_unique_ids_and_square_tables(page: Page) -> None:
    assert not page.open
    assert max(Counter(page.ids).values()) == 1
    assert all(len(set(widths)) <= 1 for widths in page.widths)


def test_links_lead_somewhere(results: Path, files: dict[str, str], page: Page) -> None:
    for link in page.links:
        if link.startswith("#"):
            assert link[1:] in page.ids
        elif not link.startswith("data:"):
            assert link in files or (results / link).exists(), link
    for name in files:
        assert name == REPORT or name in page.links, f"{name} is linked from nowhere"


def test_answers_come_from_the_rows(results: Path, files: dict[str, str]) -> None:
    said = words(files[REPORT])
    records = pd.read_csv(io.StringIO(files["data/largest-counts.csv"]))
    best = records[records["domain"] == "kernel"].iloc[0]
    stored = pd.read_csv(results / "conjecture" / "rows.csv")
    counted = stored[(stored["status"] == "ok") & (stored["domain"] == "kernel")]
    assert best["per_edge"] == pytest.approx((counted["vertices"] / counted["segments"]).max())
    assert f"n = {best['n']} edges has {best['vertices']:,} vertices, certified" in said
    bound, *_ = re.findall(r"In the kernel, .*? with c below ([\d,.]*\d)", said)
    assert best["per_edge"] - 0.1 < float(bound.replace(",", "")) <= best["per_edge"]
    assert "fails on 2 of 5" in said
    assert "segment <1> is whole" in said
    assert "2 of 5 readings fail" in said
    assert "The smallest angle rose in 6 of 9 runs" in said
    assert (
        "The paper’s greedy raised the smallest angle on 1 of 3 meshes and lowered it on 1" in said
    )


def test_the_planted_scaling_is_found(files: dict[str, str]) -> None:
    said = words(files[REPORT])
    for family in SHAPE:
        found = re.search(rf"n⁻(\S+) \({family}\)", said)
        assert found is not None
        power = found[1].translate(str.maketrans("·⁰¹²³⁴⁵⁶⁷⁸⁹", ".0123456789"))
        assert float(power) == pytest.approx(3, abs=0.2)


def test_weaves_are_compared_with_their_prediction(files: dict[str, str]) -> None:
    said = words(files[REPORT])
    assert re.search(r"Of 54 certified counts, \d+ are exactly as predicted", said)
    assert "none contradicts the prediction" in said
    assert "weave/data/weaves.csv" in files
    assert "smoothed/data/weaves.csv" in files


def test_uncertified_counts_are_no_records() -> None:
    from harness.report.build import analyse

    frame = rows("zigzag", lambda n, _: n * n, params={"tilt": 0.5})
    frame["certified"] = frame["n"] < 20
    study = analyse(frame, "doubtful")
    (record,) = record_table(study.groups, study.labels).to_dict("records")
    assert (record["n"], record["vertices"]) == (16, 256)


def test_same_rows_same_bytes(results: Path, files: dict[str, str]) -> None:
    assert outputs(results)[0] == files


def test_chapters_without_rows_say_so(tmp_path: Path) -> None:
    root = tmp_path / "results"
    store(root / "other", sample())
    path, answers = write_collection(root)
    assert len(answers) == len(CHAPTERS)
    text = path.read_text()
    assert words(text).count("stored here yet") == 2 * len(CHAPTERS)  # in the answers and below
    assert not Page(text).open


def test_the_verb_knows_a_directory_of_studies(results: Path, tmp_path: Path, capsys) -> None:
    assert is_collection(results)
    assert not is_collection(results / "conjecture")
    assert not is_collection(tmp_path)
    assert main(["report", str(results)]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0] == str(results / REPORT)
    assert any(
        line.startswith("Which statements of the paper hold? 2 of 5 readings fail") for line in out
    )


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    root = tmp_path / "results"
    audit(root / "audit")
    (root / "audit" / "verdicts.json").write_text("[1]")
    with pytest.raises(UserError, match=r"verdicts\.json: not the verdicts"):
        outputs(root)
    (root / "audit" / "verdicts.json").write_text("{")
    with pytest.raises(UserError, match=r"verdicts\.json: cannot be read"):
        outputs(root)


def test_the_audit_tells_refuted_readings_bounds_and_witnesses_apart(files: dict[str, str]) -> None:
    text = words(files[REPORT])
    assert "2 of 5 readings fail" in text
    assert (
        "5 readings of the paper’s statements, 36 checks in all. Of 3 about every instance, 1 held "
        "wherever they were tried, which proves nothing, and each of the other 2 has a "
        "counterexample below. Of 1 about growth, 0 stayed within the bound set here and 1 "
        "exceeded it. Shown by a witness: 1 of existence. Open: none."
    ) in text
    assert "Not as stated: Lemma 2." in text
    assert "more than the paper’s words must: Convex level sets, interior." in text
    table = pd.read_csv(io.StringIO(files["data/statements.csv"])).set_index("claim")
    assert table.loc["not-a-vertex", "fails"] == 17
