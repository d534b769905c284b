"""Sections of a file and the keyword arguments inside them: `:parameters (...) :task (...)`."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence

from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe, parse_group
from statehtn.hddl.tokens import Source


class Fields:
    """The keyword arguments of a section, in any order.

    Args:
        owner: the section, for errors about what is missing.
        nodes: what follows the section's name.
        allowed: the keywords that have a meaning.

    Raises:
        InputError: a keyword is unknown, stands twice or has no value.
    """

    def __init__(self, owner: Group, nodes: Sequence[Node], allowed: Iterable[str], reporter: Reporter) -> None:
        self.owner = owner
        self.reporter = reporter
        self.values: dict[str, tuple[Word, Node]] = {}
        allowed = tuple(allowed)
        index = 0
        while index < len(nodes):
            keyword = nodes[index]
            if isinstance(keyword, Group) or not keyword.is_keyword:
                raise reporter.error(f"expected one of {', '.join(allowed)}, found {describe(keyword)}", keyword)
            if keyword.lower not in allowed:
                raise reporter.error(unknown("keyword", keyword.text, allowed), keyword)
            if keyword.lower in self.values:
                raise reporter.error(f"'{keyword.text}' stands twice in one section", keyword)
            value = nodes[index + 1] if index + 1 < len(nodes) else None
            if value is None or (isinstance(value, Word) and value.is_keyword):
                raise reporter.error(f"expected a value in parentheses after '{keyword.text}'", value or keyword)
            self.values[keyword.lower] = (keyword, value)
            index += 2

    def get(self, *keywords: str) -> Group | None:
        """Return the value of one of several keywords of the same meaning, or None.

        Raises:
            InputError: two of them are given, or the value is a word.
        """
        given = [self.values[keyword] for keyword in keywords if keyword in self.values]
        if len(given) > 1:
            first, second = (keyword for keyword, _ in given[:2])
            raise self.reporter.error(f"'{second.text}' and '{first.text}' exclude each other", second)
        if not given:
            return None
        keyword, value = given[0]
        if isinstance(value, Word):
            raise self.reporter.error(f"expected parentheses after '{keyword.text}', found {describe(value)}", value)
        return value

    def items(self, *keywords: str) -> list[Node]:
        """Return what stands in the parentheses after a keyword; nothing where it is missing."""
        group = self.get(*keywords)
        return [] if group is None else group.items


def is_empty(group: Group) -> bool:
    """Tell whether a formula or an effect says nothing: `()` or `(and)`, also inside each other."""
    parts = group.items[1:] if group.head == "and" else group.items
    return all(isinstance(part, Group) and is_empty(part) for part in parts)


def section_name(source: Source, start: int) -> str:
    """Return the first word of a section, in lower case.

    Raises:
        InputError: it starts with a parenthesis.
    """
    word = source.tokens[start + 1]
    if word == "(":
        raise source.error("expected a section such as '(:action ...)', found '(('", start)
    return word.lower()


def sorted_sections(
    reporter: Reporter,
    names: Iterable[str],
    unsupported: Mapping[str, str],
    single: Container[str],
    unique: Container[str] = (),
) -> dict[str, list[tuple[int, int]]]:
    """Return the sections after the header by their names, each as its first token and the one after its last.

    Args:
        names: those that have a meaning.
        unsupported: why others, which HDDL or PDDL has, are refused.
        single: those that should not stand twice.
        unique: those that must not.
    """
    source = reporter.source
    found: dict[str, list[tuple[int, int]]] = {name: [] for name in names}
    for start, end in source.sections[1:]:
        name = section_name(source, start)
        if name in unsupported:
            raise reporter.unsupported(unsupported[name], Word(name, start))
        if name not in found:
            raise source.error(unknown("section", name, found), start)
        if found[name]:
            if name in unique:
                raise source.error(f"a second section '{name}'", start)
            if name in single:
                reporter.warn(f"a second section '{name}'; it is added to the first", Word(name, start))
        found[name].append((start, end))
    return found


def read_header(kind: str, reporter: Reporter) -> str:
    """Return the name in `(domain <name>)` or `(problem <name>)`, the first section.

    Raises:
        InputError: the file does not start that way; perhaps the two files are swapped.
    """
    reporter.warn_of_missing_spaces()
    source = reporter.source
    if not source.sections:
        raise source.error(f"expected '(define ({kind} <name>) ...'", 0)
    start = source.sections[0][0]
    found = section_name(source, start)
    if found != kind:
        other = {"domain": "problem", "problem": "domain"}[kind]
        hint = f"; this is a {other} file where the {kind} was expected" if found == other else ""
        raise source.error(f"expected '({kind} <name>)', found '({found}'{hint}", start)
    header = parse_group(source, start)
    if len(header.items) != 2 or isinstance(header.items[1], Group):
        raise reporter.error(f"expected '({kind} <name>)' with one name", header)
    return header.items[1].text
