"""How much the property tests try: `dev` by default; choose another profile by `--hypothesis-profile`."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

SUPPRESSED = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]

settings.register_profile("dev", max_examples=30, deadline=None, suppress_health_check=SUPPRESSED)
settings.register_profile("ci", max_examples=150, deadline=None, derandomize=True, suppress_health_check=SUPPRESSED)
settings.register_profile("thorough", max_examples=10_000, deadline=None, suppress_health_check=SUPPRESSED)
settings.load_profile("dev")
