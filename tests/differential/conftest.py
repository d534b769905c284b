"""The paper's problem P1, for tests beside the random ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from statehtn import read_hddl
from statehtn.model import Problem

AV = Path(__file__).parents[2] / "domains" / "av"


@pytest.fixture(scope="package")
def p1() -> Problem:
    return read_hddl(AV / "domain.hddl", AV / "p1.hddl")
