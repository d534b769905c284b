"""Typed lists: `?a ?b - t ?c - (either u v)`, in declarations of types, objects and parameters."""

from __future__ import annotations

import re
from collections.abc import Sequence

from statehtn.hddl.cycles import find_cycle
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe, parse_group
from statehtn.hddl.spelling import ODD
from statehtn.hddl.vocabulary import Types, Vocabulary, new_name
from statehtn.model import Parameter
from statehtn.model.types import ROOT_TYPE

MAX_TYPES = 20
"""Types of one object; the name of the type that joins them grows with their number."""


_ODD = ODD.pattern[1:-1]
_PLAIN_NAME = re.compile(rf"(?!either$)[^?:(){_ODD}-](?:[^{_ODD}]*[^{_ODD}-])?", re.IGNORECASE).fullmatch


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
        if node.text.endswith("-") and not node.text.startswith("-"):
            reporter.warn(f"expected a space before '-', found {describe(node)}", node)
            untyped.append(Word(node.text[:-1], node.index))
            node = Word("-", node.index)
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


def read_types(declared: Sequence[tuple[Word, list[Word]]], vocabulary: Vocabulary, reporter: Reporter) -> None:
    """Declare the types of the `:types` sections; a type that is declared twice has all the supertypes.

    Types that only stand to the right of a `-` are declared by that.

    Raises:
        InputError: a type is above itself, or two types with different supertypes differ in case only.
    """
    for word, _ in declared:
        if ":" in word.text[1:]:
            reporter.warn(f"'{word.text}' is one name; a type above others stands after ' - '", word)
        if vocabulary.spelling("type", new_name(word, "type", word, reporter).text) is None:
            vocabulary.declare("type", (word.text,), reporter.source, word.index)
    for word in (kind for _, supertypes in declared for kind in supertypes):
        if vocabulary.spelling("type", word.text) is None:
            vocabulary.declare("type", (word.text,), reporter.source, word.index)
    parents: dict[str, Types] = {}
    for word, supertypes in declared:
        name = _declared_type(word, vocabulary, reporter)
        above = tuple(_declared_type(kind, vocabulary, reporter) for kind in supertypes)
        if name == ROOT_TYPE:
            if not set(above) <= {ROOT_TYPE}:
                raise reporter.error("'object' is above all types and cannot have a supertype", word)
            continue
        if name != word.text:
            differing = vocabulary.differ_in_case("type", name, word.text, reporter)
            if set(above) != set(parents[name]):
                raise reporter.error(f"{differing}, but have different supertypes; expected another name", word)
            reporter.warn(f"{differing}; they are one type, '{name}'", word)
        parents[name] = tuple(dict.fromkeys((*parents.get(name, ()), *above)))
    for name in [name for above in parents.values() for name in above if name != ROOT_TYPE]:
        parents.setdefault(name, ())
    if cycle := find_cycle(parents):
        word = next(word for word, _ in declared if word.text in cycle)
        raise reporter.error(f"the types are in a cycle: {' - '.join(cycle)}", word)
    vocabulary.declare_types(parents)


def read_objects(start: int, end: int, vocabulary: Vocabulary, declared: dict[str, str], reporter: Reporter) -> None:
    """Add the objects of a section to the vocabulary, and those that are new to `declared`.

    An object that is declared with several types is of all of them, perhaps of a type that is made up for it.

    Args:
        start: the token of the `(` of the section.
        end: the token after its `)`.
    """
    index = _read_plain_objects(start + 2, end - 1, vocabulary, declared, reporter)
    if index < end - 1:
        nodes = parse_group(reporter.source, start, index - 1).items
        _read_other_objects(nodes, vocabulary, declared, reporter)


def _read_plain_objects(
    start: int, end: int, vocabulary: Vocabulary, declared: dict[str, str], reporter: Reporter
) -> int:
    """Add new objects with a declared type, without a node for each; return the token where anything else begins."""
    tokens = reporter.source.tokens
    while start < end:
        try:
            dash = tokens.index("-", start, end - 1)
        except ValueError:
            break
        names, kind = tokens[start:dash], vocabulary.spelling("type", tokens[dash + 1])
        is_plain = kind is not None and vocabulary.are_new("object", names) and all(map(_PLAIN_NAME, names))
        if kind is None or not is_plain or len(set(map(str.lower, names))) < len(names) or not names:
            break
        new = dict.fromkeys(names, kind)
        declared.update(new)
        vocabulary.objects.update(new)
        vocabulary.declare("object", names, reporter.source, start)
        start = dash + 2
    return start


