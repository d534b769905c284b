"""The declared names, and the checks that every use of a name goes through."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe
from statehtn.hddl.tokens import shortened
from statehtn.model import Parameter, Signature, TypeHierarchy
from statehtn.model.types import ROOT_TYPE

Types = tuple[str, ...]
Scope = Mapping[str, Types]
"""The variables that may be used, with their types."""


class Vocabulary:
    """Everything that has been declared so far; `tasks` are the compound ones, `actions` the primitive ones.

    Args:
        problem_objects: gives the problem's objects with their types while the domain is read, which should declare
            what it names, but may leave that to the problem.

    Attributes:
        objects: the types of the constants and of the problem's objects.
        borrowed: constants that only the problem declares.
    """

    def __init__(self, problem_objects: Callable[[], Mapping[str, str]] = dict) -> None:
        self._parents: dict[str, Types] = {}
        self.types = TypeHierarchy(self._parents)
        self.constants: dict[str, str] = {}
        self.objects: dict[str, str] = {}
        self.borrowed: set[str] = set()
        self.predicates: dict[str, Signature] = {}
        self.functions: dict[str, Signature] = {}
        self.tasks: dict[str, Signature] = {}
        self.actions: dict[str, Signature] = {}
        self._supertypes: dict[str, frozenset[str]] = {}
        self._overlaps: dict[tuple[Types, Types], bool] = {}
        self._problem_objects = problem_objects

    def declare_types(self, parents: Mapping[str, Types]) -> None:
        """Add types with their supertypes."""
        self._parents.update(parents)
        self._supertypes.clear()
        self._overlaps.clear()

    def joint_type(self, left: str, right: str) -> str:
        """Return the type of the objects that are of both types: the lower one of them, or a new one below both."""
        if right in self.supertypes(left):
            return left
        if left in self.supertypes(right):
            return right
        name = f"{left}+{right}"
        while self._parents.setdefault(name, (left, right)) != (left, right):
            name += "+"
        self._overlaps.clear()
        return name

    def overlap(self, left: Types, right: Types) -> bool:
        """Tell whether an object could be of one of the left types and one of the right ones."""
        if left == right or ROOT_TYPE in left or ROOT_TYPE in right:
            return True
        key = (left, right)
        if key not in self._overlaps:
            self._overlaps[key] = any(
                not self.supertypes(kind).isdisjoint(left) and not self.supertypes(kind).isdisjoint(right)
                for kind in self.types.parents
            )
        return self._overlaps[key]

    def supertypes(self, kind: str) -> frozenset[str]:
        """Return the type and everything above it; remembered."""
        found = self._supertypes.get(kind)
        if found is None:
            found = self._supertypes[kind] = self.types.supertypes(kind)
        return found

    def objects_of(self, types: Types) -> frozenset[str]:
        """Return the names of the objects that are of one of the types."""
        kinds = {kind for kind in {*self.types.parents, ROOT_TYPE} if not self.supertypes(kind).isdisjoint(types)}
        return frozenset(name for name, kind in self.objects.items() if kind in kinds)

    def term(self, node: Node, scope: Scope, reporter: Reporter) -> str:
        """Return a variable or an object; both must be declared."""
        if isinstance(node, Group):
            raise reporter.error(f"expected a variable or an object, found {describe(node)}", node)
        if node.text in scope or node.text in self.objects:
            return node.text
        if node.text.startswith("?"):
            raise reporter.error(unknown("variable", node.text, scope), node)
        kind = self._problem_objects().get(node.text)
        if kind is not None and kind in self.types:
            reporter.warn(f"'{shortened(node.text)}' is an object of the problem, not a constant of the domain", node)
            self.constants[node.text] = self.objects[node.text] = kind
            self.borrowed.add(node.text)
            return node.text
        raise reporter.error(unknown("object", node.text, self.objects), node)

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
            if term in scope:
                if not self.overlap(scope[term], parameter.types):
                    raise reporter.error(
                        self._wrong_type("variable", term, scope[term], parameter, kind, signature), node
                    )
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


def new_name(node: Node | None, kind: str, at: Node, reporter: Reporter) -> str:
    """Return the name that a declaration gives.

    Raises:
        InputError: it is missing, or a word with a meaning of its own.
    """
    if node is None:
        raise reporter.error(f"expected the name of the {kind} after {describe(at)}", at)
    if isinstance(node, Group) or node.text[0] in "?:" or node.text in ("-", "either"):
        raise reporter.error(f"expected the name of a {kind}, found {describe(node)}", node)
    return node.text


RESERVED = frozenset({"and", "or", "not", "imply", "forall", "exists"})


def unreserved(name: str, kind: str, at: Node, reporter: Reporter) -> str:
    """Return the name of a predicate or task.

    Raises:
        InputError: formulas and task networks could not tell it from a word of the language.
    """
    if name in RESERVED:
        raise reporter.error(f"'{name}' is a word of HDDL and cannot name a {kind}", at)
    return name


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
