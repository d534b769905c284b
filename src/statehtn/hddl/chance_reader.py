"""Hidden facts in `:init`: `(probabilistic 0.3 (snow) 0.7 ())`, decided once and never seen."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

from statehtn.expected import shown_number
from statehtn.hddl.cost_reader import not_read, read_number
from statehtn.hddl.diagnostics import Reporter
from statehtn.hddl.expressions import Group, Node, Word, describe, parse_group
from statehtn.hddl.vocabulary import Vocabulary
from statehtn.model import Fact
from statehtn.model.chance import MOST_SCENARIOS, Chance, Outcome, scenario_count, too_many
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE

PROBABILISTIC = "probabilistic"


def hidden_predicates_in(start: int, end: int, vocabulary: Vocabulary, reporter: Reporter) -> Iterator[str]:
    """Yield the predicates that stand in probabilistic blocks of a section, before all of it is read.

    Args:
        start: the token of the `(` of `(:init ...)`.
        end: the token after its `)`.
        vocabulary: has the predicates.
        reporter: of the file.
    """
    source = reporter.source
    if PROBABILISTIC not in source.text.lower() or vocabulary.predicate(PROBABILISTIC):
        return
    for index in range(start + 1, end):
        if source.tokens[index].lower() == PROBABILISTIC and source.tokens[index - 1] == "(":
            pending: list[Node] = [parse_group(source, index - 1)]
            while pending:
                node = pending.pop()
                if isinstance(node, Group):
                    pending += node.items
                    if signature := vocabulary.predicate(node.name):
                        yield signature.name


class ChanceReader:
    """Collects what is decided by chance.

    Args:
        reporter: of the file.
        fact: reads a fact.
    """

    def __init__(self, reporter: Reporter, fact: Callable[[Group], Fact]) -> None:
        self.chances: list[Chance] = []
        self.facts: dict[Fact, Node] = {}
        """The facts that are hidden, and where they stand."""
        self._reporter = reporter
        self._fact = fact

    def read(self, node: Group) -> None:
        """Add what `(probabilistic p1 facts1 p2 facts2 ...)` states; with the rest of probability 1 no fact holds.

        Raises:
            InputError: a probability is no number, or is negative, or they sum to more than 1.
            UnsupportedError: an outcome is more than facts, or there are too many scenarios.
        """
        nodes = node.items[1:]
        if not nodes or len(nodes) % 2:
            raise self._reporter.error(
                f"expected pairs of a probability and facts after 'probabilistic', found {len(nodes)} items", node
            )
        outcomes: dict[frozenset[Fact], Fraction] = {}
        for probability, effect in zip(nodes[::2], nodes[1::2], strict=True):
            facts = frozenset(self._facts(effect))
            outcomes[facts] = outcomes.get(facts, Fraction(0)) + self._probability(probability)
        total = sum(outcomes.values(), Fraction(0))
        if total > 1 + PROBABILITY_TOLERANCE:
            raise self._reporter.error(
                f"the probabilities of this block sum to {shown_number(total)}, more than 1", node
            )
        if total < 1 - PROBABILITY_TOLERANCE:
            self._reporter.warn(
                f"the probabilities of this block sum to {shown_number(total)}; with the rest none of its facts holds",
                node,
            )
            outcomes[frozenset()] = outcomes.get(frozenset(), Fraction(0)) + 1 - total
            total = Fraction(1)
        found = (Outcome(weight / total, facts) for facts, weight in outcomes.items() if weight)
        self.chances.append(Chance(tuple(found)))
        if (count := scenario_count(self.chances)) > MOST_SCENARIOS:
            raise self._reporter.unsupported(too_many(count), node)

    def _probability(self, node: Node) -> Fraction:
        value = read_number(node.text) if isinstance(node, Word) else None
        if value is None:
            if isinstance(node, Word):
                raise self._reporter.error(not_read("a probability", node), node)
            raise self._reporter.error(f"expected a probability, found {describe(node)}", node)
        if value < 0:
            raise self._reporter.error(f"a probability must not be negative, found {shown_number(value)}", node)
        return value

    def _facts(self, node: Node) -> Iterator[Fact]:
        """Yield the facts of one outcome."""
        if isinstance(node, Word):
            raise self._reporter.error(f"expected a fact in parentheses, found {describe(node)}", node)
        if not node.items:
            return
        if node.head == "and":
            for item in node.items[1:]:
                yield from self._facts(item)
        elif node.head in ("not", "=", "or", PROBABILISTIC):
            raise self._reporter.unsupported(
                f"an outcome of 'probabilistic' in ':init' is a fact, '(and ...)' of facts or '()', found "
                f"{describe(node)}; facts that are not in it are false",
                node,
            )
        else:
            fact = self._fact(node)
            self.facts.setdefault(fact, node)
            yield fact
