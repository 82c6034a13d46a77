"""``avd study``: run a study file, or a built-in study, and report on it."""

from __future__ import annotations

import argparse
import shlex
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.cli.options import positive
from harness.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Callable

    from harness.study.runner import Summary

MESHES = "mesh"
"""The built-in study of mesh improvement: its rows are meshes, not diagrams."""
FAILED = 3
INTERRUPTED = 130

DESCRIPTION = """\
Run the tasks of a study file (TOML), or of a built-in study, and write the report.  Every finished
task is a row in DIR/rows.csv at once; an interrupted or killed run continues with --resume."""

EPILOG = """\
a study file:
  name = "growth"                 # results go to results/growth/
  time_limit = 60                 # seconds for one task (default 300)
  memory_limit = 2048             # MiB for one task (default 2048)
  base_seed = 0                   # another number, other random instances (default 0)
  [[sweep]]                       # any number of these; lists multiply
  family = "zigzag"               # see avd families
  n = { from = 8, to = 64, factor = 2 }         # or a number, or a list
  replicates = 30                 # random instances of each kind (default 1)
  params = { tilt = [0.3, 0.5] }    # the family's parameters
  domain = ["kernel", "plane"]    # default: kernel for polygons, plane for segments
  objective = "smallest"          # or "largest"
  builder = "reference"
"""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``study``."""
    parser = subparsers.add_parser(
        "study",
        help="run a study and report on it",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "study", metavar="STUDY", nargs="?", help="a study file, or the name of a built-in study"
    )
    parser.add_argument(
        "--scale",
        choices=("small", "full"),
        help="of a study in two sizes, NAME.toml and NAME-small.toml (default: full)",
    )
    parser.add_argument("--list", action="store_true", help="list the built-in studies and exit")
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="the study's directory (default: results/NAME)"
    )
    parser.add_argument(
        "-j", "--jobs", metavar="K", type=positive, help="tasks at a time (default: processors)"
    )
    parser.add_argument(
        "--engine", choices=("local", "dask"), default="local", help="where tasks run"
    )
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="with --engine dask: a running scheduler, such as tcp://host:8786 "
        "(default: a local cluster)",
    )
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument("--resume", **_mode("resume"), help="run the tasks that have no row yet")
    mode.add_argument(
        "--retry", **_mode("retry"), help="as --resume, and repeat the tasks that failed"
    )
    mode.add_argument(
        "--fresh",
        **_mode("fresh"),
        help="run everything; what is there is moved to DIR/earlier, not deleted",
    )
    parser.add_argument("--no-report", action="store_true", help="leave the report out")
    parser.set_defaults(run=run, usage_error=parser.error)


def run(args: argparse.Namespace) -> int:
    """Run the study; exit status 0, 3 (some tasks failed) or 130 (interrupted)."""
    if args.list:
        return _list()
    if args.study is None:
        args.usage_error("name a study file or a built-in study (--list shows them)")
    if args.scheduler is not None and args.engine != "dask":
        args.usage_error("--scheduler needs --engine dask")

    if sys.platform == "win32":
        raise UserError("avd study needs a POSIX system (Linux, macOS): it limits memory")

    run_it, name = _chosen(args)
    directory = args.out or Path("results") / name
    try:
        summary = run_it(directory)
    except KeyboardInterrupt:  # at the very start, or for the second time
        print(f"avd: interrupted; continue with: {_command(args, '--resume')}", file=sys.stderr)
        return INTERRUPTED
    if summary.interrupted and summary.missing:
        return _say_interrupted(args, summary)
    _say_how_it_went(args, summary)
    if not args.no_report:
        try:
            _report(directory)
        except KeyboardInterrupt:
            print(f"\navd: interrupted; report later with: avd report {directory}", file=sys.stderr)
            return INTERRUPTED
    return FAILED if summary.failed else 0


def _chosen(args: argparse.Namespace) -> tuple[Callable[[Path], Summary], str]:
    """What runs the study that is asked for in a directory, and the study's name."""
    settings = {
        "mode": args.mode,
        "jobs": args.jobs,
        "engine": args.engine,
        "scheduler": args.scheduler,
        "command": _command(args, f"--{args.mode}" if args.mode != "new" else None),
        "resume_command": _command(args, "--resume"),
    }
    if args.study == MESHES:
        if args.scale is not None:
            args.usage_error("the study mesh has no scales")
        from harness.study.mesh_runner import run_meshes

        return partial(run_meshes, **settings), MESHES

    from harness.study.builtin import NoScales, find_study
    from harness.study.runner import run_study

    try:
        study = find_study(args.study, args.scale)
    except NoScales as problem:
        args.usage_error(str(problem))
    return partial(run_study, study, **settings), study.name


def _list() -> int:
    from harness.study.builtin import builtin_studies

    for name, study in builtin_studies().items():
        print(f"{name}\t{len(study.tasks)} tasks\t{study.description}")
    from harness.study.meshes import DESCRIPTION as MESHES_DESCRIPTION
    from harness.study.meshes import tasks

    print(f"{MESHES}\t{len(tasks())} tasks\t{MESHES_DESCRIPTION}")
    return 0


def _report(directory: Path) -> None:
    """Write the report and print where it is and what it concludes."""
    from harness.report import report_with_lines

    page, lines = report_with_lines(directory)
    print(f"report: {page}", *lines, sep="\n")


def _say_interrupted(args: argparse.Namespace, summary: Summary) -> int:
    done = summary.total - summary.missing
    print(
        f"avd: interrupted; {done} of {summary.total} tasks are kept in {summary.directory}; "
        f"continue with: {_command(args, '--resume')}",
        file=sys.stderr,
    )
    return INTERRUPTED


def _say_how_it_went(args: argparse.Namespace, summary: Summary) -> None:
    from harness.study.progress import tally

    kept = "" if summary.added else " (all were there already)"
    print(
        f"avd: {summary.total} tasks: {tally(summary.statuses)}{kept}; rows in {summary.directory}",
        file=sys.stderr,
    )
    if summary.failed:
        print(
            f"avd: {summary.failed} failed, see {summary.directory / 'failures.log'}; "
            f"repeat them with: {_command(args, '--retry')}",
            file=sys.stderr,
        )


def _command(args: argparse.Namespace, mode: str | None) -> str:
    """The command line as it was given, but with another mode."""
    words = ["avd", "study", args.study]
    for option in ("scale", "out", "jobs", "scheduler"):
        value = getattr(args, option)
        if value is not None:
            words += [f"--{option}", str(value)]
    if args.engine != "local":
        words += ["--engine", args.engine]
    if args.no_report:
        words.append("--no-report")
    return shlex.join([*words, mode] if mode else words)


def _mode(name: str) -> dict[str, Any]:
    return {"dest": "mode", "action": "store_const", "const": name, "default": "new"}
