"""Where in the files things of a model stand, found when somebody asks: the model itself knows no positions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from statehtn.errors import Place
from statehtn.hddl.expressions import Group, Node, Word, parse_group
from statehtn.hddl.tokens import Source
from statehtn.hddl.vocabulary import Kind, Vocabulary

Pattern = Sequence[str]
"""The words of one group, such as `("at", "?x")`; where "..." is the last, those it begins with. One word matches
itself, wherever it stands."""
ANYTHING = "..."


class SourceMap:
    """Finds declarations, and formulas, subtasks and variables in them.

    Args:
        vocabulary: knows the tokens of all declared names.
        domain: the domain's file.
        problem: the problem's file, if there is one.
    """

    def __init__(self, vocabulary: Vocabulary, domain: Source, problem: Source | None = None) -> None:
        self._vocabulary = vocabulary
        self.domain = domain
        self.problem = problem
        self._groups: dict[tuple[str, int], Group] = {}

    def declared(self, kind: Kind, name: str) -> Place:
        """Return where a name is declared; the beginning of the domain where it is not."""
        try:
            source, index = self._vocabulary.token(kind, name)
        except KeyError:
            return self.domain.place(0)
        return source.place(index)

    def inside(self, kind: Kind, name: str, *patterns: Pattern) -> Place:
        """Return where a task, action or method says something.

        Args:
            kind: of the declaration.
            name: of the declaration.
            patterns: what to look for, inside each other: `(":precondition",), ("at", "?x")` is the first such group
                behind that keyword. Where one is not found, the one before it counts.
        """
        try:
            source, index = self._vocabulary.token(kind, name)
        except KeyError:
            return self.domain.place(0)
        return self._find(source, index - 2, index, patterns)

    def in_section(self, section: str, *patterns: Pattern) -> Place:
        """Return where a section of the problem, such as `:goal`, says something; as `inside`."""
        source = self.problem or self.domain
        for start, _ in source.sections:
            if source.tokens[start + 1].lower() == section:
                return self._find(source, start, start, patterns)
        return source.place(0)

    def _find(self, source: Source, start: int, found: int, patterns: Sequence[Pattern]) -> Place:
        """Return the place of the last of the patterns that is found behind those before it, or of a token."""
        key = (source.file, start)
        if key not in self._groups:
            self._groups[key] = parse_group(source, start)
        nodes: list[Node] = [self._groups[key]]
        for pattern in patterns:
            match = next(_matches(nodes, [word.lower() for word in pattern]), None)
            if match is None:
                break
            node, behind = match
            found = node.index
            nodes = [behind] if behind is not None else [node]
        return source.place(found)


def _matches(nodes: Sequence[Node], words: Sequence[str]) -> Iterator[tuple[Node, Node | None]]:
    """Yield what matches a pattern, in the order of the file, with what stands behind it if it is a keyword."""
    is_open = words[-1] == ANYTHING
    head = list(words[:-1] if is_open else words)
    pending: list[tuple[Node, Node | None]] = [(node, None) for node in reversed(nodes)]
    while pending:
        node, behind = pending.pop()
        if isinstance(node, Word):
            if node.lower == " ".join(words):
                yield node, behind if node.is_keyword else None
            continue
        found = [item.lower if isinstance(item, Word) else "" for item in node.items[: len(head)]]
        if found == head and (is_open or len(node.items) == len(head)):
            yield node, None
        pending += reversed(list(zip_longest(node.items, node.items[1:])))
