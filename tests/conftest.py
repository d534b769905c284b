"""How much the property tests try: `dev` by default; choose another profile by `--hypothesis-profile`.

An example may raise `GaveUp` where a limit comes before an answer. It says nothing then, and a test of which too many
examples say nothing fails.
"""

from __future__ import annotations

import functools
import signal
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis.vendor.pretty import RepresentationPrinter, for_type_by_name

from statehtn import Problem, write_hddl
from tests.brute_force import GaveUp

DECIDED = 0.8  # of the examples
ENOUGH_EXAMPLES = 50  # of fewer, now and then too many are undecided
DECIDED_OF_FEW = 0.5

SUPPRESSED = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]

settings.register_profile("dev", max_examples=30, deadline=None, suppress_health_check=SUPPRESSED)
settings.register_profile("ci", max_examples=50, deadline=None, derandomize=True, suppress_health_check=SUPPRESSED)
settings.register_profile("thorough", max_examples=10_000, deadline=None, suppress_health_check=SUPPRESSED)
settings.register_profile("objectives", max_examples=200, deadline=None, suppress_health_check=SUPPRESSED)
settings.register_profile(
    "mutation", settings.get_profile("ci"), max_examples=100, phases=[Phase.explicit, Phase.generate]
)
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


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Iterator[None]:
    """Count the examples that say something; fail where they are too few."""
    if not hasattr(pyfuncitem.obj, "hypothesis"):
        return (yield)
    answers: Counter[bool] = Counter()
    handle = pyfuncitem.obj.hypothesis
    test = handle.inner_test

    @functools.wraps(test)
    def example(*args: Any, **arguments: Any) -> None:
        try:
            test(*args, **arguments)
        except GaveUp:
            answers[False] += 1
        else:
            answers[True] += 1

    handle.inner_test = example
    try:
        result = yield
    finally:
        handle.inner_test = test
    pyfuncitem.add_report_section("call", "examples", f"{answers[True]} of {answers.total()} were decided")
    share = DECIDED if answers.total() >= ENOUGH_EXAMPLES else DECIDED_OF_FEW
    if answers[True] < share * answers.total():
        pytest.fail(f"of {answers.total()} examples only {answers[True]} were decided")
    return result
