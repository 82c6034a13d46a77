"""``avd mesh``: improve a triangulation, and draw one."""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.cli.options import natural, positive
from harness.cli.pictures import add_picture_options, picture_format, write_picture
from harness.mesh.options import OBJECTIVES, REMEDIES, SWEEPS, TOPOLOGIES

if TYPE_CHECKING:
    from harness.mesh import Improved
    from harness.mesh.files import Stored
    from harness.mesh.state import Sweep

FORMATS = "a mesh file of any format that meshio knows: VTK, VTU, Gmsh, OBJ, OFF, PLY, …"

DESCRIPTION = "Triangulations of the plane: make their smallest angles larger, and draw them."
IMPROVE = """\
Move the interior vertices of a triangulation (and with --topology change its edges) so that its
smallest angles grow; boundary vertices stay, and so do interfaces: edges between triangles of
different regions, and lines in the file.  Point and cell data are kept.  No triangle is ever
inverted, and with the objective 'all' the smallest angle never gets worse.  OUT is either the old
file, as when interrupted, or the complete new one."""
DRAW = "Draw a triangulation, every triangle coloured by its smallest angle."

ROWS = (
    ("smallest angle", "smallest"),
    ("1st percentile", "percentile_1"),
    ("5th percentile", "percentile_5"),
    ("mean", "mean"),
)


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``mesh`` with its two verbs."""
    parser = subparsers.add_parser(
        "mesh",
        help="improve or draw a triangulation",
        description=DESCRIPTION,
        allow_abbrev=False,
    )
    verbs = parser.add_subparsers(dest="what", metavar="WHAT", required=True)
    _register_improve(verbs)
    _register_draw(verbs)


def _register_improve(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser(
        "improve",
        help="make the smallest angles of a triangulation larger",
        description=IMPROVE,
        allow_abbrev=False,
    )
    parser.add_argument("source", metavar="IN", type=Path, help=FORMATS)
    parser.add_argument("target", metavar="OUT", type=Path, help="where to write; so named")
    parser.add_argument(
        "--objective",
        choices=OBJECTIVES,
        default=OBJECTIVES[0],
        help="all: every angle counts; apex: the paper's greedy, angles at the moved vertex; the "
        "others for comparison (default: %(default)s)",
    )
    parser.add_argument(
        "--topology",
        choices=TOPOLOGIES,
        default=TOPOLOGIES[0],
        help="what may change besides coordinates: nothing, edges, or edges and the number of "
        "interior vertices (default: %(default)s)",
    )
    parser.add_argument(
        "--remedy",
        choices=REMEDIES,
        default=REMEDIES[0],
        help="of apex against small angles at a star's rim (default: %(default)s)",
    )
    parser.add_argument(
        "--sweeps",
        type=natural,
        default=SWEEPS,
        metavar="K",
        help="visit each vertex at most K times on average (default: %(default)s)",
    )
    parser.add_argument(
        "--fixed", metavar="NAME", help="point data; vertices where it is not zero stay"
    )
    interfaces = parser.add_mutually_exclusive_group()
    interfaces.add_argument(
        "--regions",
        metavar="NAMES",
        help="cell data that tell regions apart, separated by commas; edges between regions stay "
        "(default: all of one whole number a cell, and sets of cells)",
    )
    interfaces.add_argument(
        "--ignore-interfaces",
        action="store_true",
        help="treat edges between regions, and lines in the file, as any others",
    )
    parser.add_argument(
        "--time-limit",
        type=_seconds,
        metavar="SECONDS",
        help="then write the best mesh so far",
    )
    parser.add_argument(
        "--workers",
        type=positive,
        metavar="W",
        help="threads (default: one per processor); the result does not depend on it",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=improve)


def _register_draw(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser(
        "draw", help="draw a triangulation", description=DRAW, allow_abbrev=False
    )
    parser.add_argument("source", metavar="IN", type=Path, help=FORMATS)
    add_picture_options(parser)
    parser.add_argument("--title", metavar="TEXT", help="default: the name of the file")
    parser.set_defaults(run=draw)


def improve(args: argparse.Namespace) -> int:
    """Improve a mesh; exit status 0."""
    from harness.cli.ending import tidily
    from harness.mesh import read_mesh
    from harness.mesh.door import improve_mesh
    from harness.mesh.formats import check_target
    from harness.mesh.options import Options

    options = Options(args.objective, args.topology, args.remedy, args.sweeps)
    check_target(args.target)
    stored = read_mesh(
        args.source,
        args.fixed,
        regions=None if args.regions is None else args.regions.split(","),
        interfaces=not args.ignore_interfaces,
    )
    better = improve_mesh(
        stored.mesh,
        options,
        workers=args.workers,
        time_limit=args.time_limit,
        tell=None if args.quiet else _tell,
    )
    with tidily():
        lost = _write(args.target, stored, better)
    record = {
        "file": str(args.source),
        "out": str(args.target),
        "objective": options.objective,
        "topology": options.topology,
        "vertices": len(better.points),
        "triangles": len(better.triangles),
        "interface_edges": len(stored.mesh.kept),
        **better.as_dict(),
    }
    if args.json:
        print(json.dumps(record, ensure_ascii=False))
    else:
        print(*_table(better, len(stored.mesh.kept)), sep="\n")
    if lost:
        print(f"avd: {args.target}: not in the file: {', '.join(lost)}", file=sys.stderr)
    if not better.complete:
        print("avd: the time was over: this is the best mesh so far", file=sys.stderr)
    return 0


def _tell(sweep: Sweep) -> None:
    print(
        f"avd: {sweep.number:3d} {sweep.stage:10s} smallest {sweep.quality.smallest:8.4f}°  "
        f"mean {sweep.quality.mean:.3f}°  {sweep.moves} moves  {sweep.seconds:.2f} s",
        file=sys.stderr,
    )


def _write(target: Path, stored: Stored, better: Improved) -> list[str]:
    """Write the better mesh; what the format does not hold."""
    from harness.mesh import write_mesh

    if not better.is_reconnected:
        return write_mesh(target, stored, better.points)
    return write_mesh(
        target,
        stored,
        better.points,
        better.triangles,
        vertices=better.vertices,
        cells=better.cells,
        made=better.made,
    )


def _table(better: Improved, interface_edges: int) -> list[str]:
    """What has become of the mesh, for people."""
    lines = [f"{'degrees':16}{'before':>12}{'after':>12}"]
    before, after = better.before.as_dict(), better.after.as_dict()
    lines += [f"{name:16}{before[key]:12.4f}{after[key]:12.4f}" for name, key in ROWS]
    counts: list[tuple[str, Any]] = [
        ("vertices", len(better.points)),
        ("triangles", len(better.triangles)),
        ("interface edges", interface_edges),
        ("moves", better.moves),
        ("flips", better.flips),
        ("inverted", better.inverted),
        ("seconds", f"{better.seconds:.2f}"),
    ]
    return [*lines, *(f"{name:16}{value:>24}" for name, value in counts)]


def draw(args: argparse.Namespace) -> int:
    """Write the picture of a mesh; exit status 0."""
    kind = picture_format(args)
    if not 0.5 <= args.width <= 100:
        args.usage_error(f"--width {args.width:g}: must be from 0.5 to 100 inches")

    from harness.mesh import read_mesh
    from harness.report.mesh_drawing import render_mesh

    mesh = read_mesh(args.source).mesh
    title = args.source.name if args.title is None else args.title
    picture = render_mesh(mesh.points, mesh.triangles, kind, width=args.width, title=title)
    write_picture(args, picture)
    return 0


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} must be a number of seconds, at least 0")
    return value
