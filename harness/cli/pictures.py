"""The options of all verbs that draw one picture, and where the picture goes."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

PICTURES = (".svg", ".png", ".pdf")


def add_picture_options(parser: argparse.ArgumentParser) -> None:
    """Add -o and --width."""
    parser.add_argument(
        "-o",
        "--output",
        metavar="PICTURE",
        type=Path,
        help="where to write: .svg, .png or .pdf (default: SVG on standard output)",
    )
    parser.add_argument(
        "--width", type=float, default=7.0, metavar="INCHES", help="default: %(default)g"
    )
    parser.set_defaults(usage_error=parser.error)


def picture_format(args: argparse.Namespace) -> str:
    """Which of svg, png and pdf to write; a usage error if the file is named otherwise."""
    if _target(args) is None:
        return "svg"
    suffix: str = args.output.suffix.lower()
    if suffix not in PICTURES:
        choice = f"{', '.join(PICTURES[:-1])} or {PICTURES[-1]}"
        args.usage_error(f"-o {args.output}: a picture is {choice}")
    return suffix[1:]


def write_picture(args: argparse.Namespace, picture: bytes) -> None:
    """Write it to the file, in one step, or to standard output."""
    from harness.files import replace

    target = _target(args)
    if target is None:
        sys.stdout.buffer.write(picture)
    else:
        replace(target, picture)


def _target(args: argparse.Namespace) -> Path | None:
    """The file; None for standard output, which is also called "-"."""
    target: Path | None = args.output
    return None if target == Path("-") else target
