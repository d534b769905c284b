"""The order of steps and the places of method preconditions, on random decompositions, against brute force.

The steps switch two facts; the oracle tries every place of every method precondition against every pair of ordered
items.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field

from hypothesis import given
from hypothesis import strategies as st

from statehtn.model import (
    TRUE,
    Action,
    Atom,
    Decomposition,
    Domain,
    Effect,
    Formula,
    Method,
    Not,
    Plan,
    Problem,
    Signature,
    Step,
    Subtask,
    TaskNetwork,
)
from statehtn.validation import validate

FACTS = ("f", "g")
SWITCHES = {"set-f": ("f", True), "clear-f": ("f", False), "set-g": ("g", True), "clear-g": ("g", False)}


@dataclass
class Tree:
    """A network in a decomposition; its children are step numbers or trees."""

    precondition: Formula = TRUE
    children: list[int | Tree] = field(default_factory=list)
    ordering: list[tuple[int, int]] = field(default_factory=list)

    def items(self) -> Iterator[int | Tree]:
        """Yield this network (as its precondition) and all networks and steps below it."""
        yield self
        for child in self.children:
            yield from child.items() if isinstance(child, Tree) else (child,)


@st.composite
def derivations(draw: st.DrawFn) -> tuple[Tree, list[str]]:
    literals = [Atom(fact) for fact in FACTS] + [Not(Atom(fact)) for fact in FACTS]
    kinds = draw(st.lists(st.sampled_from(["step", "network"]), min_size=1, max_size=7))
    trees = [Tree()]
    step_count = 0
    for kind in kinds:
        parent = trees[draw(st.integers(0, len(trees) - 1))]
        if kind == "step" and step_count < 4:
            parent.children.append(step_count)
            step_count += 1
        elif len(trees) < 5:
            trees.append(Tree(draw(st.sampled_from([TRUE, *literals]))))
            parent.children.append(trees[-1])
    for tree in trees:
        pairs = list(itertools.combinations(range(len(tree.children)), 2))
        tree.ordering = draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []
    positions = draw(st.permutations(range(step_count)))
    for tree in trees:
        tree.children = [positions[child] if isinstance(child, int) else child for child in tree.children]
    return trees[0], [draw(st.sampled_from(list(SWITCHES))) for _ in range(step_count)]


def as_problem(root: Tree, actions: list[str]) -> tuple[Problem, Plan]:
    methods: dict[str, Method] = {}

    def lifted(tree: Tree) -> tuple[TaskNetwork, tuple[int | Decomposition, ...]]:
        names, children = [], []
        for child in tree.children:
            if isinstance(child, int):
                names.append(actions[child])
                children.append(child)
            else:
                below, nodes = lifted(child)
                name = f"n{len(methods)}"
                methods[name] = Method(name, (), name, (), below, child.precondition)
                names.append(name)
                children.append(Decomposition(name, (), name, nodes))
        subtasks = tuple(Subtask(f"t{index}", name) for index, name in enumerate(names))
        return TaskNetwork(subtasks, tuple(tree.ordering)), tuple(children)

    initial_network, roots = lifted(root)
    domain = Domain(
        "d",
        tasks={name: Signature(name) for name in methods},
        actions={
            name: Action(name, effects=(Effect(Atom(fact), positive),)) for name, (fact, positive) in SWITCHES.items()
        },
        methods=methods,
    )
    return Problem("p", domain, network=initial_network), Plan(tuple(map(Step, actions)), roots)


def can_be_placed(root: Tree, actions: list[str]) -> bool:
    """Try every place of every precondition against every pair of ordered items."""
    states: list[set[str]] = [set()]
    for name in actions:
        fact, positive = SWITCHES[name]
        states.append(states[-1] | {fact} if positive else states[-1] - {fact})

    def true(formula: Formula, state: set[str]) -> bool:
        if isinstance(formula, Not):
            return not true(formula.operand, state)
        return formula.predicate in state if isinstance(formula, Atom) else True

    trees = [item for item in root.items() if isinstance(item, Tree)]
    ordered: list[tuple[int | Tree, int | Tree]] = []
    for tree in trees:
        ordered += [(tree, item) for item in list(tree.items())[1:]]
        closure = set(tree.ordering)
        for k, i, j in itertools.product(range(len(tree.children)), repeat=3):
            if (i, k) in closure and (k, j) in closure:
                closure.add((i, j))
        below = [list(child.items()) if isinstance(child, Tree) else [child] for child in tree.children]
        ordered += [pair for i, j in closure for pair in itertools.product(below[i], below[j])]
    places = [[time for time, state in enumerate(states) if true(tree.precondition, state)] for tree in trees]
    for times in itertools.product(*places):
        # A step k runs from state k to state k + 1; a precondition is a point.
        start = {id(tree): time for tree, time in zip(trees, times, strict=True)}
        if all(
            (first + 1 if isinstance(first, int) else start[id(first)])
            <= (second if isinstance(second, int) else start[id(second)])
            for first, second in ordered
        ):
            return True
    return False


@given(derivations())
def test_ordering_and_method_preconditions_agree_with_brute_force(derivation: tuple[Tree, list[str]]) -> None:
    problem, plan = as_problem(*derivation)
    assert validate(problem, plan).valid == can_be_placed(*derivation)
