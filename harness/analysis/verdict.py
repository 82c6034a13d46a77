"""What a challenge allows to be said, in words that never claim more than was counted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from harness.analysis.challenge import Challenge
from harness.analysis.models import BY_NAME, LINEAR, MODELS, Model

Kind: TypeAlias = Literal["single", "several", "between", "undecided"]
LinearClaim: TypeAlias = Literal["faster", "possible", "slower", "undecided"]
Call: TypeAlias = Literal["right", "possible", "wrong", "undecided"]


@dataclass(frozen=True)
class Verdict:
    """The reading of one curve.

    ``kept`` are the models that survived.  Kind ``single``: exactly one did; ``several``: more,
    but not all; ``between``: none, and the rejected ones say from which side; ``undecided``: no
    model was rejected, or there were too few sizes (``reason``).
    """

    kind: Kind
    kept: tuple[Model, ...]
    too_slow: tuple[Model, ...]
    too_fast: tuple[Model, ...]
    withheld: tuple[Model, ...]
    label: str
    sentence: str

    @property
    def linear_claim(self) -> LinearClaim:
        """What becomes of "linear complexity" on the studied range.

        ``faster``: every model up to linear is too slow; ``slower``: linear and all above are too
        fast; ``possible``: linear survived; ``undecided`` otherwise.
        """
        if self.kind == "undecided":
            return "undecided"
        if all(model in self.too_slow for model in MODELS[: LINEAR + 1]):
            return "faster"
        if all(model in self.too_fast for model in MODELS[LINEAR:]):
            return "slower"
        return "possible" if MODELS[LINEAR] in self.kept else "undecided"

    def call(self, declared: str) -> Call:
        """How the verdict compares with a growth known beforehand (a name of ``BY_NAME``)."""
        model = BY_NAME[declared]
        if model in self.too_slow or model in self.too_fast:
            return "wrong"
        if self.kind == "undecided":
            return "undecided"
        return "right" if self.kept == (model,) and not self.withheld else "possible"


def judge(challenge: Challenge) -> Verdict:
    """Turn the trials into a verdict."""
    trials = challenge.trials
    if not trials:
        sentence = f"Not decided: {challenge.reason}."
        return Verdict("undecided", (), (), (), (), "not decided", sentence)
    by_finding = {
        finding: tuple(trial.model for trial in trials if trial.finding == finding)
        for finding in ("too slow", "too fast", "withheld")
    }
    kept = tuple(trial.model for trial in trials if trial.finding in ("kept", "fragile"))
    withheld = by_finding["withheld"]
    slow, fast = by_finding["too slow"], by_finding["too fast"]
    kind, label = _label(kept, slow, fast, withheld)
    sentence = _sentence(kind, label, challenge, slow, fast, withheld)
    return Verdict(kind, kept, slow, fast, withheld, label, sentence)


def _label(
    kept: tuple[Model, ...],
    slow: tuple[Model, ...],
    fast: tuple[Model, ...],
    withheld: tuple[Model, ...],
) -> tuple[Kind, str]:
    alive = tuple(model for model in MODELS if model in kept or model in withheld)
    if not slow and not fast:
        return "undecided", "not decided"
    if len(alive) == 1:
        return "single", alive[0].symbol
    if alive:
        return "several", _alternatives(alive)
    # None survived: the too slow ones end where the too fast ones begin.
    if not slow:
        return "between", f"slower than {fast[0].symbol}"
    if not fast:
        return "between", f"faster than {slow[-1].symbol}"
    return "between", f"between {slow[-1].symbol} and {fast[0].symbol}"


def _sentence(
    kind: Kind,
    label: str,
    challenge: Challenge,
    slow: tuple[Model, ...],
    fast: tuple[Model, ...],
    withheld: tuple[Model, ...],
) -> str:
    largest = challenge.challenged[-1]
    start = {
        "single": f"Consistent with {label}, and with no other candidate, up to n = {largest:g}.",
        "several": f"Consistent with {label} up to n = {largest:g}; this study cannot tell which.",
        "between": f"No candidate predicts the larger sizes: {label} up to n = {largest:g}.",
        "undecided": "Not decided: no candidate is rejected.",
    }[kind]
    parts = [start]
    if slow or fast:
        reasons = []
        if slow:
            reasons.append(f"{_list(slow)} as too slow")
        if fast:
            reasons.append(f"{_list(fast)} as too fast")
        parts.append(f"Rejected: {'; '.join(reasons)}.")
    if withheld:
        parts.append(
            f"A rejection of {_list(withheld)} is withheld: it rests on sizes with unseen tasks."
        )
    return " ".join(parts)


def _list(models: tuple[Model, ...]) -> str:
    return ", ".join(model.symbol for model in models)


def _alternatives(models: tuple[Model, ...]) -> str:
    """“1 or log n”; three or more, always a run of neighbours, are “1 … n log n”."""
    joint = " or " if len(models) == 2 else " … "
    return f"{models[0].symbol}{joint}{models[-1].symbol}"
