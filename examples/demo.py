"""Compare what three agents with different attitudes to risk do with the same problem.

Usage: python examples/demo.py DOMAIN PROBLEM [ALPHA]
"""

from __future__ import annotations

import math
import sys

import statehtn


def main(domain: str, problem: str, alpha: float = 0.9) -> None:
    """Plan for each agent, and price each plan for all of them."""
    read = statehtn.read_hddl(domain, problem)
    agents = {"averse": alpha, "neutral": None, "seeking": alpha}
    results = {name: statehtn.plan(read, attitude=name, alpha=value) for name, value in agents.items()}

    print("What each plan is worth to each agent: certainty-equivalent cost, in the domain's unit\n")
    print(f"{'':22} {'least':>8} {'expected':>8} {'most':>8}   " + " ".join(f"{f'to {name}':>10}" for name in agents))
    for name, result in results.items():
        laws = [step.law for step in result.steps]
        least = math.fsum(law.outcomes[0][1] for law in laws)
        most = math.fsum(law.outcomes[-1][1] for law in laws)
        worth = []
        for other, value in agents.items():
            utility = statehtn.utility_for(other, value)
            cost = math.fsum(utility.risk_cost(law) for law in laws)
            worth.append(f"{cost:9.4g}{'*' if other == name else ' '}")
        print(f"{f'plan of the {name}':22} {least:8.4g} {result.expected_cost:8.4g} {most:8.4g}   " + " ".join(worth))
    print("\n* the lowest in its column: proven to be the best of all plans for that agent")
    routes = {name: tuple(str(step.step) for step in result.steps) for name, result in results.items()}
    print(f"{len(set(routes.values()))} different plans for {len(routes)} attitudes")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], *(float(argument) for argument in sys.argv[3:]))
