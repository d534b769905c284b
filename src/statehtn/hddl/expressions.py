"""Nested lists with positions: the shape of HDDL before it has a meaning."""

from __future__ import annotations

from statehtn.hddl.tokens import Source, shortened


class Word:
    """A token that is not a parenthesis; `index` is its token's."""

    __slots__ = ("index", "text")

    def __init__(self, text: str, index: int) -> None:
        self.text = text
        self.index = index

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
        """The first word; empty where there is none."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Word) else ""


Node = Word | Group


def parse_group(source: Source, start: int) -> Group:
    """Return the nested list that opens at a token; the source is known to be balanced."""
    root = Group(start)
    open_groups = [root]
    tokens = source.tokens
    index = start
    while open_groups:
        index += 1
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


def describe(node: Node) -> str:
    """Name a node in a message: what was found."""
    if isinstance(node, Word):
        return f"'{shortened(node.text)}'"
    if not node.items:
        return "'()'"
    return f"'({shortened(node.head)} ...)'" if node.head else "'((...'"
