"""Typed lists: `?a ?b - t ?c - (either u v)`, in declarations of types, objects and parameters."""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.hddl.cycles import find_cycle
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe
from statehtn.hddl.vocabulary import Types, Vocabulary, new_name, words
from statehtn.model import Parameter, TypeHierarchy
from statehtn.model.types import ROOT_TYPE


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
        if node.text != "-":
            untyped.append(node)
            continue
        if not untyped:
            raise reporter.error("expected a name before '-'", node)
        if index == len(nodes):
            raise reporter.error("expected a type after '-'", node)
        types = type_words(nodes[index], reporter)
        found += [(word, types) for word in untyped]
        untyped = []
        index += 1
    return found + [(word, []) for word in untyped]


def type_words(node: Node, reporter: Reporter) -> list[Word]:
    """Return the words of `t` or `(either t u ...)`."""
    if isinstance(node, Word):
        if node.text[0] in "?:" or node.text == "-":
            raise reporter.error(f"expected a type, found {describe(node)}", node)
        return [node]
    if node.head != "either" or len(node.items) < 2:
        raise reporter.error(f"expected a type or '(either <types>)', found {describe(node)}", node)
    return words(node.items[1:], "a type", reporter)


def read_types(nodes: Sequence[Node], parents: dict[str, Types], reporter: Reporter) -> None:
    """Add the declarations of a `:types` section; a type that is declared twice has all the supertypes.

    Raises:
        InputError: a type is above itself.
    """
    for word, supertypes in typed_list(nodes, reporter):
        name = new_name(word, "type", word, reporter)
        above = tuple(kind.text for kind in supertypes)
        if name == ROOT_TYPE:
            if not set(above) <= {ROOT_TYPE}:
                raise reporter.error("'object' is above all types and cannot have a supertype", word)
            continue
        parents[name] = tuple(dict.fromkeys((*parents.get(name, ()), *above)))
        for kind in above:
            if kind != ROOT_TYPE:
                parents.setdefault(kind, ())
    if cycle := find_cycle(parents):
        word = next(word for word, _ in typed_list(nodes, reporter) if word.text in cycle)
        raise reporter.error(f"the types are in a cycle: {' - '.join(cycle)}", word)


def read_objects(nodes: Sequence[Node], vocabulary: Vocabulary, reporter: Reporter) -> dict[str, str]:
    """Return the objects of a section that the vocabulary does not have yet, and add them to it."""
    added: dict[str, str] = {}
    repeated: list[Word] = []
    for word, types in typed_list(nodes, reporter):
        name = new_name(word, "object", word, reporter)
        if len(types) > 1:
            raise reporter.unsupported(f"object '{name}' must have one type; 'either' is for parameters", types[1])
        kind = _known(types, vocabulary.types, reporter)[0]
        before = vocabulary.objects.get(name)
        if before is None:
            vocabulary.objects[name] = added[name] = kind
        elif before == kind:
            repeated.append(word)
        else:
            raise reporter.error(
                f"object '{name}' is of type '{before}' already, found a declaration as '{kind}'", word
            )
    if repeated:
        others = f", and {len(repeated) - 1} more like it" if len(repeated) > 1 else ""
        reporter.warn(f"object '{repeated[0].text}' is declared again{others}", repeated[0])
    return added


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
