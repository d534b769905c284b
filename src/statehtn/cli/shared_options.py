"""What several commands of the command line share: their files, agent and limits."""

from __future__ import annotations

import argparse

from statehtn.risk import Attitude, Utility, utility_for


def add_inputs(parser: argparse.ArgumentParser) -> None:
    """Add the files of a problem, and how they are read."""
    parser.add_argument("domain", metavar="DOMAIN", help="HDDL file of the domain")
    parser.add_argument("problem", metavar="PROBLEM", help="HDDL file of the problem")
    parser.add_argument("--costs", metavar="FILE", help="TOML or JSON file with other costs of actions (docs/costs.md)")
    parser.add_argument("--strict", action="store_true", help="treat warnings about the input as errors")


def add_agent(parser: argparse.ArgumentParser) -> None:
    """Add who plans; `agent_of` reads it back."""
    agent = parser.add_argument_group("the agent")
    agent.add_argument(
        "--attitude", choices=[str(attitude) for attitude in Attitude], default="neutral", help="default: neutral"
    )
    agent.add_argument("--alpha", type=float, metavar="A", help="how much such an agent cares, per unit of cost")


def agent_of(options: argparse.Namespace) -> Utility:
    """Return the agent that the options name.

    Raises:
        UsageError: there is none like that.
    """
    return utility_for(options.attitude, options.alpha)


def add_limits(group: argparse._ActionsContainer, time: str = "seconds, reading included") -> None:
    """Add the limits of time and memory; `time` says what the time is for."""
    group.add_argument("--time-limit", type=float, metavar="S", help=time)
    group.add_argument("--memory-limit", type=float, metavar="MB", help="of the whole process, in 10^6 bytes")


def count(text: str) -> int:
    """Read a number of things, at least one."""
    if text.isdecimal() and int(text) > 0:
        return int(text)
    raise argparse.ArgumentTypeError(f"expected a whole number of at least 1, found '{text}'")
