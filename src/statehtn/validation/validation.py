"""The judge of plans: whether a plan is executable, whether its decomposition is right, and what it costs."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from statehtn.collector import without_collector
from statehtn.counted import brief, counted
from statehtn.errors import UsageError
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_plan, expect_problem, expect_utility
from statehtn.model.plan import Plan, Step
from statehtn.model.plan_outcome import PlanOutcome
from statehtn.model.problem import Fact, Problem
from statehtn.model.status import Status
from statehtn.risk import Utility, plan_expected_cost, plan_risk_cost
from statehtn.semantics.chances import StepOutcome
from statehtn.semantics.execution import execute
from statehtn.semantics.outcomes import Changes
from statehtn.semantics.world import World
from statehtn.validation.decomposition import Matching, match_networks
from statehtn.validation.ordering import check_ordering
from statehtn.validation.trajectories import Price, Trajectories, likeliest, without_unread
from statehtn.validation.tree import PlanTree

MOST_RUNS = 10_000
"""Of a plan of actions with several outcomes that are looked at; each differs in what methods ask for."""
_STEP = re.compile(r"step (\d+) \([^()]*\): ")


@dataclass(frozen=True, slots=True, repr=False)
class Validation:
    """What the validation of a plan found; true where the plan is valid.

    Args:
        reasons: what is wrong, each in one sentence; steps are counted from 1. Empty for a valid plan.
        costs: the cost distribution of each step in the state it is executed in, up to the first step that cannot be
            executed.
        plan: the plan with the decomposition that was found for a list of actions; None for plans that had one.
        stopped: what ended the search for that before it was done: whether the actions are a plan is not known then.
        outcomes: where actions have several outcomes, for each step in `costs` the one that the plan counts on; else
            None.
    """

    reasons: tuple[str, ...]
    costs: tuple[CostLaw, ...]
    plan: Plan | None = None
    stopped: Status | None = None
    outcomes: tuple[PlanOutcome, ...] | None = None

    @property
    def valid(self) -> bool:
        """True if the plan solves the problem."""
        return not self.reasons

    def __bool__(self) -> bool:
        return self.valid

    def __str__(self) -> str:
        """Say "valid", or "invalid" and why, a reason in each line."""
        verdict = "invalid:" if self.stopped is None else "not decided:"
        return "valid" if self.valid else "\n- ".join((verdict, *self.reasons))

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn validate --json` prints."""
        return {
            "valid": None if self.stopped is not None else self.valid,
            "reasons": list(self.reasons),
            "stopped": None if self.stopped is None else self.stopped.value,
            "executed": len(self.costs),
            "expected_cost": self.expected_cost if self.valid else None,
            "probability": self.probability if self.valid else None,
            "outcomes": None if self.outcomes is None else [outcome.to_dict() for outcome in self.outcomes],
        }

    def __repr__(self) -> str:
        if self.valid:
            return f"<validation: valid, {counted(len(self.costs), 'step')}, expected cost {self.expected_cost:.10g}>"
        more = f" (and {counted(len(self.reasons) - 1, 'more reason')})" if len(self.reasons) > 1 else ""
        return f"<validation: invalid: {brief(self.reasons[0])}{more}>"

    def _repr_html_(self) -> str:
        from statehtn.display.validation import validation_html

        return validation_html(self)

    @property
    def expected_cost(self) -> float:
        """The expected cost of the steps in `costs`: positive, in the domain's unit."""
        return plan_expected_cost(self.costs)

    @property
    def probability(self) -> float:
        """That what came of the steps in `costs` is what the plan counts on: 1 where each has one outcome."""
        return float(math.prod(outcome.probability for outcome in self.outcomes or ()))

    def settled(self, plan: Plan) -> Plan:
        """Return a valid plan with what its steps cost, and the outcomes that it counts on where it has not said so."""
        outcomes = self.outcomes if plan.outcomes is None else plan.outcomes
        return replace(plan.with_costs(self.costs), outcomes=outcomes)

    def risk_cost(self, utility: Utility) -> float:
        """Return the certainty-equivalent cost of the steps in `costs` to an agent: positive, in the domain's unit."""
        expect_utility(utility)
        return plan_risk_cost(self.costs, utility)


def validate(
    problem: Problem,
    plan: Plan,
    limits: Limits = Limits(),
    price: Price = likeliest,
    seen: frozenset[Fact] | None = None,
) -> Validation:
    """Check a plan and its decomposition as `statehtn.validate` does, which says what makes a plan valid.

    Args:
        problem: the problem.
        plan: the plan; where actions have several outcomes and it does not say which it counts on, those of the best
            valid run.
        limits: of the checking.
        price: which run is the best: the one of least price, the likeliest by default.
        seen: facts by which outcomes are told apart, such as those of the ground problem; None for all that are read.

    Raises:
        InputError: the cost of a step is not defined (a value is missing in `:init`, say).
        LimitReached: a limit was reached before the plan was checked.
    """
    if expect_plan(plan).outcomes is not None:
        return _counting_on(plan.outcomes or (), problem, plan, limits)
    if not expect_problem(problem).domain.has_outcomes:
        return _Judge(problem, plan, None, limits).judged()
    judge = _Judge(problem if seen is not None else without_unread(problem), plan, seen, limits)
    return judge.best_run(price)


