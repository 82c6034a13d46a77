"""Registry, instances, growth, running, storing, resuming."""

import json
from dataclasses import replace

import pytest

from harness.audit import complexity
from harness.audit.cases import is_valid, lattice_segments, lattice_stars, star_shaped
from harness.audit.claim import Claim, Finding, Row, Series, Tally
from harness.audit.diagrams import certificates
from harness.audit.growing import series_of
from harness.audit.pool import Workers, judged
from harness.audit.registry import CLAIMS, chosen
from harness.audit.runner import fits, run_audit
from harness.audit.store import is_audit, read_rows, read_verdicts
from harness.errors import UserError
from harness.geometry.formats import read_instance
from tests.audit.instances import SQUARE, TEE, polygon


def long_segments(instance) -> Finding:
    """A false claim: at least one segment is at most 3 wide."""
    widths = abs(instance.segments[:, 0, 0] - instance.segments[:, 1, 0])
    if (widths > 3).all():
        return Finding("fails", "all are wide", {"vertices": instance.n}, ((0.0, 0.0),))
    return Finding("holds", "one is narrow", {"vertices": instance.n})


PLANTED = Claim(
    name="planted",
    title="Planted",
    gloss="some segment is narrow",
    quote="…",
    reading="…",
    failure="…",
    arithmetic="…",
    limits="…",
    cases=lattice_segments(2, 3),
    check=long_segments,
    domain="plane",
    count=40,
)


def test_the_registry_is_whole() -> None:
    assert all(name == claim.name for name, claim in CLAIMS.items())
    for claim in CLAIMS.values():
        texts = (claim.gloss, claim.quote, claim.reading, claim.failure, claim.arithmetic)
        assert all(texts), claim.name
        assert claim.limits
    assert [c.name for c in chosen(["theorem-7", "lemma-1"])] == ["lemma-1", "theorem-7"]
    with pytest.raises(UserError, match="lemma-1"):
        chosen(["lema-1"])


@pytest.mark.parametrize("name", list(CLAIMS))
def test_instances_are_valid_and_the_same_again(name) -> None:
    cases = CLAIMS[name].cases
    first, again = ([i for _, i in zip(range(4), cases(4, 1), strict=False)] for _ in range(2))
    assert [i.to_json() for i in first] == [i.to_json() for i in again]
    assert all(is_valid(instance) for instance in first)


def test_other_seeds_and_sizes_are_other_instances() -> None:
    texts = {i.to_json() for seed in range(4) for i in lattice_stars(5, 6)(4, seed)}
    assert len(texts) == 16
    assert all(star_shaped(i) or i.n > 0 for i in lattice_stars(5)(3, 0))
    with pytest.raises(UserError, match="lattice-segments"):
        list(lattice_segments(5, size=1)(1, 0))


# --- growth and verdicts -------------------------------------------------------------------------


def rows_of(counts) -> list[Row]:
    return [Row("c", "f", n, "{}", 0, "holds", "", {"vertices": v}) for n, v in counts.items()]


def test_growth_is_called_by_its_name() -> None:
    sizes = (8, 16, 32, 64, 128, 256)
    for power, label in ((1, "n"), (2, "n²")):
        (series,) = series_of(rows_of({n: 3 * n**power + 2 for n in sizes}), "vertices", {})
        assert (series.verdict, series.is_single) == (label, True)
    assert series_of(rows_of({8: 1, 16: 2}), "vertices", {}) == []


def test_the_largest_count_of_a_size_is_taken() -> None:
    rows = [*rows_of({n: n for n in (2, 4, 8, 16)}), *rows_of({4: 9})]
    (series,) = series_of(rows, "vertices", {"per n": lambda n, f: f["vertices"] / n})
    assert series.counts == (2, 9, 8, 16)
    assert series.ratios["per n"] == (1.0, 2.25, 1.0, 1.0)


def test_verdicts_in_words() -> None:
    assert Tally(5, 0, 0, 3).verdict("for all") == "holds on all 5 tried"
    assert Tally(5, 2, 1, 0).verdict("for all") == "fails on 2 of 7 (1 undecided)"
    assert Tally(0, 0, 0, 9).verdict("for all") == "nothing tried"
    assert Tally(1, 8).verdict("there is") == "shown by 1 of 9"
    assert Tally(0, 8).verdict("there is") == "no example among 8 tried"
    assert Tally(3, 4).verdict("growth") == "above the bound on 4 of 7 tried"


def test_thresholds_of_complexity(monkeypatch) -> None:
    weave = next(iter(complexity.cases.families(("zigzag", 12, {}))(1, 0)))
    assert complexity.check_linear_kernel(weave).outcome == "fails"
    assert complexity.check_linear_interior(weave).outcome == "fails"
    assert complexity.check_linear_kernel(SQUARE).outcome == "holds"
    assert complexity.check_linear_kernel(TEE).outcome == "outside"
    assert complexity.check_quadratic(weave).outcome == "holds"
    assert complexity.check_grid(TEE).outcome in ("holds", "fails")
    monkeypatch.setattr(complexity, "MOST", 0.0)
    assert complexity.check_quadratic(SQUARE).outcome == "fails"


def test_both_builders_certify() -> None:
    assert set(certificates(TEE, "plane")) == {"fast", "reference"}
    assert set(certificates(polygon(*[(k, k * k) for k in range(30)]), "kernel")) == {"fast"}


