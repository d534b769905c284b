"""Policies as trees to read: what is told of outcomes and amounts, and what is told once."""

from __future__ import annotations

import math

from statehtn.display.policy_tree import policy_html, policy_text
from statehtn.model import CostDistribution, Step
from statehtn.model.policy_graph import Branch, Decision, End, PolicyGraph, PolicyNode
from tests.made_policies import HELD, TRY, certain, ferry_or_bridge, retry, tries


def test_a_loop_has_a_letter() -> None:
    assert policy_text(retry()).splitlines() == [
        "A: (try cup)  cost 1",
        "  if (held cup), 0.5:",
        "    (carry cup)  cost 3",
        "    done",
        "  otherwise, 0.5: go on at A",
    ]


def test_what_leads_into_a_loop_of_its_own_kind_is_told_once() -> None:
    """Twice the try is a node of its own, as where amounts are remembered, and then it is one for all times."""
    again, held = Branch(0.5, certain(1), 1), Branch(0.5, certain(1), 3, frozenset({HELD}))
    first, second = (
        PolicyNode(frozenset(), (TRY,), (), Decision(0, TRY, (held, to)), left=left)
        for to, left in ((again, 2.0), (Branch(0.5, certain(1), 2), 1.0))
    )
    third = PolicyNode(frozenset(), (TRY,), (), Decision(0, TRY, (held, Branch(0.5, certain(1), 2))), left=-math.inf)
    done = PolicyNode(frozenset({HELD}), (), (), None, End.DONE, left=-math.inf)
    assert policy_text(PolicyGraph.of([first, second, third, done])).splitlines() == [
        "A: (try cup)  cost 1",
        "  if (held cup), 0.5: done",
        "  otherwise, 0.5: go on at A",
    ]


def test_what_is_left_is_told_last_and_alone() -> None:
    """Nothing changes, or the cup breaks: both are failures, and need not be told from each other."""
    ways = (
        Branch(0.2, certain(1), 2),
        Branch(0.7, certain(1), 1, frozenset({HELD})),
        Branch(0.1, certain(1), 2, frozenset({("broken", "cup")})),
    )
    nodes = [
        PolicyNode(frozenset(), (TRY,), (), Decision(0, TRY, ways)),
        PolicyNode(frozenset({HELD}), (), (), None, End.DONE),
        PolicyNode(frozenset(), (TRY,), (), None, End.FAILED),
    ]
    assert policy_text(PolicyGraph.of(nodes)).splitlines() == [
        "(try cup)  cost 1",
        "  if (held cup), 0.7: done",
        "  otherwise, 0.3: failed: nothing is left to try",
    ]


def test_what_fails_is_said() -> None:
    assert policy_text(tries(2)).splitlines() == [
        "(try cup)  cost 1",
        "  if (held cup), 0.5: done",
        "  otherwise, 0.5:",
        "    (try cup)  cost 1",
        "      if (held cup), 0.5: done",
        "      otherwise, 0.5: failed: nothing is left to try",
    ]


def test_amounts_are_told() -> None:
    assert policy_text(ferry_or_bridge()).splitlines() == [
        "(drive)  cost 4 to 10",
        "  if at most 4 is spent, 0.75:",
        "    (bridge)  cost 2 w.p. 0.5, 9 w.p. 0.5",
        "    done",
        "  if more than 4 is spent, 0.25:",
        "    (ferry)  cost 5",
        "    done",
    ]


def test_amounts_that_change_nothing_are_not_told() -> None:
    """What follows is the same whatever was spent, so that there is one way to go on."""
    go, rest = Step("go"), Step("rest")
    nodes = [
        PolicyNode(
            frozenset(),
            (go, rest),
            (),
            Decision(0, go, (Branch(0.5, certain(1), 1), Branch(0.5, certain(2), 2))),
            left=9.0,
        ),
        PolicyNode(frozenset(), (rest,), (), Decision(0, rest, (Branch(1.0, certain(1), 3),)), left=8.0),
        PolicyNode(frozenset(), (rest,), (), Decision(0, rest, (Branch(1.0, certain(1), 4),)), left=7.0),
        PolicyNode(frozenset(), (), (), None, End.DONE, left=7.0),
        PolicyNode(frozenset(), (), (), None, End.DONE, left=6.0),
    ]
    assert policy_text(PolicyGraph.of(nodes)).splitlines() == ["(go)  cost 1 to 2", "(rest)  cost 1", "done"]