class _Judge:
    """A plan with its decomposition matched, to be judged in the runs that chance may make of it."""

    def __init__(self, problem: Problem, plan: Plan, seen: frozenset[Fact] | None, limits: Limits) -> None:
        self._world = World(problem, limits)
        self._plan = plan
        self._seen = seen
        self._tree = PlanTree(plan, self._world)
        self._matching: Matching | None = None

    def judged(self, came: Sequence[Changes] | None = None, as_stated: bool = False) -> Validation:
        """Judge the run in which this came of each step; None where each has one outcome."""
        world, tree = self._world, self._tree
        with without_collector():
            execution = execute(self._plan, world, came, self._seen, as_stated)
            matching = self._matching = self._matching or match_networks(tree, world)
            reasons = [*execution.reasons, *matching.reasons]
            if not matching.reasons:
                reasons += check_ordering(tree, matching, world, execution.history)
        outcomes = None
        if came is not None:
            outcomes = tuple(map(PlanOutcome, execution.probabilities, *zip(*came, strict=True))) if came else ()
        return Validation(told_once(reasons), execution.costs, outcomes=outcomes)

    def best_run(self, price: Price) -> Validation:
        """Judge the runs of the plan in the order of their prices, up to the first in which it is valid."""
        self._matching = match_networks(self._tree, self._world)
        networks = [network for network in self._matching.networks if network is not None]
        depends = any(network.lifted.precondition is not None for network in networks)  # on more than the steps
        is_first_alone = bool(self._matching.reasons) or not depends
        runs = Trajectories(self._plan.steps, self._world, self._seen, price, is_first_alone)
        best: Validation | None = None
        for count, outcomes in enumerate(runs, 1):
            judged = self.judged([(outcome.added, outcome.deleted) for outcome in outcomes], as_stated=True)
            if judged.valid:
                return judged
            best = best or judged
            if count == MOST_RUNS:
                reason = f"it is a plan in none of the {MOST_RUNS} runs of it that are looked at, the best ones"
                return replace(best, reasons=(reason, *best.reasons), stopped=Status.GAVE_UP)
        if best is not None:
            return best
        return Validation(told_once((runs.why_not, *self._matching.reasons)), **_known_of(runs.farthest))


def validate_trajectory(
    problem: Problem,
    plan: Plan,
    came: Sequence[Changes],
    seen: frozenset[Fact] | None = None,
    limits: Limits = Limits(),
) -> Validation:
    """Check a run in which chance has chosen: whether its steps, what came of them and its decomposition are right.

    Args:
        problem: the problem, in which actions may have several outcomes.
        plan: the actions of a run that is done, and their decomposition.
        came: for each step the facts that are true after it and those that are false; others are as before.
        seen: facts by which outcomes are told apart, such as those of the ground problem; None for all facts.
        limits: of the checking.

    Raises:
        UsageError: there is not one of `came` for each step.
        InputError: a cost or a probability is not defined.
        LimitReached: a limit was reached before the run was checked.
    """
    return _Judge(expect_problem(problem), plan, seen, limits).judged(_for_each_step(came, plan))


def _counting_on(counted_on: Sequence[PlanOutcome], problem: Problem, plan: Plan, limits: Limits) -> Validation:
    """Check a plan that says which outcomes it counts on, and how likely they are at least."""
    came = [(outcome.added, outcome.deleted) for outcome in counted_on]
    judged = _Judge(problem, plan, plan.seen, limits).judged(_for_each_step(came, plan))
    reasons = [
        f"step {number} {step}: it is said to lead there with probability {float(said.probability):g}, "
        f"and does with {float(one.probability):g}"
        for number, (step, said, one) in enumerate(zip(plan.steps, counted_on, judged.outcomes or (), strict=False), 1)
        if said.probability > one.probability
    ]
    known = counted_on[: len(judged.costs)]
    return replace(judged, reasons=told_once((*judged.reasons, *reasons)), outcomes=tuple(known))


def _for_each_step(came: Sequence[Changes], plan: Plan) -> Sequence[Changes]:
    if len(came) != len(plan.steps):
        raise UsageError(f"a run of {counted(len(plan.steps), 'step')} needs what came of each, found {len(came)}")
    return came


def execute_steps(problem: Problem, steps: Sequence[Step], limits: Limits = Limits()) -> Validation:
    """Check whether steps can be executed one after the other and reach the goal; decompositions are not looked at.

    Where actions have several outcomes, whether they can in some run.

    Raises:
        InputError: the cost of a step is not defined.
        LimitReached: a limit was reached.
    """
    if problem.domain.has_outcomes:
        runs = Trajectories(steps, World(without_unread(problem), limits), None, likeliest, is_first_alone=True)
        for run in runs:
            return Validation((), **_known_of(run))
        return Validation((runs.why_not,), **_known_of(runs.farthest))
    execution = execute(Plan(tuple(steps)), World(problem, limits))
    return Validation(told_once(execution.reasons), execution.costs)


def _known_of(run: Sequence[StepOutcome]) -> dict[str, Any]:
    """Return what a validation says of the steps of a run."""
    outcomes = tuple(PlanOutcome(outcome.probability, outcome.added, outcome.deleted) for outcome in run)
    return {"costs": tuple(outcome.law for outcome in run), "outcomes": outcomes}


def told_once(reasons: Sequence[str]) -> tuple[str, ...]:
    """Return reasons, each once: what is wrong with several steps is told of the first, with the numbers of others."""
    by_cause: dict[str, list[str]] = {}
    for reason in reasons:
        match = _STEP.match(reason)
        by_cause.setdefault(reason[match.end() :] if match else reason, []).append(reason)
    found = []
    for same in by_cause.values():
        others = [match[1] for reason in same[1:] if (match := _STEP.match(reason))]
        steps = f"{'steps' if len(others) > 1 else 'step'} {', '.join(others[:5])}{' ...' if len(others) > 5 else ''}"
        more = f" (likewise {len(others)} more: {steps})"
        found.append(same[0] + (more if others else ""))
    return tuple(found)
