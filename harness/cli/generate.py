"""``avd generate``: one instance of a family, as an instance file."""

from __future__ import annotations

import argparse
import sys

from harness.errors import UserError

DESCRIPTION = """\
Make an instance of a family (see avd families).  The same family, size, seed and parameters give
the same coordinates on every machine."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``generate``."""
    parser = subparsers.add_parser(
        "generate",
        help="make an instance of a family",
        description=DESCRIPTION,
        allow_abbrev=False,
    )
    parser.add_argument("family", metavar="FAMILY", help="its name, as avd families lists it")
    parser.add_argument("-n", type=int, required=True, metavar="N", help="how many segments")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="default: %(default)s")
    parser.add_argument(
        "--param",
        type=_assignment,
        action="append",
        default=[],
        metavar="K=V",
        help="set a parameter of the family (may be repeated)",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="where to write: .wkt and .geojson choose those formats, all else is JSON "
        "(default: JSON on standard output)",
    )
    parser.set_defaults(run=run, usage_error=parser.error)


def run(args: argparse.Namespace) -> int:
    """Write the instance; exit status 0."""
    from generators import GeneratorError, family_named, generate
    from harness.geometry.formats import write_instance
    from harness.geometry.instance import Instance

    params: dict[str, str] = {}
    for key, value in args.param:
        if key in params:
            args.usage_error(f"--param {key} is given twice")
        params[key] = value
    try:
        resolved = family_named(args.family).resolve(params)  # refuses names that are not its own
        generated = generate(args.family, args.n, args.seed, **resolved)
    except GeneratorError as error:
        raise UserError(str(error)) from None
    instance = Instance.from_generated(generated)
    if args.output is None or args.output == "-":
        sys.stdout.write(instance.to_json())
    else:
        write_instance(instance, args.output)
    return 0


def _assignment(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not (key and equals):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form name=value")
    return key, value
