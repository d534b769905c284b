"""The pages of the documentation do what they say."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.pages import ROOT, blocks, run_page

PAGES = [
    path
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
    if any(block.language == "python" and not block.is_skipped for block in blocks(path.read_text(encoding="utf-8")))
]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_every_python_block_runs_and_prints_what_the_page_says(path: Path) -> None:
    if "matplotlib" in path.read_text():
        pytest.importorskip("matplotlib", reason="the page draws")
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
