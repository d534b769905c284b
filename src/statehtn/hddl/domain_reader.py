"""The domain: declarations first, in whatever order they stand, then actions and methods."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from statehtn.hddl.cost_reader import TOTAL_COST
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.effect_reader import EffectReader
from statehtn.hddl.expressions import Group, Node, Word, describe, parse_group
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.network_reader import NETWORK_KEYWORDS, read_network
from statehtn.hddl.sections import Fields, is_empty, read_header, sorted_sections
from statehtn.hddl.typed_lists import read_objects, read_parameters, read_types, type_after_dash, typed_list
from statehtn.hddl.vocabulary import Kind, Scope, Vocabulary, new_name, scope_of, unreserved
from statehtn.model import TRUE, Action, Domain, Formula, Method, Signature

SECTIONS = (":requirements", ":types", ":constants", ":predicates", ":functions", ":task", ":action", ":method")
SINGLE = (":types", ":constants", ":predicates", ":functions")
UNSUPPORTED = {
    ":durative-action": "actions with durations are not supported",
    ":derived": "derived predicates are not supported",
    ":constraints": "trajectory constraints are not supported",
    ":process": "processes are not supported",
    ":event": "events are not supported",
    ":include": "including other files is not supported",
}
UNSUPPORTED_REQUIREMENTS = {
    ":method-preconditions-are-immediately-before": "method preconditions that bind the first subtask",
    ":typeof-predicate": "facts about the types of objects",
}
ACTION_KEYWORDS = (":parameters", ":precondition", ":effect")
METHOD_KEYWORDS = (":parameters", ":task", ":precondition", ":effect", *NETWORK_KEYWORDS)


class DomainReader:
    """Reads the file of a domain: its declarations when it is made, the rest when those of the problem are known.

    Args:
        reporter: of the file.
        vocabulary: gets the declarations.

    Raises:
        InputError: with the place of the mistake.
        UnsupportedError: it uses a part of PDDL that is not supported.
    """

    def __init__(self, reporter: Reporter, vocabulary: Vocabulary) -> None:
        self.reporter = reporter
        self.vocabulary = vocabulary
        self.name = read_header("domain", reporter)
        self.sections = sorted_sections(reporter, SECTIONS, UNSUPPORTED, SINGLE)
        self._check_requirements()
        types = [entry for group in self._groups(":types") for entry in typed_list(group.items[1:], self.reporter)]
        read_types(types, vocabulary, self.reporter)
        for start, end in self.sections[":constants"]:
            read_objects(start, end, vocabulary, vocabulary.constants, self.reporter)
        for group in self._groups(":predicates"):
            self._predicates(group)
        for group in self._groups(":functions"):
            self._functions(group)
        for group in self._groups(":task"):
            self._task(group)
        self._actions = [self._head(group) for group in self._groups(":action")]

    def read(self, problem_objects: dict[str, str]) -> Domain:
        """Return the domain.

        Args:
            problem_objects: what the problem declares; those that the domain names become its constants, with a
                warning.

        Raises:
            InputError: with the place of the mistake.
            UnsupportedError: it uses a part of PDDL that is not supported.
        """
        vocabulary = self.vocabulary
        vocabulary.lent = problem_objects
        actions: dict[str, Action] = {}
        for signature, fields in self._actions:
            with self.reporter.leaving_out():
                actions[signature.name] = self._action(signature, fields)
        methods = self._methods()
        vocabulary.lent = {}
        return Domain(
            self.name,
            vocabulary.types,
            vocabulary.constants,
            vocabulary.predicates,
            vocabulary.functions,
            vocabulary.tasks,
            actions,
            methods,
        )

    def _check_requirements(self) -> None:
        """Refuse those that would change what the rest of the file means; the others are not insisted on."""
        for index in (index for start, end in self.sections[":requirements"] for index in range(start + 2, end - 1)):
            requirement = self.reporter.source.tokens[index].lower()
            if requirement in UNSUPPORTED_REQUIREMENTS:
                what = UNSUPPORTED_REQUIREMENTS[requirement]
                raise self.reporter.unsupported(f"{what} ({requirement}) are not supported", Word(requirement, index))

    def _groups(self, name: str) -> Iterable[Group]:
        source = self.reporter.source
        for start, _ in self.sections[name]:
            source.limits.check()
            yield parse_group(source, start)

    def _predicates(self, section: Group) -> None:
        for node in section.items[1:]:
            word, signature = self._signature(node, "predicate")
            if signature.name == "=":
                self.reporter.warn("'=' is built in and need not be declared", node)
                continue
            self._declare(signature, "predicate", self.vocabulary.predicates, word)

    def _functions(self, section: Group) -> None:
        """Read `(slow ?a ?b) - number`; the type may be left out, and `(total-cost)` is known anyway."""
        nodes = section.items[1:]
        index = 0
        while index < len(nodes):
            node = nodes[index]
            index += 1
            if isinstance(node, Word) and node.text.startswith("-") and index > 1:
                if node.text == "-":
                    kind = nodes[index] if index < len(nodes) else node
                    index += 1
                else:
                    kind = type_after_dash(node, self.reporter)
                if not isinstance(kind, Word) or kind.lower != "number":
                    raise self.reporter.unsupported(f"functions have the type 'number', found {describe(kind)}", kind)
                continue
            word, signature = self._signature(node, "function")
            if word.lower == TOTAL_COST:
                continue
            self._declare(signature, "function", self.vocabulary.functions, word)

    def _signature(self, node: Node, kind: str) -> tuple[Word, Signature]:
        """Return the name of a predicate or function, as it stands in the file, and its declaration."""
        if isinstance(node, Word) or not node.items:
            raise self.reporter.error(f"expected '(<{kind}> <parameters>)', found {describe(node)}", node)
        word = unreserved(node.items[0], kind, node, self.reporter)
        parameters = read_parameters(node.items[1:], self.vocabulary, self.reporter, distinct=False)
        return word, Signature(word.text, parameters)

    def _task(self, section: Group) -> None:
        signature, fields = self._head(section)
        for keyword in (":precondition", ":effect"):
            node = fields.get(keyword)
            if node is not None and not is_empty(node):
                self.reporter.warn(f"'{keyword}' of a compound task means nothing in HTN planning and is ignored", node)
        self.vocabulary.tasks[signature.name] = signature

    def _head(self, section: Group) -> tuple[Signature, Fields]:
        """Declare an action or a task; actions are read only when all of them are declared."""
        kind = section.head[1:]
        name_node = section.items[1] if len(section.items) > 1 else None
        word = unreserved(name_node, kind, section, self.reporter)
        self._claim(word, "task", "an action" if self.vocabulary.is_action(word.text) else "a task")
        fields = Fields(section, section.items[2:], ACTION_KEYWORDS, self.reporter)
        signature = Signature(word.text, read_parameters(fields.items(":parameters"), self.vocabulary, self.reporter))
        if kind == "action":
            self.vocabulary.actions[word.text] = signature
        return signature, fields

    def _declare(
        self, signature: Signature, kind: Literal["predicate", "function"], known: dict[str, Signature], word: Word
    ) -> None:
        """Add a declaration; the same one again changes nothing and is only a warning."""
        name = self.vocabulary.spelling(kind, word.text)
        if name is None or _types_of(known[name]) != _types_of(signature):
            self._claim(word, kind, f"a {kind}")
            known[signature.name] = signature
        elif name == word.text:
            self.reporter.warn(f"{kind} '{name}' is declared again", word)
        else:
            differing = self.vocabulary.differ_in_case(kind, name, word.text, self.reporter)
            self.reporter.warn(f"{differing}; they are one {kind}, '{name}'", word)

    def _claim(self, word: Word, kind: Kind, what: str) -> None:
        """Note a new name; that of `what` there is already is an error."""
        name = self.vocabulary.spelling(kind, word.text)
        if name == word.text:
            raise self.reporter.error(f"there is {what} '{name}' already", word)
        if name is not None:
            differing = self.vocabulary.differ_in_case(kind, name, word.text, self.reporter)
            raise self.reporter.error(f"{differing}; there is {what} '{name}' already, so expected another name", word)
        self.vocabulary.declare(kind, (word.text,), self.reporter.source, word.index)

    def _action(self, signature: Signature, fields: Fields) -> Action:
        scope = scope_of(signature.parameters)
        precondition = self._precondition(fields, scope)
        reader = EffectReader(self.vocabulary, self.reporter)
        effect = fields.get(":effect")
        if effect is not None:
            reader.read(effect, scope)
        found = tuple(reader.effects), tuple(reader.costs), tuple(reader.outcomes)
        return Action(signature.name, signature.parameters, precondition, *found)

    def _methods(self) -> dict[str, Method]:
        methods: dict[str, Method] = {}
        for section in self._groups(":method"):
            with self.reporter.leaving_out():
                name_node = section.items[1] if len(section.items) > 1 else None
                word = new_name(name_node, "method", section, self.reporter)
                self._claim(word, "method", "a method")
                methods[word.text] = self._method(word.text, section)
        return methods

    def _method(self, name: str, section: Group) -> Method:
        fields = Fields(section, section.items[2:], METHOD_KEYWORDS, self.reporter)
        parameters = read_parameters(fields.items(":parameters"), self.vocabulary, self.reporter)
        scope = scope_of(parameters)
        task, arguments = self._decomposed(name, fields, scope)
        effect = fields.get(":effect")
        if effect is not None and not is_empty(effect):
            raise self.reporter.unsupported("effects of methods are not supported; give them to an action", effect)
        network = read_network(fields, scope, self.vocabulary, self.reporter)
        return Method(name, parameters, task, arguments, network, self._precondition(fields, scope))

    def _decomposed(self, name: str, fields: Fields, scope: Scope) -> tuple[str, tuple[str, ...]]:
        node = fields.get(":task")
        if node is None or not node.name:
            raise self.reporter.error(
                f"method '{name}' must say which task it decomposes: ':task (<task> <arguments>)'", node or fields.owner
            )
        if self.vocabulary.is_action(node.name):
            raise self.reporter.error(
                f"method '{name}' cannot decompose '{node.name}', which is an action", node.items[0]
            )
        signature = self.vocabulary.task(node.name)
        if signature is None:
            message = unknown("task", node.name, self.vocabulary.tasks)
            raise self.reporter.error(f"method '{name}' decomposes an {message}", node.items[0])
        terms = self.vocabulary.terms("task", signature, node, node.items[1:], scope, self.reporter)
        return signature.name, terms

    def _precondition(self, fields: Fields, scope: Scope) -> Formula:
        node = fields.get(":precondition")
        return TRUE if node is None else FormulaReader(self.vocabulary, self.reporter).read(node, scope)


def _types_of(signature: Signature) -> list[tuple[str, ...]]:
    return [parameter.types for parameter in signature.parameters]
