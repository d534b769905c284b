"""The words of reasons: what a method or an action needs, and with which objects a condition can be had."""

from __future__ import annotations

from itertools import islice

from statehtn.explanation.pattern import pattern
from statehtn.explanation.query import Domains, Part, Query, renamed
from statehtn.explanation.reason import Reason
from statehtn.hddl.writer import formula_text

MOST_VALUES = 3
"""Bindings that are named where several are possible."""
MOST_COUNTED = 200
NO_REASON = "all that it needs can be had one by one"


def folded(what: str, children: tuple[Reason, ...], kind: str, name: str) -> Reason:
    """Return a reason with its only child in the same line, if that has no further ones."""
    if not children:
        return Reason(what, NO_REASON, kind=kind, name=name)
    needs = ", ".join(child.what for child in children)
    if len(children) == 1 and not children[0].children:
        child = children[0]
        return Reason(what, f"needs {needs}: {child.why}", (), child.additions, kind, name)
    return Reason(what, f"needs {needs}", children, (), kind, name)


def none_of(number: int, one: str, several: str, end: str) -> str:
    """Return that none of so many things can be used, in the words for one and for several."""
    return f"{one if number == 1 else several.format(number)} {end}"


def text_of(part: Part, domains: Domains) -> str:
    """Return a part with the objects of the variables that stand for one."""
    if part.task is not None:
        return str(pattern(part.task.task, part.terms, domains))
    assert part.formula is not None
    return formula_text(
        renamed(part.formula, {name: objects[0] for name, objects in domains.items() if len(objects) == 1})
    )


def values_of(query: Query, part: Part) -> str:
    """Return the bindings that give a part alone."""
    names = sorted(name for name in part.variables if len(query.domains[name]) > 1)
    found: dict[tuple[str, ...], None] = {}
    for binding in islice(query.answers([part]), MOST_COUNTED):
        found.setdefault(tuple(binding[name] for name in names))
    shown = [", ".join(f"{name} = {value}" for name, value in zip(names, row, strict=True)) for row in found]
    more = f" or {len(shown) - MOST_VALUES} others" if len(shown) > MOST_VALUES else ""
    return " or ".join(shown[:MOST_VALUES]) + more
