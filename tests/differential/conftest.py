"""The paper's problem P1, beside the random ones; and tests of random ones that must compare something."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from statehtn import read_hddl
from statehtn.model import Problem
from tests.brute_force import GaveUp

AV = Path(__file__).parents[2] / "domains" / "av"
DECIDED = 0.8  # of the examples
ENOUGH_EXAMPLES = 100  # of fewer, now and then too many are undecided
DECIDED_OF_FEW = 0.5


@pytest.fixture(scope="package")
def p1() -> Problem:
    return read_hddl(AV / "domain.hddl", AV / "p1.hddl")


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Iterator[None]:
    """An example that raises `GaveUp` says nothing; fail where too many do, since nothing has been compared."""
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