def test_disagreement_between_builders_is_an_error(monkeypatch) -> None:
    from harness.audit import diagrams

    right = diagrams.build

    def wrong(instance, domain, objective, builder, workers=None):
        found = right(instance, domain, objective, builder, workers=workers)
        if builder == "fast":
            return found
        cells = (*found.cells[:-1], replace(found.cells[-1], segment=found.cells[0].segment))
        return replace(found, cells=cells)

    monkeypatch.setattr(diagrams, "build", wrong)
    monkeypatch.setattr(diagrams.PlanarMap, "sanity_check", lambda _self: None)
    with pytest.raises(ArithmeticError, match="disagree"):
        certificates(SQUARE, "kernel")


def test_what_a_program_gives_up_is_undecided() -> None:
    def gives_up(_instance):
        raise UserError("too thin")

    assert judged(gives_up, SQUARE) == Finding("undecided", "too thin")


# --- running -------------------------------------------------------------------------------------


def test_a_planted_false_claim_is_refuted_shrunk_and_stored(tmp_path) -> None:
    record = run_audit([PLANTED], tmp_path)["planted"]
    assert record["tally"]["fails"] > 0
    assert record["verdict"].startswith("fails on")
    assert record["example"]["n"] == 1
    assert record["example"]["coordinates"] == [[[0.0, 0.0], [4.0, 0.0]]]
    assert set(record["example"]["counts"]) == {"fast", "reference"}
    stored = read_instance(tmp_path / "instances" / "planted.json")
    assert long_segments(stored).outcome == "fails"
    rows = read_rows(tmp_path)
    assert Tally.of(rows).fails == record["tally"]["fails"]
    assert len(rows) == 40
    assert is_audit(tmp_path)
    assert not is_audit(tmp_path / "instances")


def test_the_same_instance_of_two_sources_is_tried_once(tmp_path) -> None:
    eights = complexity.cases.families(("zigzag", 8, {}))
    sizes = complexity.cases.sizes({"zigzag": (8, 12)})
    claim = replace(PLANTED, cases=complexity.cases.together((eights, 1.0), (sizes, 1.0)), count=3)
    run_audit([claim], tmp_path)
    rows = read_rows(tmp_path)
    assert [row.n for row in rows] == [8, 8, 8, 12]
    assert len({row.seed for row in rows}) == 4


def test_fits_name_what_was_counted() -> None:
    def series(family: str, label: str, *, single: bool = True) -> Series:
        return Series(family, "steps", (1,), (1,), {}, label, single, "")

    found = fits(
        [series("a {}", "n"), series("b", "n²"), series("c", "n"), series("d", "n", single=False)]
    )
    assert found == ["steps fit n (a, c)", "steps fit n² (b)"]


def test_one_job_and_two_give_the_same_rows(tmp_path) -> None:
    """With the checks of a module that other processes can import."""
    claim = replace(CLAIMS["lemma-4-convex"], count=6)
    for jobs in (1, 2):
        run_audit([claim], tmp_path / str(jobs), jobs=jobs)
    for name in ("rows.csv", "verdicts.json"):
        one, two = ((tmp_path / jobs / name).read_bytes() for jobs in "12")
        assert one == two


def test_an_interrupted_audit_keeps_what_is_finished(tmp_path) -> None:
    calls = []

    def counted(instance) -> Finding:
        calls.append(instance)
        return long_segments(instance)

    def interrupts(_instance):
        raise KeyboardInterrupt

    first = replace(PLANTED, name="first", check=counted, shrink=False, count=5)
    second = replace(PLANTED, name="second", check=interrupts, count=5)
    with pytest.raises(KeyboardInterrupt):
        run_audit([first, second], tmp_path)
    assert list(read_verdicts(tmp_path)) == ["first"]
    seen = len(calls)
    mended = replace(second, check=long_segments)
    run_audit([first, mended], tmp_path, resume=True)
    assert len(calls) == seen
    assert set(read_verdicts(tmp_path)) == {"first", "second"}
    assert {row.claim for row in read_rows(tmp_path)} == {"first", "second"}
    run_audit([first], tmp_path, resume=True, seed=1)  # another seed: anew
    assert len(calls) > seen
    assert len(read_rows(tmp_path)) == 10


def test_damaged_files_are_refused(tmp_path) -> None:
    run_audit([replace(PLANTED, count=3, shrink=False)], tmp_path)
    (tmp_path / "verdicts.json").write_text(json.dumps({"planted": {}}))
    with pytest.raises(UserError, match=r"verdicts\.json"):
        read_verdicts(tmp_path)
    (tmp_path / "rows.csv").write_text("a,b\n1,2\n")
    with pytest.raises(UserError, match=r"rows\.csv"):
        read_rows(tmp_path)


def test_no_process_is_left_behind() -> None:
    import multiprocessing

    with pytest.raises(KeyboardInterrupt), Workers(2):
        raise KeyboardInterrupt
    assert multiprocessing.active_children() == []


def dies(_instance) -> Finding:
    """Ends its process."""
    import os

    os._exit(3)


def test_a_process_that_dies_leaves_its_instance_undecided() -> None:
    with Workers(2) as workers:
        (found,) = workers.findings(dies, [SQUARE])
    assert found.outcome == "undecided"
    assert "3" in found.message