def _read_other_objects(
    nodes: Sequence[Node], vocabulary: Vocabulary, declared: dict[str, str], reporter: Reporter
) -> None:
    repeated: list[Word] = []
    respelt: list[tuple[str, Word]] = []
    for word, types in typed_list(nodes, reporter):
        new_name(word, "object", word, reporter)
        if len(types) > 1:
            raise reporter.unsupported(f"object '{word.text}' must have one type; 'either' is for parameters", types[1])
        kind = declared_types(types, vocabulary, reporter)[0]
        name = vocabulary.spelling("object", word.text)
        if name is None:
            vocabulary.objects[word.text] = declared[word.text] = kind
            vocabulary.declare("object", (word.text,), reporter.source, word.index)
        elif name != word.text:
            if vocabulary.objects[name] != kind:
                differing = vocabulary.differ_in_case("object", name, word.text, reporter)
                types_of = f"are of different types ('{kind}' and '{vocabulary.objects[name]}')"
                raise reporter.error(f"{differing}, but {types_of}; expected another name", word)
            respelt.append((name, word))
        elif vocabulary.objects[name] != kind:
            _join_types(word, kind, vocabulary, declared, reporter)
        else:
            repeated.append(word)
    if repeated:
        others = f", and {len(repeated) - 1} more like it" if len(repeated) > 1 else ""
        reporter.warn(f"object '{repeated[0].text}' is declared again{others}", repeated[0])
    if respelt:
        name, word = respelt[0]
        others = f"; and {len(respelt) - 1} more like it" if len(respelt) > 1 else ""
        differing = vocabulary.differ_in_case("object", name, word.text, reporter)
        reporter.warn(f"{differing}: they are one object, '{name}'{others}", word)


def _join_types(word: Word, kind: str, vocabulary: Vocabulary, declared: dict[str, str], reporter: Reporter) -> None:
    """Make an object one of a further type, too."""
    name, before = word.text, vocabulary.objects[word.text]
    if before.count("+") == MAX_TYPES:
        raise reporter.error(f"object '{name}' is declared with more than {MAX_TYPES} types", word)
    reporter.warn(f"object '{name}' is of type '{before}' already, and now of type '{kind}', too", word)
    own = vocabulary.constants if name in vocabulary.constants else declared
    vocabulary.objects[name] = own[name] = vocabulary.joint_type(before, kind)


def read_parameters(
    nodes: Sequence[Node], vocabulary: Vocabulary, reporter: Reporter, distinct: bool = True
) -> tuple[Parameter, ...]:
    """Return a list of typed variables.

    Args:
        distinct: a name that stands twice is an error; otherwise, where the names carry no meaning, only a warning.
    """
    found: list[Parameter] = []
    names: dict[str, Word] = {}
    for word, types in typed_list(nodes, reporter):
        if not word.text.startswith("?") or word.text == "?":
            alone = ", alone; is there a space too many behind it?" if word.text == "?" else ""
            raise reporter.error(f"expected a variable such as '?x', found {describe(word)}{alone}", word)
        if word.lower in names:
            before = names[word.lower]
            respelt = f" (as '{before.text}', and case means nothing in HDDL)" if before.text != word.text else ""
            message = f"variable '{word.text}' is declared twice in one list{respelt}"
            if distinct:
                raise reporter.error(message, word)
            reporter.warn(message, word)
        names[word.lower] = word
        found.append(Parameter(word.text, declared_types(types, vocabulary, reporter)))
    return tuple(found)


def declared_types(words: list[Word], vocabulary: Vocabulary, reporter: Reporter) -> Types:
    """Return the types that words name; `object` where there are none.

    Raises:
        InputError: one is not declared.
    """
    return tuple(dict.fromkeys(_declared_type(word, vocabulary, reporter) for word in words)) or (ROOT_TYPE,)


def _declared_type(word: Word, vocabulary: Vocabulary, reporter: Reporter) -> str:
    name = vocabulary.spelling("type", word.text)
    if name is None:
        raise reporter.error(unknown("type", word.text, (*vocabulary.types.parents, ROOT_TYPE)), word)
    return name
