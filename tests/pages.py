"""Runs the Python blocks of documentation pages.

All blocks of a page run one after the other, in one namespace, in the project's root directory. A block of "text" that
follows a Python block is what that block prints. A block after a line `<!-- not run: <reason> -->` is left out.
"""

from __future__ import annotations

import io
import os
import re
import sys
import types
from collections.abc import Iterator
from contextlib import chdir, redirect_stdout
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

ROOT = Path(__file__).parents[1]
_FENCE = re.compile(r"^(?P<indent> *)```(?P<language>[\w-]*) *$")
_NOT_RUN = re.compile(r"^ *<!-- not run: .+ -->$")


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block: its language, its text, the line of the page that it begins in, and whether it is left out."""

    language: str
    text: str
    line: int
    is_skipped: bool = False


def blocks(page: str) -> Iterator[Block]:
    """Yield the fenced blocks of a page."""
    lines = page.splitlines()
    index = 0
    while index < len(lines):
        opening = _FENCE.match(lines[index])
        if opening is None:
            index += 1
            continue
        end = next(i for i in range(index + 1, len(lines)) if lines[i].strip() == "```")
        indent = len(opening["indent"])
        text = "".join(f"{line[indent:]}\n" for line in lines[index + 1 : end])
        before = next((line for line in reversed(lines[:index]) if line.strip()), "")
        yield Block(opening["language"], text, index + 1, bool(_NOT_RUN.match(before)))
        index = end + 1


def run_page(path: Path) -> int:
    """Run a page's Python blocks; return how many there were.

    Raises:
        AssertionError: a block prints something else than the page says. What a block raises is passed on, with the
            page's file name and lines in the traceback.
    """
    found = [block for block in blocks(path.read_text(encoding="utf-8")) if not block.is_skipped]
    module = types.ModuleType("page")
    count = 0
    with chdir(ROOT), _module(module):
        for block, following in zip_longest(found, found[1:]):
            if block.language != "python":
                continue
            printed = io.StringIO()
            code = compile("\n" * block.line + block.text, str(path), "exec")
            with redirect_stdout(printed):
                exec(code, module.__dict__)
            count += 1
            if following is not None and following.language == "text":
                found_text = printed.getvalue()
                if _stripped(found_text) != _stripped(following.text):
                    raise AssertionError(f"{path.name}:{following.line}: something else is printed:\n{found_text}")
    return count


def _stripped(text: str) -> list[str]:
    return [line.rstrip() for line in text.rstrip().splitlines()]


class _module:  # noqa: N801
    """Lets classes that a page defines find their module, and keeps windows of plots closed."""

    def __init__(self, module: types.ModuleType) -> None:
        self.module = module

    def __enter__(self) -> None:
        self.backend = os.environ.get("MPLBACKEND")
        os.environ["MPLBACKEND"] = "Agg"
        sys.modules[self.module.__name__] = self.module

    def __exit__(self, *_: object) -> None:
        del sys.modules[self.module.__name__]
        if self.backend is None:
            del os.environ["MPLBACKEND"]
        else:
            os.environ["MPLBACKEND"] = self.backend
