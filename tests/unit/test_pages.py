"""The pages of the documentation do what they say."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.pages import ROOT, blocks, run_page

PAGES = [
    path
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
    if any(block.is_run for block in blocks(path.read_text(encoding="utf-8")))
]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_every_block_runs_and_prints_what_the_page_says(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for library, word in (("matplotlib", "plot()"), ("scipy", "scipy"), ("unified_planning", "unified_planning")):
        if word in text:
            pytest.importorskip(library, reason=f"the page uses {library}")
    assert run_page(path) > 0


def page(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "page.md"
    path.write_text(text, encoding="utf-8")
    return path


def test_wrong_pages_are_found(tmp_path: Path) -> None:
    two = "```python\nx = 1\nprint(x + 1)\n```\n\n```text\n{}\n```\n"
    assert run_page(page(tmp_path, two.format("2"))) == 1
    with pytest.raises(AssertionError, match=r"page.md:6: something else is printed"):
        run_page(page(tmp_path, two.format("3")))
    with pytest.raises(NameError):
        run_page(page(tmp_path, "```python\nnot_there\n```\n"))
    assert run_page(page(tmp_path, "<!-- not run: it asks the network -->\n\n```python\nnot_there\n```\n")) == 0
    assert [(block.language, block.line) for block in blocks("a\n\n  ```lisp\n  (b\n   c)\n  ```\n")] == [("lisp", 3)]
    assert next(blocks("  ```lisp\n  (b\n   c)\n  ```\n")).text == "(b\n c)\n"


def test_wrong_commands_and_files_are_found(tmp_path: Path) -> None:
    good = "```console\n$ echo a; echo b >&2\na\nb\n$ statehtn --version | cut -c 1-8\nstatehtn\n```\n"
    assert run_page(page(tmp_path, good)) == 1
    with pytest.raises(AssertionError, match=r"page.md:2: something else is printed:\na"):
        run_page(page(tmp_path, "```console\n$ echo a\nb\n```\n"))
    with pytest.raises(AssertionError, match=r"page.md:3: exit code 3"):
        run_page(page(tmp_path, "```console\n$ true\n$ exit 3\n```\n"))
    gaps = "```console\n$ seq 9\n{}```\n"
    assert run_page(page(tmp_path, gaps.format("...\n4\n...\n"))) == 1
    for wrong in ("4\n...\n", "...\n4\n", "...\n5\n4\n...\n"):
        with pytest.raises(AssertionError):
            run_page(page(tmp_path, gaps.format(wrong)))
    read = 'import pathlib\nassert pathlib.Path("a.txt").read_text() == "x\\n"'
    written = f'```text title="a.txt"\nx\n```\n\n```python\n{read}\n```\n'
    assert run_page(page(tmp_path, written)) == 2
    assert not (ROOT / "a.txt").exists()
    excerpt = '```lisp title="domains/av/p1.hddl"\n{}\n```\n'
    assert run_page(page(tmp_path, excerpt.format("    (night)"))) == 1
    with pytest.raises(AssertionError, match=r"page.md:1: no excerpt of domains/av/p1.hddl"):
        run_page(page(tmp_path, excerpt.format("    (noon)")))
