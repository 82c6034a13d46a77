"""One claim after the other: instances, findings, the smallest example, certificates."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from harness.audit.claim import OUTCOMES, Claim, Finding, Row, Series, Tally
from harness.audit.diagrams import certificates
from harness.audit.pool import Workers, judged
from harness.audit.shrink import shrink, simplicity
from harness.audit.store import read_verdicts, write_claim, write_manifest
from harness.geometry.instance import Instance
from harness.study.lock import locked
from harness.study.task import canonical

BUDGET = 400
"""Checks spent on making one example small …"""
STARTS = 3
"""… from so many instances."""

Record = dict[str, Any]
Told = Callable[[Claim, Record | None], None]


def run_audit(
    claims: Sequence[Claim],
    directory: Path,
    *,
    count: int | None = None,
    seed: int = 0,
    jobs: int = 1,
    resume: bool = False,
    command: str = "avd audit",
    tell: Told = lambda _claim, _record: None,
    order: Sequence[str] = (),
) -> dict[str, Record]:
    """Try the claims and store each as soon as it is finished; the records, by name.

    ``count``: instances of each claim (default: the claim's own).  ``resume``: keep claims that
    were finished with the same count and seed.  ``tell`` is called before (None) and after each
    claim.  The result depends on ``count`` and ``seed`` only, not on ``jobs``; but with several
    jobs, instances that take too long are undecided.

    Raises UserError if another process is writing to the directory, or what is there is damaged.
    """
    directory.mkdir(parents=True, exist_ok=True)
    with locked(directory), Workers(jobs) as workers:
        known = read_verdicts(directory) if resume else {}
        kept = [claim for claim in claims if _is_done(known.get(claim.name), claim, count, seed)]
        anew = [claim.name for claim in claims if claim not in kept]
        write_manifest(directory, command, seed, anew)
        for claim in claims:
            if claim in kept:
                tell(claim, known[claim.name])
                continue
            tell(claim, None)
            record, rows, example = try_claim(claim, count or claim.count, seed, workers)
            text = None if example is None else example.to_json()
            write_claim(directory, record, rows, text, order)
            tell(claim, record)
        return read_verdicts(directory)


def _is_done(record: Record | None, claim: Claim, count: int | None, seed: int) -> bool:
    """Whether a claim was finished with this count and seed."""
    wanted = (count or claim.count, seed)
    return record is not None and (record["count"], record["seed"]) == wanted


def try_claim(
    claim: Claim, count: int, seed: int, workers: Workers
) -> tuple[Record, list[Row], Instance | None]:
    """Try one claim: its record, its rows and its example."""
    instances = distinct(claim.cases(count, seed))
    found = list(workers.findings(claim.check, instances))
    rows = [_row(claim, i, f) for i, f in zip(instances, found, strict=True)]
    tally = Tally.of(rows)
    sought = [i for i, f in zip(instances, found, strict=True) if f.outcome == claim.sought]
    example = _smallest(claim, sought)
    series = claim.series(rows) if claim.series else []
    record: Record = {
        "claim": claim.name,
        "count": count,
        "seed": seed,
        "verdict": "; ".join([tally.verdict(claim.kind), *fits(series)]),
        "tally": asdict(tally),
        "families": _by_family(rows),
        "example": None if example is None else _example(claim, example),
        "series": [asdict(one) for one in series],
    }
    return record, rows, example


def distinct(instances: Iterable[Instance]) -> list[Instance]:
    """Without those that came before: two sources of a claim may make the same instance."""
    first: dict[tuple[str, str | None, bytes], Instance] = {}
    for instance in instances:
        first.setdefault((instance.kind, instance.family, instance.floats.tobytes()), instance)
    return list(first.values())


def fits(series: Sequence[Series]) -> list[str]:
    """Which families' counts leave a single growth model, as "vertices fit n² (zigzag)"."""
    families: dict[str, list[str]] = {}
    for one in series:
        if one.is_single:
            what = f"{one.title} fit {one.verdict}"
            families.setdefault(what, []).append(one.family.partition(" ")[0])
    return [f"{what} ({', '.join(dict.fromkeys(names))})" for what, names in families.items()]


def _row(claim: Claim, instance: Instance, finding: Finding) -> Row:
    return Row(
        claim.name,
        instance.family or "",
        instance.n,
        canonical(dict(instance.params)),
        instance.seed or 0,
        finding.outcome,
        finding.message,
        finding.facts,
    )


def _by_family(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """How often each outcome came up, family by family and size by size."""
    groups: dict[tuple[str, str, int], Counter[str]] = {}
    for row in rows:
        groups.setdefault((row.family, row.params, row.n), Counter())[row.outcome] += 1
    return [
        {"family": family, "params": params, "n": n, **{name: seen[name] for name in OUTCOMES}}
        for (family, params, n), seen in groups.items()
    ]


def _smallest(claim: Claim, instances: Sequence[Instance]) -> Instance | None:
    """The simplest example that shrinking the simplest few leads to."""
    starts = sorted(instances, key=simplicity)[:STARTS]
    if not starts or not claim.shrink:
        return starts[0] if starts else None

    def shows(instance: Instance) -> bool:
        return judged(claim.check, instance).outcome == claim.sought

    ends = [shrink(start, shows, BUDGET).instance for start in starts]
    return min(ends, key=simplicity)


def _example(claim: Claim, instance: Instance) -> Record:
    """What is told of an example; the finding is made anew, on the shrunk instance."""
    finding = judged(claim.check, instance)
    record: Record = {
        "n": instance.n,
        "kind": instance.kind,
        "coordinates": instance.floats.tolist(),
        "message": finding.message,
        "facts": dict(finding.facts),
        "marks": [list(mark) for mark in finding.marks],
        "domain": claim.domain,
        "counts": {},
        "problem": "",
    }
    if claim.domain is not None:
        try:
            found = certificates(instance, claim.domain)
            record["counts"] = {name: counts.as_dict() for name, counts in found.items()}
        except ArithmeticError as error:
            record["problem"] = str(error)
    return record
