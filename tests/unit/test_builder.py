"""The builder: what it makes, and what it says at the line that is wrong."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest

import statehtn
from statehtn import CostDistribution, ProblemBuilder, UsageError, chance, equal, exists, forall, when
from statehtn.build import Object, Type
from statehtn.model import And, Arithmetic, Atom, Equals, Forall, FunctionTerm, Not, Number, Or, Parameter


class Deliveries:
    """A small domain that the tests add to."""

    def __init__(self) -> None:
        self.build = build = ProblemBuilder("p", domain="deliveries")
        self.place, self.vehicle = build.type("place"), build.type("vehicle")
        self.truck = build.type("truck", above=self.vehicle)
        self.train = build.type("train", above=self.vehicle)
        self.v, (self.a, self.b) = self.vehicle.variable("v"), self.place.variables("a", "b")
        self.at = build.predicate("at", self.v, self.a)
        self.icy = build.predicate("icy", self.b)
        self.closed = build.predicate("closed")
        self.hours = build.function("hours", self.a, self.b)
        self.go = build.task("go", self.v, self.b)
        self.home, self.work = self.place.objects("home", "work")
        (self.t1,) = self.truck.objects("t1")

    def drive(self, **changes: Any) -> statehtn.build.Task:
        v, a, b = self.v, self.a, self.b
        arguments: dict[str, Any] = {
            "parameters": [v, a, b],
            "precondition": self.at(v, a) & ~self.closed() & ~equal(a, b),
            "effects": [~self.at(v, a), self.at(v, b)],
            "cost": self.hours(a, b),
        }
        return self.build.action("drive", **{**arguments, **changes})


@pytest.fixture
def d() -> Deliveries:
    return Deliveries()


def test_a_problem_is_planned_written_and_read(d: Deliveries) -> None:
    v, a, b = d.v, d.a, d.b
    drive = d.drive(cost=[d.hours(a, b), when(d.icy(b), chance((0.5, 0), (0.5, 3)))])
    wait = d.build.action("wait", effects=forall([b], ~d.icy(b)), cost=1)
    d.build.method("now", d.go(v, b), drive(v, a, b), parameters=[v, a, b])
    d.build.method("later", d.go(v, b), [wait(), drive(v, a, b)], parameters=[v, a, b])
    d.build.initially(d.at("t1", d.home), d.icy(d.work))
    d.build.set_values({d.hours(d.home, d.work): 2})
    d.build.set_network(d.go(d.t1, d.work))
    d.build.set_goal(d.at(d.t1, d.work))
    problem = d.build.build()

    bold, careful = statehtn.plan(problem), statehtn.plan(problem, attitude="averse", alpha=2)
    assert (bold.risk_cost, [step.step.action for step in bold.steps]) == (3.0, ["wait", "drive"])
    assert [step.step.action for step in careful.steps] == ["wait", "drive"]
    seeking = statehtn.plan(problem, attitude="seeking", alpha=2)
    assert [str(step.step) for step in seeking.steps] == ["(drive t1 home work)"]
    assert statehtn.read_hddl_text(*statehtn.write_hddl(problem), strict=True) == problem
    assert seeking.plan is not None
    assert statehtn.validate(problem, seeking.plan)


def test_what_was_built_stays_as_it_is(d: Deliveries) -> None:
    d.build.set_network(d.go(d.t1, d.work))
    first = d.build.build()
    d.build.initially(d.closed())
    d.place.objects("depot")
    second = d.build.build()
    assert (len(first.initial_state), len(second.initial_state)) == (0, 1)
    assert "depot" not in first.objects
    assert first != second


def test_a_second_problem_in_the_same_domain(d: Deliveries) -> None:
    d.drive()
    d.build.set_network(d.go(d.t1, d.work))
    first = d.build.build()
    second = ProblemBuilder("p2", domain=first.domain)
    second.types["truck"].objects("t9")
    second.types["place"].objects("x")
    second.set_network(second.tasks["go"]("t9", "x"))
    second.initially(second.predicates["at"](second.objects["t9"], "x"))
    assert second.build().domain == first.domain
    assert second.build().objects == {"t9": "truck", "x": "place"}


def test_orders_of_networks(d: Deliveries) -> None:
    v, b = d.v, d.b
    first, second, third = d.go(v, b), d.go(v, b), d.go(v, b, label="last")
    tasks = [first, second, third]

    def ordering(**given: Any) -> tuple[tuple[int, int], ...]:
        d.build.set_network(tasks, parameters=[v, b], **given)
        return d.build.build().network.ordering

    assert ordering() == ((0, 1), (1, 2))
    assert ordering(ordering=()) == ()
    assert ordering(ordering=[(second, first), (first, "last")]) == ((1, 0), (0, 2))
    assert [subtask.label for subtask in d.build.build().network.subtasks] == ["task0", "task1", "last"]
    with pytest.raises(UsageError, match="the ordering is cyclic"):
        ordering(ordering=[(first, second), (second, first)])
    with pytest.raises(UsageError, match="stands more than once in this network; give it a label"):
        ordering(ordering=[(d.go(v, b), "last")])
    with pytest.raises(UsageError, match="unknown label 'lst'; did you mean 'last'"):
        ordering(ordering=[("lst", first)])


def test_formulas_combine_by_operators(d: Deliveries) -> None:
    p, q, r = d.closed(), d.icy(d.home), d.icy(d.work)
    assert p & q & r == And((p, q, r)) == p & (q & r)
    assert p | q | r == Or((p, q, r))
    assert ~(p & q) | r == Or((Not(And((p, q))), r))
    assert equal(d.a, "home") == Equals("?a", "home")
    assert forall(d.b, d.icy(d.b)) == Forall((d.b,), Atom("icy", ("?b",)))
    with pytest.raises(UsageError, match="combine formulas by &, | and ~"):
        bool(p)


def test_expressions_compute_exactly(d: Deliveries) -> None:
    hours = d.hours(d.home, d.work)
    assert 1 - hours == Arithmetic("-", (Number(Fraction(1)), hours))
    assert hours * 0.1 + Decimal("0.2") == Arithmetic(
        "+", (Arithmetic("*", (hours, Number(Fraction(1, 10)))), Number(Fraction(1, 5)))
    )
    assert -hours == Arithmetic("-", (hours,))
    with pytest.raises(UsageError, match="expected a number, found 'x'"):
        hours + "x"
    with pytest.raises(UsageError, match="expected a finite number, found nan"):
        hours + float("nan")


def test_all_kinds_of_costs(d: Deliveries) -> None:
    v, a, b = d.v, d.a, d.b
    d.drive(
        cost=[
            3,
            Fraction(1, 3),
            CostDistribution.of([(0.25, 1), (0.75, 2)]),
            when(d.icy(a), when(d.icy(b), 1)),
            forall([d.place.variable("c")], when(d.icy(d.place.variable("c")), d.hours(d.place.variable("c"), b))),
        ]
    )
    blocks = d.build.tasks["drive"]._declarations.actions["drive"].costs
    assert [len(block.branches) for block in blocks] == [1, 1, 2, 1, 1]
    assert blocks[3].condition == And((Atom("icy", ("?a",)), Atom("icy", ("?b",))))
    assert blocks[4].parameters == (Parameter("?c", ("place",)),)
    assert blocks[4].branches[0][1] == FunctionTerm("hours", ("?c", "?b"))
    assert v.types == ("vehicle",)


def test_reprs_read(d: Deliveries) -> None:
    drive = d.drive()
    assert repr(d.truck) == "<type truck>"
    assert repr(d.truck | d.train) == "<type truck | train>"
    assert repr(d.at) == "<predicate (at ?v - vehicle ?a - place)>"
    assert repr(d.hours) == "<function (hours ?a - place ?b - place)>"
    assert repr(d.go) == "<task (go ?v - vehicle ?b - place)>"
    assert repr(drive) == "<action (drive ?v - vehicle ?a - place ?b - place)>"
    assert str(drive("t1", d.home, d.b)) == "(drive t1 home ?b)"
    assert "objects 3" in repr(d.build)
    assert d.home == Object("home", "place")


WRONG: list[tuple[Callable[[Deliveries], object], str]] = [
    # names
    (lambda d: d.build.type("place"), "there is a type 'place' already"),
    (lambda d: d.build.type("object"), "there is a type 'object' already"),
    (lambda d: d.build.predicate("At"), "there is a predicate 'at' already, and 'At' differs in case only"),
    (lambda d: d.build.action("GO"), "there is a task 'go' already, and 'GO' differs in case only"),
    (lambda d: d.place.objects("X", "x"), "there is an object 'X' already, and 'x' differs in case only"),
    (lambda d: d.build.type("Object"), "there is a type 'object' already"),
    (lambda d: d.build.predicate("AND"), "is no word of HDDL such as 'and'"),
    (lambda d: d.build.predicate("and"), "is no word of HDDL such as 'and'"),
    (lambda d: d.build.task("a b"), "a name has no spaces"),
    (lambda d: d.build.task("a(b"), "a name has no spaces, parentheses"),
    (lambda d: d.build.predicate(3), "the name of a predicate must be a string, found 3"),
    (lambda d: d.build.action("go"), "there is a task 'go' already"),
    (lambda d: d.build.function("total-cost"), "there is a function 'total-cost' already"),
    (lambda d: d.place.objects("x", "x"), "there is an object 'x' already"),
    (lambda d: d.place.constants("home"), "there is an object 'home' already"),
    (lambda d: (d.truck | d.train).objects("x"), "an object has one type, not a union such as truck | train"),
    (lambda d: d.build.type("t", above="place"), "a supertype is a type that type() has returned"),
    # arguments
    (lambda d: d.at(d.t1), "predicate 'at' takes 2 arguments, found 1 (declared with ?v - vehicle ?a - place)"),
    (lambda d: d.closed(d.t1), "predicate 'closed' takes no arguments, found 1"),
    (lambda d: d.at(d.home, d.t1), "object 'home' is of type 'place', but predicate 'at' expects 'vehicle' for '?v'"),
    (lambda d: d.at(d.v, d.v), "variable '?v' is of type 'vehicle', but predicate 'at' expects 'place' for '?a'"),
    (lambda d: d.at(d.t1, "homee"), "unknown object 'homee'; did you mean 'home'?"),
    (lambda d: d.at("?v", d.home), "a variable needs a type: use Type.variables('v') instead of '?v'"),
    (lambda d: d.at(7, d.home), "expected a variable, an object or the name of an object, found 7"),
    (lambda d: d.icy(Object("mars", "place")), "object 'mars' of type 'place' is not declared in this builder"),
    (lambda d: d.go(d.t1), "task 'go' takes 2 arguments, found 1"),
    (lambda d: Type(("x",), d.build._declared).objects("y") and d.icy("y"), "object 'y' is of type 'x'"),
    # actions
    (lambda d: d.build.action("x", [d.a, d.a]), "variable '?a' stands twice in one list"),
    (lambda d: d.build.action("x", ["?a"]), "expected a variable such as Type.variables() makes, found '?a'"),
    (
        lambda d: d.build.action("x", precondition=d.icy(d.b)),
        "variable '?b' is not one of the parameters, as there are",
    ),
    (
        lambda d: d.build.action("x", [d.truck.variable("b")], precondition=d.icy(d.b)),
        "variable '?b' is of type 'truck', but predicate 'icy' expects 'place'",
    ),
    (lambda d: d.build.action("x", precondition=d.a == d.b), "'precondition' must be a formula, found False"),
    (
        lambda d: d.build.action("x", precondition=d.closed),
        "'precondition' must be a formula, found <predicate (closed)>",
    ),
    (lambda d: d.build.action("x", effects=[d.closed() | d.closed()]), "an effect is an atom such as at(x), or ~at(x)"),
    (lambda d: d.build.action("x", effects=[d.closed]), "an effect is an atom such as at(x)"),
    (lambda d: d.drive(effects=forall(d.b, d.icy(d.b))), "variable '?b' of 'forall' is a variable around it, too"),
    (
        lambda d: d.build.action("x", effects=d.icy(d.home)),
        "'home' is an object of the problem; a domain names constants",
    ),
    (lambda d: when(d.closed()), "'when' has a condition and what is due under it, found the condition alone"),
    (lambda d: d.build.action("x", 5), "expected variables such as Type.variables() makes, found 5"),
    (lambda d: d.build.action("x", cost={1: 2}), "a cost is a number"),
    (lambda d: d.build.set_network(None), "expected a task with its arguments, such as drive(a, b), found None"),
    (lambda d: d.build.set_values(3), "expected a mapping such as {fare(a, b): 4}, found 3"),
    (lambda d: when(True, d.closed()), "the condition of 'when' must be a formula, found True"),
    # costs
    (lambda d: d.drive(cost=-1), "a cost must not be negative, found -1"),
    (lambda d: d.drive(cost="3"), "a cost is a number, a CostDistribution, an expression of functions, chance(...)"),
    (lambda d: d.drive(cost=True), "a cost is a number"),
    (lambda d: d.drive(cost=float("inf")), "expected a finite number, found inf"),
    (
        lambda d: d.drive(cost=d.hours(d.a, d.place.variable("c"))),
        "variable '?c' is not one of the parameters (?v - veh",
    ),
    (
        lambda d: d.drive(cost=divmod),
        "called with its arguments (?v ?a ?b), but 'divmod' takes (x, y, /",
    ),
    (lambda _: chance((0.5, 1), (0.4, 2)), "the probabilities of a cost must sum to 1, found 0.9"),
    (lambda d: chance((d.hours("home", "work"), 1), (1.4, 2)), "must sum to 1, found 1.4"),
    (lambda _: chance((-0.5, 1), (1.5, 2)), "a probability must not be negative, found -0.5"),
    (lambda _: chance(3), "expected a pair (probability, cost), found 3"),
    (lambda _: chance(), "expected pairs (probability, cost), found none"),
    # methods and networks
    (lambda d: d.build.method("m", d.go), "method 'm' must say what it decomposes, such as travel(here, to)"),
    (lambda d: d.build.method("m", d.drive()(d.v, d.a, d.b)), "cannot decompose 'drive', which is an action"),
    (lambda d: d.build.method("m", d.go(d.v, d.b), [d.drive()(d.v, d.a, d.b)]), "variable '?a - place' is not one of"),
    (lambda d: d.build.method("m", d.go(d.v, d.b), [d.go]), "expected a task with its arguments, such as drive(a, b)"),
    (lambda d: d.build.method("m", d.go(d.v, d.b), d.go(d.t1, d.b)), "'t1' is an object of the problem"),
    (
        lambda d: d.build.method("m", d.go(d.v, d.b), constraints=d.icy(d.b)),
        "a constraint speaks of variables only (equal() and OfType), found (icy ?b)",
    ),
    (lambda d: d.build.set_network(d.go(d.t1, d.work), ordering="partial"), "an ordering is 'total' or pairs"),
    (lambda d: d.build.set_network(d.go(d.t1, d.work, label="a b")), "'a b' cannot name a label"),
    (lambda d: d.build.set_network([d.go(d.t1, d.work, label="x")] * 2), "label 'x' stands twice in one network"),
    (lambda d: d.build.set_network([d.go(d.t1, d.b)]), "variable '?b - place' is not one of the parameters"),
    (lambda d: d.build.build(), "problem 'p' has nothing to do yet: give it tasks by set_network(...)"),
    # the initial state
    (lambda d: d.build.initially(~d.closed()), "a fact is an atom such as at(l1), found Not("),
    (lambda d: d.build.initially(d.icy(d.b)), "variable '?b' is not one of the parameters, as there are none"),
    (lambda d: d.build.set_values({d.hours(d.home, d.work): "3"}), "expected a number, found '3'"),
    (lambda d: d.build.set_goal(exists([d.b], d.icy(d.a))), "variable '?a' is not one of the parameters (?b - place)"),
    (lambda d: d.build.set_cost("drvie", 1), "unknown action 'drvie'"),
]


@pytest.mark.parametrize(("wrong", "message"), WRONG, ids=range(len(WRONG)))
def test_what_is_wrong_is_told_where_it_is_wrong(
    d: Deliveries, wrong: Callable[[Deliveries], object], message: str
) -> None:
    with pytest.raises(UsageError, match=re.escape(message)):
        wrong(d)


def test_a_refused_call_changes_nothing(d: Deliveries) -> None:
    d.build.set_network(d.go(d.t1, d.work))
    before = d.build.build()
    with pytest.raises(UsageError):
        d.drive(cost=-1)
    with pytest.raises(UsageError):
        d.build.initially(d.closed(), d.icy(d.b))
    with pytest.raises(UsageError):
        d.build.set_values({d.hours(d.home, d.work): 1, d.hours(d.work, d.home): float("nan")})
    assert d.build.build() == before
