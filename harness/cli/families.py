"""``avd families``: the families of instances, with sources, parameters and declared growth."""

from __future__ import annotations

import argparse
import json
import textwrap
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from generators import Family

DESCRIPTION = """\
List the families of instances.  The growth is that of the number of Voronoi vertices in the
default domain: derived where the family is a control, expected elsewhere."""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the verb ``families``."""
    parser = subparsers.add_parser(
        "families",
        help="list the families of instances",
        description=DESCRIPTION,
        allow_abbrev=False,
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Print every family; exit status 0."""
    from generators import FAMILIES

    for family in FAMILIES.values():
        print(json.dumps(_record(family), ensure_ascii=False) if args.json else _text(family))
    return 0


def _record(family: Family) -> dict[str, Any]:
    return {
        "name": family.name,
        "kind": family.kind,
        "summary": family.summary,
        "source": family.source,
        "growth": family.growth,
        "control": family.control,
        "random": family.random,
        "smallest": family.smallest,
        "largest": family.largest,
        "even": family.even,
        "parameters": [
            {
                "name": parameter.name,
                "type": parameter.type.__name__,
                "default": parameter.default,
                "allowed": str(parameter.allowed) if parameter.allowed else None,
                "choices": list(parameter.choices),
                "help": parameter.help,
            }
            for parameter in family.parameters
        ],
    }


def _text(family: Family) -> str:
    growth = f"{family.growth} ({'derived' if family.control else 'declared'})"
    lines = [
        f"{family.name}  ({family.kind}{', random' if family.random else ''})",
        _paragraph("", family.summary),
        _paragraph("growth  ", "not known" if family.growth == "unknown" else growth),
        _paragraph("source  ", family.source),
    ]
    for parameter in family.parameters:
        allowed = " | ".join(parameter.choices) or str(parameter.allowed or parameter.type.__name__)
        label = f"--param {parameter.name}={parameter.default}  "
        lines.append(_paragraph(label, f"{parameter.help} ({allowed})"))
    return "\n".join(lines) + "\n"


def _paragraph(label: str, text: str) -> str:
    """Folded text whose first line starts with the label."""
    indent = 4 * " "
    return textwrap.fill(
        " ".join(text.split()),
        width=88,
        initial_indent=indent + label,
        subsequent_indent=indent + 8 * " " if label else indent,
        break_on_hyphens=False,
    )
