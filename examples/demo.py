"""Compare what three agents with different attitudes to risk do with the same problem.

Usage: python examples/demo.py DOMAIN PROBLEM [ALPHA]
"""

from __future__ import annotations

import math
import sys
from itertools import zip_longest

import statehtn


def compare(domain: str, problem: str, alpha: float = 0.9) -> None:
    """Plan for each agent, print the plans side by side, and price each plan for every agent."""
    read = statehtn.read_hddl(domain, problem)
    agents = {"averse": alpha, "neutral": None, "seeking": alpha}
    results = {name: statehtn.plan(read, attitude=name, alpha=value) for name, value in agents.items()}

    columns = [[f"risk-{name}", *(str(step.step) for step in result.steps)] for name, result in results.items()]
    width = 3 + max(len(cell) for column in columns for cell in column)
    for row in zip_longest(*columns, fillvalue=""):
        print("".join(cell.ljust(width) for cell in row).rstrip())

    heads = [f"for {name}" for name in agents]
    print(
        f"\n{'cost of the plan':20} {'least':>8} {'expected':>9} {'most':>8}   " + " ".join(f"{h:>12}" for h in heads)
    )
    for name, result in results.items():
        laws = [step.law for step in result.steps]
        least = math.fsum(law.outcomes[0][1] for law in laws)
        most = math.fsum(law.outcomes[-1][1] for law in laws)
        cells = []
        for other, value in agents.items():
            utility = statehtn.utility_for(other, value)
            cost = math.fsum(utility.risk_cost(law) for law in laws)
            cells.append(f"{cost:11.4g}{'*' if other == name else ' '}")
        line = f"{'of the ' + name:20} {least:8.4g} {result.expected_cost:9.4g} {most:8.4g}   {' '.join(cells)}"
        print(line.rstrip())
    print("\n'for averse' and so on: the certainty equivalent, a certain cost that such an agent finds exactly as bad")
    print("* proven: no plan has a lower one for this agent")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    compare(sys.argv[1], sys.argv[2], *(float(argument) for argument in sys.argv[3:]))
