"""The numbers behind the report, as tables: every figure and every HTML table is made from these.

They are written beside the report as CSV; what is drawn is read back from that text, so a plotted
number and a stored number cannot differ.
"""

from __future__ import annotations

import io
from collections.abc import Sequence

import pandas as pd

from harness.analysis import HEADLINES, MODELS, STATISTICS, Group, GroupGrowth, Growth
from harness.analysis.models import Floats

#: Column names of the models' ratios.
RATIO = {
    "1": "per_1",
    "log n": "per_log_n",
    "n": "per_n",
    "n log n": "per_n_log_n",
    "n^2": "per_n2",
}
ROW_COLUMNS = (
    "task",
    "n",
    "segments",
    "replicate",
    "seed",
    "status",
    "cells",
    "edges",
    "vertices",
    "certified",
    "message",
)


def to_csv(table: pd.DataFrame) -> str:
    """The table as CSV text; the same numbers give the same text."""
    text: str = table.to_csv(index=False, float_format="%.9g", lineterminator="\n")
    return text


def from_csv(text: str) -> pd.DataFrame:
    """The table back from its text."""
    return pd.read_csv(io.StringIO(text), keep_default_na=False, na_values=[""])


def curves(analysed: GroupGrowth) -> pd.DataFrame:
    """One row per count, statistic and size of a group.

    ``value`` is the statistic over the counted tasks, ``lower``/``upper`` its 95 % bootstrap
    interval (empty: nothing to resample), ``at_least``/``at_most`` what it can be if unseen tasks
    are taken into account, ``per_…`` the ratio to each model, ``slope`` the local slope from the
    size before, ``declared`` the declared model, scaled to the value at the largest size.
    """
    records = []
    for headline in HEADLINES:
        for statistic in STATISTICS:
            curve = analysed.curves[headline, statistic]
            declared = _declared_line(analysed, curve)
            for index, size in enumerate(analysed.group.seen):
                record: dict[str, object] = {
                    "count": headline,
                    "statistic": statistic,
                    "n": curve.n[index],
                    "requested": size.n,
                    "tasks": len(size.rows),
                    "counted": len(size.counted),
                    "unseen": size.unseen,
                    "uncertified": size.uncertified,
                    "value": curve.observed[index],
                    "lower": None if curve.low is None else curve.low[index],
                    "upper": None if curve.high is None else curve.high[index],
                    "at_least": curve.bounds[index].low,
                    "at_most": curve.bounds[index].high,
                    "slope": curve.slopes[index],
                    "fitted": bool(curve.n[index] in curve.challenge.fitted),
                    "declared": declared[index] if declared is not None else None,
                }
                for model in MODELS:
                    record[RATIO[model.name]] = curve.ratios[model.name][index]
                records.append(record)
    columns = [
        *("count", "statistic", "n", "requested", "tasks", "counted", "unseen", "uncertified"),
        *("value", "lower", "upper", "at_least", "at_most", "slope", "fitted", "declared"),
        *RATIO.values(),
    ]
    return pd.DataFrame.from_records(records, columns=columns)


def _declared_line(analysed: GroupGrowth, curve: Growth) -> Floats | None:
    """The declared leading term alone, through the value at the largest size: for the eye."""
    if analysed.declared is None or curve.headline != "vertices" or not len(curve.n):
        return None
    leading = analysed.declared.model.leading(curve.n)
    if leading[-1] <= 0 or curve.observed[-1] <= 0:
        return None
    line: Floats = curve.observed[-1] * leading / leading[-1]
    return line


def trials(analysed: GroupGrowth) -> pd.DataFrame:
    """One row per count, statistic, model and challenge size: predicted against observed."""
    records = []
    for (headline, statistic), curve in analysed.curves.items():
        cut = len(curve.challenge.fitted)
        for trial in curve.challenge.trials:
            for index, n in enumerate(curve.challenge.challenged):
                records.append(
                    {
                        "count": headline,
                        "statistic": statistic,
                        "model": trial.model.name,
                        "finding": trial.finding,
                        "miss": trial.miss,
                        "miss_low": trial.low,
                        "miss_high": trial.high,
                        "n": n,
                        "observed": curve.observed[cut + index],
                        "predicted": _to_six_digits(trial.predicted[index]),
                        "predicted_low": _to_six_digits(trial.predicted_low[index]),
                        "predicted_high": _to_six_digits(trial.predicted_high[index]),
                    }
                )
    columns = [
        *("count", "statistic", "model", "finding", "miss", "miss_low", "miss_high", "n"),
        *("observed", "predicted", "predicted_low", "predicted_high"),
    ]
    return pd.DataFrame.from_records(records, columns=columns)


def _to_six_digits(fitted: float) -> float:
    """A fitted value as every processor finds it: see ``without_noise``."""
    return float(f"{fitted:.6g}")


def verdicts(study: Sequence[GroupGrowth]) -> pd.DataFrame:
    """One row per curve of the study: the verdict, the exponent, the models rejected."""
    records = []
    for analysed in study:
        for curve in analysed.curves.values():
            verdict, power = curve.verdict, curve.power
            records.append(
                {
                    **dict(
                        zip(
                            ("family", "params", "domain", "objective", "builder"),
                            analysed.group.key.fields,
                            strict=True,
                        )
                    ),
                    "count": curve.headline,
                    "statistic": curve.statistic,
                    "verdict": verdict.label,
                    "linear": verdict.linear_claim,
                    "kept": _names(verdict.kept),
                    "too_slow": _names(verdict.too_slow),
                    "too_fast": _names(verdict.too_fast),
                    "withheld": _names(verdict.withheld),
                    "exponent": power.exponent,
                    "exponent_low": power.low,
                    "exponent_high": power.high,
                    "exponent_note": power.reason,
                    "wiggle": curve.challenge.wiggle,
                    "sentence": verdict.sentence,
                }
            )
    return pd.DataFrame.from_records(records)


def _names(models: Sequence[object]) -> str:
    return ", ".join(str(getattr(model, "name", model)) for model in models)


def raw_rows(group: Group) -> pd.DataFrame:
    """The group's rows as stored, without the columns that are the same for all of them."""
    return group.rows[list(ROW_COLUMNS)]


def overview(study: Sequence[GroupGrowth], labels: Sequence[str]) -> pd.DataFrame:
    """Maximum number of vertices per segment: the curves of the whole study side by side."""
    records: list[dict[str, object]] = []
    for analysed, label in zip(study, labels, strict=True):
        curve = analysed.curves["vertices", "maximum"]
        key = analysed.group.key
        records.extend(
            {
                "curve": label,
                "domain": key.domain,
                "objective": key.objective,
                "n": n,
                "vertices": value,
                "per_n": value / n,
            }
            for n, value in zip(curve.n, curve.observed, strict=True)
        )
    columns = ["curve", "domain", "objective", "n", "vertices", "per_n"]
    return pd.DataFrame.from_records(records, columns=columns)


def failures(groups: Sequence[Group]) -> pd.DataFrame:
    """Every task that did not end with a count, with its status and message."""
    columns = ["family", "params", "n", "replicate", "seed", "domain", "objective", "builder"]
    columns += ["status", "message", "task"]
    parts = [group.rows for group in groups]
    together = pd.concat(parts) if parts else pd.DataFrame(columns=columns)
    return together[together["status"] != "ok"][columns]
