"""Hypothesis profiles: the same examples on every run where ``CI`` is set, new ones elsewhere."""

import os

from hypothesis import HealthCheck, settings

# No deadlines: a test must not fail because the machine is busy.
settings.register_profile(
    "ci", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("dev", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "dev")
