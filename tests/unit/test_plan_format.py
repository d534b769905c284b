"""Plans in the IPC 2020 format: written, read back, as other planners print them, and malformed."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from statehtn.errors import InputError
from statehtn.hddl.plan_format import read_plan, write_plan
from statehtn.model import (
    Action,
    Atom,
    Decomposition,
    Domain,
    Method,
    Not,
    Parameter,
    Plan,
    Problem,
    Signature,
    Step,
    Subtask,
    TaskNetwork,
)
from statehtn.validation import validate

X = (Parameter("?x"),)
XY = (Parameter("?x"), Parameter("?y"))


def network(*tasks: str, ordering: tuple[tuple[int, int], ...] = ()) -> TaskNetwork:
    subtasks = tuple(Subtask(f"t{i}", name, tuple(terms)) for i, (name, *terms) in enumerate(map(str.split, tasks)))
    return TaskNetwork(subtasks, ordering)


DOMAIN = Domain(
    "errands",
    actions={name: Action(name, X) for name in ("fetch", "bring", "rest")},
    tasks={"errand": Signature("errand", X), "pause": Signature("pause", X), "day": Signature("day")},
    methods={
        method.name: method
        for method in (
            Method("do-it", X, "errand", ("?x",), network("fetch ?x", "bring ?x", ordering=((0, 1),))),
            Method("two", XY, "day", (), network("errand ?x", "pause ?x", "errand ?y", ordering=((0, 1), (1, 2)))),
            Method("any", XY, "day", (), network("errand ?x", "errand ?y", "rest ?y")),
            Method("backwards", X, "errand", ("?x",), network("bring ?x", "fetch ?x", ordering=((1, 0),))),
            Method("none", X, "pause", ("?x",)),
        )
    },
)
PROBLEM = Problem("p", DOMAIN, {"a": "object", "b": "object"}, network=network("day", "rest a", ordering=((0, 1),)))


def errand(name: str, fetch: int, bring: int) -> Decomposition:
    return Decomposition("errand", (name,), "do-it", (fetch, bring))


STEPS = (
    Step("fetch", ("a",)),
    Step("bring", ("a",)),
    Step("fetch", ("b",)),
    Step("bring", ("b",)),
    Step("rest", ("a",)),
)
PAUSE = Decomposition("pause", ("a",), "none")
DAY = Decomposition("day", (), "two", (errand("a", 0, 1), PAUSE, errand("b", 2, 3)))
PLAN = Plan(STEPS, (DAY, 4))
TEXT = """==>
0 fetch a
1 bring a
2 fetch b
3 bring b
4 rest a
root 5 4
5 day -> two 6 7 8
6 errand a -> do-it 0 1
7 pause a -> none
8 errand b -> do-it 2 3
<==
"""


def test_writing_and_reading_back() -> None:
    assert validate(PROBLEM, PLAN)
    assert write_plan(PLAN, PROBLEM) == TEXT
    assert read_plan(TEXT, PROBLEM) == PLAN


def test_subtasks_are_written_in_an_order_that_the_network_allows() -> None:
    problem = replace(PROBLEM, network=network("errand a"))
    backwards = Plan(STEPS[:2], (Decomposition("errand", ("a",), "backwards", (1, 0)),))
    text = write_plan(backwards, problem)
    assert "2 errand a -> backwards 0 1\n" in text
    assert read_plan(text, problem) == backwards
    assert validate(problem, backwards)


def test_an_empty_plan() -> None:
    problem = Problem("p", DOMAIN)
    assert write_plan(Plan(), problem) == "==>\nroot\n<==\n"
    assert read_plan("==>\nroot\n<==\n", problem) == Plan()


def test_plans_of_other_planners() -> None:
    """Brackets, other letters, any numbers, any order of lines and subtasks, an artificial root, text around it."""
    text = """Searching ... done in 0.1 s
    - Status: Solved
    ==>
      70 (Fetch a)
    30 BRING[a]
    9 fetch b

    2 bring b
    400 rest a
    root 1000
    5 ERRAND b -> Do-It 2 9
    12 errand(a) -> do-it 30 70
    1000 __top -> __top_method 400 50
    50 day -> two 12 5 13
    13 pause a -> none
    <==
    8 goodbye
    """
    assert read_plan(text, PROBLEM) == PLAN


def test_the_last_line_may_be_missing() -> None:
    assert read_plan(TEXT.replace("<==\n", ""), PROBLEM) == PLAN


def test_equal_subtasks_are_matched_by_the_order_of_their_steps() -> None:
    domain = replace(
        DOMAIN, methods={**DOMAIN.methods, "two": replace(DOMAIN.methods["two"], network=network(
            "errand ?x", "errand ?x", "pause ?y", ordering=((0, 2), (2, 1))))}
    )  # fmt: skip
    problem = replace(PROBLEM, domain=domain, network=network("day"))
    text = (
        "==>\n0 fetch a\n1 bring a\n2 fetch a\n3 bring a\nroot 4\n4 day -> two 5 6 7\n"
        "5 errand a -> do-it 2 3\n6 errand a -> do-it 0 1\n7 pause b -> none\n<==\n"
    )
    plan = read_plan(text, problem)
    assert isinstance(plan.roots[0], Decomposition)
    assert plan.roots[0].children == (errand("a", 0, 1), errand("a", 2, 3), replace(PAUSE, arguments=("b",)))
    assert validate(problem, plan)


def test_many_equal_subtasks_in_reverse_order() -> None:
    count = 300
    problem = replace(
        PROBLEM, network=network(*["rest a"] * count, ordering=tuple((i, i + 1) for i in range(count - 1)))
    )
    lines = [f"{number} rest a" for number in range(count)]
    text = "\n".join(["==>", *lines, f"root {' '.join(map(str, reversed(range(count))))}", "<=="])
    assert read_plan(text, problem).roots == tuple(range(count))


def test_arguments_decide_which_subtask_is_which() -> None:
    problem = replace(PROBLEM, network=network("day"))
    plan = Plan(
        (STEPS[2], STEPS[0], Step("rest", ("b",)), STEPS[1], STEPS[3]),
        (Decomposition("day", (), "any", (errand("a", 1, 3), errand("b", 0, 4), 2)),),
    )
    assert validate(problem, plan)
    text = write_plan(plan, problem)
    assert "5 day -> any 6 7 2\n" in text
    shuffled = text.replace("any 6 7 2", "any 2 7 6")
    assert read_plan(shuffled, problem) == plan


def test_what_does_not_match_keeps_the_order_of_the_file() -> None:
    wrong = TEXT.replace("6 errand a -> do-it 0 1", "6 errand a -> do-it 1 2")
    plan = read_plan(wrong.replace("8 errand b -> do-it 2 3", "8 errand b -> do-it 3 0"), PROBLEM)
    assert isinstance(plan.roots[0], Decomposition)
    assert plan.roots[0].children == (errand("a", 1, 2), PAUSE, errand("b", 3, 0))
    assert not validate(PROBLEM, plan)


def test_a_wrong_order_of_steps_is_left_to_the_validator() -> None:
    swapped = TEXT.replace("0 fetch a\n1 bring a", "1 bring a\n0 fetch a")
    plan = read_plan(swapped, PROBLEM)
    assert plan.roots == (replace(DAY, children=(errand("a", 1, 0), *DAY.children[1:])), 4)
    assert "must come after" in validate(PROBLEM, plan).reasons[0]


def test_unknown_names_are_left_to_the_validator() -> None:
    for name in ("fetch", "errand", "do-it", "day"):
        plan = read_plan(TEXT.replace(name, "dance"), PROBLEM)
        assert "dance" in "\n".join(validate(PROBLEM, plan).reasons)


def test_bindings_of_a_parametrised_initial_network_are_unknown() -> None:
    problem = replace(PROBLEM, parameters=X, network=network("day", "rest ?x"))
    assert read_plan(TEXT, problem) == replace(PLAN, root_bindings=None)


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("==>\n", "", 11, "there is no plan: expected a line '==>'"),
        (TEXT, "\n", 1, "there is no plan: expected a line '==>'"),
        ("root 5 4\n", "", 11, "the plan has no decomposition: expected a line 'root ...'"),
        (TEXT[TEXT.index("root") :], "", 6, "the plan has no decomposition: expected a line 'root ...'"),
        ("root 5 4\n", "root 5 4\nroot 5\n", 8, "a second line 'root'"),
        ("root 5 4", "root 5 x", 7, "expected the number of a task (0, 1, ...), found 'x'"),
        ("root 5 4", "root 5 4 99", 7, "there is no task of number 99"),
        ("root 5 4", "root 5 4 8", 7, "task 8 stands in two places of the decomposition"),
        ("root 5 4", "root 4", 8, "task 5 (day) is not below the root tasks"),
        ("two 6 7 8", "two 6 7 5", 8, "task 5 stands in two places"),
        ("two 6 7 8", "two 6 7 -8", 8, "found '-8'"),
        ("5 day -> two 6 7 8", "5 day -> two 6 7\n8 errand b -> do-it 2 8", 12, "the number 8 stands before two tasks"),
        ("1 bring a", "0 bring a", 3, "the number 0 stands before two tasks"),
        ("1 bring a", "1", 3, "expected the name of a task after the number 1"),
        ("1 bring a", "bring a", 3, "expected the number of a task (0, 1, ...), found 'bring'"),
        ("7 pause a -> none", "7 pause a", 10, "actions stand before the line 'root'"),
        ("7 pause a -> none", "7 pause a ->", 10, "expected '<number> <task> <arguments> -> <method> <numbers>'"),
        ("7 pause a -> none", "7 -> none", 10, "expected '<number> <task> <arguments> -> <method> <numbers>'"),
    ],
)
def test_malformed_plans_are_input_errors_with_their_line(old: str, new: str, line: int, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as error:
        read_plan(TEXT.replace(old, new), PROBLEM, "my.plan")
    assert error.value.place is not None
    assert (error.value.place.file, error.value.place.line) == ("my.plan", line)


@pytest.mark.parametrize(
    ("old", "new", "column", "message"),
    [
        ("root 5 4", "  root 5 x", 10, "found 'x'"),
        ("root 5 4", "root 5   99", 10, "there is no task of number 99"),
        ("two 6 7 8", "two 6 7 5", 18, "task 5 stands in two places"),
        ("two 6 7 8", "two [6,7] -8", 20, "found '-8'"),
        ("1 bring a", " bring a", 2, "found 'bring'"),
        ("1 bring a", "1 br\x1b[31ming a", 5, "the character U+001B cannot be seen"),
    ],
)
def test_the_place_is_that_of_the_word_that_is_named(old: str, new: str, column: int, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as error:
        read_plan(TEXT.replace(old, new), PROBLEM)
    assert error.value.place is not None
    assert error.value.place.column == column


RAW = """==>
0 __method_precondition_do-it[a]
1 fetch[a]
2 bring[a]
root 9
3 errand[a] -> do-it 0 1 2
9 __top[] -> __top_method 3
<=="""


@pytest.mark.parametrize(
    ("old", "new", "place", "name"),
    [
        ("", "", "2:3", "__method_precondition_do-it"),
        ("0 __method_precondition_do-it[a]\n", "", None, ""),
        ("__method_precondition_do-it[a]", "fetch[b]", None, ""),
        ("__method_precondition_do-it[a]\n1 fetch[a]", "fetch[a]\n1 __noop[]", "3:3", "__noop"),
        ("__method_precondition_do-it[a]", "_!rest[a]", "2:3", "_!rest"),
    ],
)
def test_raw_plans_of_another_planner_are_told(old: str, new: str, place: str | None, name: str) -> None:
    text = RAW.replace(old, new)
    if place is None:  # an artificial root task alone is seen through
        text = text.replace("do-it 0 1 2", "do-it 1 2").replace("0 fetch[b]\n", "")
        assert read_plan(text, PROBLEM).steps == (Step("fetch", ("a",)), Step("bring", ("a",)))
        return
    with pytest.raises(InputError) as error:
        read_plan(text, PROBLEM, "raw.txt")
    assert str(error.value).startswith(f"raw.txt:{place}: '{name}' is a name that the planner pandaPI makes up")
    assert "'pandaPIparser -c raw.txt PLAN'" in str(error.value)


def test_raw_methods_of_another_planner_are_told() -> None:
    text = TEXT.replace("day -> two", "day -> <<two;errand[a];do-it;0;-1>")
    with pytest.raises(InputError, match=r":8:10: '<<two;errand' is a name that the planner pandaPI makes up"):
        read_plan(text, PROBLEM)


def test_names_of_the_domain_may_begin_with_underscores() -> None:
    domain = Domain("d", actions={"__noop": Action("__noop")})
    problem = Problem("p", domain, network=network("__noop"))
    assert read_plan("==>\n0 __noop\nroot 0\n<==", problem).steps == (Step("__noop"),)


def test_long_plans() -> None:
    length = 5000
    domain = Domain(
        "d",
        actions={"rest": Action("rest")},
        tasks={"more": Signature("more")},
        methods={
            "go-on": Method("go-on", (), "more", (), network("rest", "more", ordering=((0, 1),)), Not(Atom("late"))),
            "end": Method("end", (), "more", ()),
        },
    )
    problem = Problem("p", domain, network=network("more"))
    tree = Decomposition("more", (), "end")
    for index in reversed(range(length)):
        tree = Decomposition("more", (), "go-on", (index, tree))
    plan = Plan((Step("rest"),) * length, (tree,))
    again = read_plan(write_plan(plan, problem), problem)
    assert write_plan(again, problem) == write_plan(plan, problem)
    assert validate(problem, again)
