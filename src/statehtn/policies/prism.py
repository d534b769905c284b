"""Markov decision processes and Markov chains in the PRISM language, which PRISM, Storm and others read.

The module has one variable, the number of a state. PRISM has no reward on a branch: what a branch costs is paid in a
state of its own, one for each outcome and cost. Costs are whole numbers of units, so that properties may bound them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from statehtn.counted import finite
from statehtn.errors import UnsupportedError
from statehtn.model.cost.law import CostLaw
from statehtn.model.fraction import fraction_of
from statehtn.model.policy_graph import End, FlatPolicy
from statehtn.policies.totals import outcomes_of

MOST_UNITS = 2**31 - 1
"""In the cost of an action: PRISM's whole numbers have 32 bits."""


@dataclass(frozen=True, slots=True)
class Edge:
    """What may come of a choice: a probability, the law of its cost, and the state that it leads to."""

    probability: float | Fraction
    law: CostLaw
    successor: int


@dataclass(frozen=True, slots=True)
class MarkovModel:
    """States with choices among which an agent decides, and chance among the edges of each.

    Args:
        choices: for each state; none at an end.
        done: for each state whether the agent is done there.
        failure: what giving up costs, in the domain's unit; None where the agent cannot. It can in every state that is
            not done, and has to where there is no choice.
        is_chain: nothing is left to decide.
    """

    choices: Sequence[Sequence[Sequence[Edge]]]
    done: Sequence[bool]
    failure: float | None = None
    is_chain: bool = False


def chain_of(flat: FlatPolicy, failure: float | None) -> MarkovModel:
    """Return the Markov chain of a policy's runs."""
    choices: list[list[list[Edge]]] = []
    for node in range(len(flat)):
        edges = [Edge(flat.probabilities[b], flat.laws[b], flat.successors[b]) for b in flat.branches(node)]
        choices.append([edges] if edges else [])
    return MarkovModel(choices, [end is End.DONE for end in flat.ends], finite(failure), is_chain=True)


def prism_text(model: MarkovModel, title: str) -> Iterator[str]:
    """Yield the lines of a model in the PRISM language.

    Args:
        model: state 0 is where it begins.
        title: what it is, for a comment.

    Raises:
        UnsupportedError: a cost is no list of outcomes, or has no unit in whole numbers.
    """
    return _Writer(model).lines(title)


class _Writer:
    def __init__(self, model: MarkovModel) -> None:
        self.model = model
        laws = {id(edge.law): edge.law for choices in model.choices for edges in choices for edge in edges}
        self.outcomes = {key: outcomes_of(law) for key, law in laws.items()}
        costs = [cost for outcomes in self.outcomes.values() for _, cost in outcomes]
        if model.failure is not None:
            costs.append(fraction_of(model.failure))
        self.per_unit = math.lcm(*(cost.denominator for cost in costs), 1)
        if max(costs, default=Fraction(0)) * self.per_unit > MOST_UNITS:
            which = "the costs of this problem"
            if model.failure is not None and costs[-1] == max(costs):
                which += f" and the failure cost of {model.failure:g}"
            raise UnsupportedError(
                f"{which} have no unit in which all of them are whole numbers below {MOST_UNITS}, which the PRISM "
                "language needs; round them, or take a smaller one"
            )
        self.paying: dict[tuple[int, int], int] = {}
        """The states in which a cost is paid, by where they lead to and the cost."""
        self.failed = len(model.choices)
        self.count = self.failed + 1

    def lines(self, title: str) -> Iterator[str]:
        """Yield the lines; states in which costs are paid come after those that lead to them."""
        model = self.model
        commands = [line for node in range(len(model.choices)) for line in self._commands(node)]
        commands += [f"  [pay] s={state} -> (s'={target});" for (target, _), state in self.paying.items()]
        ends = [self.failed, *(node for node, is_done in enumerate(model.done) if is_done)]
        commands += [f"  [end] s={state} -> true;" for state in ends]
        yield f"// {title}"
        yield f"// costs are in units of {Fraction(1, self.per_unit)} of the domain's unit"
        yield "dtmc" if model.is_chain else "mdp"
        yield ""
        yield "module run"
        yield f"  s : [0..{self.count - 1}] init 0;"
        yield from commands
        yield "endmodule"
        yield ""
        yield 'rewards "cost"'
        yield "  true : 0;"  # Storm takes no empty list
        yield from (f"  s={state} : {amount};" for (_, amount), state in self.paying.items())
        yield "endrewards"
        yield ""
        yield f'label "done" = {_one_of(node for node, is_done in enumerate(model.done) if is_done)};'
        yield f'label "failed" = s={self.failed};'

    def _commands(self, node: int) -> Iterator[str]:
        """Yield a command for each choice in a state."""
        if self.model.done[node]:
            return
        choices = self.model.choices[node]
        for number, edges in enumerate(choices):
            yield f"  [c{number}] s={node} -> {self._updates(edges)};"
        if not choices or (self.model.failure is not None and not self.model.is_chain):
            amount = 0 if self.model.failure is None else int(fraction_of(self.model.failure) * self.per_unit)
            yield f"  [give_up] s={node} -> (s'={self._after(self.failed, amount)});"

    def _updates(self, edges: Sequence[Edge]) -> str:
        parts: dict[int, Fraction] = {}
        for edge in edges:
            given = edge.probability
            share = given if isinstance(given, Fraction) else fraction_of(float(given))
            for probability, cost in self.outcomes[id(edge.law)]:
                target = self._after(edge.successor, int(cost * self.per_unit))
                parts[target] = parts.get(target, Fraction(0)) + share * fraction_of(probability)
        whole = sum(parts.values())
        if len(parts) == 1:
            return f"(s'={next(iter(parts))})"
        return " + ".join(f"{_shown(part / whole)}:(s'={target})" for target, part in parts.items())

    def _after(self, target: int, amount: int) -> int:
        """Return the state in which an amount is paid on the way to another; the other where it is nothing."""
        if not amount:
            return target
        key = target, amount
        if key not in self.paying:
            self.paying[key] = self.count
            self.count += 1
        return self.paying[key]


def _shown(probability: Fraction) -> str:
    """Return a probability as PRISM reads it: exactly, as a decimal where that is short, else as a quotient."""
    decimal = repr(float(probability))
    if "e" not in decimal and Fraction(decimal) == probability:
        return decimal
    # Whole numbers have 64 bits there, others as many digits as are written.
    end = "" if probability.denominator < 2**63 else ".0"
    return f"{probability.numerator}{end}/{probability.denominator}{end}"


def _one_of(states: Iterable[int]) -> str:
    """Return the formula that is true in some states; ranges are short where states follow each other."""
    ranges: list[list[int]] = []
    for state in states:
        if ranges and state == ranges[-1][1] + 1:
            ranges[-1][1] = state
        else:
            ranges.append([state, state])
    parts = [f"s={low}" if low == high else f"(s>={low} & s<={high})" for low, high in ranges]
    return " | ".join(parts) or "false"
