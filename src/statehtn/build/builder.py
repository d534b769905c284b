"""The builder of problems."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction

from statehtn.build.chances import chance_of
from statehtn.build.declarations import Declarations, Scope
from statehtn.build.domain_builder import DomainBuilder, declared_in
from statehtn.build.names import new_name
from statehtn.build.networks import Occurrence, Ordering, network_of
from statehtn.build.terms import checked_formula, checked_variables
from statehtn.errors import UsageError
from statehtn.model import (
    TRUE,
    Atom,
    Domain,
    Fact,
    Formula,
    FunctionTerm,
    Parameter,
    Problem,
    TaskNetwork,
)
from statehtn.model.chance import Chance, scenarios_of
from statehtn.model.cost.blocks import Amount, exact
from statehtn.model.expect import expect_problem
from statehtn.model.formula import Combinable
from statehtn.model.hidden import check_that_costs_alone_read


class ProblemBuilder(DomainBuilder):
    """Builds an HTN problem, call by call; each call checks what it is given and raises where it is wrong.

    Names keep their case, and those of one kind must differ by more, as HDDL does not distinguish it. Types,
    predicates, functions, tasks and actions are declared before they are used, methods last. `build` returns the
    immutable problem; the builder can go on afterwards, for the next one.

    Args:
        name: the problem's name.
        domain: the name of a new domain (the problem's name where it is left out), or a domain to build upon, such as
            `problem.domain` of a problem that was read.

    Raises:
        UsageError: a name is none. Every method raises it where a name is unknown, taken or malformed, or an argument
            of a wrong number or type.
    """

    def __init__(self, name: str, domain: str | Domain | None = None) -> None:
        self.name = new_name(name, "problem")
        if isinstance(domain, Domain):
            super().__init__(domain.name, declared_in(domain))
        else:
            super().__init__(new_name(name if domain is None else domain, "domain"), Declarations())
        self._network: tuple[tuple[Parameter, ...], TaskNetwork] | None = None
        self._facts: set[Fact] = set()
        self._values: dict[tuple[str, ...], Fraction] = {}
        self._goal: Formula = TRUE
        self._chances: list[Chance] = []

    @classmethod
    def of(cls, problem: Problem) -> ProblemBuilder:
        """Return a builder that begins with all of a problem, which stays as it is."""
        builder = cls("problem", expect_problem(problem).domain)
        builder.name = problem.name  # as the reader accepted it
        builder._declared.objects.update(problem.objects)
        builder._network = (problem.parameters, problem.network)
        builder._facts.update(problem.initial_state)
        builder._values.update(problem.function_values)
        builder._goal = problem.goal
        builder._chances += problem.chances
        return builder

    def initially(self, *facts: Atom) -> None:
        """Add facts that are true in the initial state; all others are false."""
        for fact in facts:
            if not isinstance(fact, Atom):
                raise UsageError(f"a fact is an atom such as at(l1), found {fact!r}; what is not stated is false")
            self._declared.check_formula(fact, Scope())
        self._facts.update((fact.predicate, *fact.arguments) for fact in facts)

    def initially_by_chance(self, *outcomes: tuple[Amount, Atom | Iterable[Atom]]) -> None:
        """Add facts that are decided by chance before a plan begins and never seen: only conditions of costs read them.

        Args:
            outcomes: pairs (probability, the facts that hold then), such as `(0.3, snow()), (0.7, ())`: exactly one
                comes true. What is decided by other calls is independent.

        Raises:
            UsageError: the probabilities do not sum to 1, or a fact is none.
        """
        self._chances.append(chance_of(outcomes, self._declared))

    def set_values(self, values: Mapping[FunctionTerm, Amount]) -> None:
        """Give functions their values, such as `{fare(a, b): 4}`; a second value replaces the first."""
        if not isinstance(values, Mapping):
            raise UsageError(f"expected a mapping such as {{fare(a, b): 4}}, found {values!r}")
        for term in values:
            if not isinstance(term, FunctionTerm):
                raise UsageError(f"expected a function of objects, such as fare(a, b), found {term!r}")
            self._declared.check_expression(term, Scope())
        self._values.update({(term.function, *term.arguments): exact(value) for term, value in values.items()})

    def set_network(
        self,
        *subtasks: Occurrence | Iterable[Occurrence],
        parameters: Iterable[Parameter] = (),
        ordering: Ordering = "total",
        constraints: Combinable = TRUE,
    ) -> None:
        """Set the tasks to accomplish; the arguments are those of `method`.

        Args:
            subtasks: tasks with arguments, one after the other or in lists.
            parameters: variables that may be bound to any objects of their types.
        """
        variables = checked_variables(parameters)
        scope = self._declared.scope(variables)
        self._network = (variables, network_of(subtasks, ordering, constraints, scope, self._declared))

    def set_goal(self, goal: Combinable) -> None:
        """Set a formula that holds in the end, besides the tasks being accomplished."""
        formula = checked_formula(goal, "a goal")
        self._declared.check_formula(formula, Scope())
        self._goal = formula

    def build(self) -> Problem:
        """Return the problem as it is now; what the builder does later does not change it.

        Raises:
            UsageError: it has no initial task network.
            UnsupportedError: something else than the condition of a cost reads hidden facts, or there are too many
                scenarios.
        """
        if self._network is None:
            raise UsageError(f"problem '{self.name}' has nothing to do yet: give it tasks by set_network(...)")
        parameters, network = self._network
        problem = Problem(
            self.name,
            self._domain(),
            dict(self._declared.objects),
            parameters,
            network,
            frozenset(self._facts),
            dict(self._values),
            self._goal,
            tuple(self._chances),
        )
        check_that_costs_alone_read(problem)
        scenarios_of(problem.chances)
        return problem

    def __repr__(self) -> str:
        declared = self._declared
        counts = {
            "types": declared.parents,
            "objects": self.objects,
            "predicates": declared.predicates,
            "actions": declared.actions,
            "tasks": declared.tasks,
            "methods": declared.methods,
            "facts": self._facts,
        }
        return f"<builder of '{self.name}': {', '.join(f'{what} {len(found)}' for what, found in counts.items())}>"
