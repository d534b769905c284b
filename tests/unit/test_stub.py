"""The types of the compiled module that mypy reads are those of the module."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import statehtn
import statehtn._relax as _relax


def declarations(stub: str) -> set[str]:
    """What a stub declares, in whatever order: functions, and members each with its class."""
    found: set[str] = set()
    for statement in ast.parse(stub).body:
        if isinstance(statement, ast.ClassDef):
            bases = ", ".join(map(ast.unparse, statement.bases))
            found.update(f"class {statement.name}({bases}): {ast.unparse(member)}" for member in statement.body)
        elif not isinstance(statement, ast.Import | ast.ImportFrom):
            found.add(ast.unparse(statement))
    return found


def test_the_stub_declares_what_the_module_has() -> None:
    """To write it anew: `python -m nanobind.stubgen -m statehtn._relax -o src/statehtn/_relax.pyi`, `make format`."""
    stubgen = pytest.importorskip("nanobind.stubgen")
    generator = stubgen.StubGen(_relax)
    generator.put(_relax)
    ours = Path(statehtn.__file__).with_name("_relax.pyi").read_text(encoding="utf-8")
    assert declarations(ours) == declarations(generator.get())
