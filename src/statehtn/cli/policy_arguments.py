"""The options of the commands about policies."""

from __future__ import annotations

import argparse

from statehtn.cli.epilogs import WRITING, policy_epilog
from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import add_inputs, add_limits, add_policy_agent


def add_policy(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add `statehtn policy`."""
    parser = commands.add_parser(
        "policy",
        help="find the best policy: what to do in every state that may come up",
        description="Find the best policy by an objective, and prove it: actions may have several outcomes, and the "
        "agent sees what came of them, and what they cost, before it decides further.",
        epilog=policy_epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add_inputs(parser)
    add_policy_agent(parser)
    add_limits(parser.add_argument_group("the search"))
    output = parser.add_argument_group("output")
    output.add_argument("--dot", metavar="FILE", help="write the policy as a graph for Graphviz; - for stdout")
    output.add_argument("--svg", metavar="FILE", help="write a picture of the policy; - for stdout")
    form = output.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print the result as one JSON object")
    form.add_argument("--quiet", action="store_true", help="print the tree of decisions only")


def add_export(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add `statehtn export`."""
    parser = commands.add_parser(
        "export",
        help="write the problem, or its best policy, for a model checker",
        description="Write the Markov decision process of all states and networks that can be reached, or with "
        "--policy the Markov chain of the best policy by an objective, in the language of PRISM and Storm.",
        epilog="Exit codes: 0 written, 2 usage, 10 proven that there is no policy, 12 none found, 20 time limit, "
        f"21 memory limit, 30 input error, 31 unsupported feature, 74 cannot write, 130 interrupted. {WRITING}",
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument("--prism", metavar="FILE", required=True, help="the file to write; - for stdout")
    parser.add_argument("--policy", action="store_true", help="the Markov chain of the best policy")
    add_policy_agent(parser)
    add_limits(parser)
