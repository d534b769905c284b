"""Runs the blocks of documentation pages, of all of a page one after the other, in a directory like the project's root.

- Blocks of "python" share one namespace. A block of "text" right after one is what it prints.
- Lines of "console" blocks that begin with "$ " are commands for bash, which have to succeed; the others are what they
  print.
- A line "..." in what is printed stands for any lines.
- A block with a title is a file: an excerpt of the project's file of that name, or else written for what follows.
- A block after a line `<!-- not run: <reason> -->` is left out.
"""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import tempfile
import types
from collections.abc import Iterator
from contextlib import chdir, contextmanager, redirect_stdout
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).parents[1]
LINKED = ("README.md", "docs", "domains", "examples")
TIME_LIMIT = 120  # seconds for a command
_FENCE = re.compile(r"^(?P<indent> *)```(?P<language>[\w-]*)(?: +title=\"(?P<title>[^\"]+)\")? *$")
_NOT_RUN = re.compile(r"^ *<!-- not run: .+ -->$")


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block: its language, text and title, the line of the page that it begins in, whether it is left out."""

    language: str
    text: str
    line: int
    is_skipped: bool = False
    title: str | None = None

    @property
    def is_run(self) -> bool:
        return not self.is_skipped and (self.language in ("python", "console") or self.title is not None)


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
        yield Block(opening["language"], text, index + 1, bool(_NOT_RUN.match(before)), opening["title"])
        index = end + 1


def run_page(path: Path) -> int:
    """Run a page's blocks; return how many there were.

    Raises:
        AssertionError: a block prints something else than the page says, a command fails, or an excerpt is none. What
            a Python block raises is passed on, with the page's file name and lines in the traceback.
    """
    found = [block for block in blocks(path.read_text(encoding="utf-8")) if not block.is_skipped]
    module = types.ModuleType("page")
    with _scratch(), _module(module), mock.patch.dict(os.environ, _environment()):
        for block, following in zip_longest(found, found[1:]):
            if block.title is not None:
                _put(path, block)
            elif block.language == "console":
                _run_commands(path, block)
            elif block.language == "python":
                printed = io.StringIO()
                code = compile("\n" * block.line + block.text, str(path), "exec")
                with redirect_stdout(printed):
                    exec(code, module.__dict__)
                if following is not None and following.language == "text":
                    _compare(path, following.line, printed.getvalue(), following.text)
    return sum(block.is_run for block in found)


def _put(path: Path, block: Block) -> None:
    """Write a file, or look for an excerpt in it where the project has it."""
    assert block.title is not None
    if (ROOT / block.title).exists():
        if block.text not in (ROOT / block.title).read_text(encoding="utf-8"):
            raise AssertionError(f"{path.name}:{block.line}: no excerpt of {block.title}")
    else:
        Path(block.title).write_text(block.text, encoding="utf-8")


def _run_commands(path: Path, block: Block) -> None:
    """Run the commands of a console block; what each prints, on either stream, stands below it."""
    parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)
    assert not parts[0].strip(), f"{path.name}:{block.line}: a console block begins with '$ '"
    line = block.line + 1
    for part in parts[1:]:
        command, _, expected = part.partition("\n")
        run = subprocess.run(
            ["bash", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=TIME_LIMIT
        )
        if run.returncode != 0:
            raise AssertionError(f"{path.name}:{line}: exit code {run.returncode}:\n{run.stdout}")
        _compare(path, line, run.stdout, expected)
        line += part.count("\n")


def _compare(path: Path, line: int, printed: str, expected: str) -> None:
    patterns = [r"(?:.*\n)*" if row == "..." else re.escape(row) + "\n" for row in _stripped(expected)]
    if not re.fullmatch("".join(patterns), "".join(f"{row}\n" for row in _stripped(printed))):
        raise AssertionError(f"{path.name}:{line}: something else is printed:\n{printed}")


def _stripped(text: str) -> list[str]:
    return [line.rstrip() for line in text.strip("\n").rstrip().splitlines()]


def _environment() -> dict[str, str]:
    """Return what commands find themselves in: the command `statehtn`, and neither colours nor windows of plots."""
    search_path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', '')}"
    return {"PATH": search_path, "NO_COLOR": "1", "MPLBACKEND": "Agg"}


@contextmanager
def _scratch() -> Iterator[None]:
    """Work in a directory that has what the project's root has, and that may be written to."""
    with tempfile.TemporaryDirectory() as name:
        for linked in LINKED:
            (Path(name) / linked).symlink_to(ROOT / linked)
        with chdir(name):
            yield


@contextmanager
def _module(module: types.ModuleType) -> Iterator[None]:
    """Let classes that a page defines find their module."""
    sys.modules[module.__name__] = module
    try:
        yield
    finally:
        del sys.modules[module.__name__]
