"""The tables that lead from the paper to the code name files that are there, and names that are in them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.pages import ROOT

PAGES = (ROOT / "README.md", ROOT / "docs" / "paper-map.md")
FEWEST = {"README.md": 40, "paper-map.md": 60}  # names in each page's tables
_CODE = re.compile(r"`([^`]+)`")


def named(page: Path) -> Iterator[tuple[Path, str | None]]:
    """Yield the files of a page's tables, and the names that stand behind each.

    A column's head says in which folder its files are: `folder/`. In its cells a file is followed by names.
    """
    folders: list[str | None] = []
    for line in page.read_text(encoding="utf-8").splitlines():
        if not line.startswith("|"):
            folders = []
            continue
        cells = line.strip("|").split("|")
        if not folders:
            folders = [next((code for code in _CODE.findall(cell) if code.endswith("/")), None) for cell in cells]
            continue
        for folder, cell in zip(folders, cells, strict=True):
            path = None
            for code in _CODE.findall(cell) if folder is not None else ():
                if re.fullmatch(r"[\w/]+\.(py|hpp|cpp)", code):
                    path = ROOT / str(folder) / code
                    yield path, None
                elif path is not None:
                    yield path, code


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_files_and_names_are_there(page: Path) -> None:
    found = list(named(page))
    assert len(found) >= FEWEST[page.name]
    for path, name in found:
        assert path.is_file(), f"{page.name}: there is no {path.relative_to(ROOT)}"
        text = path.read_text(encoding="utf-8")
        for part in re.split(r"::|\.", name or ""):
            assert re.search(rf"\b{part}\b", text), f"{page.name}: {path.relative_to(ROOT)} has no {part}"


def test_what_is_wrong_is_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("| a | here: `tests/` |\n|---|---|\n| `x.py` | `pages.py`: `run_page`, `nothing`; `gone.py` |\n")
    assert list(named(page)) == [
        (ROOT / "tests" / "pages.py", None),
        (ROOT / "tests" / "pages.py", "run_page"),
        (ROOT / "tests" / "pages.py", "nothing"),
        (ROOT / "tests" / "gone.py", None),
    ]
