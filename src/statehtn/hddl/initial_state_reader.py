"""The initial state: many facts and function values, read without an object for each token."""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

from statehtn.hddl.chance_reader import ChanceReader
from statehtn.hddl.cost_reader import TOTAL_COST, not_read, read_number
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe, parse_group
from statehtn.hddl.vocabulary import Vocabulary
from statehtn.model import Fact, Signature
from statehtn.model.chance import Chance

CHECK_EVERY = 4096


class InitialStateReader:
    """Collects facts, function values and what is decided by chance.

    Plain facts and values take a fast path that looks at tokens only; whatever it does not take is read as a nested
    list, which then explains what is wrong with it.
    """

    def __init__(self, vocabulary: Vocabulary, reporter: Reporter) -> None:
        self.facts: set[Fact] = set()
        self.values: dict[tuple[str, ...], Fraction] = {}
        self._chance_reader = ChanceReader(reporter, self._fact)
        self._false: list[tuple[Fact, Node]] = []
        self._vocabulary = vocabulary
        self._reporter = reporter
        self._objects_of: dict[tuple[str, ...], frozenset[str]] = {}
        self._predicates = self._allowed(vocabulary.predicates)
        self._functions = self._allowed(vocabulary.functions)
        self._numbers: dict[str, Fraction | None] = {}

    @property
    def chances(self) -> tuple[Chance, ...]:
        """What is decided by chance."""
        return tuple(self._chance_reader.chances)

    def read(self, start: int, end: int) -> None:
        """Add what a section states.

        Args:
            start: the token of the `(` of `(:init ...)`.
            end: the token after its `)`.

        Raises:
            InputError: a name is unknown, an argument wrong, or a statement contradicts another one.
        """
        tokens, facts, predicates = self._reporter.source.tokens, self.facts, self._predicates
        index = start + 2
        countdown = CHECK_EVERY
        while index < end - 1:
            countdown -= 1
            if not countdown:
                self._reporter.source.limits.check()
                countdown = CHECK_EVERY
            close = tokens.index(")", index)
            fact = tuple(tokens[index + 1 : close])
            allowed = predicates.get(fact[0]) if fact else None
            if allowed is None or tokens[index] != "(" or len(fact) != len(allowed) + 1:
                index = self._respelt(fact, index, close) or self._value(index) or self._other(index)
                continue
            for position, names in enumerate(allowed, 1):
                if fact[position] not in names:
                    index = self._respelt(fact, index, close) or self._other(index)
                    break
            else:
                facts.add(fact)
                index = close + 1
        for fact, node in self._false:
            if fact in facts:
                raise self._reporter.error(f"the fact ({' '.join(fact)}) is stated as true and as false", node)
        for fact, hidden in self._chance_reader.facts.items():
            if fact in facts:
                raise self._reporter.error(f"the fact ({' '.join(fact)}) is stated as true and as a chance", hidden)

    def _allowed(self, signatures: dict[str, Signature]) -> dict[str, tuple[frozenset[str], ...]]:
        """For every name the objects that each parameter allows."""
        return {
            name: tuple(self._objects(parameter.types) for parameter in signature.parameters)
            for name, signature in signatures.items()
        }

    def _objects(self, types: tuple[str, ...]) -> frozenset[str]:
        if types not in self._objects_of:
            self._objects_of[types] = self._vocabulary.objects_of(types)
        return self._objects_of[types]

    def _respelt(self, words: tuple[str, ...], index: int, close: int) -> int | None:
        """Take a fact whose names are spelt otherwise than in their declarations; return the token after it."""
        if not words or self._reporter.source.tokens[index] != "(":
            return None
        fact = self._as_declared("predicate", words, self._predicates)
        if fact is None:
            return None
        self.facts.add(fact)
        return close + 1

    def _as_declared(
        self,
        kind: Literal["predicate", "function"],
        words: tuple[str, ...],
        allowed: dict[str, tuple[frozenset[str], ...]],
    ) -> tuple[str, ...] | None:
        """Return a predicate or function and its objects as they are declared; None where something is wrong."""
        name = self._vocabulary.spelling(kind, words[0])
        if name is None or len(words) != len(allowed[name]) + 1:
            return None
        found = [name]
        for word, names in zip(words[1:], allowed[name], strict=True):
            argument = word if word in names else self._vocabulary.spelling("object", word)
            if argument not in names:
                return None
            found.append(argument)
        return tuple(found)

    def _value(self, index: int) -> int | None:
        """Take `(= (function objects) number)` and return the token after it; None if it is anything else."""
        tokens = self._reporter.source.tokens
        if tokens[index : index + 3] != ["(", "=", "("]:
            return None
        close = tokens.index(")", index)
        words = tuple(tokens[index + 3 : close])
        key = self._as_declared("function", words, self._functions) if words else None
        if key is None or tokens[close + 2] != ")" or key in self.values:
            return None
        text = tokens[close + 1]
        if text not in self._numbers:
            self._numbers[text] = read_number(text)
        value = self._numbers[text]
        if value is None:
            return None
        self.values[key] = value
        return close + 3

    def _other(self, index: int) -> int:
        """Read one statement of the less usual kinds, or say what is wrong; return the token after it."""
        source = self._reporter.source
        if source.tokens[index] != "(":
            raise source.error(f"expected a fact in parentheses, found '{source.tokens[index]}'", index)
        node = parse_group(source, index)
        end, depth = index, 0
        while depth or end == index:
            depth += {"(": 1, ")": -1}.get(source.tokens[end], 0)
            end += 1
        self._statement(node)
        return end

    def _statement(self, node: Group) -> None:
        match node.head:
            case "and":  # cannot name a predicate
                self._reporter.warn("the facts of ':init' need no 'and' around them", node)
                for item in node.items[1:]:
                    if isinstance(item, Word):
                        raise self._reporter.error(f"expected a fact in parentheses, found {describe(item)}", item)
                    self._statement(item)
            case "=":
                self._assignment(node)
            case "not":
                operand = node.items[1] if len(node.items) == 2 else node
                if not isinstance(operand, Group) or operand is node:
                    raise self._reporter.error("expected '(not (<predicate> ...))'", node)
                self._false.append((self._fact(operand), node))
            case "probabilistic" if not self._vocabulary.predicate(node.name):
                self._chance_reader.read(node)
            case "oneof" | "or" | "unknown" if not self._vocabulary.predicate(node.name):
                raise self._reporter.unsupported(
                    f"'{node.head}' is not supported in ':init'; what is uncertain has a probability: "
                    f"'(probabilistic 0.5 ...)'",
                    node,
                )
            case _:
                self.facts.add(self._fact(node))

    def _fact(self, node: Group) -> Fact:
        if not node.name:
            raise self._reporter.error(f"expected '(<predicate> <objects>)', found {describe(node)}", node)
        signature = self._vocabulary.predicate(node.name)
        if signature is None:
            raise self._reporter.error(unknown("predicate", node.name, self._predicates), node.items[0])
        return (
            signature.name,
            *self._vocabulary.terms("predicate", signature, node, node.items[1:], {}, self._reporter),
        )

    def _assignment(self, node: Group) -> None:
        _, term, number = node.items if len(node.items) == 3 else (node, node, node)
        if not isinstance(term, Group) or not isinstance(number, Word):
            raise self._reporter.error("expected '(= (<function> <objects>) <number>)'", node)
        value = read_number(number.text)
        if value is None:
            raise self._reporter.error(not_read("a number", number), number)
        if term.head == TOTAL_COST and len(term.items) == 1:
            if value:
                self._reporter.warn("the total cost starts at 0; another value is ignored", node)
            return
        signature = self._vocabulary.function(term.name)
        if signature is None:
            raise self._reporter.error(unknown("function", term.name, self._functions), term)
        key = (signature.name, *self._vocabulary.terms("function", signature, term, term.items[1:], {}, self._reporter))
        if self.values.setdefault(key, value) != value:
            raise self._reporter.error(f"the value of ({' '.join(key)}) is given twice, with different numbers", node)
