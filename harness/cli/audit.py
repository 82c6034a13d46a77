"""``avd audit``: every statement of the paper as a check over many instances."""

from __future__ import annotations

import argparse
import json
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.cli.options import natural, positive
from harness.errors import UserError

if TYPE_CHECKING:
    from harness.audit.claim import Claim

INTERRUPTED = 130
DIRECTORY = Path("results", "audit")

DESCRIPTION = """\
Try the statements of the paper on many instances and say of each whether it held, or on how many it
failed, with the smallest counterexample that was found: shrunk, drawn, certified by both builders
and stored as an instance file.  Finished claims are stored at once; DIR/report.html explains
readings, failures and limits."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``audit``."""
    parser = subparsers.add_parser(
        "audit", help="check the paper's statements", description=DESCRIPTION, allow_abbrev=False
    )
    parser.add_argument(
        "claims", metavar="CLAIM", nargs="*", help="only these claims (default: all)"
    )
    parser.add_argument("--list", action="store_true", help="list the claims and exit")
    parser.add_argument(
        "-o",
        "--out",
        metavar="DIR",
        type=Path,
        default=DIRECTORY,
        help="where rows, verdicts and report go (default: %(default)s)",
    )
    parser.add_argument(
        "--count",
        metavar="N",
        type=positive,
        help="instances of each claim, besides series of growing n (default: the claim's own)",
    )
    parser.add_argument(
        "--seed", metavar="S", type=natural, default=0, help="other instances (default: 0)"
    )
    parser.add_argument(
        "-j", "--jobs", metavar="K", type=positive, help="processes (default: processors)"
    )
    parser.add_argument(
        "--resume",
        action="store_true",
        help="keep the claims that were finished with this count and seed",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line for each claim")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run the audit; exit status 0, or 130 (interrupted)."""
    from harness.audit.registry import CLAIMS, chosen

    claims = chosen(args.claims)
    if args.list:
        width = max(len(claim.name) for claim in claims)
        for claim in claims:
            print(f"{claim.name:{width}}  {claim.title}: {claim.gloss}")
        return 0
    if sys.platform == "win32":
        raise UserError("avd audit needs a POSIX system (Linux, macOS): it locks its directory")

    from harness.audit.runner import run_audit
    from harness.study.processors import default_jobs
    from harness.study.warming import compile_apart

    def tell(claim: Claim, record: dict[str, Any] | None) -> None:
        if record is None:
            print(f"avd: {claim.name} …", file=sys.stderr, flush=True)
        elif args.json:
            print(json.dumps(record, ensure_ascii=False), flush=True)
        else:
            print(f"{claim.name:23} {record['verdict']}", flush=True)

    try:
        compile_apart()
        run_audit(
            claims,
            args.out,
            count=args.count,
            seed=args.seed,
            jobs=args.jobs or default_jobs(),
            resume=args.resume,
            command=_command(args, resume=args.resume),
            tell=tell,
            order=list(CLAIMS),
        )
        from harness.report.audit_page import write_audit_page

        page, _ = write_audit_page(args.out)
    except KeyboardInterrupt:
        print(
            f"avd: interrupted; finished claims are kept in {args.out}; "
            f"continue with: {_command(args, resume=True)}",
            file=sys.stderr,
        )
        return INTERRUPTED
    print(f"avd: report: {page}", file=sys.stderr)
    return 0


def _command(args: argparse.Namespace, *, resume: bool) -> str:
    """The command line as far as it decides what is done."""
    words = ["avd", "audit", *args.claims]
    if args.out != DIRECTORY:
        words += ["--out", str(args.out)]
    if args.count is not None:
        words += ["--count", str(args.count)]
    if args.seed:
        words += ["--seed", str(args.seed)]
    return shlex.join([*words, "--resume"] if resume else words)