def test_decompositions_and_preconditions_are_left_out() -> None:
    solve, go = Step("solve"), Step("go")
    law = CostDistribution.certain(0)
    nodes = [
        PolicyNode(frozenset(), (solve,), (), Decision(0, solve, (Branch(1.0, law, 1),), "by-going")),
        PolicyNode(frozenset(), (go,), (), Decision(0, None, (Branch(1.0, law, 2),))),
        PolicyNode(frozenset(), (go,), (), Decision(0, go, (Branch(1.0, law, 3),))),
        PolicyNode(frozenset(), (), (), None, End.DONE),
    ]
    assert policy_text(PolicyGraph.of(nodes)).splitlines() == ["(go)", "done"]


def test_what_is_not_certain_is_not_said_to_be() -> None:
    for rest, texts in ((1e-10, ("1e-10", "1 - 1e-10")), (1e-20, ("1e-20", "1 - 1e-20"))):
        held, again = (
            Branch(p, certain(1), to, facts)
            for p, to, facts in ((rest, 1, frozenset({HELD})), (1 - rest, 0, frozenset()))
        )
        nodes = [
            PolicyNode(frozenset(), (TRY,), (), Decision(0, TRY, (held, again))),
            PolicyNode(frozenset({HELD}), (), (), None, End.DONE),
        ]
        shown = policy_text(PolicyGraph.of(nodes)).splitlines()
        assert shown[1:] == [f"  if (held cup), {texts[0]}: done", f"  otherwise, {texts[1]}: go on at A"]


def test_two_ways_to_one_place_share_it() -> None:
    lock, jammed, opened = Step("turn-key"), ("jammed", "lock"), ("open", "lock")
    nodes = [
        PolicyNode(
            frozenset(),
            (lock,),
            (),
            Decision(
                0,
                lock,
                (
                    Branch(0.8, certain(1), 2, frozenset({opened})),
                    Branch(0.2, certain(1), 1, frozenset({jammed})),
                ),
            ),
        ),
        PolicyNode(frozenset(), (lock,), (), Decision(0, Step("force"), (Branch(1.0, certain(5), 2),))),
        PolicyNode(frozenset(), (Step("enter"),), (), Decision(0, Step("enter"), (Branch(1.0, certain(1), 3),))),
        PolicyNode(frozenset(), (), (), None, End.DONE),
    ]
    graph = PolicyGraph.of(nodes)
    assert policy_text(graph).splitlines() == [
        "(turn-key)  cost 1",
        "  if (open lock), 0.8:",
        "    A: (enter)  cost 1",
        "    done",
        "  if (jammed lock), 0.2:",
        "    (force)  cost 5",
        "    go on at A",
    ]
    assert "<pre" in policy_html(graph)
    assert "(jammed lock)" in policy_html(graph)


def test_equal_loops_are_one_wherever_they_are_entered() -> None:
    """Two copies of trying and looking, one entered at the try and the other at the look."""
    look, go = Step("look"), Step("go")

    def loop(first: int) -> list[PolicyNode]:
        held = Branch(0.5, certain(1), 5, frozenset({("held", "cup")}))
        return [
            PolicyNode(
                frozenset(),
                (),
                (),
                Decision(0, Step("try", ("cup",)), (held, Branch(0.5, certain(1), first + 1))),
            ),
            PolicyNode(frozenset(), (), (), Decision(0, look, (Branch(1.0, certain(2), first),))),
        ]

    opened, closed = Branch(0.4, certain(1), 1, frozenset({("open",)})), Branch(0.6, certain(1), 4)
    nodes = [
        PolicyNode(frozenset(), (), (), Decision(0, go, (opened, closed))),
        *loop(1),
        *loop(3),
        PolicyNode(frozenset(), (), (), None, End.DONE),
    ]
    assert policy_text(PolicyGraph.of(nodes)).splitlines() == [
        "(go)  cost 1",
        "  if (open), 0.4:",
        "    A: (try cup)  cost 1",
        "      if (held cup), 0.5: done",
        "      otherwise, 0.5:",
        "        B: (look)  cost 2",
        "        go on at A",
        "  otherwise, 0.6: go on at B",
    ]
