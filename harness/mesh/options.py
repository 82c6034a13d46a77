"""What can be chosen, by name; nothing heavy is imported here."""

from __future__ import annotations

OBJECTIVES = ("all", "apex", "laplacian", "smart-laplacian", "combined")
"""``all``: raise the smallest of all angles.  ``apex``: the paper's greedy, which looks at the
angles at the moved vertex.  The others are for comparison: every vertex into the mean of its
neighbours; the same only where the star gets no worse; and smart Laplacian sweeps followed by
ascent where angles are small (Freitag and Ollivier-Gooch, 1997)."""
TOPOLOGIES = ("fixed", "flip", "full")
"""What may change besides coordinates: nothing; edges; edges and the number of vertices."""
REMEDIES = ("none", "bisector", "chord", "both")
"""Against small angles at the rim of a star after a move of ``apex`` (paper, Figure 6)."""
