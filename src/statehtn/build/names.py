"""Names that HDDL can write and read again."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable

from statehtn.errors import UsageError
from statehtn.hddl.diagnostics import unknown
from statehtn.hddl.vocabulary import RESERVED

_NAME = re.compile(r"[^\s();?:-][^\s();]*")
WORDS = RESERVED | {"=", "<", ">", "<=", ">=", "+", "-", "*", "/", "either", "when", "increase", "probabilistic"}
"""Words with a meaning of their own wherever a predicate, a function or a task could stand."""


def new_name(name: object, kind: str, *taken: tuple[str, Container[str]]) -> str:
    """Return a name that is new.

    Args:
        kind: what it names, for messages.
        taken: pairs of a kind and the names of that kind that it must differ from.

    Raises:
        UsageError: it is no name, not in lower case (HDDL does not distinguish it), a word of HDDL, or taken.
    """
    article = "an" if kind[0] in "aeiou" else "a"
    if not isinstance(name, str):
        raise UsageError(f"the name of {article} {kind} must be a string, found {name!r}")
    if not _NAME.fullmatch(name) or name in WORDS:
        raise UsageError(
            f"'{name}' cannot name {article} {kind}: a name has no spaces, parentheses or semicolons, does not begin "
            f"with '?', ':' or '-', and is no word of HDDL such as 'and'"
        )
    if name != name.lower():
        raise UsageError(f"'{name}' cannot name {article} {kind}: names are in lower case, such as '{name.lower()}'")
    for other, names in taken:
        if name in names:
            raise UsageError(f"there is {'an' if other[0] in 'aeiou' else 'a'} {other} '{name}' already")
    return name


def not_declared(kind: str, name: str, known: Iterable[str]) -> UsageError:
    """Return the error that a name is unknown, with the most similar one that is known."""
    return UsageError(unknown(kind, name, known))
