"""Hypothesis profiles: the same examples on every run where ``CI`` is set, new ones elsewhere.

And signals: a shell starts what runs in its background with SIGINT ignored, ``nohup`` ignores
SIGHUP, and programs inherit that; those that the tests interrupt would then run on.
"""

import os
import signal

from hypothesis import HealthCheck, settings

# No deadlines: a test must not fail because the machine is busy.
settings.register_profile(
    "ci", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("dev", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "dev")

for number, usual in (
    (signal.SIGINT, signal.default_int_handler),
    (signal.SIGTERM, signal.SIG_DFL),
    (signal.SIGHUP, signal.SIG_DFL),
):
    if signal.getsignal(number) == signal.SIG_IGN:
        signal.signal(number, usual)
