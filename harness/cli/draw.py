"""``avd draw``: a picture of the diagram of one file."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from harness.cli.options import FORMATS, add_diagram_options, load
from harness.cli.pictures import add_picture_options, picture_format, write_picture

if TYPE_CHECKING:
    from harness.geometry.instance import Instance

DESCRIPTION = """\
Draw a diagram: cells coloured by segment, edges as true curves, nodes by kind.  A kernel much
smaller than its polygon is shown a second time, enlarged."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``draw``."""
    parser = subparsers.add_parser(
        "draw", help="draw a diagram", description=DESCRIPTION, allow_abbrev=False
    )
    parser.add_argument("file", metavar="FILE", help=FORMATS)
    add_picture_options(parser)
    add_diagram_options(parser)
    parser.add_argument(
        "--window",
        nargs=4,
        type=float,
        metavar=("X0", "Y0", "X1", "Y1"),
        help="the part to show (default: all segments, and all nodes that are not far away)",
    )
    parser.add_argument("--labels", action="store_true", help="write each cell's segment into it")
    parser.add_argument(
        "--peak",
        action="store_true",
        help="mark the kernel's point of best visual angle (with --objective largest: min-max)",
    )
    parser.add_argument("--no-nodes", action="store_true", help="leave out the marks of nodes")
    parser.add_argument("--title", metavar="TEXT", help="default: the name of the instance")
    parser.add_argument("--caption", metavar="TEXT", help="default: the counts; empty for none")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write the picture; exit status 0."""
    kind = picture_format(args)

    from harness.diagram import build
    from harness.report.drawing import render

    instance = load(args.file)
    marked = _peak(instance, args) if args.peak else None
    picture = render(
        build(instance, args.domain, args.objective, args.builder),
        kind,
        width=args.width,
        window=args.window,
        labels=args.labels,
        nodes=not args.no_nodes,
        title=instance.name if args.title is None else args.title,
        caption=args.caption,
        peak=marked,
    )
    write_picture(args, picture)
    return 0


def _peak(instance: Instance, args: argparse.Namespace) -> tuple[float, float]:
    """The point to mark: that of the objective that the diagram is for."""
    from harness.peak import peak

    if args.objective == "smallest":
        found = peak(instance)
    else:
        found = peak(instance, objective="min-max", builder=args.builder)
    return found.x, found.y
