"""The domain's part of the builder: declarations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

from statehtn.build.conditions import read_condition
from statehtn.build.declarations import Declarations
from statehtn.build.declared import NumericFunction, Predicate, Task, Type
from statehtn.build.names import Named, new_name, not_declared
from statehtn.build.networks import Occurrence, Ordering, network_of
from statehtn.build.outcomes import OutcomePart, outcomes_of
from statehtn.build.parts import CostPart, EffectPart, When, costs_of, effects_of
from statehtn.build.terms import Object, checked_formula, checked_variables
from statehtn.errors import UsageError
from statehtn.expected import expect
from statehtn.hddl.cost_reader import TOTAL_COST
from statehtn.model import (
    TRUE,
    Action,
    Domain,
    Method,
    Parameter,
    Signature,
    TypeHierarchy,
)
from statehtn.model.formula import Combinable
from statehtn.model.types import ROOT_TYPE

_ROOT = Named({ROOT_TYPE: ()})
_TOTAL = Named({TOTAL_COST: ()})


class DomainBuilder:
    """Declares the domain of a problem; `ProblemBuilder` adds the problem."""

    def __init__(self, name: str, declared: Declarations) -> None:
        self.domain_name = name
        self._declared = declared

    def type(self, name: str, above: Type | None = None) -> Type:
        """Declare a type.

        Args:
            above: its supertype, or a union of them; `object` is above all.
        """
        declared = self._declared
        new_name(name, "type", ("type", declared.parents), ("type", _ROOT))
        if above is not None and not isinstance(above, Type):
            raise UsageError(f"a supertype is a type that type() has returned, found {above!r}")
        supertypes = (ROOT_TYPE,) if above is None else above.names
        declared.check_types(supertypes)
        declared.parents[name] = supertypes
        return Type((name,), declared)

    @property
    def any_object(self) -> Type:
        """The type `object`, which is above all types; for problems without types of their own."""
        return Type((ROOT_TYPE,), self._declared)

    def predicate(self, name: str, *parameters: Parameter) -> Predicate:
        """Declare a predicate; its parameters are variables that tell their types."""
        new_name(name, "predicate", ("predicate", self._declared.predicates))
        signature = self._signature(name, parameters)
        self._declared.predicates[name] = signature
        return Predicate(signature, self._declared)

    def function(self, name: str, *parameters: Parameter) -> NumericFunction:
        """Declare a function with numbers as values, which `set_values` gives, for costs and probabilities."""
        new_name(name, "function", ("function", self._declared.functions), ("function", _TOTAL))
        signature = self._signature(name, parameters)
        self._declared.functions[name] = signature
        return NumericFunction(signature, self._declared)

    def task(self, name: str, *parameters: Parameter) -> Task:
        """Declare a compound task."""
        new_name(name, "task", ("task", self._declared.tasks), ("action", self._declared.actions))
        signature = self._signature(name, parameters)
        self._declared.tasks[name] = signature
        return Task(signature, False, self._declared)

    def action(
        self,
        name: str,
        parameters: Iterable[Parameter] = (),
        *,
        precondition: Combinable = TRUE,
        effects: EffectPart | Iterable[EffectPart] = (),
        cost: CostPart | Iterable[CostPart] = (),
        outcomes: OutcomePart | Iterable[OutcomePart] = (),
    ) -> Task:
        """Declare an action, a primitive task.

        Args:
            parameters: its variables.
            precondition: a formula over facts.
            effects: atoms that become true, negated ones that become false, `when(...)` and `forall(...)` of them. What
                is added wins over what is deleted.
            cost: numbers, distributions, expressions, `chance(...)`, Python callables, `when(...)` and `forall(...)` of
                them: at least 0, in the domain's unit, independent and added up. Without any cost in all of the domain
                every action costs 1; otherwise an action without one is free.
            outcomes: what it does by chance besides: `Outcome(probability, effects, cost)` for each thing that may
                come, of which one does. Lists of outcomes, `when(...)` and `forall(...)` of them are blocks of their
                own, independent of each other.
        """
        declared = self._declared
        new_name(name, "action", ("task", declared.tasks), ("action", declared.actions))
        signature = self._signature(name, parameters)
        scope = declared.scope(signature.parameters, in_domain=True)
        condition = checked_formula(precondition, "'precondition'")
        declared.check_formula(condition, scope)
        action = Action(
            name,
            signature.parameters,
            condition,
            effects_of(effects, scope, declared),
            costs_of(cost, name, signature.parameters, scope, declared),
            outcomes_of(outcomes, name, signature.parameters, scope, declared),
        )
        declared.actions[name] = action
        return Task(signature, True, declared)

    def method(
        self,
        name: str,
        task: Occurrence,
        *subtasks: Occurrence | Iterable[Occurrence],
        parameters: Iterable[Parameter] | None = None,
        ordering: Ordering = "total",
        precondition: Combinable = TRUE,
        constraints: Combinable = TRUE,
    ) -> Method:
        """Declare a way to decompose a compound task.

        Args:
            task: the task with the method's variables as arguments, such as `travel(here, to)`.
            subtasks: tasks with arguments, one after the other or in lists; none where nothing is left to do.
            parameters: all variables of the method; where they are left out, those among the task's arguments.
            ordering: `"total"`, or pairs (before, after) of subtasks or labels; `()` for none.
            precondition: a formula over facts that holds before the first subtask starts.
            constraints: a formula over variables: `equal(a, b)`, `~equal(a, b)`, combined by `&`, `|`, `~`.
        """
        declared = self._declared
        new_name(name, "method", ("method", declared.methods))
        if not isinstance(task, Occurrence):
            raise UsageError(f"method '{name}' must say what it decomposes, such as travel(here, to), found {task!r}")
        if task.task not in declared.tasks:
            what = "an action" if task.task in declared.actions else "no task of this builder"
            raise UsageError(f"method '{name}' cannot decompose '{task.task}', which is {what}")
        if parameters is None:
            parameters = dict.fromkeys(term for term in task.terms if isinstance(term, Parameter))
        variables = checked_variables(parameters)
        scope = declared.scope(variables, in_domain=True)
        arguments = declared.arguments("task", declared.tasks[task.task], task.terms, scope)
        condition = checked_formula(precondition, "'precondition'")
        declared.check_formula(condition, scope)
        network = network_of(subtasks, ordering, constraints, scope, declared)
        method = declared.methods[name] = Method(name, variables, task.task, arguments, network, condition)
        return method

    def _signature(self, name: str, parameters: Iterable[Parameter]) -> Signature:
        signature = Signature(name, checked_variables(parameters))
        self._declared.scope(signature.parameters)
        return signature

    def set_cost(self, action: Task | str, *costs: CostPart, when: Combinable | str | None = None) -> None:
        """Replace the cost of an action, or the part of it that is due under one condition.

        Args:
            action: a declared action or its name, in any case.
            costs: as in `action`, at least one; 0 for none.
            when: a formula over the action's parameters, or its HDDL text, such as `(icy ?to)`: the costs are due where
                it holds. They replace what was due under exactly this condition; other parts stay, and so do costs of
                outcomes, which are replaced where there is no `when`.
        """
        declared = self._declared
        given = action.name if isinstance(action, Task) else expect(action, str, "the action must be a name")
        name = declared.actions.spelling(given)
        if name is None:
            raise not_declared("action", given, declared.actions)
        if not costs:
            raise UsageError(f"expected a cost for action '{name}', found none; 0 is a cost, too")
        old = declared.actions[name]
        scope = declared.scope(old.parameters)  # a problem's costs may name its objects
        if when is None:
            new = costs_of(costs, name, old.parameters, scope, declared)
            declared.actions[name] = replace(without_costs(old), costs=new)
            return
        condition = read_condition(when, scope, declared) if isinstance(when, str) else checked_formula(when, "'when'")
        new = costs_of(When(condition, costs), name, old.parameters, scope, declared)
        kept = tuple(block for block in old.costs if block.condition != condition or block.parameters)
        declared.actions[name] = replace(old, costs=(*kept, *new))

    @property
    def types(self) -> Mapping[str, Type]:
        """The declared types by name."""
        return MappingProxyType({name: Type((name,), self._declared) for name in self._declared.parents})

    @property
    def objects(self) -> Mapping[str, Object]:
        """The constants and objects by name."""
        declared = self._declared
        return MappingProxyType({n: Object(n, kind) for n, kind in (declared.constants | declared.objects).items()})

    @property
    def predicates(self) -> Mapping[str, Predicate]:
        """The declared predicates by name."""
        found = self._declared.predicates.items()
        return MappingProxyType({name: Predicate(signature, self._declared) for name, signature in found})

    @property
    def functions(self) -> Mapping[str, NumericFunction]:
        """The declared functions by name."""
        found = self._declared.functions.items()
        return MappingProxyType({name: NumericFunction(signature, self._declared) for name, signature in found})

    @property
    def tasks(self) -> Mapping[str, Task]:
        """The declared compound tasks and actions by name."""
        declared = self._declared
        found = {name: Task(signature, False, declared) for name, signature in declared.tasks.items()}
        for name, action in declared.actions.items():
            found[name] = Task(Signature(name, action.parameters), True, declared)
        return MappingProxyType(found)

    def _domain(self) -> Domain:
        """Return the domain as it is now."""
        declared = self._declared
        return Domain(
            self.domain_name,
            TypeHierarchy(dict(declared.parents)),
            dict(declared.constants),
            dict(declared.predicates),
            dict(declared.functions),
            dict(declared.tasks),
            dict(declared.actions),
            dict(declared.methods),
        )


def without_costs(action: Action) -> Action:
    """Return an action without any cost, in its outcomes, too."""
    blocks = tuple(
        replace(block, outcomes=tuple(replace(outcome, costs=()) for outcome in block.outcomes))
        for block in action.outcomes
    )
    return replace(action, costs=(), outcomes=blocks)


def declared_in(domain: Domain) -> Declarations:
    """Return all that a domain declares, to build upon."""
    return Declarations(
        Named(domain.types.parents),
        Named(domain.constants),
        Named(),
        Named(domain.predicates),
        Named(domain.functions),
        Named(domain.tasks),
        Named(domain.actions),
        Named(domain.methods),
    )
