"""``avd figures``: the paper's figures and the project's own, as files for print."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

DESCRIPTION = """\
Draw the figures: figure-1 to figure-6 are the paper's, made anew; the others are our own.
Writes DIR/NAME.svg (or .pdf, .png), and DIR/captions.json: title, caption, recipe of each figure.
A plot of stored rows has its
table beside it, DIR/NAME.csv.  Prints the paths.  Without NAME all are drawn, except those whose
rows are missing."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``figures``."""
    parser = subparsers.add_parser(
        "figures",
        help="draw the paper's figures and our own",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("names", metavar="NAME", nargs="*", help="which (default: all)")
    parser.add_argument("--list", action="store_true", help="list the figures and do nothing else")
    parser.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("results/figures"), help="%(default)s"
    )
    parser.add_argument(
        "--format", choices=("svg", "pdf", "png"), default="svg", help="default: %(default)s"
    )
    parser.add_argument(
        "--results",
        metavar="DIR",
        type=Path,
        default=Path("results"),
        help="where the studies lie whose rows some figures show (default: %(default)s)",
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Draw; exit status 0, or 1 (UserError) for an unknown name or missing rows."""
    from harness.errors import UserError, suggestion
    from harness.report.plates import PLATES
    from harness.report.plates.shelf import put

    if args.list:
        width = max(map(len, PLATES))
        for plate in PLATES.values():
            rows = f"  (from results/{plate.studies[0]})" if plate.studies else ""
            print(f"{plate.name:{width}}  {plate.title}{rows}")
        return 0
    for name in args.names:
        if name not in PLATES:
            hint = suggestion(name, list(PLATES)) or f"there are {', '.join(PLATES)}"
            raise UserError(f"no figure is called {name!r}: {hint}")
    for name in args.names or PLATES:
        plate = PLATES[name]
        if not args.names and (lacking := plate.lacks(args.results)):
            print(f"avd: figure {name} left out: {lacking}", file=sys.stderr)
            continue
        print(put(plate, args.out, args.results, args.format))
    return 0
