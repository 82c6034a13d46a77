"""The study in a few sentences: for the terminal and for the top of the page."""

from __future__ import annotations

from collections.abc import Sequence

from harness.analysis import GroupGrowth
from harness.analysis.verdict import Call, LinearClaim
from harness.report.labels import number

CALLS: dict[Call, str] = {
    "right": "called right",
    "possible": "not contradicted",
    "wrong": "CALLED WRONG",
    "undecided": "not decided",
}
LINEAR: dict[LinearClaim, str] = {
    "faster": "faster than linear",
    "possible": "linear not excluded",
    "slower": "slower than linear",
    "undecided": "not decided",
}


def controls(study: Sequence[GroupGrowth]) -> list[tuple[GroupGrowth, Call, Call]]:
    """The groups whose growth is known, with the calls on their maximum and their median."""
    found = []
    for analysed in study:
        if analysed.declared is None or not analysed.declared.is_control:
            continue
        name = analysed.declared.model.name
        maximum, median = (
            analysed.curves["vertices", statistic].verdict.call(name)
            for statistic in ("maximum", "median")
        )
        found.append((analysed, maximum, median))
    return found


def control_sentence(study: Sequence[GroupGrowth]) -> str:
    """How the controls came out, in one sentence; empty if there are none."""
    calls = [call for _, maximum, median in controls(study) for call in (maximum, median)]
    if not calls:
        return ""
    parts = [f"{calls.count(call)} {words}" for call, words in CALLS.items() if calls.count(call)]
    curves = len(calls) // 2
    noun = "curve" if curves == 1 else "curves"
    return f"{len(calls)} verdicts on {curves} {noun} of known growth: {', '.join(parts)}."


def by_linear_claim(
    study: Sequence[GroupGrowth], labels: Sequence[str]
) -> list[tuple[str, list[str]]]:
    """What becomes of linear complexity: the labels of the curves by their verdict.

    On the maximum number of vertices; only verdicts that occur, in the order of ``LINEAR``.
    """
    claims = [analysed.curves["vertices", "maximum"].verdict.linear_claim for analysed in study]
    return [
        (words, [label for label, found in zip(labels, claims, strict=True) if found == claim])
        for claim, words in LINEAR.items()
        if claim in claims
    ]


def tasks_sentence(study: Sequence[GroupGrowth], planned: int | None) -> str:
    """How many tasks there are, how many were counted, how many certified."""
    rows = sum(len(analysed.group.rows) for analysed in study)
    sizes = [size for analysed in study for size in analysed.group.sizes]
    counted = sum(len(size.counted) for size in sizes)
    uncertified = sum(size.uncertified for size in sizes)
    failed = rows - counted
    parts = [f"{rows} tasks, {counted} counted"]
    parts.append("all certified" if not uncertified else f"{uncertified} NOT certified")
    if failed:
        parts.append(f"{failed} without a count")
    if planned is not None and planned > rows:
        parts.append(f"INCOMPLETE: the study has {planned} tasks")
    return ", ".join(parts) + "."


def lines(
    study: Sequence[GroupGrowth], labels: Sequence[str], planned: int | None = None
) -> list[str]:
    """The verdicts for a terminal: one line per curve, between two lines about the whole."""
    width = max((len(label) for label in labels), default=0)
    result = [tasks_sentence(study, planned)]
    result.append("growth of the number of vertices:")
    for analysed, label in zip(study, labels, strict=True):
        maximum = analysed.curves["vertices", "maximum"]
        median = analysed.curves["vertices", "median"]
        largest = number(float(maximum.n[-1])) if len(maximum.n) else "–"
        text = f"  {label:{width}}  n ≤ {largest:>4}  maximum {maximum.verdict.label}"
        if not analysed.noise_free or median.verdict.label != maximum.verdict.label:
            text += f"; median {median.verdict.label}"
        if analysed.declared is not None and analysed.declared.is_control:
            name = analysed.declared.model.name
            calls = {curve.verdict.call(name) for curve in (maximum, median)}
            worst = next(
                call for call in ("wrong", "undecided", "possible", "right") if call in calls
            )
            text += f"  (known: {analysed.declared.model.symbol}, {CALLS[worst]})"
        elif analysed.declared is not None and analysed.declared.defaults:
            text += f"  (expected: {analysed.declared.model.symbol})"
        result.append(text)
    sentence = control_sentence(study)
    if sentence:
        result.append(f"controls: {sentence}")
    return result
