"""From a study's rows to growth verdicts: tables, growth models, challenges, planted controls.

References
----------
C. C. McGeoch, P. Sanders, R. Fleischer, P. R. Cohen, D. Precup: Using finite experiments to
study asymptotic performance.  Experimental Algorithmics, LNCS 2547 (2002), 93–126.

D. S. Johnson: A theoretician's guide to the experimental analysis of algorithms.  Data
Structures, Near Neighbor Searches, and Methodology, DIMACS 59 (2002), 215–250.

Y. Pushak, H. H. Hoos: Advanced statistical analysis of empirical performance scaling.
GECCO 2020, 236–244.
"""

from harness.analysis.growth import GroupGrowth, Growth, analyse_group
from harness.analysis.models import MODELS, Model
from harness.analysis.planted import Check, Design, check, design_of
from harness.analysis.samples import HEADLINES, Group, Key, Size, split
from harness.analysis.statistics import STATISTICS, Statistic
from harness.analysis.verdict import Verdict

__all__ = [
    "HEADLINES",
    "MODELS",
    "STATISTICS",
    "Check",
    "Design",
    "Group",
    "GroupGrowth",
    "Growth",
    "Key",
    "Model",
    "Size",
    "Statistic",
    "Verdict",
    "analyse_group",
    "check",
    "design_of",
    "split",
]
