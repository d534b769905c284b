"""The table of all RA-parameters: every combination is in a row, and every row that names an objective is run."""

from __future__ import annotations

import itertools
import re

import pytest

import statehtn
from statehtn import Status
from statehtn.risk import SuccessUtility
from tests.pages import ROOT

PAGE = ROOT / "docs/paper-map.md"
ROW = re.compile(r"^\| `(P\S+)` \| (.+?) \| (.*?) ?\|$", re.MULTILINE)
ONE_OUTCOME = ("domains/av/domain.hddl", "domains/av/p1.hddl")
SEVERAL = ("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")


def rows() -> list[tuple[str, str, str]]:
    section = PAGE.read_text(encoding="utf-8").split("## All RA-parameters")[1].split("\n## ")[0]
    return [(match[1], match[2], match[3].strip("` ")) for match in ROW.finditer(section)]


def fits(pattern: str, name: str) -> bool:
    signs = re.findall(r"\[[^]]+\]|.", pattern)
    return all(sign == "." or letter in sign.strip("[]") for sign, letter in zip(signs, name, strict=True))


NAMES = ["P" + "".join(parts) for parts in itertools.product("SP", "1n", "01", "012", "01", "0123*")]


def row_of(name: str) -> tuple[str, str, str]:
    for row in rows():
        if fits(row[0], name):
            return row
    raise AssertionError(f"no row of the table is about {name}")


def test_every_combination_is_in_a_row() -> None:
    assert len(NAMES) == 240
    used = {row_of(name)[0] for name in NAMES}
    assert used == {pattern for pattern, _, _ in rows()}


RUN = sorted({(name, row_of(name)[2]) for name in NAMES if row_of(name)[2]})


@pytest.mark.parametrize(("name", "objective"), RUN)
def test_rows_are_run(name: str, objective: str) -> None:
    wanted = SuccessUtility(lambda cost: 1 / (1 + cost)) if objective == "a function" else objective
    solver = "state" if name[1] == "S" else "plan"
    if name[2] == "1":
        result = statehtn.plan(statehtn.read_hddl(*ONE_OUTCOME), objective=wanted, solver=solver)
    elif name.endswith("2"):
        result = statehtn.plan(statehtn.read_hddl(*SEVERAL), objective=wanted)
    else:
        policy = statehtn.policy(statehtn.read_hddl(*SEVERAL), objective=wanted)
        assert (policy.status, policy.problem_class) == (Status.OPTIMAL, name)
        assert policy.value is not None
        return
    assert result.status is Status.OPTIMAL
    if objective != "a function":
        assert result.problem_class == name
