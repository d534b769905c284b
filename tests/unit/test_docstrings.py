"""Every public name is documented, and so is every public method of public classes, and every argument of functions."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import statehtn

SOURCES = Path(statehtn.__file__).parent
NAMES = [name for name in statehtn.__all__ if not name.startswith("_")]
CLASSES = [name for name in NAMES if inspect.isclass(getattr(statehtn, name))]
FUNCTIONS = [name for name in NAMES if inspect.isroutine(getattr(statehtn, name))]
VALUES = sorted(set(NAMES) - set(CLASSES) - set(FUNCTIONS))


def is_sentence(text: str | None) -> bool:
    """Tell whether a docstring begins with a sentence of more than two words, not with dataclass's own signature."""
    paragraph = (text or "").split("\n\n")[0]
    return len(paragraph.split()) > 2 and paragraph.rstrip().endswith((".", ":")) and paragraph[0].isupper()


def members(kind: type) -> Iterator[tuple[str, Any]]:
    """Yield the public methods and properties that a class and its bases in statehtn define."""
    for base in kind.__mro__:
        if base.__module__.startswith("statehtn"):
            for name, member in vars(base).items():
                found = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
                found = getattr(found, "func", found)  # cached properties
                if not name.startswith("_") and inspect.isroutine(found):
                    yield f"{base.__name__}.{name}", found


@pytest.mark.parametrize("name", [*CLASSES, *FUNCTIONS])
def test_a_public_name_has_a_docstring(name: str) -> None:
    assert is_sentence(vars(getattr(statehtn, name)).get("__doc__") or getattr(statehtn, name).__doc__), name


@pytest.mark.parametrize("name", CLASSES)
def test_so_has_every_public_method_and_property(name: str) -> None:
    wanting = [place for place, member in members(getattr(statehtn, name)) if not is_sentence(inspect.getdoc(member))]
    assert wanting == []


@pytest.mark.parametrize("name", CLASSES)
def test_and_every_field_of_a_dataclass_is_spoken_of(name: str) -> None:
    kind = getattr(statehtn, name)
    fields = [field for field in getattr(kind, "__dataclass_fields__", {}) if not field.startswith("_")]
    text = inspect.getdoc(kind) or ""
    assert [field for field in fields if not re.search(rf"\b{field}\b", text)] == []


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_argument_of_a_function_is_spoken_of(name: str) -> None:
    function = getattr(statehtn, name)
    text = inspect.getdoc(function) or ""
    arguments = inspect.signature(function).parameters
    assert [argument for argument in arguments if not re.search(rf"\b{argument}\b", text)] == []


@pytest.mark.parametrize("name", VALUES)
def test_a_public_value_has_a_docstring_below_it(name: str) -> None:
    documented = []
    for path in SOURCES.rglob("*.py"):
        body = ast.parse(path.read_text(encoding="utf-8")).body
        for statement, below in pairwise(body):
            match statement:
                case ast.Assign(targets=[ast.Name(id=target)]) | ast.AnnAssign(target=ast.Name(id=target)):
                    if target == name and isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
                        documented.append(is_sentence(inspect.cleandoc(str(below.value.value))))
    assert documented  # another module may have a value of the same name
    assert all(documented)
