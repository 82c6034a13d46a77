"""The table of a benchmark, for people."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from harness.bench.rows import NAME, values_of

if TYPE_CHECKING:
    from harness.bench.benchmark import Benchmark
    from harness.bench.runner import Summary

NOTHING = "–"
"""Where there is no value."""

_WORDS = frozenset({NAME, "family", "domain", "certified", "to reach", "verdict"})
"""The columns that are aligned to the left."""

Values = dict[str, Any]
Show = Callable[[Values], str]


def lines_of(benchmark: Benchmark, summary: Summary) -> Iterator[str]:
    """The table, one line for each row, and what stands under it."""
    columns = _columns(benchmark)
    records = [values_of(row) for row in summary.rows]
    yield from _aligned(
        [tuple(columns), *([show(r) for show in columns.values()] for r in records)]
    )
    yield ""
    for comparison, ratio in zip(benchmark.comparisons, summary.ratios, strict=True):
        if ratio is not None:
            asked = "" if comparison.most is None else f" (to reach: < {comparison.most:g})"
            verdict = _verdict(comparison.is_reached(ratio))
            yield (
                f"seconds per {_singular(benchmark.unit)}, {comparison.large} against "
                f"{comparison.small}: {ratio:.3g} times{asked}" + (f": {verdict}" if asked else "")
            )
    yield from _first_calls(summary)


def _columns(benchmark: Benchmark) -> dict[str, Show]:
    """Headings, and how a row is shown under each."""

    def form(column: str, spec: str) -> Show:
        return lambda row: NOTHING if row[column] is None else format(row[column], spec)

    return {
        NAME: form(NAME, ""),
        "family": form("family", ""),
        "n": form("n", "d"),
        "domain": form("domain", ""),
        benchmark.unit: form(benchmark.unit, "d"),
        "seconds": form("seconds", ".4g"),
        f"{benchmark.unit}/s": form(benchmark.rate_column, ".0f"),
        **{fact.heading: form(fact.column, fact.form) for fact in benchmark.facts},
        "MiB": form("peak_mib", ".0f"),
        "workers": form("workers", "d"),
        "certified": lambda row: {True: "yes", False: "no", None: NOTHING}[row["certified"]],
        "warm-up": form("warm_up_seconds", ".2f"),
        "to reach": lambda row: _asked(benchmark, row),
        "verdict": lambda row: row["status"] if row["status"] != "ok" else _verdict(row["reached"]),
    }


def _asked(benchmark: Benchmark, row: Values) -> str:
    """What the instance is to reach, in words."""
    forms = {
        "target_rate": f"≥ {{:g}} {benchmark.unit}/s",
        "target_seconds": "< {:g} s",
        "target_mib": "< {:g} MiB",
    }
    said = [form.format(row[key]) for key, form in forms.items() if row[key] is not None]
    return ", ".join(said) or NOTHING


def _verdict(reached: bool | None) -> str:
    return {True: "reached", False: "not reached", None: NOTHING}[reached]


def _singular(unit: str) -> str:
    """One of the units."""
    return {"vertices": "vertex"}.get(unit, unit.removesuffix("s"))


def _first_calls(summary: Summary) -> Iterator[str]:
    """What the seconds leave out."""
    if summary.loading is not None:
        anew = summary.compiling
        compiling = "" if anew is None else f" ({anew:.3g} s with everything to compile)"
        yield f"warm-up, in a fresh interpreter: {summary.loading:.3g} s{compiling}"


def _aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Columns as wide as need be: words to the left, numbers to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = [
            text.ljust(width) if heading in _WORDS else text.rjust(width)
            for heading, text, width in zip(rows[0], row, widths, strict=True)
        ]
        yield "  ".join(cells).rstrip()
