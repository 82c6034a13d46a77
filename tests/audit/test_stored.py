"""The audit that is stored: its examples show what they are said to show, its rows add up."""

from dataclasses import asdict
from pathlib import Path

import pytest

from harness.audit.claim import Tally
from harness.audit.diagrams import certificates
from harness.audit.registry import CLAIMS
from harness.audit.store import read_rows, read_verdicts
from harness.geometry.formats import read_instance
from harness.geometry.validation import validate

AUDIT = Path(__file__).resolve().parents[2] / "results" / "audit"
RECORDS = read_verdicts(AUDIT)
EXAMPLES = [name for name, record in RECORDS.items() if record["example"]]
CHEAP = ("lemma-2-proof", "lemma-4-kernel", "single-circle-interior", "two-segments")


def test_every_claim_is_there() -> None:
    assert list(RECORDS) == list(CLAIMS)
    assert {path.stem for path in (AUDIT / "instances").iterdir()} == set(EXAMPLES)


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_show_it_and_both_builders_agree(name) -> None:
    claim, example = CLAIMS[name], RECORDS[name]["example"]
    instance = read_instance(AUDIT / "instances" / f"{name}.json")
    validate(instance)
    found = claim.check(instance)
    assert found.outcome == claim.sought
    assert found.message == example["message"]
    if claim.domain is not None:
        counted = certificates(instance, claim.domain)
        assert set(counted) == {"fast", "reference"}
        assert {builder: c.as_dict() for builder, c in counted.items()} == example["counts"]


def test_verdicts_follow_from_the_rows() -> None:
    rows = read_rows(AUDIT)
    for name, record in RECORDS.items():
        tally = Tally.of([row for row in rows if row.claim == name])
        assert asdict(tally) == record["tally"]
        assert record["verdict"].startswith(tally.verdict(CLAIMS[name].kind))


@pytest.mark.parametrize("name", CHEAP)
def test_rows_come_out_again(name) -> None:
    claim, record = CLAIMS[name], RECORDS[name]
    rows = [row for row in read_rows(AUDIT) if row.claim == name]
    instances = list(claim.cases(record["count"], record["seed"]))
    assert [(i.family, i.n, i.seed) for i in instances] == [(r.family, r.n, r.seed) for r in rows]
    for k in range(0, len(rows), 23):
        found = claim.check(instances[k])
        assert (found.outcome, found.message) == (rows[k].outcome, rows[k].message)
