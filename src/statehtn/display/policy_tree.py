"""A policy as a tree of decisions to read: actions below each other, and what may come of them further in."""

from __future__ import annotations

from html import escape

from statehtn.counted import counted, likely
from statehtn.display.policy_outline import MOST_NODES, Choice, Outline, Place, outline
from statehtn.display.policy_words import OTHERWISE
from statehtn.model.policy_graph import End, PolicyGraph

ENDS = {End.DONE: "done", End.FAILED: "failed: nothing is left to try", End.GIVEN_UP: "give up"}
INDENT = "  "
MOST_LINES = 500
"""Of a policy that is shown."""


def policy_text(graph: PolicyGraph) -> str:
    """Return a policy as a tree of decisions, in lines; what is reached in several ways has a letter."""
    if len(graph) > MOST_NODES:
        return f"a policy of {counted(len(graph), 'node')}, too large to be read; --json writes it"
    return "\n".join(_lines(outline(graph)))


def policy_html(graph: PolicyGraph) -> str:
    """Return what `policy_text` does as HTML for a notebook."""
    return f'<pre style="line-height: 1.25">{escape(policy_text(graph))}</pre>'


def _lines(shown: Outline) -> list[str]:
    names = shown.shared()
    lines: list[str] = []
    told: set[int] = set()
    pending: list[tuple[int, int, str]] = [(0, 0, "")]  # place, depth, what stands before it in a line of its own
    while pending:
        index, depth, head = pending.pop()
        if len(lines) >= MOST_LINES:
            lines.append(f"... and {counted(len(pending) + 1, 'branch').replace('branchs', 'branches')} more")
            break
        place = shown.places[index]
        if place.end is not None or index in told:
            short = ENDS[place.end] if place.end is not None else f"go on at {names[index]}"
            lines.append(f"{INDENT * depth}{head} {short}" if head else f"{INDENT * depth}{short}")
            continue
        if head:
            lines.append(f"{INDENT * depth}{head}")
            depth += 1
        told.add(index)
        lines.append(f"{INDENT * depth}{f'{names[index]}: ' if index in names else ''}{_action(place)}")
        is_one = len(place.choices) == 1
        further = depth if is_one else depth + 1
        pending += [(c.place, further, "" if is_one else choice_text(c)) for c in reversed(place.choices)]
    return lines


def _action(place: Place) -> str:
    return f"{place.step}  cost {place.cost}" if place.cost != "0" else str(place.step)


def choice_text(choice: Choice) -> str:
    """Return on which condition a choice is taken, with its probability, such as `if (open door), 0.9:`."""
    probability = "" if choice.probability is None else f", {likely(choice.probability, choice.rest, digits=6)}"
    condition = choice.condition if choice.condition == OTHERWISE else f"if {choice.condition}"
    return f"{condition}{probability}:"
