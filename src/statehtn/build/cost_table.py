"""Costs by action and arguments, for a domain that is left as it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, count

from statehtn.counted import with_article
from statehtn.errors import InputError, UnsupportedError
from statehtn.hddl.diagnostics import unknown
from statehtn.hddl.spelling import Spellings
from statehtn.model import (
    Action,
    And,
    CostBlock,
    CostDistribution,
    CostLaw,
    Domain,
    Equals,
    Fact,
    Formula,
    Not,
    OutcomeBlock,
    Problem,
    Signature,
)
from statehtn.model.chance import MOST_SCENARIOS, Chance, Outcome, scenario_count, too_many
from statehtn.model.cost.blocks import NO_COST, block_of
from statehtn.model.expect import expect_problem
from statehtn.model.formula import TRUE

ANY = "*"


@dataclass(frozen=True, slots=True)
class CostEntry:
    """The law of an action's cost, for all instances or for some.

    Args:
        place: the file and the number of the entry, for messages.
        action: the action's name, in any case.
        arguments: an object for each parameter, in any case, or `*` for any; None for all instances.
        law: of the cost.
        by_day: instead of it the cost on each observed day.
    """

    place: str
    action: str
    arguments: tuple[str, ...] | None
    law: CostLaw = NO_COST
    by_day: tuple[CostLaw, ...] = ()

    def block(self, days: Sequence[Fact]) -> CostBlock:
        """Return the cost, where each of the hidden facts stands for a day."""
        return CostBlock((), cases=dict(zip(days, self.by_day, strict=True))) if self.by_day else block_of(self.law)

    def covers(self, other: CostEntry) -> bool:
        """Tell whether every instance that the other entry is about is one of this entry's, too."""
        pairs = zip(self.arguments or (), other.arguments or (), strict=False)
        return self.arguments is None or (
            all(mine == ANY for mine in self.arguments)
            or (other.arguments is not None and all(mine in (ANY, its) for mine, its in pairs))
        )

    def overlaps(self, other: CostEntry) -> bool:
        """Tell whether there may be an instance that both entries are about."""
        pairs = zip(self.arguments or (), other.arguments or (), strict=False)
        return all(mine == its or ANY in (mine, its) for mine, its in pairs)

    def condition(self, action: Action) -> Formula:
        """Return the condition on the action's parameters under which this entry is meant."""
        fixed = tuple(
            Equals(parameter.name, name)
            for parameter, name in zip(action.parameters, self.arguments or (), strict=False)
            if name != ANY
        )
        return TRUE if not fixed else fixed[0] if len(fixed) == 1 else And(fixed)


@dataclass(frozen=True, slots=True)
class Days:
    """Costs that were observed together.

    Args:
        place: the file, for messages.
        names: of the days.
        entries: for each instance its cost on each of them.
    """

    place: str
    names: tuple[str, ...]
    entries: tuple[CostEntry, ...]


@dataclass(frozen=True, slots=True, repr=False)
class CostTable:
    """Laws of costs by action and arguments; `statehtn.read_costs` reads one from a file.

    Args:
        entries: the laws, in the file's order: of several for one instance the first one counts.
        files: the names of the files with samples that were read for them.
        days: costs that were observed together; they count before the others.
    """

    entries: tuple[CostEntry, ...]
    files: tuple[str, ...] = ()
    days: Days | None = None

    def __repr__(self) -> str:
        days = "" if self.days is None else f", {len(self.days.entries)} columns of {len(self.days.names)} days"
        return f"<cost table: {len(self.entries)} entries{days}>"

    def apply(self, problem: Problem) -> Problem:
        """Return a problem in which actions cost what the entries say; the problem that is given stays as it is.

        Of several entries for an instance the first one counts. It replaces the whole cost of the action. Instances and
        actions without an entry keep their cost; that is 1 in a domain that states no cost at all.

        Raises:
            InputError: there is no such action or object, arguments do not fit the parameters, or an entry can never
                count; the message names the entry.
        """
        domain = expect_problem(problem).domain
        by_action: dict[str, list[CostEntry]] = {}
        names = Spellings(domain.actions), Spellings(problem.all_objects)
        facts: list[Fact] = []
        if self.days is not None:
            facts = _facts_of(self.days, domain)
            problem = _with_days(problem, self.days, facts)
            domain = problem.domain
        for given in (*(self.days.entries if self.days else ()), *self.entries):
            entry = _as_declared(given, *names)
            _check(entry, problem, by_action.setdefault(entry.action, []))
            by_action[entry.action].append(entry)
        unit = (block_of(CostDistribution.certain(1)),) if domain.has_unit_costs else None
        actions = {}
        for name, action in domain.actions.items():
            old = action.costs if unit is None else unit
            entries = by_action.get(name, [])
            costs = _blocks(action, entries, old, facts)
            actions[name] = replace(action, costs=costs, outcomes=_outcomes(action, entries))
        return replace(problem, domain=replace(domain, actions=actions)) if by_action else problem


