"""The study file: TOML in, tasks out, every mistake named by file, table and key.

A study file looks like this::

    name = "growth"                # results go to results/growth/
    description = "How the kernel's vertices grow"
    time_limit = 60                # seconds for one task (default 300)
    memory_limit = 2048            # MiB for one task's process (default 2048)
    base_seed = 0                  # another number, other random instances (default 0)

    [[sweep]]                      # any number of these
    family = "zigzag"
    n = { from = 8, to = 64, factor = 2 }      # or a list, or one number
    replicates = 30                # instances of each kind (default 1)
    params = { tilt = [0.3, 0.5] }   # a scalar or a list each; lists multiply
    domain = ["kernel", "plane"]   # default: kernel for polygons, plane for segments
    objective = "smallest"         # default
    builder = "reference"          # default

The tasks are the product of all lists.  A family that uses no randomness has one replicate, and
a task that several sweeps ask for is one task.
"""

from __future__ import annotations

import itertools
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from generators import FAMILIES, Family, GeneratorError
from harness.diagram import BUILDERS
from harness.diagram.counts import DOMAINS, OBJECTIVES, default_domain
from harness.errors import UserError, shown
from harness.study.limits import Limits
from harness.study.task import Scalar, Task, seed_of
from harness.study.values import Table, choose

DEFAULT_TIME_LIMIT = 300.0
DEFAULT_MEMORY_LIMIT = 2048
LEAST_MEMORY_LIMIT = 256
"""MiB; Python and the libraries alone take about 150."""
MOST_SECONDS, MOST_MEMORY_LIMIT = 366 * 86_400, 2**30
"""Beyond any task and any machine; clocks and the system's limits still take such numbers."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


@dataclass(frozen=True)
class Study:
    """A study file, read: what to run and within which limits.

    ``tasks``: without repetition, small n first.  ``text``: the file, verbatim.
    """

    name: str
    description: str
    limits: Limits
    base_seed: int
    tasks: tuple[Task, ...]
    text: str


def read_study(path: Path) -> Study:
    """Read a study file.  Raises UserError naming file, table and key."""
    try:
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise UserError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UserError(f"{path}: not UTF-8") from None
    text = text.removeprefix("\ufeff")  # an editor's byte order mark
    return parse_study(text, str(path))


def parse_study(text: str, source: str) -> Study:
    """The study in ``text``; ``source`` names it in errors.  Raises UserError."""
    try:
        top = Table(tomllib.loads(text), source)
    except (ValueError, RecursionError) as error:  # numbers of too many digits are ValueErrors
        raise UserError(f"{source}: not TOML: {error}") from None
    name = top.text("name")
    if not _NAME.fullmatch(name):
        raise top.error("name", f"{shown(name)} must be letters, digits, '.', '_' and '-'")
    seconds = top.number("time_limit", DEFAULT_TIME_LIMIT)
    mib = top.integer("memory_limit", DEFAULT_MEMORY_LIMIT)
    if not 0 < seconds <= MOST_SECONDS:
        reason = f"must be a positive number of seconds, at most {MOST_SECONDS} (a year)"
        raise top.error("time_limit", f"{seconds:g} {reason}")
    if not LEAST_MEMORY_LIMIT <= mib <= MOST_MEMORY_LIMIT:
        reason = f"must be at least {LEAST_MEMORY_LIMIT} and at most {MOST_MEMORY_LIMIT} MiB"
        raise top.error("memory_limit", f"{shown(mib)} {reason}")
    description = top.text("description", "")
    base_seed = top.integer("base_seed", 0)
    sweeps = top.tables("sweep")
    top.finish()
    unique = dict.fromkeys(task for sweep in sweeps for task in _tasks(sweep, base_seed))
    tasks = tuple(sorted(unique, key=lambda task: task.n))  # stable: within n, the file's order
    return Study(name, description, Limits(seconds, mib), base_seed, tasks, text)


#: More replicates or sizes than this in one sweep are a slip of the pen.
MOST = 100_000
#: More segments than this no machine holds.
MOST_SEGMENTS = 10**12


def _tasks(sweep: Table, base_seed: int) -> Iterator[Task]:
    """The tasks of one sweep.  Raises UserError."""
    family = FAMILIES[choose(sweep, "family", sweep.text("family"), FAMILIES)]
    sizes = _sizes(sweep)
    replicates = sweep.integer("replicates", 1)
    if replicates < 1:
        raise sweep.error("replicates", f"{shown(replicates)} must be at least 1")
    if replicates > MOST:
        raise sweep.error("replicates", f"{shown(replicates)} is more than {MOST}")
    combinations = list(_combinations(sweep.table("params")))
    domains = sweep.choices("domain", default_domain(family.kind), DOMAINS)
    objectives = sweep.choices("objective", "smallest", OBJECTIVES)
    builders = sweep.choices("builder", BUILDERS[0], BUILDERS)
    sweep.finish()
    if family.kind == "segments" and set(domains) != {"plane"}:
        raise sweep.error("domain", f"{family.name} makes segments, whose only domain is 'plane'")
    for n, given in itertools.product(sizes, combinations):
        params = _resolved(sweep, family, n, given)
        for replicate in range(replicates if family.random else 1):
            seed = seed_of(base_seed, family.name, params, n, replicate)
            for domain, objective, builder in itertools.product(domains, objectives, builders):
                yield Task(
                    family=family.name,
                    n=n,
                    params=tuple(sorted(params.items())),
                    replicate=replicate,
                    seed=seed,
                    domain=domain,
                    objective=objective,
                    builder=builder,
                )


def _resolved(
    sweep: Table, family: Family, n: int, given: Mapping[str, Scalar]
) -> dict[str, Scalar]:
    """Every parameter of the family, checked.  Raises UserError."""
    try:
        return family.check(n, given)
    except GeneratorError as error:
        raise UserError(f"{sweep.where}: {error}") from None


def _combinations(params: Table) -> Iterator[dict[str, Scalar]]:
    """The product of the lists among the parameters."""
    values = {name: params.scalars(name) for name in params}
    for combination in itertools.product(*values.values()):
        yield dict(zip(values, combination, strict=True))


def _sizes(sweep: Table) -> list[int]:
    """The sizes n that a sweep names: a number, a list, or a geometric range (rounded).

    Raises UserError.
    """
    value: Any = sweep.take("n")
    if not isinstance(value, dict):
        sizes = value if isinstance(value, list) else [value]
        if not sizes or any(type(n) is not int for n in sizes):
            raise sweep.error("n", "must be an integer, a list of integers, or a range")
        if max(sizes) > MOST_SEGMENTS:
            raise sweep.error("n", f"{shown(max(sizes))} is more than {MOST_SEGMENTS}")
        return list(dict.fromkeys(sizes))
    span = Table(value, f"{sweep.where}: n")
    first, last = span.integer("from"), span.integer("to")
    factor = span.number("factor", 2.0)
    span.finish()
    if not 1 <= first <= last:
        reason = f"must be at least 1 and at most 'to', {shown(last)}"
        raise span.error("from", f"{shown(first)} {reason}")
    if last > MOST_SEGMENTS:
        raise span.error("to", f"{shown(last)} is more than {MOST_SEGMENTS}")
    if not 1.0 < factor < math.inf:
        raise span.error("factor", f"{factor:g} must be greater than 1")
    steps = math.floor(math.log(last / first) / math.log(factor) + 1e-9)
    if steps > MOST:
        raise span.error("factor", f"{factor!r} makes more than {MOST} sizes")
    return list(dict.fromkeys(round(first * factor**k) for k in range(steps + 1)))
