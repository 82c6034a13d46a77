"""``avd peak``: the point of best visual angle of each file's polygon."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from typing import TYPE_CHECKING, Any

from harness.cli.options import FORMATS, load
from harness.diagram import BUILDERS
from harness.errors import UserError
from harness.peak.result import METHODS, OBJECTIVES

if TYPE_CHECKING:
    from harness.peak.result import Peak

DESCRIPTION = """\
Find the point of the kernel of a star-shaped polygon from which the smallest visual angle of its
edges is greatest (or, with --objective min-max, the largest is least), with a proven enclosure of
that angle of at most 1e-12 radians.  A file that cannot be used is named on standard error and the
others are done all the same; the exit status is then 1."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``peak``."""
    parser = subparsers.add_parser(
        "peak",
        help="find the point of best visual angle",
        description=DESCRIPTION,
        allow_abbrev=False,
    )
    parser.add_argument("files", metavar="FILE", nargs="+", help=FORMATS)
    parser.add_argument(
        "--method",
        choices=METHODS,
        help="lp: expected linear time; diagram: all edges and vertices of the diagram; "
        "parametric: parametric search (default: lp; for min-max diagram, the only one)",
    )
    parser.add_argument(
        "--objective",
        choices=OBJECTIVES,
        default=OBJECTIVES[0],
        help="default: %(default)s",
    )
    parser.add_argument(
        "--exact",
        action="store_true",
        help="also the cotangent of the angle as an algebraic number, and all edges that tie",
    )
    parser.add_argument(
        "--builder",
        choices=BUILDERS,
        help="of the diagram, if one is built (default: the one that suits n)",
    )
    parser.add_argument(
        "--seed", type=int, default=0, help="of random samples; the result does not depend on it"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line for each file")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Find every peak; exit status 0, or 1 if a file could not be used."""
    failed = False
    for path in args.files:
        try:
            record = record_of(path, args)
        except UserError as error:
            print(f"avd: {error}", file=sys.stderr)
            failed = True
            continue
        print(json.dumps(record, ensure_ascii=False) if args.json else sentence(record), flush=True)
    return 1 if failed else 0


def record_of(path: str, args: argparse.Namespace) -> dict[str, Any]:
    """The record of one file; ``seconds`` for the search and its proof alone."""
    from harness.peak import peak

    instance = load(path)
    begin = time.perf_counter()
    found: Peak = peak(
        instance,
        args.method,
        args.objective,
        exact=args.exact,
        seed=args.seed,
        builder=args.builder,
    )
    seconds = time.perf_counter() - begin
    named = {} if instance.name is None else {"name": instance.name}
    rest = {"n": instance.n, **found.as_dict(), "seconds": round(seconds, 6)}
    return {"file": path, **named, **rest}


def sentence(record: dict[str, Any]) -> str:
    """One line for people: point, angle, basis."""
    basis = ", ".join(map(str, record["basis"]))
    angle = record["angle"]
    text = (
        f"{record['file']}: ({record['x']!r}, {record['y']!r})  angle {angle:.12g} "
        f"({math.degrees(angle):.9g}°)  basis {basis}"
    )
    if record["vertex"] is not None:
        text += f"  at vertex {record['vertex']}: approached, not reached"
    if "exact" in record:
        coefficients = ", ".join(map(str, record["exact"]["polynomial"]))
        tied = ", ".join(map(str, record["exact"]["tied"]))
        text += f"  tied {tied}  cot is a root of [{coefficients}]"
    return text
