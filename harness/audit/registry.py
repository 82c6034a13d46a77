"""All claims, in the order of the paper."""

from __future__ import annotations

from collections.abc import Sequence

from harness.audit import complexity, cubics, discs, extrema, levels, peaks, plane, regions
from harness.audit.claim import Claim
from harness.errors import UserError, suggestion

_ORDER = (
    "lemma-1",
    "lemma-1-one-curve",
    "lemma-2",
    "lemma-2-proof",
    "lemma-2-repaired",
    "lemma-3",
    "lemma-3-plane",
    "lemma-4-plane",
    "lemma-4-kernel",
    "lemma-4-convex",
    "theorem-5",
    "grid",
    "linear-kernel",
    "linear-interior",
    "two-segments",
    "not-a-vertex",
    "naive-algorithm",
    "single-circle",
    "single-circle-interior",
    "convex-levels",
    "convex-levels-interior",
    "lemma-6",
    "theorem-7",
)
_ALL = {
    claim.name: claim
    for module in (cubics, regions, peaks, plane, extrema, complexity, levels, discs)
    for claim in module.CLAIMS
}

CLAIMS: dict[str, Claim] = {name: _ALL[name] for name in _ORDER}


def chosen(names: Sequence[str]) -> list[Claim]:
    """The claims with these names, in the order of the paper; all of them if there are no names.

    Raises UserError, with a suggestion, for an unknown name.
    """
    for name in names:
        if name not in CLAIMS:
            hint = suggestion(name, CLAIMS) or "avd audit --list names them"
            raise UserError(f"unknown claim {name!r}: {hint}")
    return [claim for name, claim in CLAIMS.items() if not names or name in names]
