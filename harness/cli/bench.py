"""``avd bench``: time fixed instances, beside what is to be reached."""

from __future__ import annotations

import argparse
import json
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from harness.bench import BENCHMARKS, benchmark_named
from harness.cli.options import positive
from harness.diagram import BUILDERS
from harness.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from harness.bench.runner import Summary
    from harness.study.schema import Record

FAILED = 3
INTERRUPTED = 130

DESCRIPTION = """\
Run the instances of a benchmark one after the other, each in a process of its own, and print a
table: times, rates, work, memory, and whether what is to be reached is reached.  The time is that
from coordinates in memory to the counts, and the median of the repeats; compiling and loading of
compiled code are reported apart.  Every row is stored at once, in place of an earlier one of the
same instance."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``bench``."""
    parser = subparsers.add_parser(
        "bench", help="time fixed instances", description=DESCRIPTION, allow_abbrev=False
    )
    parser.add_argument("what", metavar="WHAT", choices=BENCHMARKS, help=" or ".join(BENCHMARKS))
    parser.add_argument(
        "--only",
        nargs="+",
        action="extend",
        metavar="NAME",
        help="only these instances (default: all)",
    )
    parser.add_argument(
        "--quick", action="store_true", help="a few small instances instead, in some seconds"
    )
    parser.add_argument(
        "--repeat",
        type=positive,
        default=5,
        metavar="K",
        help="timings of each instance (default: %(default)s)",
    )
    parser.add_argument(
        "--workers",
        type=positive,
        metavar="W",
        help="processors that a builder uses (default: what it chooses)",
    )
    parser.add_argument(
        "--builder", choices=BUILDERS, default=BUILDERS[0], help="default: %(default)s"
    )
    parser.add_argument(
        "-o",
        "--out",
        metavar="DIR",
        type=Path,
        help="where rows are stored (default: results/bench/WHAT; WHAT-quick with --quick)",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line for each row")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run the benchmark; exit status 0, 3 (some instances failed) or 130 (interrupted)."""
    if sys.platform == "win32":
        raise UserError("avd bench needs a POSIX system (Linux, macOS): it limits memory")

    from harness.bench.runner import Settings, run_benchmark
    from harness.bench.table import lines_of

    benchmark = benchmark_named(args.what)
    cases = benchmark.chosen(args.only, quick=args.quick)
    directory = args.out or Path("results", "bench", args.what + ("-quick" if args.quick else ""))
    settings = Settings(
        builder=args.builder,
        repeat=args.repeat,
        workers=args.workers,
        compile_anew=not (args.quick or args.only),  # it takes long: for whole runs
        command=shlex.join(_words(args, args.only)),
    )
    show = _show_json if args.json else _show_nothing
    summary = run_benchmark(benchmark, cases, directory, settings, show)
    if summary.rows and not args.json:
        print(*lines_of(benchmark, summary), sep="\n")
    return _say_how_it_went(args, summary, directory)


def _show_json(row: Record) -> None:
    from harness.bench.rows import values_of

    print(json.dumps(values_of(row), ensure_ascii=False), flush=True)


def _show_nothing(_row: Record) -> None:
    """The table comes when its widths are known."""


def _say_how_it_went(args: argparse.Namespace, summary: Summary, directory: Path) -> int:
    """Tell where the rows are and what has failed; return the exit status."""
    if summary.missing:
        words = _words(args, summary.missing) + (["-o", str(args.out)] if args.out else [])
        print(
            f"avd: interrupted; rows of {len(summary.rows)} instances are kept in {directory}; "
            f"continue with: {shlex.join(words)}",
            file=sys.stderr,
        )
        return INTERRUPTED
    for row in summary.failed:
        print(f"avd: {row['instance']}: {row['status']}: {row['message']}", file=sys.stderr)
    print(f"avd: rows of {len(summary.rows)} instances are in {directory}", file=sys.stderr)
    return FAILED if summary.failed else 0


def _words(args: argparse.Namespace, only: Sequence[str] | None) -> list[str]:
    """The command line as far as it decides what is measured, for these instances."""
    words = ["avd", "bench", args.what, "--builder", args.builder, "--repeat", str(args.repeat)]
    if args.workers is not None:
        words += ["--workers", str(args.workers)]
    if args.quick:
        words.append("--quick")
    return [*words, "--only", *only] if only else words
