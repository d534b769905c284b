"""What declarations return: types that make objects and variables; predicates, functions and tasks that are called."""

from __future__ import annotations

from dataclasses import dataclass, field

from statehtn.build.declarations import Declarations
from statehtn.build.names import Named, new_name
from statehtn.build.networks import Occurrence
from statehtn.build.terms import Object, Term
from statehtn.errors import UsageError
from statehtn.model import Atom, FunctionTerm, Parameter, Signature


@dataclass(frozen=True, slots=True)
class Type:
    """A type, or a union of types (`truck | train`): it makes variables, and a single type makes objects."""

    names: tuple[str, ...]
    _declarations: Declarations = field(compare=False, repr=False)

    def __or__(self, other: Type) -> Type:
        if not isinstance(other, Type):
            return NotImplemented
        return Type(tuple(dict.fromkeys((*self.names, *other.names))), self._declarations)

    def variables(self, *names: str) -> tuple[Parameter, ...]:
        """Return a variable of this type for each name; the question mark may be left out."""
        return tuple(
            Parameter(f"?{new_name(name.removeprefix('?') if isinstance(name, str) else name, 'variable')}", self.names)
            for name in names
        )

    def variable(self, name: str) -> Parameter:
        """Return one variable of this type."""
        return self.variables(name)[0]

    def objects(self, *names: str) -> tuple[Object, ...]:
        """Declare objects of the problem.

        Raises:
            UsageError: a name is none or taken, or this is a union of types.
        """
        return self._declare(names, self._declarations.objects)

    def constants(self, *names: str) -> tuple[Object, ...]:
        """Declare objects of the domain, which its actions and methods may name; as `objects`."""
        return self._declare(names, self._declarations.constants)

    def _declare(self, names: tuple[str, ...], known: Named[str]) -> tuple[Object, ...]:
        if len(self.names) > 1:
            raise UsageError(f"an object has one type, not a union such as {self}")
        taken = (("object", self._declarations.objects), ("constant", self._declarations.constants))
        found = []
        for name in names:  # the second of two equal names meets the first
            known[new_name(name, "object", *taken)] = self.names[0]
            found.append(Object(name, self.names[0]))
        return tuple(found)

    def __str__(self) -> str:
        return " | ".join(self.names)

    def __repr__(self) -> str:
        return f"<type {self}>"


@dataclass(frozen=True, slots=True)
class Predicate:
    """A declared predicate: `at(l1)` is the fact, or the condition, that it holds of its arguments."""

    signature: Signature
    _declarations: Declarations = field(compare=False, repr=False)

    def __call__(self, *terms: Term) -> Atom:
        """Return the atom; raises a `UsageError` where number or types of the arguments are wrong."""
        return Atom(self.signature.name, self._declarations.arguments("predicate", self.signature, terms, None))

    def __repr__(self) -> str:
        return f"<predicate {_shown(self.signature)}>"


@dataclass(frozen=True, slots=True)
class NumericFunction:
    """A declared function with numbers as values: `fare(a, b)` is an expression of costs and probabilities."""

    signature: Signature
    _declarations: Declarations = field(compare=False, repr=False)

    def __call__(self, *terms: Term) -> FunctionTerm:
        """Return the expression; raises a `UsageError` where number or types of the arguments are wrong."""
        return FunctionTerm(self.signature.name, self._declarations.arguments("function", self.signature, terms, None))

    def __repr__(self) -> str:
        return f"<function {_shown(self.signature)}>"


@dataclass(frozen=True, slots=True)
class Task:
    """A declared task, compound or primitive (an action): `drive(a, b)` is its occurrence in a task network."""

    signature: Signature
    is_primitive: bool
    _declarations: Declarations = field(compare=False, repr=False)

    @property
    def name(self) -> str:
        """The task's name."""
        return self.signature.name

    def __call__(self, *terms: Term, label: str | None = None) -> Occurrence:
        """Return an occurrence of the task.

        Args:
            terms: one variable or object for each parameter.
            label: a name in its network, for the ordering.

        Raises:
            UsageError: number or types of the arguments are wrong.
        """
        kind = "action" if self.is_primitive else "task"
        self._declarations.arguments(kind, self.signature, terms, None)
        return Occurrence(self.name, terms, label)

    def __repr__(self) -> str:
        return f"<{'action' if self.is_primitive else 'task'} {_shown(self.signature)}>"


def _shown(signature: Signature) -> str:
    return f"({' '.join((signature.name, *map(str, signature.parameters)))})"
