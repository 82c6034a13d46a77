"""``avd verify``: check the rows of a study, and count them again in another way."""

from __future__ import annotations

import argparse
import json
import shlex
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.cli.options import positive
from harness.diagram import BUILDERS
from harness.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from harness.study.verify import Verification

DISAGREED, UNSEEN, INTERRUPTED = 1, 3, 130
SAMPLE = 50

DESCRIPTION = """\
Check the rows of a study.  Of every row the arithmetic of its counts (Euler's formula, the ends of
edges), its task's key and its seed; of a sample, the counts themselves: the instance is made anew
from family, parameters, n and seed, and counted by the reference builder where that is feasible,
and otherwise by the fast builder in another way (the instance turned and listed from another
vertex on, the domain cut into other triangles, other threads).  Nothing is written."""

EPILOG = """\
exit status: 0 all agree, 1 something disagrees (a line each on standard error says row, key, stored
and found value), 3 nothing disagrees but some rows could not be counted again, 130 interrupted
"""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``verify``."""
    parser = subparsers.add_parser(
        "verify",
        help="count the rows of a study again and compare",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "directory", metavar="DIR", type=Path, help="a study's directory, such as results/quick"
    )
    how_many = parser.add_mutually_exclusive_group()
    how_many.add_argument(
        "--sample",
        metavar="K",
        type=positive,
        default=SAMPLE,
        help="count K random rows again (default: %(default)s)",
    )
    how_many.add_argument("--all", action="store_true", help="count every row again")
    parser.add_argument(
        "--seed", metavar="S", type=int, default=0, help="of the sample (default: %(default)s)"
    )
    parser.add_argument(
        "--builder",
        choices=("auto", *BUILDERS),
        default="auto",
        help="who counts (default: another than before where that is feasible)",
    )
    parser.add_argument(
        "-j", "--jobs", metavar="K", type=positive, help="rows at a time (default: processors)"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the table")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Verify; exit status 0, 1 (disagreements), 3 (rows not recounted) or 130 (interrupted)."""
    if sys.platform == "win32":
        raise UserError("avd verify needs a POSIX system (Linux, macOS): it limits memory")
    from harness.study.progress import Progress
    from harness.study.verify import count_again, examine

    verification = examine(args.directory, None if args.all else args.sample, args.seed)
    name, rows = f"verify {args.directory.name}", len(verification.chosen)
    with Progress(name, rows, verification.statuses) as progress:
        count_again(verification, args.builder, args.jobs, progress.update)
    for problem in (*verification.disagreements, *verification.unseen):
        print(f"avd: {args.directory}/{problem}", file=sys.stderr)
    if args.json:
        print(json.dumps(_record(verification), ensure_ascii=False))
    else:
        print(*_lines(verification), sep="\n")
    return _status(args, verification)


def _status(args: argparse.Namespace, verification: Verification) -> int:
    """The exit status; on standard error, why it is not 0."""
    if verification.interrupted:
        words = ["avd", "verify", str(args.directory), "--seed", str(args.seed)]
        words += ["--all"] if args.all else ["--sample", str(args.sample)]
        words += ["--builder", args.builder]
        print(
            f"avd: interrupted after {verification.recounted} of {len(verification.chosen)} rows; "
            f"begin again with: {shlex.join(words)}",
            file=sys.stderr,
        )
        return INTERRUPTED
    if verification.disagreements:
        return DISAGREED
    return UNSEEN if verification.unseen else 0


def _record(verification: Verification) -> dict[str, Any]:
    """The verification as plain JSON values."""
    return {
        "rows": len(verification.places),
        "without_count": verification.without_count,
        "missing": verification.missing,
        "chosen": len(verification.chosen),
        "recounted": verification.recounted,
        "recounts": [
            {"family": family, "domain": domain, "builder": builder, "rows": number}
            for (family, domain, builder), number in sorted(verification.recounts.items())
        ],
        "disagreements": [_flat(asdict(each)) for each in verification.disagreements],
        "not_recounted": [_flat(asdict(each)) for each in verification.unseen],
        "interrupted": verification.interrupted,
        "agrees": not (
            verification.disagreements or verification.unseen or verification.interrupted
        ),
    }


def _flat(record: dict[str, Any]) -> dict[str, Any]:
    return {**record.pop("place"), **record}


def _lines(verification: Verification) -> Iterator[str]:
    """The table by family and domain, and a sentence about the whole."""
    wrong = {each.place for each in verification.disagreements}
    unseen = {each.place for each in verification.unseen}
    kinds = sorted({(place.family, place.domain) for place in verification.places})
    heads = ("family", "domain", "rows", *BUILDERS, "wrong", "not recounted")
    table: list[Sequence[str]] = [heads]
    for family, domain in kinds:
        of_kind = [p for p in verification.places if (p.family, p.domain) == (family, domain)]
        by = [str(verification.recounts[family, domain, builder]) for builder in BUILDERS]
        bad = [str(sum(place in found for place in of_kind)) for found in (wrong, unseen)]
        table.append((family, domain, str(len(of_kind)), *by, *bad))
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for row in table:
        words = (cell.ljust(width) for cell, width in zip(row[:2], widths[:2], strict=True))
        numbers = (cell.rjust(width) for cell, width in zip(row[2:], widths[2:], strict=True))
        yield "  ".join((*words, *numbers)).rstrip()
    yield ""
    yield _sentence(verification, len(wrong))


def _sentence(verification: Verification, wrong: int) -> str:
    parts = [f"{len(verification.places)} rows checked, {verification.recounted} counted again"]
    parts.append(f"{wrong} wrong" if wrong else "no disagreement")
    if verification.unseen:
        parts.append(f"{len(verification.unseen)} could not be counted again")
    if verification.without_count:
        parts.append(f"{verification.without_count} hold no count")
    if verification.missing:
        parts.append(f"{verification.missing} tasks of the study have no row")
    if verification.missing is None:
        parts.append("no manifest: seeds taken as they stand")
    return ", ".join(parts) + "."
