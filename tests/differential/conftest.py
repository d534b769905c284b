"""The paper's problem P1, for tests beside the random ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from statehtn import read_hddl
from statehtn.model import Problem
from tests.differential.judge import EXPLAINED

AV = Path(__file__).parents[2] / "domains" / "av"


@pytest.fixture(scope="package")
def p1() -> Problem:
    return read_hddl(AV / "domain.hddl", AV / "p1.hddl")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how many cases of each family were judged, and how many choices no neutral or exponential agent explains."""
    if EXPLAINED:
        terminalreporter.section("objectives")
        for family in dict.fromkeys(family for family, _ in EXPLAINED):
            decided, finite, unexplained = (EXPLAINED[family, what] for what in ("decided", "finite", "unexplained"))
            terminalreporter.line(
                f"{family}: {decided} with a plan; of {finite} with finitely many plans {unexplained} whose best plan "
                "is best neither for the mean nor for any exponential utility"
            )
