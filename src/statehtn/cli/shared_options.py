"""What several commands of the command line share: their files, agent and limits."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, NoReturn

from statehtn.errors import UsageError
from statehtn.risk import Attitude, Objective, Utility, utility_for
from statehtn.settings import DEFAULT_PRECISION, PRECISION_OF_SUMS, objective_of

if TYPE_CHECKING:
    from statehtn.policies.settings import PolicySettings


def add_inputs(parser: argparse.ArgumentParser) -> None:
    """Add the files of a problem, and how they are read."""
    parser.add_argument("domain", metavar="DOMAIN", help="HDDL file of the domain")
    parser.add_argument("problem", metavar="PROBLEM", help="HDDL file of the problem")
    parser.add_argument("--costs", metavar="FILE", help="TOML or JSON file with other costs of actions (docs/costs.md)")
    parser.add_argument("--strict", action="store_true", help="treat warnings about the input as errors")


def add_agent(parser: argparse.ArgumentParser) -> None:
    """Add who plans; `agent_of` reads it back."""
    agent = parser.add_argument_group("the agent")
    _add_attitude(agent)


def add_objective(
    parser: argparse.ArgumentParser, title: str = "the agent", has_budgets: bool = True
) -> argparse._ActionsContainer:
    """Add what plans are compared by, and what they have to keep; `objective_in` reads the former back.

    Returns the group of these options.
    """
    agent = parser.add_argument_group(title)
    agent.add_argument(
        "--objective",
        metavar="TEXT",
        help="what plans are compared by, such as 'cvar 0.95' or 'deadline 25': see the end of the help of "
        "'statehtn plan'; default: the expected cost",
    )
    _add_attitude(agent)
    if has_budgets:
        add_keep(agent)
    return agent


def _add_attitude(agent: argparse._ActionsContainer) -> None:
    agent.add_argument("--attitude", choices=[str(attitude) for attitude in Attitude], help="default: neutral")
    agent.add_argument("--alpha", type=float, metavar="A", help="how much such an agent cares, per unit of cost")


def add_keep(agent: argparse._ActionsContainer) -> None:
    """Add the budgets that plans have to keep, and how far from the best they may be."""
    agent.add_argument(
        "--keep",
        action="append",
        default=[],
        metavar="'BUDGET PROBABILITY'",
        help="only plans that cost no more than the budget with this probability at least, as in '25 0.95'; repeatable",
    )
    agent.add_argument(
        "--precision",
        type=float,
        metavar="P",
        help=f"how close to the best counts as optimal, where prices do not add up; default: {DEFAULT_PRECISION:g} "
        f"(one-switch, exponentials, mean-deviation without --keep: {PRECISION_OF_SUMS:g})",
    )


class _NoBudgets(argparse.Action):
    """Refuses budgets to keep: plans take them."""

    def __call__(self, *_: object) -> NoReturn:
        """Raise an error that says why."""
        raise UsageError(
            "policies keep no budgets (--keep), since the best one might have to draw lots; 'deadline' and 'quantile' "
            "are objectives of policies, and 'statehtn plan' takes --keep"
        )


def add_policy_agent(parser: argparse.ArgumentParser) -> None:
    """Add what policies are compared by; `policy_settings_in` reads it back."""
    agent = parser.add_argument_group("the agent")
    agent.add_argument(
        "--objective",
        metavar="TEXT",
        help="what policies are compared by, such as 'success' or 'deadline 25': see the end of the help of 'statehtn "
        "policy'; default: the expected cost",
    )
    _add_attitude(agent)
    add_failing(agent)
    agent.add_argument("--keep", action=_NoBudgets, help=argparse.SUPPRESS)
    agent.add_argument(
        "--precision",
        type=float,
        metavar="P",
        help=f"how close to the best counts as optimal; default: {DEFAULT_PRECISION:g}",
    )


def add_failing(agent: argparse._ActionsContainer) -> None:
    """Add what failing costs a policy, and whether it is compared with a plan."""
    add_failure_cost(agent)
    agent.add_argument(
        "--adaptive",
        action="store_true",
        help="find a policy that looks at what was spent, and say what looking is worth, beside the best plan",
    )


def add_failure_cost(agent: argparse._ActionsContainer) -> None:
    """Add what failing costs a policy."""
    agent.add_argument(
        "--failure-cost",
        type=float,
        metavar="F",
        help="what failing costs a policy on top of what was spent; the agent may give up anywhere. 'inf' is allowed "
        "for deadline and quantile. Without it only policies count that are done with probability 1",
    )


def policy_settings_in(options: argparse.Namespace) -> PolicySettings:
    """Return what the options ask of the search for a policy.

    Raises:
        UsageError: a number is out of its range, or the options do not go together.
        UnsupportedError: there are no policies by this objective.
    """
    from statehtn.policies.settings import PolicySettings

    _check_said_once(options)
    how = options.failure_cost, getattr(options, "adaptive", False), getattr(options, "precision", None)
    return PolicySettings.of(options.objective, options.attitude, options.alpha, *how)


def _check_said_once(options: argparse.Namespace) -> None:
    """Raise a `UsageError` where an objective is named in both ways."""
    for option, value in (("--attitude", options.attitude), ("--alpha", options.alpha)):
        if options.objective is not None and value is not None:
            raise UsageError(f"--objective and {option} are two ways to say one thing; leave out {option}")


def agent_of(options: argparse.Namespace) -> Utility:
    """Return the agent that the options name.

    Raises:
        UsageError: there is none like that.
    """
    return utility_for(options.attitude or Attitude.NEUTRAL, options.alpha)


def objective_in(options: argparse.Namespace) -> Objective:
    """Return the objective that the options name, by its text or by an attitude.

    Raises:
        UsageError: there is none like that, or it is named in both ways.
    """
    _check_said_once(options)
    return objective_of(options.objective, options.attitude, options.alpha)


def add_limits(group: argparse._ActionsContainer, time: str = "seconds, reading included") -> None:
    """Add the limits of time and memory; `time` says what the time is for."""
    group.add_argument("--time-limit", type=float, metavar="S", help=time)
    group.add_argument("--memory-limit", type=float, metavar="MB", help="of the whole process, in 10^6 bytes")


def count(text: str) -> int:
    """Read a number of things, at least one."""
    if text.isdecimal() and int(text) > 0:
        return int(text)
    raise argparse.ArgumentTypeError(f"expected a whole number of at least 1, found '{text}'")
