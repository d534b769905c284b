"""Typed lists: `?a ?b - t ?c - (either u v)`, in declarations of types, objects and parameters."""

from __future__ import annotations

import re
from collections.abc import Sequence

from statehtn.hddl.cycles import find_cycle
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe, parse_group
from statehtn.hddl.vocabulary import Types, Vocabulary, new_name
from statehtn.model import Parameter, TypeHierarchy
from statehtn.model.types import ROOT_TYPE

MAX_TYPES = 20
"""Types of one object; the name of the type that joins them grows with their number."""


_PLAIN_NAME = re.compile(r"(?!either$)[^-?:()]").match


def typed_list(nodes: Sequence[Node], reporter: Reporter) -> list[tuple[Word, list[Word]]]:
    """Return the words of a typed list with the words of their types; none where no type is given."""
    found: list[tuple[Word, list[Word]]] = []
    untyped: list[Word] = []
    index = 0
    while index < len(nodes):
        node = nodes[index]
        if isinstance(node, Group):
            raise reporter.error(f"expected a name or '-', found {describe(node)}", node)
        index += 1
        if not node.text.startswith("-"):
            untyped.append(node)
            continue
        if not untyped:
            raise reporter.error("expected a name before '-'", node)
        if node.text != "-":
            types = [type_after_dash(node, reporter)]
        elif index == len(nodes):
            raise reporter.error("expected a type after '-'", node)
        else:
            types = type_words(nodes[index], reporter)
            index += 1
        found += [(word, types) for word in untyped]
        untyped = []
    return found + [(word, []) for word in untyped]


def type_after_dash(word: Word, reporter: Reporter) -> Word:
    """Return the type in `-t`: no name starts with a dash, so that only a space is missing."""
    reporter.warn(f"expected a space after '-', found {describe(word)}", word)
    return Word(word.text[1:], word.index)


def type_words(node: Node, reporter: Reporter) -> list[Word]:
    """Return the words of `t` or `(either t u ...)`."""
    if isinstance(node, Word):
        if node.text[0] in "?:" or node.text == "-":
            raise reporter.error(f"expected a type, found {describe(node)}", node)
        return [node]
    if node.head != "either" or len(node.items) < 2:
        raise reporter.error(f"expected a type or '(either <types>)', found {describe(node)}", node)
    found: list[Word] = []
    for item in node.items[1:]:
        if isinstance(item, Group):
            reporter.warn("'either' inside 'either' means the same as without it", item)
        found += type_words(item, reporter)
    return found


def read_types(nodes: Sequence[Node], parents: dict[str, Types], reporter: Reporter) -> None:
    """Add the declarations of a `:types` section; a type that is declared twice has all the supertypes.

    Raises:
        InputError: a type is above itself.
    """
    mentioned: dict[str, None] = {}
    for word, supertypes in typed_list(nodes, reporter):
        name = new_name(word, "type", word, reporter)
        above = tuple(kind.text for kind in supertypes)
        if name == ROOT_TYPE:
            if not set(above) <= {ROOT_TYPE}:
                raise reporter.error("'object' is above all types and cannot have a supertype", word)
            continue
        parents[name] = tuple(dict.fromkeys((*parents.get(name, ()), *above)))
        mentioned |= dict.fromkeys(above)
    for kind in mentioned:
        if kind != ROOT_TYPE:
            parents.setdefault(kind, ())
    if cycle := find_cycle(parents):
        word = next(word for word, _ in typed_list(nodes, reporter) if word.text in cycle)
        raise reporter.error(f"the types are in a cycle: {' - '.join(cycle)}", word)


def read_objects(start: int, end: int, vocabulary: Vocabulary, declared: dict[str, str], reporter: Reporter) -> None:
    """Add the objects of a section to the vocabulary, and those that are new to `declared`.

    An object that is declared with several types is of all of them, perhaps of a type that is made up for it.

    Args:
        start: the token of the `(` of the section.
        end: the token after its `)`.
    """
    index = _read_plain_objects(start + 2, end - 1, vocabulary, declared, reporter.source.tokens)
    if index < end - 1:
        nodes = parse_group(reporter.source, start, index - 1).items
        _read_other_objects(nodes, vocabulary, declared, reporter)


def _read_plain_objects(
    start: int, end: int, vocabulary: Vocabulary, declared: dict[str, str], tokens: list[str]
) -> int:
    """Add new objects with a declared type, without a node for each; return the token where anything else begins."""
    while start < end:
        try:
            dash = tokens.index("-", start, end - 1)
        except ValueError:
            break
        names, kind = tokens[start:dash], tokens[dash + 1]
        is_plain = kind in vocabulary.types and vocabulary.objects.keys().isdisjoint(names)
        if not is_plain or len(set(names)) < len(names) or not all(map(_PLAIN_NAME, names)) or not names:
            break
        new = dict.fromkeys(names, kind)
        declared.update(new)
        vocabulary.objects.update(new)
        start = dash + 2
    return start


def _read_other_objects(
    nodes: Sequence[Node], vocabulary: Vocabulary, declared: dict[str, str], reporter: Reporter
) -> None:
    repeated: list[Word] = []
    for word, types in typed_list(nodes, reporter):
        name = new_name(word, "object", word, reporter)
        if len(types) > 1:
            raise reporter.unsupported(f"object '{name}' must have one type; 'either' is for parameters", types[1])
        kind = _known(types, vocabulary.types, reporter)[0]
        before = vocabulary.objects.get(name)
        if before is None:
            vocabulary.objects[name] = declared[name] = kind
        elif before != kind:
            if before.count("+") == MAX_TYPES:
                raise reporter.error(f"object '{name}' is declared with more than {MAX_TYPES} types", word)
            reporter.warn(f"object '{name}' is of type '{before}' already, and now of type '{kind}', too", word)
            own = vocabulary.constants if name in vocabulary.constants else declared
            vocabulary.objects[name] = own[name] = vocabulary.joint_type(before, kind)
        elif name in vocabulary.borrowed:
            vocabulary.borrowed.remove(name)
        else:
            repeated.append(word)
    if repeated:
        others = f", and {len(repeated) - 1} more like it" if len(repeated) > 1 else ""
        reporter.warn(f"object '{repeated[0].text}' is declared again{others}", repeated[0])


def read_parameters(
    nodes: Sequence[Node], vocabulary: Vocabulary, reporter: Reporter, distinct: bool = True
) -> tuple[Parameter, ...]:
    """Return a list of typed variables.

    Args:
        distinct: a name that stands twice is an error; otherwise, where the names carry no meaning, only a warning.
    """
    found: list[Parameter] = []
    names: set[str] = set()
    for word, types in typed_list(nodes, reporter):
        if not word.text.startswith("?") or word.text == "?":
            raise reporter.error(f"expected a variable such as '?x', found {describe(word)}", word)
        if word.text in names:
            message = f"variable '{word.text}' is declared twice in one list"
            if distinct:
                raise reporter.error(message, word)
            reporter.warn(message, word)
        names.add(word.text)
        found.append(Parameter(word.text, _known(types, vocabulary.types, reporter)))
    return tuple(found)


def _known(types: list[Word], hierarchy: TypeHierarchy, reporter: Reporter) -> Types:
    for word in types:
        if word.text not in hierarchy:
            raise reporter.error(unknown("type", word.text, (*hierarchy.parents, ROOT_TYPE)), word)
    return tuple(dict.fromkeys(word.text for word in types)) or (ROOT_TYPE,)
