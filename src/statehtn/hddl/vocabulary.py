"""The declared names, and the checks that every use of a name goes through."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePath
from typing import Literal

from statehtn.counted import with_article
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe
from statehtn.hddl.spelling import ODD, Spellings
from statehtn.hddl.tokens import Source, shortened
from statehtn.model import Parameter, Signature, TypeHierarchy
from statehtn.model.types import ROOT_TYPE

Types = tuple[str, ...]
Scope = Mapping[str, Parameter]
"""The variables that may be used, by their names in lower case."""
Kind = Literal["type", "object", "predicate", "function", "task", "method"]
"""Names of one kind must differ by more than case; constants are objects, and actions are tasks."""
ANY_TYPE = "any type"
"""The type, below all others, of objects that some problem is taken to declare; no name that is read has a space."""


class Vocabulary:
    """Everything that has been declared so far; `tasks` are the compound ones, `actions` the primitive ones.

    Names are compared without case. All that this class returns, and all keys of its attributes, are spelt as they are
    declared, so that names are compared as they are wherever the problem has been read.

    Attributes:
        objects: the types of the constants and of the problem's objects.
        lent: while the domain is read, the problem's objects: the domain should declare what it names, but may leave
            that to the problem.
        assumes_objects: whether an object that nobody declares is taken as one that some problem declares, of whatever
            type is needed, with a warning: where a domain is read without a problem.
        hidden: the predicates of which the problem's initial state decides facts by chance.
    """

    def __init__(self) -> None:
        self._parents: dict[str, Types] = {}
        self.types = TypeHierarchy(self._parents)
        self.constants: dict[str, str] = {}
        self.objects: dict[str, str] = {}
        self.lent: dict[str, str] = {}
        self.assumes_objects = False
        self.predicates: dict[str, Signature] = {}
        self.hidden: set[str] = set()
        self.functions: dict[str, Signature] = {}
        self.tasks: dict[str, Signature] = {}
        self.actions: dict[str, Signature] = {}
        self._supertypes: dict[str, frozenset[str]] = {}
        self._overlaps: dict[tuple[Types, Types], bool] = {}
        self._spellings: defaultdict[Kind, Spellings] = defaultdict(Spellings)
        self._spellings["type"].add((ROOT_TYPE,))
        self._ranges: defaultdict[Kind, list[tuple[Source, int, int]]] = defaultdict(list)

    def declare_types(self, parents: Mapping[str, Types]) -> None:
        """Add types with their supertypes."""
        self._parents.update(parents)
        self._spellings["type"].add(parents)
        self._supertypes.clear()
        self._overlaps.clear()

    def declare(self, kind: Kind, names: Iterable[str], source: Source | None = None, start: int = 0) -> None:
        """Note how new names are spelt.

        Args:
            names: of one kind.
            source: where they stand, one token after the other; None where they do not come from a file.
            start: the token of the first one.
        """
        names = tuple(names)
        self._spellings[kind].add(names)
        if source is not None:
            self._ranges[kind].append((source, start, start + len(names)))

    def spelling(self, kind: Kind, name: str) -> str | None:
        """Return a name as it is declared; None if it is not."""
        return self._spellings[kind].find(name)

    def are_new(self, kind: Kind, names: Iterable[str]) -> bool:
        """Tell whether none of the names is declared."""
        return self._spellings[kind].has_none_of(names)

    def token(self, kind: Kind, name: str) -> tuple[Source, int]:
        """Return the file and the token where a name, spelt like this, was declared.

        Raises:
            KeyError: not in a file.
        """
        for source, start, end in self._ranges[kind]:
            for index in range(start, end):
                if source.tokens[index] == name:
                    return source, index
        raise KeyError(name)

    def differ_in_case(self, kind: Kind, declared: str, name: str, reporter: Reporter) -> str:
        """Return the beginning of a message about a declared name and another one that differs in case only."""
        source, index = self.token(kind, declared)
        place = source.place(index)
        if source is reporter.source:
            where = f"line {place.line}, column {place.column}"
        else:
            where = f"{PurePath(place.file).name}:{place.line}:{place.column}"
        return f"'{name}' and '{declared}' ({where}) differ in case only, which means nothing in HDDL"

    def predicate(self, name: str) -> Signature | None:
        """Return the declaration of a predicate."""
        return self.predicates.get(self.spelling("predicate", name) or "")

    def function(self, name: str) -> Signature | None:
        """Return the declaration of a function."""
        return self.functions.get(self.spelling("function", name) or "")

    def task(self, name: str) -> Signature | None:
        """Return the declaration of a task or an action."""
        found = self.spelling("task", name) or ""
        return self.tasks.get(found) or self.actions.get(found)

    def is_action(self, name: str) -> bool:
        """Tell whether an action is called like this."""
        return self.spelling("task", name) in self.actions

    def joint_type(self, left: str, right: str) -> str:
        """Return the type of the objects that are of both types: the lower one of them, or a new one below both."""
        if right in self.supertypes(left):
            return left
        if left in self.supertypes(right):
            return right
        name = f"{left}+{right}"
        while self._parents.setdefault(name, (left, right)) != (left, right):
            name += "+"
        self.declare("type", (name,))
        self._overlaps.clear()
        return name

    def overlap(self, left: Types, right: Types) -> bool:
        """Tell whether an object could be of one of the left types and one of the right ones."""
        if left == right or ROOT_TYPE in left or ROOT_TYPE in right:
            return True
        key = (left, right)
        if key not in self._overlaps:
            self._overlaps[key] = not self.types.subtypes(left).isdisjoint(self.types.subtypes(right))
        return self._overlaps[key]

    def supertypes(self, kind: str) -> frozenset[str]:
        """Return the type and everything above it; remembered."""
        found = self._supertypes.get(kind)
        if found is None:
            found = self._supertypes[kind] = self.types.supertypes(kind)
        return found

    def objects_of(self, types: Types) -> frozenset[str]:
        """Return the names of the objects that are of one of the types."""
        kinds = self.types.subtypes(types)
        return frozenset(name for name, kind in self.objects.items() if kind in kinds)

    def term(self, node: Node, scope: Scope, reporter: Reporter) -> str:
        """Return a variable or an object; both must be declared."""
        if isinstance(node, Group):
            raise reporter.error(f"expected a variable or an object, found {describe(node)}", node)
        if node.text.startswith("?"):
            variable = scope.get(node.lower)
            if variable is None:
                variables = (parameter.name for parameter in scope.values())
                raise reporter.error(unknown("variable", node.text, variables), node)
            return variable.name
        name = self.spelling("object", node.text)
        if name is None:
            known = [name for name in self.objects if name not in self.lent]
            if not self.assumes_objects:
                raise reporter.error(unknown("object", node.text, known), node)
            reporter.warn(f"{unknown('object', node.text, known)}; the domain declares no such constant", node)
            return self._assumed(node.text)
        if name in self.lent:
            reporter.warn(f"'{shortened(name)}' is an object of the problem, not a constant of the domain", node)
            self.constants[name] = self.lent.pop(name)
        return name

    def _assumed(self, name: str) -> str:
        """Declare an object that is of all types."""
        self._parents.setdefault(ANY_TYPE, tuple(self._parents))
        self.declare("object", (name,))
        self.objects[name] = self.constants[name] = ANY_TYPE
        self._supertypes.clear()
        self._overlaps.clear()
        return name

    def terms(
        self, kind: str, signature: Signature, head: Node, nodes: Sequence[Node], scope: Scope, reporter: Reporter
    ) -> tuple[str, ...]:
        """Return the arguments of a predicate, a function or a task, checked against its declaration.

        Args:
            kind: what the signature declares, for messages.
            head: the node that an error about the number of arguments points to.

        Raises:
            InputError: the number of arguments, a name or a type is wrong. A variable is of a wrong type only if no
                object can be of both types.
        """
        wanted = signature.parameters
        if len(nodes) != len(wanted):
            raise reporter.error(
                f"{kind} '{signature.name}' takes {_count(len(wanted))}, found {len(nodes)}{_declared(signature)}", head
            )
        terms = tuple(self.term(node, scope, reporter) for node in nodes)
        for node, term, parameter in zip(nodes, terms, wanted, strict=True):
            if term.startswith("?"):
                types = scope[term.lower()].types
                if not self.overlap(types, parameter.types):
                    raise reporter.error(self._wrong_type("variable", term, types, parameter, kind, signature), node)
            elif self.supertypes(self.objects[term]).isdisjoint(parameter.types):
                raise reporter.error(
                    self._wrong_type("object", term, (self.objects[term],), parameter, kind, signature), node
                )
        return terms

    @staticmethod
    def _wrong_type(what: str, term: str, found: Types, wanted: Parameter, kind: str, signature: Signature) -> str:
        return (
            f"{what} '{term}' is of type {_alternatives(found)}, but {kind} '{signature.name}' expects "
            f"{_alternatives(wanted.types)} for '{wanted.name}'"
        )


def scope_of(parameters: Iterable[Parameter]) -> dict[str, Parameter]:
    """Return the scope in which these variables may be used."""
    return {parameter.name.lower(): parameter for parameter in parameters}


def new_name(node: Node | None, kind: str, at: Node, reporter: Reporter) -> Word:
    """Return the name that a declaration gives.

    Raises:
        InputError: it is missing, or a word with a meaning of its own.
    """
    if node is None:
        raise reporter.error(f"expected the name of the {kind} after {describe(at)}", at)
    if isinstance(node, Group) or node.text[0] in "?:" or node.lower in ("-", "either"):
        raise reporter.error(f"expected the name of {with_article(kind)}, found {describe(node)}", node)
    if odd := ODD.search(node.text):
        reporter.warn(f"no name in HDDL has a {odd[0]}, found {describe(node)}; other programs will not read it", node)
    return node


RESERVED = frozenset({"and", "or", "not", "imply", "forall", "exists"})


def unreserved(node: Node | None, kind: str, at: Node, reporter: Reporter) -> Word:
    """Return the name that the declaration of a predicate, function or task gives; as `new_name`.

    Raises:
        InputError: also where formulas and task networks could not tell it from a word of the language.
    """
    word = new_name(node, kind, at, reporter)
    if word.lower in RESERVED:
        raise reporter.error(f"'{word.text}' is a word of HDDL and cannot name {with_article(kind)}", word)
    return word


def words(nodes: Iterable[Node], what: str, reporter: Reporter) -> list[Word]:
    """Return nodes that must all be words."""
    found = []
    for node in nodes:
        if isinstance(node, Group):
            raise reporter.error(f"expected {what}, found {describe(node)}", node)
        found.append(node)
    return found


def _alternatives(types: Types) -> str:
    return " or ".join(f"'{kind}'" for kind in types)


def _count(number: int) -> str:
    return "no arguments" if number == 0 else "1 argument" if number == 1 else f"{number} arguments"


def _declared(signature: Signature) -> str:
    return f" (declared with {' '.join(map(str, signature.parameters))})" if signature.parameters else ""
