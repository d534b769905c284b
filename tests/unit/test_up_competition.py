"""Problems of the planning competition in unified-planning: there and back, and plans that aries-val accepts."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import pytest

import statehtn
from statehtn import Problem, UnsupportedError, validate
from statehtn.hddl import HddlWarning, read_hddl
from statehtn.interop import Conversion
from statehtn.model import TRUE, And
from tests.normal_form import normal_form
from tests.unit.test_hddl_benchmarks import DOMAINS, FOLDER, problems

pytestmark = pytest.mark.skipif(not FOLDER, reason="STATEHTN_IPC does not name the folder of the IPC's benchmarks")

# Where aries-val (0.5.0) is fast and right. In Barman it refuses actions that delete and add one fact, in Monroe
# quantifiers over a type without objects; it does not know the variables of initial networks of Woodworking.
ACCEPTED = (
    "partial-order/PCP",
    "partial-order/Rover",
    "partial-order/Satellite",
    "partial-order/Transport",
    "total-order/AssemblyHierarchical",
    "total-order/Blocksworld-GTOHP",
    "total-order/Depots",
    "total-order/Factories-simple",
    "total-order/Robot",
    "total-order/Satellite-GTOHP",
    "total-order/Snake",
    "total-order/Towers",
    "total-order/Transport",
)


def smallest(folder: Path) -> Problem:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HddlWarning)
        return read_hddl(*problems(folder)[0])


@pytest.mark.parametrize("folder", DOMAINS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_there_and_back(folder: Path) -> None:
    problem = smallest(folder)
    if folder.name == "UM-Translog":
        with pytest.raises(UnsupportedError, match="has several supertypes"):
            statehtn.to_unified_planning(problem)
        return
    conversion = Conversion.to_up(problem)
    back = statehtn.from_unified_planning(conversion.up_problem)
    if folder.name in ("Barman-BDI", "Freecell-Learned-ECAI-16"):  # two things have one name, so one gets another
        assert normal_form(back) != normal_form(problem)
        again = statehtn.from_unified_planning(statehtn.to_unified_planning(back))
        assert normal_form(again) == normal_form(back)
    else:
        assert normal_form(back) == normal_form(problem)


def constraints_as_preconditions(problem: Problem) -> Problem:
    """An equivalent problem without constraints of methods, which aries-val does not know."""
    methods = {
        name: replace(
            method,
            precondition=And((method.precondition, method.network.constraints)),
            network=replace(method.network, constraints=TRUE),
        )
        for name, method in problem.domain.methods.items()
    }
    return replace(problem, domain=replace(problem.domain, methods=methods))


@pytest.mark.filterwarnings("ignore:subprocess .* is still running:ResourceWarning")  # which aries starts
@pytest.mark.parametrize("name", ACCEPTED)
def test_plans_are_accepted_by_aries(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    aries = pytest.importorskip("up_aries")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))  # it leaves its logs there
    problem = constraints_as_preconditions(smallest(Path(FOLDER) / name))
    conversion = Conversion.to_up(problem)
    result = statehtn.plan(problem, search="greedy", time_limit=60)
    assert result.plan is not None
    plan = conversion.plan_to_up(result.plan)
    validator = aries.AriesVal()
    assert validator.supports(conversion.up_problem.kind)
    assert validator.validate(conversion.up_problem, plan)
    assert validate(problem, conversion.plan_from_up(plan))
