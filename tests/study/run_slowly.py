"""A program to be interrupted and killed: run the study of ``TEXT`` with slow, logged work.

Usage: ``python -m tests.study.run_slowly DIRECTORY LOG MODE JOBS WORK``, where WORK is a function
of ``fakes``.  Exit status 0 or 130.
"""

from __future__ import annotations

import functools
import sys
from pathlib import Path

from harness.study.runner import run_study
from tests.study import fakes
from tests.study.studies import study, sweep

TEXT = sweep(range(3, 13), 4)


def main() -> int:
    directory, log, mode, jobs, work = sys.argv[1:]
    summary = run_study(
        study(TEXT),
        Path(directory),
        mode=mode,  # type: ignore[arg-type]  # one of the modes
        jobs=int(jobs),
        work=functools.partial(getattr(fakes, work), Path(log)),
    )
    return 130 if summary.interrupted else 0


if __name__ == "__main__":
    sys.exit(main())
