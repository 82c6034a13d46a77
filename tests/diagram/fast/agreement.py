"""Builds with two builders, object by object: ``python -m tests.diagram.fast.agreement --help``.

Failures are printed and written as instance files, which every verb reads; two more keys say domain
and objective, a third what differs.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import TimeoutError as LateError
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pebble import ProcessExpired, ProcessPool

from harness.diagram import build
from harness.diagram.counts import DOMAINS, OBJECTIVES, Domain, Objective
from harness.errors import UserError
from harness.geometry.formats import parse_instance
from harness.geometry.instance import Instance
from harness.geometry.validation import validate
from tests.diagram.fast.sources import SOURCES, instance
from tests.diagram.same_map import TOLERANCE, differences

#: Seconds for both builds of one small instance.
PATIENCE = 60.0
_SHRINKINGS = 400


@dataclass(frozen=True)
class Case:
    """What is built."""

    instance: Instance
    domain: Domain
    objective: Objective

    def to_json(self, found: Sequence[str] = ()) -> str:
        data = json.loads(self.instance.to_json())
        data |= {"domain": self.domain, "objective": self.objective, "differences": list(found)}
        return json.dumps(data, indent=1, ensure_ascii=False) + "\n"

    @classmethod
    def from_json(cls, text: str) -> Case:
        data = json.loads(text)
        return cls(parse_instance(text), data["domain"], data["objective"])


def domains(made: Instance) -> tuple[Domain, ...]:
    return DOMAINS if made.kind == "polygon" else ("plane",)


def cases(source: str, seed: int, count: int, domain: Domain | None = None) -> Iterator[Case]:
    """Every instance in every domain that there is of it, for both objectives."""
    for index in range(count):
        made = instance(source, seed, index)
        for its in domains(made):
            if domain in (None, its):
                yield from (Case(made, its, objective) for objective in OBJECTIVES)


@dataclass(frozen=True)
class Outcome:
    """What is wrong with a builder's map in words; ``handed_over``: whether the fast builder left
    the instance to the other; ``judge_failed``: how the judge failed, so that nothing is known."""

    differences: list[str]
    handed_over: bool = False
    judge_failed: str = ""


def compared(
    case: Case, builder: str = "fast", judge: str = "reference", tolerance: float = TOLERANCE
) -> Outcome:
    """What is wrong with a builder's map of a case; nothing if the judge has it too.

    A domain that both refuse is no disagreement.  ``tolerance``: see :mod:`tests.diagram.same_map`.
    """
    arguments = case.instance, case.domain, case.objective
    try:
        expected = build(*arguments, builder=judge)
    except UserError as refusal:
        try:
            build(*arguments, builder=builder)
        except UserError as other:
            same = str(other) == str(refusal)
            return Outcome([] if same else [f"refused: {other}; not: {refusal}"])
        return Outcome([f"not refused: {refusal}"])
    except ArithmeticError as error:
        try:
            build(*arguments, builder=builder).sanity_check()
        except type(error) as other:  # handed over to the judge
            if str(other) != str(error):
                raise
        return Outcome([], judge_failed=f"{type(error).__name__}: {error}")
    found = build(*arguments, builder=builder)
    found.sanity_check()
    wrong = [
        f"{name}: {mine} against {theirs}"
        for (name, mine), theirs in zip(
            found.counts.as_dict().items(), expected.counts.as_dict().values(), strict=True
        )
        if mine != theirs and name != "builder"
    ]
    # Without places the matching may exchange alike cells, so where they lie says nothing.
    wrong += differences(found, expected, tolerance=tolerance, witnesses=tolerance < 1)
    return Outcome(wrong, found.work is not None and found.work.triangles == 0)


def disagreements(case: Case, builder: str = "fast", tolerance: float = TOLERANCE) -> list[str]:
    """What is wrong with a builder's map of a case; that the judge failed, if it did."""
    outcome = compared(case, builder, tolerance=tolerance)
    return outcome.differences + [outcome.judge_failed] * bool(outcome.judge_failed)


def examined(case: Case, builder: str = "fast", tolerance: float = TOLERANCE) -> Outcome:
    """As :func:`compared`, with an error as the only difference."""
    try:
        return compared(case, builder, tolerance=tolerance)
    except Exception as error:  # any failure of a builder is what is looked for
        return Outcome([f"{type(error).__name__}: {error}"])


# --- shrinking -----------------------------------------------------------------------------------


def smaller(made: Instance) -> Iterator[Instance]:
    """The instance without one of its segments or vertices, then with fewer digits."""
    values: Any = made.floats.tolist() if made.exact is None else made.exact
    for k in range(made.n):
        yield from _valid(made, [*values[:k], *values[k + 1 :]])
    for scale in (1, 4, 2**10, 10**6):

        def coarse(value: Any, scale: int = scale) -> Any:
            if isinstance(value, (list, tuple)):
                return [coarse(item) for item in value]
            return round(value * scale) / scale

        yield from _valid(made, coarse(values))


