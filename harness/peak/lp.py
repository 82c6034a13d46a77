"""The method ``lp``: the peak as an LP-type problem, expected O(n)."""

from __future__ import annotations

import numpy as np

from harness.peak.polygon import Floats, Polygon
from harness.peak.proof import prove
from harness.peak.result import Peak
from harness.peak.sampling import Ascent, sampled_ascent


def lp_peak(polygon: Polygon, seed: int = 0) -> Peak:
    """The peak by randomised quasiconvex programming: expected O(n) and one certificate, O(n).

    ``seed`` decides the samples, hence the time but not the optimum.  ``facts``: ``rounds``, how
    often all edges were looked at (0: the direct ascent, up to 256 edges).  Raises as
    :func:`harness.peak.proof.prove`.
    """
    facts = {"rounds": 0}

    def search(start: float, edges: Floats) -> Ascent:
        end = sampled_ascent(start, edges, np.random.default_rng(seed))
        facts["rounds"] = end.rounds
        return end

    return prove(polygon, search, "lp", facts)
