"""The way of a run for a policy: read, ground, search, value, check. Whatever ends it, it ends in a result."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from statehtn.core.grounding import Grounding
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_search import search_policy
from statehtn.core.progress import SearchProgress
from statehtn.effort import Meter
from statehtn.errors import InputError, UnsupportedError, UsageError
from statehtn.found_plan import SECONDS_TO_VALIDATE
from statehtn.limits import ENDINGS, Limits, status_of, watched
from statehtn.log import log
from statehtn.model.policy_graph import FlatPolicy
from statehtn.model.status import Status
from statehtn.policies.chain import Chain
from statehtn.policies.checking import check_policy
from statehtn.policies.policy import Policy
from statehtn.policies.result import Looking, PolicyResult
from statehtn.policies.settings import PolicySettings
from statehtn.policies.total_cost import PolicyCost
from statehtn.risk import EntropicValueAtRisk, Success
from statehtn.session import Session
from statehtn.settings import Settings
from statehtn.sweeps import solve

PolicyProgress = Callable[[SearchProgress], None]


def find_policy(
    session: Session, settings: PolicySettings, limits: Limits, progress: PolicyProgress | None = None
) -> PolicyResult:
    """Search for a policy; return how the run ended.

    Raises:
        UsageError: what looking is worth is asked for, and actions have several outcomes.
        UnsupportedError: costs hang together by hidden facts.
        InputError: a probability of an outcome is none.
    """
    run = PolicyPipeline(session, settings, limits, progress)
    try:
        run.search()
        run.check()
        run.evaluate()
        run.look()
    except ENDINGS as ending:
        run.stopped = status_of(ending)
        log.info("the run ended: %s", run.stopped)
    return run.result()


class PolicyPipeline:
    """A run for a policy, and how far it has come.

    Args:
        session: the problem.
        settings: what is asked for.
        limits: they hold for all of it.
        progress: is called while the search goes on.
    """

    def __init__(
        self, session: Session, settings: PolicySettings, limits: Limits, progress: PolicyProgress | None
    ) -> None:
        self.session = session
        self.settings = settings
        self.limits = limits
        self.progress = progress
        self.meter = Meter()
        self.outcome: PolicyOutcome | None = None
        self.policy: Policy | None = None
        self.value: float | None = None
        self.looking: Looking | None = None
        self.stopped: Status | None = None
        self.validated: str | None = None
        self.has_outcomes = False

    def search(self) -> None:
        """Read and ground the problem, and search for a policy.

        Raises:
            UsageError, UnsupportedError: as `find_policy`.
        """
        problem = self.session.read(self.limits, self.meter)
        self.has_outcomes = problem.domain.has_outcomes
        if self.has_outcomes and self.settings.adaptive:
            raise UsageError(
                "what looking at costs is worth (--adaptive) compares a policy with a plan, and where actions have "
                "several outcomes there is no plan that is certain to be done; leave it out: policies look at what was "
                "spent wherever the objective asks for it"
            )
        grounding = self.session.ground_for_policies(self.limits, self.meter)
        with self.meter.timed("search"):
            self.outcome = self._searched(grounding)
        self.stopped = self.outcome.stopped
        self.meter.note(search=self.outcome.effort)
        if self.outcome.graph is not None:
            how = self.settings.objective, self.settings.failure_cost, self.outcome.plan_of
            self.policy = Policy(problem, self.outcome.graph, *how)
            is_success = isinstance(self.settings.objective, Success)
            self.value = self.outcome.lower if is_success else self.outcome.upper

    def _searched(self, grounding: Grounding) -> PolicyOutcome:
        settings = self.settings
        search = partial(
            search_policy,
            grounding,
            failure_cost=settings.failure_cost,
            adaptive=True,
            precision=settings.precision,
            limits=self.limits,
            value_of=self._value_of,
            switches=settings.switches,
        )
        if isinstance(settings.objective, EntropicValueAtRisk):
            from statehtn.policies.evar import EvarSearch  # few runs need it

            how = settings.failure_cost or 0.0, settings.precision, search, self.limits, self.progress
            return EvarSearch(settings.objective, *how).outcome()
        return search(settings.objective, progress=self.progress)

    def _value_of(self, flat: FlatPolicy) -> float:
        """Return what a policy is worth by the objective, from its runs alone; infinite where that is not finite."""
        assert not isinstance(self.settings.objective, Success)
        try:
            return self.settings.objective.value(PolicyCost(Chain(flat), self.settings.failure_cost or 0.0))
        except InputError:
            return math.inf

    def check(self) -> None:
        """Check the policy against the lifted problem, as far as limits and Ctrl-C let it.

        Raises:
            InternalError: the policy is wrong.
        """
        if self.policy is None:
            return
        grounding = self.session.ground_for_policies(self.limits, self.meter)
        with self._in_time() as left:
            self.validated = str(check_policy(self.policy, grounding.seen_facts(), left))

    def evaluate(self) -> None:
        """Work out what the policy is worth from the policy alone, as far as limits and Ctrl-C let it."""
        if self.policy is None:
            return
        with self._in_time() as left, watched(left):
            try:
                self.value = self.policy.value
            except UnsupportedError:
                log.info("the law of the total cost has too many values: the value is that of the search")
            except InputError:
                self.value = math.inf

    @contextmanager
    def _in_time(self) -> Iterator[Limits]:
        """Yield limits for what is done with the policy in hand; note what ends it, and keep what there is."""
        left = self.limits.with_grace(SECONDS_TO_VALIDATE, is_over=self.stopped is not None)
        try:
            with self.meter.timed("validate"):
                yield left
        except ENDINGS as ending:
            self.stopped = self.stopped or status_of(ending)

    def look(self) -> None:
        """Find the best plan, which looks at no costs, where that is asked for."""
        objective = self.settings.objective
        if not self.settings.adaptive or self.value is None or isinstance(objective, Success):
            return
        settings = Settings.of(objective, precision=self.settings.precision)
        found = solve(self.session, settings, self.limits)
        self.meter.note(search=self.meter.read().and_search(found.statistics).search)
        if found.found is not None:
            worth = found.found.value - self.value
            self.looking = Looking(found.found, found.status is Status.OPTIMAL, worth)

    def result(self) -> PolicyResult:
        """Return how the run ended."""
        found = self.outcome
        if found is None:
            assert self.stopped is not None
            return PolicyResult(self.stopped, self.settings, self.meter.read(), self.stopped)
        is_success = isinstance(self.settings.objective, Success)
        return PolicyResult(
            found.status,
            self.settings,
            self.meter.read(),
            self.stopped,
            self.policy,
            found.upper if is_success else found.lower,
            found.reason,
            found.most_success,
            self.looking,
            self.has_outcomes,
            self.validated,
            self.value,
        )
