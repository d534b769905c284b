"""The search for policies as a method of a session."""

from __future__ import annotations

from typing import TYPE_CHECKING

from statehtn.expected import function
from statehtn.interrupt import OnInterrupt, check_interrupt, returned
from statehtn.limits import Limits
from statehtn.risk import Attitude, AttitudeName, ObjectiveLike, Success
from statehtn.session import Session

if TYPE_CHECKING:
    from statehtn.policies.result import PolicyResult
    from statehtn.policies.run import PolicyProgress


class PolicyPlanner:
    """A session that finds policies."""

    _session: Session

    def policy(
        self,
        *,
        objective: ObjectiveLike | Success | None = None,
        attitude: Attitude | AttitudeName | None = None,
        alpha: float | None = None,
        failure_cost: float | None = None,
        adaptive: bool = False,
        precision: float | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: PolicyProgress | None = None,
        interrupt: OnInterrupt = "return",
    ) -> PolicyResult:
        """Find the best policy of the problem by an objective, and prove that it is.

        A policy says what to do in every state and with every remaining network that can come up: the agent sees what
        comes of its actions, and what they cost, before it decides further. Problems whose actions have one outcome
        each have policies, too. No policy, a limit that was reached and a Ctrl-C are values of the result's `status`
        and `stopped`, not exceptions.

        Args:
            objective: what policies are compared by, as for `plan`; or `success`, the largest probability of being done
                (of those the least expected cost until done, or until being done has become impossible).
            attitude: neutral, averse or seeking: with alpha a short form of an objective.
            alpha: how much an averse or a seeking agent cares about risk: positive, per unit of cost.
            failure_cost: what a run pays that fails, on top of what it has spent, at least 0, in the domain's unit, and
                at most 10^9 times the largest expected cost of an action: the agent may give up anywhere. `math.inf` is
                allowed for `deadline` and `quantile`: failed is late. None: only policies count that are done with
                probability 1.
            adaptive: find the best plan, too, which does not look at what was spent, and say what looking is worth; for
                problems whose actions have one outcome each.
            precision: a policy counts as optimal where it is within this part of max(1, its value) of the best one.
            time_limit: seconds, for grounding and search together.
            memory_limit: resident memory of the whole process in MB (10^6 bytes).
            progress: is called some twenty times a second during the search.
            interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as
                its argument.

        Raises:
            UsageError: an argument is out of its range.
            InputError: a cost or the probability of an outcome is undefined or out of its range.
            UnsupportedError: there are no policies by this objective, or for this problem.
        """
        from statehtn.policies.run import find_policy  # most sessions do without
        from statehtn.policies.settings import PolicySettings

        settings = PolicySettings.of(objective, attitude, alpha, failure_cost, adaptive, precision)
        function(progress, "progress")
        check_interrupt(interrupt)
        limits = Limits.starting_now(time_limit, memory_limit)
        return returned(find_policy(self._session, settings, limits, progress), interrupt)
