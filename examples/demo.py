"""Compare what three agents with different attitudes to risk do with the same problem.

Usage: python examples/demo.py DOMAIN PROBLEM [ALPHA]
"""

from __future__ import annotations

import sys

import statehtn


def compare(domain: str, problem: str, alpha: float = 0.9) -> None:
    """Plan for each agent, print the plans side by side, and how their costs are distributed."""
    comparison = statehtn.compare_attitudes(statehtn.read_hddl(domain, problem), alpha)
    print(comparison)
    print("\nHow the total cost of each plan is distributed:")
    for agent, result in zip(comparison.agents, comparison.results, strict=True):
        if result.plan is not None:
            law = result.plan.cost_distribution()
            print(
                f"  {agent:12} mean {law.mean:6.4g}, standard deviation {law.standard_deviation:5.3g}, "
                f"95% quantile {law.quantile(0.95):5.4g}, mean of the worst 5% {law.cvar(0.95):5.4g}"
            )


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    compare(sys.argv[1], sys.argv[2], *(float(argument) for argument in sys.argv[3:]))
