"""What several verbs share: the options that choose a diagram, numbers, and reading an instance."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from harness.diagram import BUILDERS
from harness.diagram.counts import DOMAINS, OBJECTIVES

if TYPE_CHECKING:
    from harness.geometry.instance import Instance

FORMATS = "an instance file: JSON, WKT or GeoJSON (- reads standard input)"


def add_diagram_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--domain``, ``--objective`` and ``--builder``."""
    parser.add_argument(
        "--domain",
        choices=DOMAINS,
        help="where (default: kernel for a polygon, plane for segments)",
    )
    parser.add_argument(
        "--objective",
        choices=OBJECTIVES,
        default=OBJECTIVES[0],
        help="which visual angle wins a point (default: %(default)s)",
    )
    parser.add_argument(
        "--builder",
        choices=BUILDERS,
        default=BUILDERS[0],
        help="how the diagram is built (default: %(default)s)",
    )


def positive(text: str) -> int:
    """An argument that is a whole number, at least 1."""
    return _whole(text, 1)


def natural(text: str) -> int:
    """An argument that is a whole number, at least 0."""
    return _whole(text, 0)


def _whole(text: str, least: int) -> int:
    if not text.isdecimal() or int(text) < least:
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number, at least {least}")
    return int(text)


def load(path: str) -> Instance:
    """The valid instance in the file ``path``; "-" is standard input.

    Raises:
        UserError: names the file, the index and the reason.
    """
    from harness.cli.streams import read_input
    from harness.errors import UserError
    from harness.geometry.formats import parse_instance, read_instance
    from harness.geometry.validation import validate

    if path == "-":
        source = "standard input"
        try:
            instance = parse_instance(read_input(), source)
        except UserError as error:
            raise UserError(f"{source}: {error}") from None
        except UnicodeDecodeError:
            raise UserError(f"{source}: not text (UTF-8)") from None
        except OSError as error:
            raise UserError(f"{source}: {error.strerror or error}") from None
    else:
        instance = read_instance(path)
    validate(instance)
    return instance
