"""``avd``: the command line.  One file per verb; this one finds the verb and reports failure."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, NoReturn

from harness.cli.streams import abandon_output, flush_or_abandon_output, occupy_closed
from harness.errors import UserError, suggestion

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

#: The verbs in the order in which a newcomer meets them; each is a module of this room with
#: ``register(subparsers)`` and ``run(args) -> int``.
VERBS = (
    "count",
    "draw",
    "peak",
    "mesh",
    "generate",
    "families",
    "study",
    "verify",
    "report",
    "audit",
    "figures",
    "bench",
)

EPILOG = """\
standard output is data, standard error is messages and progress
exit status: 0 done, 1 bad input (one line says what), 2 usage, 3 some tasks of a study or a
benchmark failed, 130 interrupted (finished work is kept)
"""


class Parser(argparse.ArgumentParser):
    """An argument parser that suggests the name that was probably meant."""

    def print_help(self, file: SupportsWrite[str] | None = None) -> None:
        """Print the help; unlike argparse's own, raise OSError if that is impossible."""
        (file or sys.stdout).write(self.format_help())

    def error(self, message: str) -> NoReturn:
        """Print one line and exit with status 2."""
        self.exit(2, f"{self.prog}: {message}\n(see {self.prog} --help)\n")


class Version(argparse.Action):
    """Print the version; looked up only when asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Print and exit."""
        import harness

        print(f"avd {harness.__version__}")
        parser.exit()


def build_parser() -> Parser:
    """The parser with every verb registered."""
    parser = Parser(
        prog="avd",
        description="Exact angular Voronoi diagrams, and the study of their complexity.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action=Version, nargs=0, help="print the version and exit")
    subparsers = parser.add_subparsers(dest="verb", metavar="VERB", required=True, title="verbs")
    for verb in VERBS:
        importlib.import_module(f"harness.cli.{verb}").register(subparsers)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``avd`` with ``argv`` (default: the process's arguments); return the exit status."""
    occupy_closed()
    try:
        try:
            return _run(list(sys.argv[1:] if argv is None else argv))
        finally:
            sys.stdout.flush()  # here, where a reader that has gone away can still be noticed
    except UserError as error:
        return _fail(str(error))
    except BrokenPipeError:  # the reader (head, less) has seen enough
        abandon_output()
        return 0
    except OSError as error:
        flush_or_abandon_output()
        where = f"{error.filename}: " if error.filename is not None else ""
        return _fail(f"{where}{error.strerror or error}")
    except UnicodeError as error:
        return _fail(f"text that cannot be read or written in this encoding: {error}")
    except KeyboardInterrupt:
        print("avd: interrupted", file=sys.stderr)
        return 130


def _run(arguments: Sequence[str]) -> int:
    parser = build_parser()
    _suggest_verb(parser, arguments)
    args = parser.parse_args(arguments)
    return int(args.run(args))


def _fail(message: str) -> int:
    print(f"avd: {message}", file=sys.stderr)
    return 1


def _suggest_verb(parser: Parser, arguments: Sequence[str]) -> None:
    """Reject an unknown verb with a suggestion instead of argparse's list of choices."""
    if not arguments or arguments[0].startswith("-") or arguments[0] in VERBS:
        return
    hint = suggestion(arguments[0], VERBS) or f"the verbs are {', '.join(VERBS)}"
    parser.error(f"unknown verb {arguments[0]!r}: {hint}")


if __name__ == "__main__":
    sys.exit(main())
