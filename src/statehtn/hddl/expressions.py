"""Nested lists with positions: the shape of HDDL before it has a meaning."""

from __future__ import annotations

from collections.abc import Iterator

from statehtn.hddl.tokens import Source, shortened

CHECK_EVERY = 0xFFFF
"""Tokens, a power of two less one, after which limits are checked."""


class Word:
    """A token that is not a parenthesis; `index` is its token's."""

    __slots__ = ("index", "text")

    def __init__(self, text: str, index: int) -> None:
        self.text = text
        self.index = index

    @property
    def lower(self) -> str:
        """The word in lower case, which compares words of the language."""
        return self.text.lower()

    @property
    def is_keyword(self) -> bool:
        """True for words such as `:parameters`."""
        return self.text.startswith(":")


class Group:
    """What stands between two parentheses; `index` is the token of the opening one."""

    __slots__ = ("index", "items")

    def __init__(self, index: int) -> None:
        self.items: list[Node] = []
        self.index = index

    @property
    def head(self) -> str:
        """The first word in lower case, for words of the language; empty where there is none."""
        first = self.items[0] if self.items else None
        return first.text.lower() if isinstance(first, Word) else ""

    @property
    def name(self) -> str:
        """The first word as it is written; empty where there is none."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Word) else ""


Node = Word | Group


def parse_group(source: Source, start: int, after: int | None = None) -> Group:
    """Return the nested list that opens at a token; the source is known to be balanced.

    Args:
        after: leave out what stands in the group up to this token.
    """
    root = Group(start)
    open_groups = [root]
    tokens = source.tokens
    index = start if after is None else after
    while open_groups:
        index += 1
        if not index & CHECK_EVERY:
            source.limits.check()
        token = tokens[index]
        if token == "(":
            group = Group(index)
            open_groups[-1].items.append(group)
            open_groups.append(group)
        elif token == ")":
            open_groups.pop()
        else:
            open_groups[-1].items.append(Word(token, index))
    return root


def consumed(group: Group) -> Iterator[Node]:
    """Yield what follows the first word of a group and let go of it, so that no large file is in memory twice."""
    group.items.reverse()
    first = group.items.pop()
    while group.items:
        yield group.items.pop()
    group.items.append(first)


def describe(node: Node) -> str:
    """Name a node in a message: what was found."""
    if isinstance(node, Word):
        return f"'{shortened(node.text)}'"
    if not node.items:
        return "'()'"
    return f"'({shortened(node.name)} ...)'" if node.name else "'((...'"