def _facts_of(days: Days, domain: Domain) -> list[Fact]:
    """Return a hidden fact for each day, of predicates that the domain does not have."""
    taken = Spellings(domain.predicates)
    for prefix in chain(("day",), (f"day{n}" for n in count(2))):
        names = [f"{prefix}-{number}" for number in range(1, len(days.names) + 1)]
        if taken.has_none_of(names):
            break
    return [(name,) for name in names]


def _with_days(problem: Problem, days: Days, facts: Sequence[Fact]) -> Problem:
    """Return a problem in which one of the days is chosen by chance."""
    weight = Fraction(1, len(facts))
    chance = Chance(tuple(Outcome(weight, frozenset({fact}), day) for fact, day in zip(facts, days.names, strict=True)))
    chances = (*problem.chances, chance)
    if (number := scenario_count(chances)) > MOST_SCENARIOS:
        raise UnsupportedError(f"{days.place}: together with the hidden facts, {too_many(number)}")
    predicates = {**problem.domain.predicates, **{name: Signature(name) for (name,) in facts}}
    return replace(problem, domain=replace(problem.domain, predicates=predicates), chances=chances)


def _as_declared(entry: CostEntry, actions: Spellings, objects: Spellings) -> CostEntry:
    """Return an entry with names as they are spelt in the problem; those that it does not know stay as they are."""
    arguments = entry.arguments
    if arguments is not None:
        arguments = tuple(objects.find(name) or name for name in arguments)
    return replace(entry, action=actions.find(entry.action) or entry.action, arguments=arguments)


def _check(entry: CostEntry, problem: Problem, before: list[CostEntry]) -> None:
    action = problem.domain.actions.get(entry.action)
    if action is None:
        raise InputError(f"{entry.place}: 'action': {unknown('action', entry.action, problem.domain.actions)}")
    if entry.arguments is not None:
        if len(entry.arguments) != len(action.parameters):
            parameters = " ".join(map(str, action.parameters))
            raise InputError(
                f"{entry.place}: 'arguments': expected {len(action.parameters)} for ({entry.action}"
                f"{' ' + parameters if parameters else ''}), found {len(entry.arguments)}"
            )
        for name, parameter in zip(entry.arguments, action.parameters, strict=True):
            if name == ANY:
                continue
            if name not in problem.all_objects:
                raise InputError(f"{entry.place}: 'arguments': {unknown('object', name, problem.all_objects)}")
            if name not in problem.objects_of(parameter.types):
                kind = problem.all_objects[name]
                raise InputError(
                    f"{entry.place}: 'arguments': expected {parameter}, found '{name}', {with_article(kind)}"
                )
    for earlier in before:
        if earlier.covers(entry):
            raise InputError(
                f"{entry.place}: it never counts, as {earlier.place.rpartition(': ')[2]} says the cost of the same "
                f"instances before; put what is more special first"
            )


def _blocks(
    action: Action, entries: list[CostEntry], old: tuple[CostBlock, ...], days: Sequence[Fact]
) -> tuple[CostBlock, ...]:
    """Return the cost of an action: what the entries say, and its old cost for instances without an entry."""
    found = []
    for number, entry in enumerate(entries):
        others = [earlier for earlier in entries[:number] if earlier.overlaps(entry)]
        condition = _joined(entry.condition(action), action, others)
        found.append(replace(entry.block(days), condition=condition))
    if any(entry.condition(action) == TRUE for entry in entries):
        return tuple(found)
    return (*found, *(replace(block, condition=_joined(block.condition, action, entries)) for block in old))


def _outcomes(action: Action, entries: list[CostEntry]) -> tuple[OutcomeBlock, ...]:
    """Return an action's outcomes, with their old costs for instances without an entry: it says the whole cost."""
    is_all = any(entry.condition(action) == TRUE for entry in entries)

    def costs(old: tuple[CostBlock, ...]) -> tuple[CostBlock, ...]:
        return tuple(
            replace(cost, condition=_joined(cost.condition, action, entries)) for cost in (() if is_all else old)
        )

    return (
        tuple(
            replace(block, outcomes=tuple(replace(outcome, costs=costs(outcome.costs)) for outcome in block.outcomes))
            for block in (action.outcomes if entries else ())
        )
        or action.outcomes
    )


def _joined(condition: Formula, action: Action, others: list[CostEntry]) -> Formula:
    """Return a condition where none of the other entries is meant."""
    parts = condition.operands if isinstance(condition, And) else (condition,)
    parts = (*parts, *(Not(other.condition(action)) for other in others))
    return parts[0] if len(parts) == 1 else And(parts)
