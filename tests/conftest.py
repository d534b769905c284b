"""How much the property tests try: `dev` by default; choose another profile by `--hypothesis-profile`."""

from __future__ import annotations

import signal

from hypothesis import HealthCheck, settings
from hypothesis.vendor.pretty import RepresentationPrinter, for_type_by_name

from statehtn import Problem, write_hddl

SUPPRESSED = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]

settings.register_profile("dev", max_examples=30, deadline=None, suppress_health_check=SUPPRESSED)
settings.register_profile("ci", max_examples=100, deadline=None, derandomize=True, suppress_health_check=SUPPRESSED)
settings.register_profile("thorough", max_examples=10_000, deadline=None, suppress_health_check=SUPPRESSED)
settings.load_profile("dev")

# A shell starts its background jobs with Ctrl-C ignored, `nohup` with hang-ups ignored, and CI may do both; what they
# start inherits that. The tests that send signals, to themselves or to commands, expect what a terminal gives.
for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, handler)


def show_problem(problem: Problem, printer: RepresentationPrinter, _cycle: bool) -> None:
    """Show a falsifying example as HDDL; `repr` only counts."""
    printer.text("\n".join(("", *write_hddl(problem))))


for_type_by_name("statehtn.model.problem", "Problem", show_problem)
