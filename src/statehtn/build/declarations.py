"""Everything that a builder has declared, and the checks that every use of a name goes through."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from statehtn.build.names import Named, not_declared
from statehtn.build.terms import Object, Term, name_of
from statehtn.errors import UsageError
from statehtn.model import (
    Action,
    And,
    Arithmetic,
    Atom,
    Equals,
    Exists,
    Expression,
    Forall,
    Formula,
    FunctionTerm,
    Method,
    Not,
    OfType,
    Or,
    Parameter,
    Signature,
    TypeHierarchy,
)

Types = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Scope:
    """What may be used at some place.

    Args:
        variables: the variables with their types.
        in_domain: only constants may be named, as the domain does not know the problem's objects.
    """

    variables: Mapping[str, Types] = field(default_factory=dict)
    in_domain: bool = False


@dataclass(slots=True)
class Declarations:
    """What has been declared so far, by name, in order of declaration; `signatures` are those of tasks and actions."""

    parents: Named[Types] = field(default_factory=Named)
    constants: Named[str] = field(default_factory=Named)
    objects: Named[str] = field(default_factory=Named)
    predicates: Named[Signature] = field(default_factory=Named)
    functions: Named[Signature] = field(default_factory=Named)
    tasks: Named[Signature] = field(default_factory=Named)
    actions: Named[Action] = field(default_factory=Named)
    methods: Named[Method] = field(default_factory=Named)

    @property
    def types(self) -> TypeHierarchy:
        """The type hierarchy; a view, not a copy."""
        return TypeHierarchy(self.parents)

    def type_of(self, name: str) -> str | None:
        """Return the type of an object or constant; None if there is no such object."""
        return self.objects.get(name) or self.constants.get(name)

    def signature(self, task: str) -> Signature | None:
        """Return the signature of a compound or primitive task."""
        action = self.actions.get(task)
        return Signature(task, action.parameters) if action else self.tasks.get(task)

    def arguments(self, kind: str, signature: Signature, terms: Sequence[Term], scope: Scope | None) -> tuple[str, ...]:
        """Return the names of the arguments of a predicate, function or task, checked against its declaration.

        Args:
            scope: the variables that may be used; None where that is not known yet: variables then tell their types.

        Raises:
            UsageError: the number of arguments, a name or a type is wrong. A variable is of a wrong type only if no
                object can be of both types.
        """
        wanted = signature.parameters
        if len(terms) != len(wanted):
            count = "no arguments" if not wanted else "1 argument" if len(wanted) == 1 else f"{len(wanted)} arguments"
            declared = f" (declared with {' '.join(map(str, wanted))})" if wanted else ""
            raise UsageError(f"{kind} '{signature.name}' takes {count}, found {len(terms)}{declared}")
        for term, parameter in zip(terms, wanted, strict=True):
            what, types = self._types_of(term, scope)
            if not self._overlap(types, parameter.types, what == "object"):
                raise UsageError(
                    f"{what} '{name_of(term)}' is of type {_alternatives(types)}, but {kind} '{signature.name}' "
                    f"expects {_alternatives(parameter.types)} for '{parameter.name}'"
                )
        return tuple(map(name_of, terms))

    def check_term(self, term: Term, scope: Scope | None) -> str:
        """Return the name of a term that may be used."""
        self._types_of(term, scope)
        return name_of(term)

    def check_formula(self, formula: Formula, scope: Scope) -> None:
        """Check every name in a formula, and that every variable is in scope.

        Raises:
            UsageError: a name is unknown, or an argument wrong.
        """
        match formula:
            case Atom(predicate, terms):
                if predicate not in self.predicates:
                    raise not_declared("predicate", predicate, self.predicates)
                self.arguments("predicate", self.predicates[predicate], terms, scope)
            case Equals(left, right):
                self.check_term(left, scope)
                self.check_term(right, scope)
            case OfType(term, types):
                self.check_term(term, scope)
                self.check_types(types)
            case Not(operand):
                self.check_formula(operand, scope)
            case And(operands) | Or(operands):
                for operand in operands:
                    self.check_formula(operand, scope)
            case Exists(parameters, body) | Forall(parameters, body):
                self.check_formula(body, self.extended(scope, parameters))

    def check_expression(self, expression: Expression, scope: Scope) -> None:
        """Check every name in a cost or probability expression.

        Raises:
            UsageError: a function is unknown, or an argument wrong.
        """
        match expression:
            case FunctionTerm(function, terms):
                if function not in self.functions:
                    raise not_declared("function", function, self.functions)
                self.arguments("function", self.functions[function], terms, scope)
            case Arithmetic(_, operands):
                for operand in operands:
                    self.check_expression(operand, scope)

    def scope(self, parameters: Sequence[Parameter], in_domain: bool = False) -> Scope:
        """Return the scope of variables, whose types are all declared."""
        return self.extended(Scope(in_domain=in_domain), parameters)

    def extended(self, scope: Scope, parameters: Sequence[Parameter]) -> Scope:
        """Return a scope with more variables, which hide those of the same name."""
        for parameter in parameters:
            self.check_types(parameter.types)
        added = {parameter.name: parameter.types for parameter in parameters}
        return Scope({**scope.variables, **added}, scope.in_domain)

    def check_types(self, types: Types) -> None:
        """Raise a `UsageError` if one of the types is not declared."""
        for kind in types:
            if kind not in self.types:
                raise not_declared("type", kind, self.parents)

    def _types_of(self, term: Term, scope: Scope | None) -> tuple[str, Types]:
        """Return whether a term is a variable or an object, and its types."""
        if isinstance(term, Parameter):
            if scope is not None and term.types != scope.variables.get(term.name):
                raise UsageError(f"variable '{term}' is not one of the parameters{_shown(scope)}")
            return "variable", term.types
        if isinstance(term, Object):
            if self.type_of(term.name) != term.type:
                raise UsageError(f"object '{term.name}' of type '{term.type}' is not declared in this builder")
            term = term.name
        if not isinstance(term, str):
            raise UsageError(f"expected a variable, an object or the name of an object, found {term!r}")
        if term.startswith("?"):
            if scope is None:
                raise UsageError(f"a variable needs a type: use Type.variables('{term[1:]}') instead of '{term}'")
            if term not in scope.variables:
                raise UsageError(f"variable '{term}' is not one of the parameters{_shown(scope)}")
            return "variable", scope.variables[term]
        kind = self.type_of(term)
        if kind is None:
            raise not_declared("object", term, (*self.constants, *self.objects))
        if scope is not None and scope.in_domain and term not in self.constants:
            raise UsageError(f"'{term}' is an object of the problem; a domain names constants, see Type.constants()")
        return "object", (kind,)

    def _overlap(self, types: Types, wanted: Types, is_object: bool) -> bool:
        """Tell whether an object of one of the types is (for variables: could be) of one of the wanted ones."""
        hierarchy = self.types
        if any(hierarchy.is_subtype(kind, wanted) for kind in types):
            return True
        return not is_object and any(
            not (above := hierarchy.supertypes(kind)).isdisjoint(types) and not above.isdisjoint(wanted)
            for kind in ("object", *self.parents)
        )


def _shown(scope: Scope) -> str:
    names = ", ".join(str(Parameter(name, types)) for name, types in scope.variables.items())
    return f" ({names})" if names else ", as there are none"


def _alternatives(types: Types) -> str:
    return " or ".join(f"'{kind}'" for kind in types)