def _valid(made: Instance, values: Any) -> Iterator[Instance]:
    try:
        candidate = Instance.from_arrays(made.kind, values)
        validate(candidate)
    except UserError:
        return
    if candidate.to_json() != Instance.from_arrays(made.kind, made.exact or made.floats).to_json():
        yield candidate


def shrunk(case: Case, builder: str = "fast", tries: int = _SHRINKINGS) -> Case:
    """A case with fewer segments or digits that still fails."""
    for candidate in smaller(case.instance):
        tries -= 1
        simpler = Case(candidate, case.domain, case.objective)
        if tries > 0 and _domain_exists(simpler) and examined(simpler, builder).differences:
            return shrunk(simpler, builder, tries)
    return case


def _domain_exists(case: Case) -> bool:
    try:
        build(case.instance, case.domain, case.objective, builder="reference")
    except UserError:
        return False
    return True


# --- the long run --------------------------------------------------------------------------------


def _examined_together(batch: list[Case], builder: str, tolerance: float) -> list[Outcome]:
    return [examined(case, builder, tolerance) for case in batch]


def outcomes(
    every: Sequence[Case], builder: str, jobs: int, patience: float, tolerance: float
) -> Iterator[tuple[Case, Outcome]]:
    """What becomes of every case, in processes of their own that may hang or die."""
    batches = [list(every[k : k + 6]) for k in range(0, len(every), 6)]
    with ProcessPool(max_workers=jobs) as pool:
        waiting = [
            (
                batch,
                pool.schedule(_examined_together, (batch, builder, tolerance), timeout=patience),
            )
            for batch in batches
        ]
        for batch, future in waiting:
            try:
                results = future.result()
            except (LateError, ProcessExpired) as error:
                results = [Outcome([f"{type(error).__name__} in a batch: {error}"])] * len(batch)
            yield from zip(batch, results, strict=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare builders on many instances; 1 if any failed."""
    parser = argparse.ArgumentParser(prog="agreement", description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="instances of every source")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--family", action="append", choices=[*SOURCES], help="only these sources")
    parser.add_argument("--domain", choices=DOMAINS)
    parser.add_argument("--builder", default="fast")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=PATIENCE, help="seconds for six builds")
    parser.add_argument(
        "--tolerance", type=float, default=TOLERANCE, help="of places; 10 compares no places"
    )
    parser.add_argument("--most", type=int, default=5, help="failures written for each source")
    parser.add_argument("--shrink", action="store_true", help="also write smaller cases")
    parser.add_argument("--out", type=Path, default=Path(), help="where failures are written")
    parser.add_argument("files", nargs="*", type=Path, help="failures to try again")
    options = parser.parse_args(arguments)
    if options.files:
        return _again(options.files, options.builder)
    options.out.mkdir(parents=True, exist_ok=True)
    totals: Counter[str] = Counter()
    for source in options.family or SOURCES:
        start = time.perf_counter()
        every = list(cases(source, options.seed, options.count, options.domain))
        failed = handed_over = open_cases = 0
        limits = options.jobs, options.timeout, options.tolerance
        for case, outcome in outcomes(every, options.builder, *limits):
            handed_over += outcome.handed_over
            if outcome.judge_failed:
                open_cases += 1
                name = f"open-{source}-{options.seed}-{open_cases}.json"
                (options.out / name).write_text(case.to_json([outcome.judge_failed]), "utf-8")
            if not outcome.differences:
                continue
            failed += 1
            if failed <= options.most:
                name = f"fail-{source}-{options.seed}-{failed}.json"
                _report(case, outcome.differences, options.out / name, options)
        totals[source] = failed
        seconds = time.perf_counter() - start
        print(
            f"{source}: {failed} of {len(every)} failed, {handed_over} handed over, "
            f"{open_cases} without a judge, {seconds:.0f} s",
            flush=True,
        )
    return 1 if any(totals.values()) else 0


def _report(case: Case, found: list[str], path: Path, options: argparse.Namespace) -> None:
    path.write_text(case.to_json(found), encoding="utf-8")
    print(f"{path}: {case.domain}, {case.objective}: {'; '.join(found[:3])}", flush=True)
    if options.shrink and "in a batch" not in found[0]:
        small = shrunk(case, options.builder)
        away = path.with_name(f"small-{path.name}")
        away.write_text(
            small.to_json(examined(small, options.builder).differences), encoding="utf-8"
        )


def _again(paths: Sequence[Path], builder: str) -> int:
    """Try written failures again."""
    failed = 0
    for path in paths:
        outcome = examined(Case.from_json(path.read_text(encoding="utf-8")), builder)
        failed += bool(outcome.differences)
        said = "; ".join(outcome.differences[:3]) or outcome.judge_failed or "agrees"
        print(f"{path}: {said}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
