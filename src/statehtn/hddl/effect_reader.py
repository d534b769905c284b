"""Effects of actions: facts that become true or false, and costs; by chance, under conditions and for all objects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import count

from statehtn.hddl.cost_reader import Branches, CostReader, refusal
from statehtn.hddl.diagnostics import Reporter
from statehtn.hddl.expressions import Group, Node, Word, describe
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.typed_lists import read_parameters
from statehtn.hddl.vocabulary import Scope, Vocabulary, scope_of
from statehtn.model import TRUE, And, Atom, CostBlock, Effect, Formula, Number, Outcome, OutcomeBlock, Parameter
from statehtn.model.formula import predicates
from statehtn.model.hidden import ONLY_COSTS


@dataclass(slots=True)
class EffectReader:
    """Collects the effects, cost blocks and outcomes of one action, or of one of its outcomes."""

    vocabulary: Vocabulary
    reporter: Reporter
    effects: list[Effect] = field(default_factory=list)
    costs: list[CostBlock] = field(default_factory=list)
    outcomes: list[OutcomeBlock] = field(default_factory=list)
    is_outcome: bool = False

    def read(self, node: Node, scope: Scope, condition: Formula = TRUE, parameters: tuple[Parameter, ...] = ()) -> None:
        """Add the effects, costs and outcomes of a node.

        Args:
            scope: all variables that are declared here.
            condition: of the `when`s around the node.
            parameters: of the `forall`s around the node.

        Raises:
            InputError: it is malformed, or a name is unknown.
            UnsupportedError: it changes numbers other than the total cost, or has outcomes inside of an outcome.
        """
        if isinstance(node, Word):
            raise self.reporter.error(f"expected an effect in parentheses, found {describe(node)}", node)
        if not node.items:
            return
        match node.head:
            case "and":
                for item in node.items[1:]:
                    self.read(item, scope, condition, parameters)
            case "not":
                if len(node.items) != 2:
                    raise self.reporter.error("expected '(not (<predicate> ...))'", node)
                self._add_effect(Effect(self._atom(node.items[1], scope), False, condition, parameters), node)
            case "forall":
                self._forall(node, scope, condition, parameters)
            case _ if self.vocabulary.predicate(node.name):
                self._add_effect(Effect(self._atom(node, scope), True, condition, parameters), node)
            case "when":
                self._when(node, scope, condition, parameters)
            case "increase":
                cost = self._cost_reader().increase(node, scope)
                self._add_cost(((Number(Fraction(1)), cost),), condition, parameters, node)
            case "probabilistic" if self._changes_facts(node):
                self._outcomes(node, scope, condition, parameters)
            case "probabilistic":
                branches = self._cost_reader().probabilistic(node, scope)
                self._add_cost(branches, condition, parameters, node)
            case _:
                raise refusal(node, self.vocabulary, self.reporter)

    def _add_effect(self, effect: Effect, node: Group) -> None:
        hidden = self.vocabulary.hidden
        if effect.atom.predicate in hidden:
            message = f"this effect changes a fact of '{effect.atom.predicate}'; {ONLY_COSTS}"
            raise self.reporter.unsupported(message, node)
        for predicate in predicates(effect.condition) if hidden else ():
            if predicate in hidden:
                raise self.reporter.unsupported(f"this effect depends on a fact of '{predicate}'; {ONLY_COSTS}", node)
        self.effects.append(effect)

    def _outcomes(self, node: Group, scope: Scope, condition: Formula, parameters: tuple[Parameter, ...]) -> None:
        """Add a block of outcomes that change facts; what costs they have stays with them."""
        if self.is_outcome:
            raise self.reporter.unsupported(
                "outcomes inside of an outcome are not supported; write the products of the probabilities in one block",
                node,
            )
        for predicate in predicates(condition):
            if predicate in self.vocabulary.hidden:
                raise self.reporter.unsupported(f"these outcomes depend on a fact of '{predicate}'; {ONLY_COSTS}", node)
        found = []
        pairs = self._cost_reader().chances(node, scope)
        for probability, effect in pairs:
            reader = EffectReader(self.vocabulary, self.reporter, is_outcome=True)
            reader.read(effect, scope)
            found.append(Outcome(probability, tuple(reader.effects), tuple(reader.costs)))
        self._cost_reader().check_sum(pairs, node, "nothing happens")
        place = self.reporter.source.place(node.index)
        self.outcomes.append(OutcomeBlock(tuple(found), condition, parameters, place))

    def _changes_facts(self, node: Node) -> bool:
        """Tell whether there is a literal in an effect."""
        if isinstance(node, Word) or not node.items:
            return False
        match node.head:
            case "and":
                return any(map(self._changes_facts, node.items[1:]))
            case "not":
                return True
            case _ if node.head != "forall" and self.vocabulary.predicate(node.name):
                return True
            case "when" | "forall":
                return any(map(self._changes_facts, node.items[2:]))
            case "probabilistic":
                return any(map(self._changes_facts, node.items[2::2]))
        return False

    def _add_cost(self, branches: Branches, condition: Formula, parameters: tuple[Parameter, ...], node: Group) -> None:
        place = self.reporter.source.place(node.index)
        self.costs.append(CostBlock(branches, condition, parameters, place=place))

    def _when(self, node: Group, scope: Scope, condition: Formula, parameters: tuple[Parameter, ...]) -> None:
        if len(node.items) != 3:
            raise self.reporter.error("expected '(when <condition> <effect>)'", node)
        inner = FormulaReader(self.vocabulary, self.reporter, may_read_hidden=True).read(node.items[1], scope)
        both = inner if condition == TRUE else And((condition, inner))
        self.read(node.items[2], scope, both, parameters)

    def _forall(self, node: Group, scope: Scope, condition: Formula, parameters: tuple[Parameter, ...]) -> None:
        declared = node.items[1] if len(node.items) == 3 else None
        if not isinstance(declared, Group):
            raise self.reporter.error("expected '(forall (<variables>) <effect>)'", node)
        names = _fresh_names(declared, node, scope)
        added = read_parameters(_renamed(declared.items, names), self.vocabulary, self.reporter)
        (body,) = _renamed(node.items[2:], names)
        self.read(body, {**scope, **scope_of(added)}, condition, (*parameters, *added))

    def _atom(self, node: Node, scope: Scope) -> Atom:
        if isinstance(node, Word) or not node.head:
            raise self.reporter.error(f"expected '(<predicate> ...)', found {describe(node)}", node)
        signature = self.vocabulary.predicate(node.name)
        if signature is None:
            raise refusal(node, self.vocabulary, self.reporter)
        terms = self.vocabulary.terms("predicate", signature, node, node.items[1:], scope, self.reporter)
        return Atom(signature.name, terms)

    def _cost_reader(self) -> CostReader:
        return CostReader(self.vocabulary, self.reporter)


def _fresh_names(declared: Group, node: Group, scope: Scope) -> dict[str, str]:
    """Return other names for the variables of a quantifier, in lower case, that are variables outside of it, too.

    Both may end up in one condition: that of a `when` around the quantifier and that of one inside it.
    """
    clashes = [word for word in _words(declared) if word.lower in scope]
    used = {*scope, *(word.lower for word in _words(node))} if clashes else set()
    return {
        word.lower: next(new for number in count(1) if (new := f"{word.text}_{number}").lower() not in used)
        for word in clashes
    }


def _words(group: Group) -> Iterator[Word]:
    """Yield the words in a group, also those inside other groups in it."""
    for item in group.items:
        if isinstance(item, Word):
            yield item
        else:
            yield from _words(item)


def _renamed(nodes: list[Node], names: dict[str, str]) -> list[Node]:
    """Return nodes with other names for some words; themselves where there are none to change."""
    if not names:
        return nodes
    found: list[Node] = []
    for node in nodes:
        if isinstance(node, Word):
            found.append(Word(names.get(node.lower, node.text), node.index))
        else:
            group = Group(node.index)
            group.items = _renamed(node.items, names)
            found.append(group)
    return found
